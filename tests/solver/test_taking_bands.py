"""Bands in which laws take energy alone are left out of the count of poles: nothing is counted otherwise, and nothing missed."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from electrode_pairs import pairs
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.numerics.modes import Modes
from coaxshell.solver import stability, tied_stability
from coaxshell.solver.contour import NOWHERE, Bands, Contour, along_alone, turned
from coaxshell.solver.scaling import FluidRegion, Problem, dimensionless
from coaxshell.solver.stability import unstable_poles
from coaxshell.solver.taking_bands import all_taken, all_taken_in_waves, asymmetry, held_in, taking_bands
from coaxshell.solver.tied_stability import Tied, growing

PAIRS = cx.presets.load("electrodes")
TIME = PAIRS.transit_time
MODES = Modes.up_to(4)
LEAST = 1.0


def under(**law: object) -> cx.System:
    return PAIRS.replace(control=cx.Feedback(**{"numerator": [2 * TIME, 3.0], "transducers": "electrodes"} | law))


def bands_of(system: cx.System, modes: Modes = MODES) -> tuple[Problem, Contour, Bands]:
    problem = dimensionless(system, 2 if modes.two_dimensional else 3)
    contour = Contour.of(problem, modes, LEAST)
    return problem, contour, taking_bands(problem, modes, contour)


RESONATOR = {"numerator": [5.0, 0.0], "denominator": [2.8e-9, 1e-6, 1.0]}
SPLIT = [
    cx.Feedback(numerator=[2 * TIME, 0.0], delay="20 us", transducers="electrodes", shells=["inner"]),
    cx.Feedback(numerator=[-TIME, 30.0], delay="4 us", transducers="electrodes", shells=["outer"]),
]


LATE = under(delay="20 us", weights=[1.0, 0.5, 0.0, 1.0, 1.0])
TWO = PAIRS.replace(control=SPLIT)


@pytest.mark.parametrize(
    ("system", "k"),
    [(LATE, 0.0), (under(**RESONATOR, delay="10 us"), 0.0), (TWO, 0.0), (TWO, 2.3)],
    ids=["late", "resonator", "two laws", "two laws in space"],
)
def test_turns_are_those_of_the_whole_contour(system, k):
    modes = Modes(MODES.orders, k)
    problem, contour, bands = bands_of(system, modes)
    assert bands.lows.size > 1
    assert not bands.hold_all(contour)
    known = problem, None, problem.open_loop
    ratio, angle = partial(stability._ratio, *known), partial(stability._angle, *known)
    whole, _ = turned(problem, modes, contour, ratio)
    found, _ = turned(problem, modes, contour, ratio, bands, angle)
    assert (np.rint(-whole / np.pi) > 0).any()  # some grow
    assert_allclose(found, whole, atol=1e-6)
    blind, _ = turned(problem, modes, contour, ratio, bands, lambda nodes, some: np.zeros((some.count, nodes.size)))
    assert np.abs(blind - whole).max() > 0.1  # what is turned by in bands is told by their ends


@pytest.mark.parametrize(
    "law", [{"segments": 4}, {"segments": 4, "weights": [0.5, 1.0]}, {"matrix": [[1.0, 0.5], [0.3, 0.8]]}], ids=["cut", "filtered", "tied"]
)
@pytest.mark.parametrize("delay", ["8 us", "20 us"])
def test_patterns_that_grow_are_those_of_the_whole_contour(law, delay):
    problem, contour, bands = bands_of(under(delay=delay, **law))
    assert bands.lows.size
    found, whole = (tied_stability._counted(problem, Tied(MODES), contour, one)[0] for one in (bands, NOWHERE))
    assert (found is None) == (whole is None)
    assert whole is None or (found.patterns.tolist(), found.counts.tolist()) == (whole.patterns.tolist(), whole.counts.tolist())
    assert (growing(problem, 4, LEAST) is None) == (whole is None)


@pytest.mark.parametrize("weights", [[0.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, 0.0, -1.0]])
@pytest.mark.parametrize("tied", [{}, {"segments": 5}])
def test_a_law_of_the_wrong_sign_grows_whatever_the_weight_of_order_0(weights, tied):
    sign = -1.0 if min(weights) >= 0.0 else 1.0
    problem = dimensionless(under(numerator=[sign * 2 * TIME, 0.0], weights=weights, **tied))
    assert not all_taken(problem, MODES, LEAST)
    grows = growing(problem, 4, LEAST) is not None if tied else unstable_poles(problem, 4, 1.0 / LEAST).orders.size > 0
    assert grows


def test_what_laws_take_everywhere_is_not_followed(monkeypatch):
    monkeypatch.setattr(stability, "turned", lambda *_: pytest.fail("poles were counted"))
    monkeypatch.setattr(tied_stability, "_factors", lambda *_: pytest.fail("poles were counted"))
    for law in ({}, {"delay": "0.05 us", "numerator": [0.2 * TIME, 0.0]}, {"amplifier_corner": "200 kHz", "weights": [0.0, 1.0]}):
        assert unstable_poles(dimensionless(under(**law)), 4, 1.0).orders.size == 0
    assert growing(dimensionless(under(matrix=[[1.0, 0.3], [0.3, 1.0]])), 4, LEAST) is None


@pytest.mark.parametrize(("delay", "taken"), [("0.05 us", True), ("40 us", False)])
def test_waves_are_taken_all_or_asked_one_by_one(delay, taken):
    problem = dimensionless(under(delay=delay, numerator=[0.2 * TIME, 0.0]), 3)
    waves = [Modes(MODES.orders, k) for k in (0.0, 0.7, 5.0, 16.0)]
    assert all_taken_in_waves(problem, waves, LEAST) == taken
    assert all(all_taken(problem, modes, LEAST) for modes in waves) == taken
    assert {asymmetry(problem, modes) for modes in waves} == {0.0}


def test_matrices_that_ask_for_more_leave_less():
    # W = diag(c A) of radii 0.5 and 1 and of one c: W K = [[1, x], [2 y, 2]] c, symmetric for x = 2 y.
    angles = []
    for x, y in ((0.4, 0.2), (0.4, 0.4), (0.4, -0.9)):
        even, odd = 0.5 * (x + 2 * y), 0.5 * (x - 2 * y)
        expected = np.arctan(abs(odd) / np.sqrt(2.0 - even**2))
        found = asymmetry(dimensionless(under(matrix=[[1.0, x], [y, 1.0]])), MODES)
        assert_allclose(found, expected, atol=1e-3)  # c differs a little: layers lie at other radii
        angles.append(found)
    assert angles[0] < 1e-3 < angles[1] < angles[2]
    lows = [bands_of(under(matrix=[[1.0, x], [y, 1.0]], delay="5 us"))[2].highs[0] for x, y in ((0.4, 0.2), (0.4, -0.9))]
    assert lows[1] < 0.6 * lows[0]
    assert asymmetry(dimensionless(under(matrix=[[1.0, 2.0], [1.0, 1.0]])), MODES) is None


def test_walls_that_push_otherwise_and_fluids_that_may_give_have_no_bands():
    class Giving(FluidRegion):
        """A fluid that may feel its walls otherwise than they move."""

    apart = cx.presets.load("bare").replace(control=cx.PDControl(proportional=0, derivative=1, transducers="electrodes"))
    assert asymmetry(dimensionless(apart), MODES) is None
    elastic = PAIRS.replace(shells=[PAIRS.shells[0].replace(theory="elastic"), PAIRS.shells[1]])
    assert asymmetry(dimensionless(elastic), MODES) is None
    problem = dimensionless(PAIRS)
    inside = Giving(problem.fluids[0].density, problem.fluids[0].slowness)
    assert asymmetry(problem, MODES) == 0.0
    assert asymmetry(replace(problem, fluids=(inside, *problem.fluids[1:])), MODES) is None


def test_solid_walls_have_bands_where_their_shapes_take_energy():
    system = pairs(numerator=[0.3 * TIME, 0.0], delay="2 us")
    problem = dimensionless(system)
    modes = Modes.up_to(3)
    slow, contour = along_alone(problem, modes), Contour.of(problem, modes, 4 * LEAST)
    assert held_in(slow, modes, contour).all()
    far = contour._replace(fades=16 * contour.fades)
    bands = taking_bands(slow, modes, far)
    assert 0.0 < bands.highs[0] < far.nodes[-1].imag
    known = slow, None, slow.open_loop
    ratio = partial(stability._ratio, *known)
    whole, _ = turned(slow, modes, far, ratio)
    found, _ = turned(slow, modes, far, ratio, bands, partial(stability._angle, *known))
    assert_allclose(found, whole, atol=1e-6)
    wrong = along_alone(dimensionless(pairs(numerator=[-3 * TIME, 0.0], weights=[1.0, 0.0, 1.0])), modes)
    np.testing.assert_array_equal(held_in(wrong, modes, contour), [False, True, False, True])
    later = along_alone(dimensionless(pairs(numerator=[3 * TIME, 0.0], delay="100 us")), modes)
    assert not held_in(later, modes, contour).any()


def test_thin_walls_with_their_fluids_at_the_faces_have_them_too():
    faced = PAIRS.replace(shells=[one.replace(wetted="faces") for one in under(delay="10 us").shells], control=under(delay="10 us").control)
    problem, contour, bands = bands_of(faced)
    known = problem, None, problem.open_loop
    ratio = partial(stability._ratio, *known)
    whole, _ = turned(problem, MODES, contour, ratio)
    assert_allclose(turned(problem, MODES, contour, ratio, bands, partial(stability._angle, *known))[0], whole, atol=1e-6)
