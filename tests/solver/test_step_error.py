"""The march at longer steps that the step's error is told from: its kernels, and the points of the absorbers marched alone."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver import estimates, step_error
from coaxshell.solver.interface import saturation
from coaxshell.solver.interface.absorbers import InterfacePoints, absorber_set
from coaxshell.solver.interface.march import march
from coaxshell.solver.orders_left_out import relative, surface_norms
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.structure_spectra import StructureSpectra

ABSORBERS = [
    cx.Absorber(angle=angle, mass=10, damping=1e5, linear_stiffness=1e9, cubic_stiffness=1e20, inner_shell=inner)
    for angle, inner in ((0.0, 0), (70.0, 1), (-110.0, 0))
]


@pytest.fixture(scope="module")
def structure() -> StructureSpectra:
    bare = cx.presets.load("bare")
    shells = [bare.shells[0].replace(radius=0.4), *bare.shells]
    system = bare.replace(shells=shells, fluids=[bare.fluids[0], *bare.fluids], absorbers=ABSORBERS)
    return StructureSpectra(dimensionless(system), LaplaceGrid(5e-3, 203), Modes.up_to(12))


@pytest.mark.parametrize("every", [2, 4, 8])
def test_summed_kernels_answer_forces_linear_over_the_longer_steps_alike(structure: StructureSpectra, every: int) -> None:
    links = absorber_set(structure.problem, tuple(ABSORBERS), 1)
    coarser = step_error.CoarserStructure(structure, every, True, links)
    fine, coarse = structure.kernels.kernels[1, 2, 3], coarser.kernels.kernels[1, 2, 3]
    force = np.random.default_rng(0).normal(size=coarse.size)
    force[0] = 0.0
    between = np.interp(structure.grid.time, coarser.grid.time, force)
    expected = np.convolve(between, fine)[: fine.size : every][: coarse.size]
    np.testing.assert_allclose(np.convolve(force, coarse)[: coarse.size], expected, rtol=0, atol=1e-12 * np.abs(expected).max())


def test_points_alone_move_as_they_do_with_the_shells(structure: StructureSpectra, monkeypatch: pytest.MonkeyPatch) -> None:
    links = absorber_set(structure.problem, tuple(ABSORBERS), 1)
    alone = step_error.CoarserStructure(structure, 4, False, links)
    monkeypatch.setattr(step_error, "_MANY", 0)
    together = step_error.CoarserStructure(structure, 4, False, links)
    assert alone.kernels.shape[2] == 1
    assert together.kernels.shape[2] == structure.modes.count
    found, expected = (march(seen, links).force for seen in (alone, together))
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * np.abs(expected).max())


def test_kernels_between_points_are_their_receptance(structure: StructureSpectra) -> None:
    links = absorber_set(structure.problem, tuple(ABSORBERS), 1)
    points = InterfacePoints(structure.problem, links, structure.modes)
    nodes = structure.compliance[..., ::50]
    found = points.between(nodes)
    np.testing.assert_allclose(np.moveaxis(found, -1, 0), points.receptance(nodes), rtol=0, atol=1e-13 * np.abs(found).max())
    orders = np.array([0, 3, 7])
    force = np.random.default_rng(0).normal(size=(points.count, 5))
    np.testing.assert_allclose(points.project(force, orders), points.project(force)[:, :, orders], rtol=1e-13)


def test_what_points_fold_back_is_estimated(monkeypatch: pytest.MonkeyPatch) -> None:
    """Against a run that cuts voltages at four times as many points; and the repeated march tells how far it is."""
    system = cx.presets.load("hybrid").with_overrides({"control.saturation": True, "absorbers.count": 5})
    folded, told = [], []
    estimate = estimates.folded_error
    monkeypatch.setattr(estimates, "folded_error", lambda *given: folded.append(estimate(*given)) or folded[-1])
    run = cx.simulate(system, duration=0.8, modes=46, time_step=1e-2, progress=lambda share, stage: told.append((stage, share))).solution
    assert run.estimates.orders.min() > 0.0
    assert ("error estimates", 1.0) in told
    monkeypatch.setattr(saturation, "_OVERSAMPLING", 4 * saturation._OVERSAMPLING)
    fine = cx.simulate(system, duration=0.8, modes=46, time_step=1e-2).solution
    changed = surface_norms(run.normal - fine.normal, run.tangential - fine.tangential).sum(axis=-1)
    true = relative(changed, surface_norms(fine.normal, fine.tangential).sum(axis=-1))
    assert np.all(2.0 * folded[0] > 0.5 * true)
    assert np.all(folded[0][:, 1] < 3.0 * true[:, 1])
