"""Line absorbers that hold arcs of thin and exact walls in three dimensions: against points, two dimensions, limits, balances."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import coaxshell as cx

STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=210e9, poisson_ratio=0.3)
WATER = cx.Fluid(density=1000, sound_speed=1400)
SPHERE = cx.SphericalShock(distance=3.0, peak_pressure=25e3, decay_time=0.13e-3)
PLANE = cx.PlaneShock(peak_pressure=25e3, decay_time=0.13e-3)
LINES = {"mass": 50.0, "damping": 1e5, "linear_stiffness": 1e9, "footprint": 0.2}
BENT = {**LINES, "cubic_stiffness": 1e21}
EXACT, MIXED, THIN = ("elastic", "elastic"), ("elastic", "thin"), ("thin", "thin")


def system(theories: tuple[str, ...], absorbers: Any, thickness: float = 0.02, source: Any = SPHERE) -> cx.System:
    shells = [cx.Shell(radius=r, layers=[cx.Layer(STEEL, thickness)], theory=t) for r, t in zip((0.5, 1.0), theories, strict=True)]
    return cx.System(shells=shells, fluids=[WATER] * 3, source=source, absorbers=absorbers)


def run(described: cx.System, **settings: Any) -> Any:
    return cx.simulate(described, **{"duration": 0.4, "time_step": 2e-2, "modes": 4, "dimensions": 3, **settings})


def off(found: Any, true: Any) -> float:
    found, true = np.asarray(found), np.asarray(true)
    return float(np.linalg.norm(found - true) / np.linalg.norm(true))


@lru_cache(maxsize=1)
def bent() -> Any:
    """Return a marched run in the plane of the source and beside it."""
    return run(system(MIXED, cx.absorber_ring(3, **BENT)), stations=[0.0, 0.4])


@pytest.mark.parametrize(("theories", "law"), [(EXACT, LINES), (MIXED, BENT), (THIN, BENT)])
def test_under_a_uniform_source_all_is_as_in_two_dimensions(theories: tuple[str, ...], law: dict[str, float]) -> None:
    described = system(theories, cx.absorber_ring(3, **law), source=PLANE)
    flat, space = run(described, dimensions=2), run(described)
    assert off(space.stress("inner", station=0.0), flat.stress("inner")) < 1e-9
    assert off(space.absorber_force(station=0.0), flat.absorber_force()) < 1e-9


def test_lattices_and_any_layout_agree() -> None:
    """Orders that are added up by classes, with their means over the arcs, and all orders beside each other."""
    ring: Any = cx.absorber_ring(3, **LINES)
    nothing = cx.Absorber(angle=17.3, mass=1e-9, linear_stiffness=1e-9, footprint=0.1)
    folded, apart = (run(system(EXACT, absorbers)) for absorbers in (ring, (*ring.absorbers, nothing)))
    assert off(folded.absorber_force(), apart.absorber_force()[:-1]) < 1e-9


@pytest.mark.slow
def test_short_arcs_are_lines_and_exact_walls_tend_to_thin_ones() -> None:
    """By O(h), thin walls wetted at their faces and held over the same arcs."""
    lines = [run(system(THIN, cx.absorber_ring(3, **{**LINES, "footprint": b}))).absorber_force() for b in (1e-7, None)]
    assert off(*lines) < 1e-9
    errors = []
    for thickness in (0.02, 0.005):
        thin = system(THIN, cx.absorber_ring(3, **LINES), thickness)
        thin = thin.replace(shells=[one.replace(wetted="faces") for one in thin.shells])
        exact = system(EXACT, cx.absorber_ring(3, **LINES), thickness)
        errors.append(off(*(run(one, modes=3, axial_period=8.0).absorber_force() for one in (exact, thin))))
    assert errors[1] < 3e-3
    assert errors[0] / errors[1] > 2.8


def test_the_energy_closes_and_files_hold_what_forces_moved(tmp_path: Path) -> None:
    found = bent()
    balance = found.energy(every=10)
    assert float(np.abs(balance.closure_relative).max()) < 1e-4
    assert float(balance.damper_dissipation[-1]) > 1e-2 * float(balance.exterior_work.max())
    again = cx.load_response(found.save(tmp_path / "run.nc"))
    np.testing.assert_array_equal(again.absorber_force(), found.absorber_force())
    skin, field = ([one.stress("inner", depth="outer"), one.pressure(x=[0.7], y=[0.1], z=0.1, time=[0.3])] for one in (again, found))
    for there, here in zip(skin, field, strict=True):
        np.testing.assert_allclose(there, here, rtol=1e-9)
