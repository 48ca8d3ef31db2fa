"""Linear absorbers, exact at each Laplace node: any layout, and rings by their symmetry."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.interface import absorbers
from coaxshell.solver.interface.absorbers import InterfacePoints, absorber_set, admittance
from coaxshell.solver.interface.linear import solve_linear
from coaxshell.solver.interface.linear_ring import is_ring, solve_ring
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.structure_spectra import StructureSpectra

PAPERS = {"mass": 10, "damping": 1e6, "linear_stiffness": 1e9}
SETTINGS = {"duration": 1.0, "time_step": 1e-2, "modes": 12}


@pytest.fixture(scope="module")
def structure() -> StructureSpectra:
    return StructureSpectra(dimensionless(cx.presets.load("bare")), LaplaceGrid(1e-2, 100), Modes.up_to(12))


@pytest.mark.parametrize("offset", [0.0, 7.3])
@pytest.mark.parametrize("count", [1, 2, 5, 6, 24, 25, 40])
def test_a_ring_equals_any_layout(structure: StructureSpectra, count: int, offset: float) -> None:
    links = absorber_set(structure.problem, cx.absorber_ring(count, offset=offset, **PAPERS).absorbers, 1)
    assert is_ring(links)
    by_symmetry = solve_ring(structure, links)
    in_general = solve_linear(structure, links, InterfacePoints(structure.problem, links, structure.modes))
    for name in ("force", "mass_displacement", "modal_pressure"):
        found, expected = getattr(by_symmetry, name), getattr(in_general, name)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-11 * abs(expected).max(), err_msg=name)


def test_what_is_no_ring(structure: StructureSpectra) -> None:
    ring = list(cx.absorber_ring(6, **PAPERS).absorbers)
    others = (
        ring[:5],
        [*ring[:5], ring[5].replace(mass=11)],
        [*ring[:5], ring[5].replace(angle=300.001)],
        [*ring[:5], ring[5].replace(damping=0)],
    )
    for layout in others:
        assert not is_ring(absorber_set(structure.problem, tuple(layout), 1))


def test_admittance_meets_the_equations_of_motion(structure: StructureSpectra) -> None:
    links = absorber_set(structure.problem, (cx.Absorber(angle=20, **PAPERS), cx.Absorber(angle=50, mass=0, linear_stiffness=1e8)), 1)
    s = structure.grid.nodes[::10]
    own, other, mass = admittance(links, s)
    inner, outer = 0.3 + 0.1j, -0.2j
    q = mass * (inner + outer)
    z = links.damping * s[:, None] + links.linear
    forces = z * (q - inner), z * (q - outer)
    np.testing.assert_allclose(forces[0], -(own * inner + other * outer), rtol=1e-12)
    np.testing.assert_allclose(forces[1], -(other * inner + own * outer), rtol=1e-12)
    np.testing.assert_allclose(links.mass * s[:, None] ** 2 * q, -sum(forces), rtol=0, atol=1e-12 * abs(forces[0]).max())


def test_no_absorber_is_bare() -> None:
    bare = cx.simulate(cx.presets.load("bare"), **SETTINGS)
    for nothing in (cx.absorber_ring(0, **PAPERS), []):
        without = cx.simulate(cx.presets.load("bare").replace(absorbers=nothing), **SETTINGS)
        np.testing.assert_array_equal(without.solution.normal, bare.solution.normal)


def test_weak_absorbers_add(structure: StructureSpectra) -> None:
    # To first order in their stiffness, two absorbers act as the sum of each alone.
    one, other = (cx.Absorber(angle=angle, mass=10, linear_stiffness=1e3) for angle in (30, 100))
    system = cx.presets.load("bare")
    none, first, second, both = (
        cx.simulate(system.replace(absorbers=fitted), **SETTINGS).displacement("outer", [0, 90])
        for fitted in ([], [one], [other], [one, other])
    )
    change = np.asarray(both - none)
    np.testing.assert_allclose(np.asarray(first + second - 2 * none), change, rtol=0, atol=1e-4 * abs(change).max())


@pytest.mark.parametrize("kept", [0, 10**9])
def test_receptance_by_pairs_and_by_points(monkeypatch, kept):
    """A point answers a force at another by the sum of all orders' compliances times both shapes."""
    monkeypatch.setattr(absorbers, "_PAIR_BYTES", kept)
    listed = [cx.Absorber(angle=angle, mass=1.0, linear_stiffness=1e9) for angle in (5.0, 77.0, 250.0)]
    problem = dimensionless(cx.presets.load("bare").replace(absorbers=listed))
    modes, rng = Modes.up_to(7), np.random.default_rng(2)
    points = absorbers.InterfacePoints(problem, absorbers.absorber_set(problem, tuple(listed), 1), modes)
    compliance = rng.normal(size=(2, 2, 8, 4)) + 1j * rng.normal(size=(2, 2, 8, 4))
    found = points.receptance(compliance)
    for force in range(points.count):
        unit = np.zeros((points.count, 4))
        unit[force] = 1.0
        moved = points.evaluate(np.einsum("ijmk,jhmk->ihmk", compliance, points.project(unit)))
        assert_allclose(found[:, :, force].T, moved, rtol=1e-12, atol=1e-13)
