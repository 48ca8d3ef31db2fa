"""Rings marched class by class against the march of all points at once."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.interface import ring_march
from coaxshell.solver.interface.absorbers import AbsorberSet, absorber_set
from coaxshell.solver.interface.march import MarchResult, march
from coaxshell.solver.interface.ring_march import RingPlan, RingState, march_ring_block
from coaxshell.solver.interface.seen import as_seen
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.structure_spectra import StructureSpectra

MODES, GRID = Modes.up_to(9), LaplaceGrid(0.02, 70)


def ring(count: int, **further: object) -> tuple[cx.Absorber, ...]:
    """Return the paper's absorbers, changed as told."""
    properties = {"mass": 10, "damping": 1e6, "linear_stiffness": 1e9, "cubic_stiffness": 1e20} | further
    return cx.absorber_ring(count, **properties).absorbers


UNEQUAL = tuple(one.model_copy(update={"cubic_stiffness": 1e20 * (1 + n % 3)}) for n, one in enumerate(ring(9)))
RINGS = {
    "one at the head": (ring(8), 1),
    "none on the axis": (ring(8, offset=22.5), 1),
    "odd": (ring(9), 1),
    "more places than orders see": (ring(24), 1),
    "turned": (ring(8, offset=10), 2),
    "springs that differ": (UNEQUAL, 2),
    "arcs": (ring(8, footprint=0.3), 1),
    "undamped and stiff": (ring(8, damping=0, cubic_stiffness=3e20), 1),
}


@pytest.fixture(scope="module")
def structure() -> StructureSpectra:
    """Return the paper's shells under the paper's shock."""
    return StructureSpectra(dimensionless(cx.presets.load("bare")), GRID, MODES)


def marched(structure: StructureSpectra, links: AbsorberSet, least: int, monkeypatch: pytest.MonkeyPatch) -> MarchResult:
    """Return the march of some absorbers, as a ring if there are at least so many links."""
    monkeypatch.setattr(ring_march, "LINKS", least)
    return march(structure, links)


@pytest.mark.parametrize("name", RINGS)
def test_a_ring_moves_as_its_points_do(structure: StructureSpectra, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    absorbers, parities = RINGS[name]
    links = absorber_set(structure.problem, absorbers, parities)
    done: list[object] = []
    original = ring_march.march_ring
    monkeypatch.setattr("coaxshell.solver.interface.march.march_ring", lambda *given: done.append(original(*given)) or done[-1])
    points = marched(structure, links, 10**6, monkeypatch)
    assert not done
    for seen in (structure, as_seen(structure, links)):
        found = marched(seen, links, 2, monkeypatch)
        for attribute in ("force", "mass_displacement"):
            mine, other = getattr(found, attribute), getattr(points, attribute)
            assert_allclose(mine, other, rtol=0, atol=5e-11 * np.abs(other).max())  # either solves each step to 1e-11
    assert done


def test_a_march_stopped_at_any_block_goes_on_to_the_same_bits(structure: StructureSpectra, tmp_path: Path) -> None:
    plan = RingPlan.of(structure, absorber_set(structure.problem, ring(24), 1))
    assert plan is not None
    steps = 4 * plan.steps
    moved = np.random.default_rng(0).normal(size=(2, steps, 2, plan.classes)) * 1e-6
    blocks = [moved[:, first : first + plan.steps] for first in range(0, steps, plan.steps)]
    states, found = [RingState.at_rest(plan)], []
    for block in blocks:
        state, *rest = march_ring_block(plan, states[-1], *block, surfaces=2)
        states.append(state)
        found.append(rest)
    for start in range(4):
        (tmp_path / "state").write_bytes(pickle.dumps(states[start]))
        state = pickle.loads((tmp_path / "state").read_bytes())
        for k in range(start, 4):
            state, *rest = march_ring_block(plan, state, *blocks[k], surfaces=2)
            for one, other in zip(rest, found[k], strict=True):
                np.testing.assert_array_equal(one, other)


def test_springs_too_stiff_for_it_are_left_to_the_points(structure: StructureSpectra, monkeypatch: pytest.MonkeyPatch) -> None:
    links = absorber_set(structure.problem, ring(8, cubic_stiffness=1e25), 1)
    few = absorber_set(structure.problem, ring(6), 1)
    assert ring_march.RingPlan.of(structure, few) is None  # too few to pay
    monkeypatch.setattr(ring_march, "LINKS", 2)
    plan = ring_march.RingPlan.of(structure, links)
    assert plan is not None
    displacement, velocity = (x.T.reshape(-1, 2, links.count) for x in structure.motion_at(structure.points(links)))
    with pytest.raises(ring_march.TooStiffError):
        ring_march.march_ring(plan, displacement, velocity, 2)
    found, points = marched(structure, links, 2, monkeypatch), marched(structure, links, 10**6, monkeypatch)
    np.testing.assert_array_equal(found.force, points.force)


def test_what_is_no_ring_is_left_to_the_points(structure: StructureSpectra, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ring_march, "LINKS", 2)
    absorbers = ring(8)
    for others in (absorbers[:7], (absorbers[0].model_copy(update={"mass": 20.0}), *absorbers[1:])):
        assert ring_march.RingPlan.of(structure, absorber_set(structure.problem, others, 2)) is None
