"""Walls with two faces that are read once, of all loads together and when it is first asked for, against walls read at once."""

from __future__ import annotations

import pickle
from dataclasses import replace

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.cascade import CascadeSystem
from coaxshell.solver.faced_forces import moved_by_forces, moved_surfaces
from coaxshell.solver.interface.absorbers import absorber_set
from coaxshell.solver.interface.seen import as_seen
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.solid_spectra import FacedSystem
from coaxshell.solver.structure_spectra import StructureSpectra

STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=210e9, poisson_ratio=0.3)
CERAMIC = cx.materials.PZT4_STANDARD
WATER = cx.Fluid(density=1000, sound_speed=1400)
SHOCK = cx.PlaneShock(peak_pressure=25e3, decay_time=0.13e-3)
GRID, MODES = LaplaceGrid(0.02, 40), Modes.up_to(5)
THEORIES = [("elastic", "elastic"), ("elastic", "thin"), ("thin", "elastic")]


def problem(theories: tuple[str, ...] = THEORIES[0], absorbers: object = ()) -> Problem:
    layers = [cx.Layer(STEEL, 0.02), cx.Layer(CERAMIC, 0.004, role="sensor")]
    shells = [cx.Shell(radius=r, layers=layers, theory=t) for r, t in zip((0.5, 1.0), theories, strict=True)]
    return dimensionless(cx.System(shells=shells, fluids=[WATER] * 3, source=SHOCK, absorbers=absorbers))


def pressures(structure: StructureSpectra) -> np.ndarray:
    """Return pressures on all surfaces, cosines and sines."""
    shape = len(structure.problem.surfaces), 2, structure.modes.count, GRID.nodes.size
    return np.random.default_rng(1).normal(size=shape) * np.exp(-GRID.nodes / 50.0)


@pytest.mark.parametrize("theories", THEORIES)
def test_loads_are_added_up_and_read_once(theories: tuple[str, ...]) -> None:
    """As what the sources and what the forces do are read each and added, to rounding."""
    structure = StructureSpectra(problem(theories), GRID, MODES)
    at_once, pressure = StructureSpectra(problem(theories), GRID, MODES), pressures(structure)
    forced = moved_by_forces(structure.problem, GRID, MODES, pressure)
    sources = at_once.solid
    assert sources is not None
    expected, found = sources.plus(forced), structure.forced_spectra(pressure).solid
    assert found is not None
    for name in ("normal", "tangential", "hoop", "potentials", "faces", "loads"):
        a, b = getattr(found, name), getattr(expected, name)
        np.testing.assert_allclose(a, b, rtol=0.0, atol=1e-11 * np.abs(b).max())
    np.testing.assert_allclose(structure.surface_motion, at_once.surface_motion, rtol=0.0, atol=1e-12 * np.abs(sources.normal).max())


def test_what_is_read_later_is_what_the_walls_do() -> None:
    """Faces, hoop stress and potentials from the loads as they come with the motion."""
    structure = StructureSpectra(problem(THEORIES[1]), GRID, MODES)
    solid, some = structure.solid, slice(3, 9)
    assert solid is not None
    system = FacedSystem(structure.problem, GRID.nodes[some], MODES)
    answer = system._together([system.cascade.solve_outside(np.ones((MODES.count, 6), np.complex128))])[0]
    load = solid.loads[0, 0, 0, :, some] / answer.faces.load_inner  # of the true source per unit pressure
    np.testing.assert_allclose(solid.hoop[0, 0, :, some], answer.hoop * load, rtol=1e-10)
    np.testing.assert_allclose(solid.potentials[0, 0, 0, :, some], answer.potentials[0] * load, rtol=1e-10)
    for side in (0, 1):
        np.testing.assert_allclose(solid.faces[side, 0, 0, :, some], answer.faces[side] * load, rtol=1e-9)


def test_faces_of_one_gap() -> None:
    """Two equations give what the way through all walls does."""
    found = problem()
    cascade = CascadeSystem(found, GRID.nodes, MODES)
    moved = [cascade.solve(one.shell, 1.0, one.side) for one in found.surfaces]
    columns, answers = [moved_surfaces(found, one) for one in moved], cascade.gap_answers()
    for (inner, outer), (q_a, q_b), column in zip(moved, answers.loads, columns, strict=True):
        (y_a, y_b), (behind_a, behind_b) = answers.receptances, answers.behind
        every = [inner.load_inner, inner.load_outer, outer.load_inner, outer.load_outer, *column]
        for expected, told in zip(every, [behind_a * q_a, q_a, q_b, behind_b * q_b, y_a * q_a, y_b * q_b], strict=True):
            np.testing.assert_allclose(told, expected, rtol=0, atol=1e-11 * np.abs(expected).max())
    for i, row in enumerate(cascade.gap_compliance()):
        for j, entry in enumerate(row):
            np.testing.assert_allclose(entry, columns[j][i], rtol=1e-11)


def test_first_and_later_absorbers_march_alike() -> None:
    """Kernels added up over the orders before they are inverted, or after."""
    ring = cx.AbsorberRing(count=4, mass=50.0, damping=1e5, linear_stiffness=1e9, cubic_stiffness=1e20, footprint=0.05)
    described = problem(absorbers=ring)
    structure, links = StructureSpectra(described, GRID, MODES), absorber_set(described, described.system.absorber_list, 1)
    first = as_seen(structure, links).kernels.kernels
    assert structure.units.kernels is None
    structure.units.classes.clear()
    later = as_seen(structure, links).kernels.kernels
    assert structure.units.kernels is not None
    np.testing.assert_allclose(first, later, rtol=0.0, atol=1e-12 * np.abs(later).max())


def test_histories_are_made_when_they_are_read_and_go_with_copies() -> None:
    """A run that is pickled or replaced takes them along."""
    solution = cx.simulate(problem().system, duration=0.5, time_step=0.02, modes=4).solution
    assert not solution.here("hoop")
    copied, changed = pickle.loads(pickle.dumps(solution)), replace(solution, warnings=())
    for name in ("hoop", "potentials"):
        assert copied.here(name)
        np.testing.assert_array_equal(getattr(copied, name), getattr(solution, name))
        np.testing.assert_array_equal(getattr(changed, name), getattr(solution, name))
    assert solution.here("hoop")
    with pytest.raises(AttributeError):
        solution.nothing_like_it  # noqa: B018
