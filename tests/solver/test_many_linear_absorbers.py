"""Many linear absorbers solved by iteration on the orders, against the dense solution of all points."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.interface import linear, linear_many
from coaxshell.solver.interface.absorbers import InterfacePoints, absorber_set
from coaxshell.solver.interface.linear_around import Around
from coaxshell.solver.interface.linear_many import Spread
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.structure_spectra import StructureSpectra

MODES = Modes.up_to(12)
EVEN = np.arange(24) * 15.0
DRAWN = np.random.default_rng(3)


def unequal(angles: np.ndarray, **further: object) -> tuple[cx.Absorber, ...]:
    """Return absorbers whose properties differ by up to a factor 3."""
    properties = (10.0, 1e6, 1e9) * DRAWN.uniform(0.5, 1.5, (angles.size, 3))
    return tuple(
        cx.Absorber(angle=float(angle), mass=mass, damping=damping, linear_stiffness=stiffness, **further)
        for angle, (mass, damping, stiffness) in zip(angles, properties.tolist(), strict=True)
    )


LAYOUTS = {
    "even": unequal(EVEN),
    "uneven": unequal(EVEN + DRAWN.uniform(-3.0, 3.0, EVEN.size)),
    "arcs": unequal(EVEN, footprint=0.1),
    "arcs that differ": unequal(EVEN[:12], footprint=0.1) + unequal(EVEN[12:], footprint=0.2),
    "mirror images": (_HALF := unequal(EVEN[:12] + 7.5)) + tuple(one.model_copy(update={"angle": -one.angle}) for one in _HALF),
    "sides that differ": unequal(
        EVEN, law=cx.laws.Sides(inner=cx.laws.Maxwell(stiffness=1e9, relaxation_time=1e-4), outer=cx.laws.Linear(stiffness=1e8))
    ),
    "one half of the circle": unequal(EVEN / 2.0),
}


@pytest.fixture(scope="module")
def structure() -> StructureSpectra:
    """Return the paper's shells under feedback."""
    return StructureSpectra(dimensionless(cx.presets.load("active")), LaplaceGrid(0.02, 60), MODES)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_iteration_finds_what_a_dense_solution_does(structure: StructureSpectra, layout: str, monkeypatch: pytest.MonkeyPatch) -> None:
    links = absorber_set(structure.problem, LAYOUTS[layout], 1)
    points = InterfacePoints(structure.problem, links, MODES)
    assert Spread.of(structure.problem, links, points) is None  # too few to pay
    dense = linear.solve_linear(structure, links, points)
    monkeypatch.setattr(linear_many, "POINTS", 20)
    found = linear.solve_linear(structure, links, points)
    for name in ("force", "mass_displacement"):
        mine, other = (structure.grid.invert(getattr(one, name)) for one in (found, dense))
        np.testing.assert_allclose(mine, other, rtol=0, atol=1e-10 * np.abs(other).max())


def test_what_does_not_converge_is_solved_by_matrices(structure: StructureSpectra, monkeypatch: pytest.MonkeyPatch) -> None:
    links = absorber_set(structure.problem, LAYOUTS["even"], 1)
    points = InterfacePoints(structure.problem, links, MODES)
    dense = linear.solve_linear(structure, links, points)
    monkeypatch.setattr(linear_many, "POINTS", 20)
    monkeypatch.setattr(linear_many, "STEPS", 3)
    spread = Around.of(structure.problem, links, MODES)
    assert spread is not None
    nodes, excited = structure.grid.nodes[:3], points.evaluate(structure.surface_motion[..., :3])
    _, reached = spread.iterate(nodes, structure.compliance[..., :3], excited, float(np.abs(excited).max()))
    assert not reached.any()
    np.testing.assert_allclose(linear.solve_linear(structure, links, points).force, dense.force, rtol=1e-12)


def test_other_systems_are_left_to_matrices(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(linear_many, "POINTS", 4)
    bare = cx.presets.load("bare")
    problem = dimensionless(bare.replace(shells=[cx.RigidShell(radius=0.2), *bare.shells], fluids=[bare.fluids[0], *bare.fluids]))
    links = absorber_set(problem, cx.absorber_ring(3, mass=10, linear_stiffness=1e9, inner_shell=1).absorbers, 2)
    assert Spread.of(problem, links, InterfacePoints(problem, links, MODES)) is None
