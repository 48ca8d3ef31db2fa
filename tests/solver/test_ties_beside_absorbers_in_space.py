"""Segments and matrices of feedback beside absorbers in three dimensions: laws met at every node, two dimensions, balances, refusals."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from electrode_pairs import BOTH, pairs

import coaxshell as cx
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.axial.blocks import node_blocks, on_threads
from coaxshell.solver.axial.line_solve import solve_lines
from coaxshell.solver.axial.lines import line_layout
from coaxshell.solver.axial.linked import point_structure, solve_points
from coaxshell.solver.axial.motion import wave_motions
from coaxshell.solver.axial.points import point_layout
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.interface.absorbers import point_law
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.solid_spectra import band

PLANE = cx.PlaneShock(peak_pressure=25e3, decay_time=1.314e-4)
SMALL: dict[str, Any] = {"duration": 0.4, "time_step": 4e-2, "modes": 3, "dimensions": 3, "axial_modes": 1.0, "axial_period": 12.0}
MIXED = [[1.0, 0.5], [0.3, 0.8]]
CUT: dict[str, Any] = {"segments": 3, "segment_gap": 0.02, "dead": [1]}
THIN, BESIDE_THIN = ("thin", "thin"), ("thin", "elastic")
ONE: dict[str, Any] = {"mass": 50.0, "damping": 1e5, "linear_stiffness": 1e9, "footprint": 0.2}
LINES = [cx.Absorber(angle=angle, **ONE) for angle in (20.0, 160.0, 250.0)]
POINTS = [cx.PointAbsorber(angle=angle, z=z, **ONE) for angle, z in ((20.0, 0.0), (-20.0, 0.0), (250.0, 0.3))]


def system(theories: tuple[str, str], absorbers: Any, **law: Any) -> cx.System:
    """Return pairs of electrodes under a lead with absorbers, walls of two theories."""
    return pairs(theories, **law).replace(absorbers=absorbers)


def solvable(described: cx.System) -> tuple[Any, LaplaceGrid, AxialSampling]:
    grid = LaplaceGrid(0.08, 5)
    return dimensionless(described, 3).resolving(band(grid)), grid, AxialSampling(12.0, 3, 1.0)


@pytest.mark.parametrize("theories", [THIN, BESIDE_THIN], ids="-".join)
def test_lines_beside_segments_obey_their_law_at_every_wavenumber(theories: tuple[str, str]) -> None:
    """What forces of the run, as loads on all waves, make of the walls at the lines asks for these forces again."""
    problem, grid, sampling = solvable(system(theories, LINES, matrix=MIXED, **CUT))
    layout = line_layout(problem, sampling)
    solved, law = solve_lines(layout, grid, on_threads), point_law(layout.absorbers, grid.nodes)
    assert solved.exact is not None
    force, parities = solved.exact[0][:, :, 0], layout.absorbers.parities
    for j, wave in enumerate(wave_motions(problem, sampling, grid, solved.forces)):
        felt, moved = layout.felt(wave.modes), wave.of_surfaces[:, :parities]
        walls = np.stack([np.einsum("hm,hmk->k", felt[:, n], moved[i]) for n, i in enumerate(layout.points.surface)])
        asked = -np.einsum("kab,bk->ak", law, walls)
        np.testing.assert_allclose(force[j], asked, rtol=0, atol=1e-9 * np.abs(asked).max())
        assert wave.voltage is not None


@pytest.mark.parametrize("theories", [THIN, BESIDE_THIN], ids="-".join)
def test_points_beside_segments_obey_their_law(theories: tuple[str, str]) -> None:
    problem, grid, sampling = solvable(system(theories, POINTS, matrix=MIXED, **CUT))
    layout = point_layout(problem)
    solved = solve_points(point_structure(problem, grid, sampling, layout, node_blocks(grid), on_threads))
    walls = np.sum([wave.at_points(layout.carried) for wave in wave_motions(problem, sampling, grid, solved.forces)], axis=0)
    asked = -np.einsum("kab,bk->ak", point_law(layout.absorbers, grid.nodes), walls)
    np.testing.assert_allclose(solved.carried, asked, rtol=0, atol=1e-9 * np.abs(asked).max())


@pytest.mark.parametrize(("theories", "absorbers"), [(THIN, POINTS), (BESIDE_THIN, LINES)], ids=["points", "lines"])
def test_shells_that_read_themselves_are_those_without_a_matrix(theories: tuple[str, str], absorbers: Any) -> None:
    own, unit = (cx.simulate(system(theories, absorbers, matrix=matrix), stations=[0.2], **SMALL) for matrix in (None, [[1, 0], [0, 1]]))
    for name, values in own.spatial.fields.items():
        np.testing.assert_allclose(unit.spatial.fields[name], values, rtol=0, atol=1e-12 * np.abs(values).max())


def test_symmetric_lines_beside_dead_segments_are_two_dimensions() -> None:
    """Dead segments excite both parities, of elastic walls too, so that mirror images of absorbers do not move alike."""
    described = system(BOTH, [LINES[0].replace(angle=angle) for angle in (0.0, 90.0, 270.0)], matrix=MIXED, **CUT).replace(source=PLANE)
    flat = cx.simulate(described, **{name: SMALL[name] for name in ("duration", "time_step", "modes")})
    space = cx.simulate(described, stations=[0.3], **SMALL)
    np.testing.assert_allclose(space.spatial.fields["w"][0], flat.solution.normal, rtol=0, atol=1e-11 * np.abs(flat.solution.normal).max())
    nudged = described.replace(absorbers=[one.replace(angle=one.angle + 1e-6) for one in described.absorbers])  # symmetric no more
    other = cx.simulate(nudged, **{name: SMALL[name] for name in ("duration", "time_step", "modes")}).solution.normal
    for shell in (0, 1):
        size = np.abs(flat.solution.normal[shell]).max()
        np.testing.assert_allclose(flat.solution.normal[shell], other[shell], rtol=0, atol=1e-6 * size)


@pytest.mark.parametrize(
    ("theories", "absorbers", "law"),
    [
        (BESIDE_THIN, [one.replace(cubic_stiffness=1e20) for one in POINTS], CUT),
        (THIN, [one.replace(cubic_stiffness=1e20) for one in LINES], {}),
    ],
    ids=["points beside segments", "lines beside a matrix"],
)
def test_balances_close_beside_cubic_springs(theories: tuple[str, str], absorbers: Any, law: dict[str, Any]) -> None:
    response = cx.simulate(system(theories, absorbers, matrix=MIXED, **law), stations=[0.0], **{**SMALL, "time_step": 2e-2})
    energy = response.energy(every=5)
    assert float(np.abs(energy.closure_relative).max()) < 1e-4
    electrical = energy.amplifier_work - (energy.actuator_field - energy.actuator_work)
    assert float(np.abs(electrical).max()) < 1e-9 * float(np.abs(energy.actuator_work).max())


def test_marched_lines_beside_segments_are_refused_with_a_remedy() -> None:
    cubic = [one.replace(cubic_stiffness=1e20) for one in LINES]
    with pytest.raises(cx.InputError, match=r"control\.segments: 3 segments tie .* march of line absorbers .*use linear springs, point"):
        cx.simulate(system(THIN, cubic, segments=3), stations=[0.0], **SMALL)
