"""Absorbers marched by classes of orders, or by their points alone, against the march by all orders."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.interface.absorbers import absorber_set
from coaxshell.solver.interface.lattice import folding, lattice_of
from coaxshell.solver.interface.march import MarchResult
from coaxshell.solver.interface.seen import StructureOfClasses, StructureOfPoints, as_seen
from coaxshell.solver.links.any_law import march_interface
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.structure_spectra import StructureSpectra

CUBIC = {"mass": 10, "damping": 1e6, "linear_stiffness": 1e9, "cubic_stiffness": 1e20}
UNEQUAL = [
    cx.Absorber(angle=angle, **{**CUBIC, "mass": mass}) for angle, mass in ((10, 5), (70, 10), (100, 20), (190, 2), (250, 7), (310, 9))
]
STICKING = {**CUBIC, "law": cx.laws.Friction(force=1e5, stiffness=1e9)}

LAYOUTS = {
    "ring": (cx.absorber_ring(9, **CUBIC).absorbers, StructureOfClasses),
    "ring between the axes": (cx.absorber_ring(8, offset=22.5, **CUBIC).absorbers, StructureOfClasses),
    "ring of arcs": (cx.absorber_ring(7, offset=13, footprint=0.1, **CUBIC).absorbers, StructureOfClasses),
    "unequal on a lattice": (tuple(UNEQUAL), StructureOfClasses),
    "laws": (cx.absorber_ring(5, offset=4, **STICKING).absorbers, StructureOfClasses),
    "few": ((cx.Absorber(angle=33, **CUBIC), cx.Absorber(angle=121.7, **CUBIC)), StructureOfPoints),
    "one with a core": ((cx.Absorber(angle=33, **CUBIC, links="inner", grounded=True),), StructureOfPoints),
}


@pytest.fixture(scope="module")
def structure() -> StructureSpectra:
    """Return the paper's shells; the step does not resolve the highest of their orders."""
    return StructureSpectra(dimensionless(cx.presets.load("bare")), LaplaceGrid(0.02, 40), Modes.up_to(30))


def marched(structure: StructureSpectra, absorbers: tuple[cx.Absorber, ...]) -> tuple[MarchResult, MarchResult, StructureSpectra]:
    """Return the march by all orders, that by what the absorbers see, and what that is."""
    links = absorber_set(structure.problem, absorbers, 1)
    seen = as_seen(structure, links)
    return march_interface(structure, links), march_interface(seen, links), seen


@pytest.mark.parametrize("layout", LAYOUTS)
def test_absorbers_do_the_same_by_fewer_kernels(structure: StructureSpectra, layout: str) -> None:
    absorbers, kind = LAYOUTS[layout]
    whole, few, seen = marched(structure, absorbers)
    assert isinstance(seen, kind)
    assert seen.kernels.kernels[..., 0].size < structure.kernels.kernels[..., 0].size / 2
    assert_close(few.force, whole.force, 1e-9)
    assert_close(few.mass_displacement, whole.mass_displacement, 1e-10)


def assert_close(found: np.ndarray, expected: np.ndarray, tolerance: float) -> None:
    """Assert that histories differ by no more than a part of the largest value."""
    assert np.abs(found - expected).max() <= tolerance * np.abs(expected).max() > 0


def test_orders_stay_where_they_are_fewest(structure: StructureSpectra) -> None:
    angles = np.random.default_rng(0).uniform(0.0, 360.0, 40)
    links = absorber_set(structure.problem, tuple(cx.Absorber(angle=float(a), **CUBIC) for a in angles), 1)
    assert as_seen(structure, links) is structure


def test_arcs_that_differ_are_no_lattice(structure: StructureSpectra) -> None:
    ring = cx.absorber_ring(9, footprint=0.1, **CUBIC).absorbers
    links = absorber_set(structure.problem, (ring[0].model_copy(update={"footprint": 0.2}), *ring[1:]), 2)
    assert as_seen(structure, links) is structure


def test_kernels_of_a_lattice_are_shared_by_sets(structure: StructureSpectra) -> None:
    first, second = (absorber_set(structure.problem, cx.absorber_ring(9, **{**CUBIC, "mass": mass}).absorbers, 1) for mass in (5, 8))
    assert as_seen(structure, first).kernels is as_seen(structure, second).kernels


def test_kernels_of_a_lattice_are_those_between_the_shells_that_it_holds() -> None:
    bare = cx.presets.load("bare")
    inner, outer = bare.shells
    system = bare.replace(shells=[inner, inner.replace(radius=0.75), outer], fluids=[bare.exterior] * 4)
    three = StructureSpectra(dimensionless(system), LaplaceGrid(0.05, 20), Modes.up_to(15))
    for gap in (0, 1):  # the second lattice finds what is kept of the first
        whole, few, _ = marched(three, cx.absorber_ring(9, inner_shell=gap, **CUBIC).absorbers)
        assert_close(few.force, whole.force, 1e-9)


def test_a_lattice_is_told_from_angles_that_are_none() -> None:
    assert lattice_of(np.array([5.0, 95.0, 185.0]), 10) == 4
    assert lattice_of(np.array([5.0, 95.1, 185.0]), 10) == 0
    assert lattice_of(np.arange(20) * 18.0, 10) == 0  # as many classes as orders


def test_classes_hold_every_order_once() -> None:
    shares = folding(6, 20)
    angles = np.radians(5.0 + 60.0 * np.arange(6))
    orders = np.arange(21)
    beta = np.where(orders == 0, 2.0, 1.0)
    apart = angles[:, None] - angles
    each = np.cos(apart[..., None] * orders) / beta
    of_class = np.cos(apart[..., None] * np.arange(4)) / beta[:4]
    np.testing.assert_allclose(of_class @ shares, each, rtol=0, atol=1e-13)
