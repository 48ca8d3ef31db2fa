"""Dampers far stiffer than the walls they link, where dD/dt is a small difference of large velocities; and refined runs."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.errors import InputError
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.response import Response
from coaxshell.solver.interface import march as marching
from coaxshell.solver.interface.absorbers import absorber_set
from coaxshell.solver.interface.link_motion import marched_motion
from coaxshell.solver.interface.march import march
from coaxshell.solver.interface.newton import ConvergenceError, ImplicitStep
from coaxshell.solver.recompute import spectra_of
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.structure_spectra import StructureSpectra
from coaxshell.studies.reading import MetricSource

pytestmark = pytest.mark.filterwarnings("ignore::coaxshell.PhysicsWarning")

COARSE = {"duration": 1.0, "time_step": 0.02, "modes": 4}


def system(**absorber: float) -> cx.System:
    found = cx.presets.load("absorbers")
    return found.replace(absorbers=found.absorbers.replace(**{"cubic_stiffness": 0.0, **absorber}))


@cache
def solved(damping: float, refinement: int = 1, **absorber: float) -> Response:
    return cx.simulate(system(damping=damping, **absorber), refinement=refinement, **COARSE)


@cache
def balance(damping: float, refinement: int = 1, **absorber: float) -> Any:
    return solved(damping, refinement, **absorber).energy(every=10)


@pytest.mark.slow_for("1000000000.0-4-9.0")
@pytest.mark.parametrize(("damping", "refinement", "mass"), [(1e9, 1, 9.0), (1e10, 1, 9.0), (1e13, 1, 9.0), (1e9, 4, 9.0), (1e9, 1, 0.0)])
def test_linear_ones_close_at_any_step(damping: float, refinement: int, mass: float) -> None:
    assert np.abs(balance(damping, refinement, mass=mass)["closure_relative"]).max() < 5e-5


@pytest.mark.parametrize("absorber", [{}, pytest.param({"mass": 0.0}, marks=pytest.mark.slow)], ids=["mass", "massless"])
def test_marched_ones_close_at_second_order_and_refinement_helps(absorber: dict[str, float]) -> None:
    worst = [float(np.abs(balance(1e9, n, cubic_stiffness=1e16, **absorber)["closure_relative"]).max()) for n in (1, 4)]
    assert worst[0] < 5e-3
    assert worst[1] < worst[0] / 8.0


@pytest.mark.parametrize(("damping", "cubic", "limit"), [(1e9, 0.0, 2e-3), (1e10, 0.0, 2e-3), (1e10, 1e16, 0.05)])
def test_what_they_take_is_force_squared_over_damping(damping: float, cubic: float, limit: float) -> None:
    """Springs give nothing to a force held by such a damper: the integral of f^2/c over all links of a run of a quarter of the step."""
    fine = cx.simulate(system(damping=damping), **{**COARSE, "time_step": 0.005}).absorber_force()
    seconds = 0.005 * dimensionless(system()).scales.time
    expected = float(np.trapezoid((fine.to_numpy() ** 2).sum(axis=(0, 1)), dx=seconds)) / damping
    found = solved(damping, cubic_stiffness=cubic)
    assert MetricSource(found).dissipated_energy == pytest.approx(expected, rel=limit)
    assert balance(damping, cubic_stiffness=cubic)["damper_dissipation"][-1] == pytest.approx(expected, rel=limit)


@pytest.mark.slow_for("1e+16")
@pytest.mark.parametrize("cubic", [0.0, 1e16])
def test_a_refined_run_has_the_fields_and_energies_of_the_fine_one(cubic: float, tmp_path: Path) -> None:
    refined = solved(1e9, 4, cubic_stiffness=cubic)
    fine = cx.simulate(system(damping=1e9, cubic_stiffness=cubic), **{**COARSE, "time_step": 0.005})
    refined.save(tmp_path / "refined.nc")
    ask = {"time": 0.9, "radius": np.linspace(0.6, 0.9, 3), "angle": [0.0, 40.0]}
    expected = fine.pressure(**ask).to_numpy()
    loaded = cx.load_response(tmp_path / "refined.nc")
    for run in (refined, loaded):
        np.testing.assert_allclose(run.pressure(**ask).to_numpy(), expected, rtol=1e-9, atol=1e-9 * np.nanmax(np.abs(expected)))
    energies, other = loaded.energy(every=10), fine.energy(every=40)
    np.testing.assert_allclose(energies["time"], other["time"], rtol=1e-12)
    for name in ("exterior_work", "damper_dissipation", "closure_residual", "gap_kinetic", "absorber_spring"):
        np.testing.assert_allclose(energies[name], other[name], rtol=1e-7, atol=1e-9 * float(np.abs(other["exterior_work"]).max()))


def test_a_refined_saturated_run_is_recomputed_as_it_was_solved() -> None:
    found = cx.presets.load("active")
    found = found.replace(control=found.control.replace(saturation=True, field_limit=10.0))
    solution = cx.simulate(found, refinement=3, **COARSE).solution
    spectra = spectra_of(solution)
    assert spectra.actuation is not None
    again = spectra.grid.invert(spectra.normal)[..., ::3]
    np.testing.assert_allclose(again, solution.normal, rtol=0, atol=1e-10 * np.abs(solution.normal).max())


def test_rates_of_a_marched_link_are_those_of_its_law() -> None:
    """f made of a known D by the trapezoidal rule, for dampers from nearly none to rigid ones."""
    rng, step, law = np.random.default_rng(1), 0.01, (3.0, 0.7, 40.0)
    for c in (1e-6, 1.0, 1e8):
        rate = np.cumsum(rng.standard_normal((1, 2, 300)), axis=-1) / max(c, 1.0)
        rate[..., 0] = 0.0
        stretch = np.concatenate([np.zeros((1, 2, 1)), np.cumsum(0.5 * step * (rate[..., 1:] + rate[..., :-1]), axis=-1)], axis=-1)
        force = c * rate + law[1] * stretch + law[2] * stretch**3
        links = absorber_set(dimensionless(system()), system(count=1).absorber_list, 1)
        links = replace(links, damping=np.array([c]), linear=np.array([law[1]]), cubic=np.array([law[2]]))
        found = marched_motion(links, step, force, np.zeros((1, 300)))
        np.testing.assert_allclose(found.stretch_rate, rate, rtol=1e-6, atol=1e-6 * np.abs(rate).max())


@pytest.mark.parametrize(("preset", "blamed"), [("active", "saturating actuators"), ("hybrid", "absorbers and saturating actuators")])
def test_only_what_is_there_is_called_too_stiff_for_the_step(preset: str, blamed: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise ConvergenceError

    monkeypatch.setattr(ImplicitStep, "solve", fail)
    for without_newton in ("march_actuators", "march_beside"):  # alone and beside absorbers, before Newton's method of all unknowns
        monkeypatch.setattr(marching, without_newton, lambda *_: None)
    found = cx.presets.load(preset)
    problem = dimensionless(found)
    links = absorber_set(problem, found.absorber_list, 1)
    with pytest.raises(InputError, match=f"too coarse for the {blamed}: their forces"):
        march(StructureSpectra(problem, LaplaceGrid(0.02, 20), Modes.up_to(3)), links, saturate=True)
