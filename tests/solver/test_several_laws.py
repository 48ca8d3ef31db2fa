"""Several laws, each for shells of its own: what one law of several gains is, stability, margins of all loops together, and refusals."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.numerics.modes import Modes
from coaxshell.solver.delay_margin import delay_margin
from coaxshell.solver.margins import common_loop, margins_of
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.solver.stability import unstable_poles

PAIRS = cx.presets.load("electrodes")
T = PAIRS.transit_time


def pd(gain, shell, **more):
    return cx.PDControl(**{"proportional": 0, "derivative": gain, "transducers": "electrodes", "shells": [shell], **more})


def law(gain, shell, **more):
    return cx.Feedback(numerator=[gain * T, 0], transducers="electrodes", shells=[shell], **more)


def solved(control):
    return cx.simulate(PAIRS.replace(control=control), duration=0.6, time_step=2e-2, modes=4).solution


def test_each_shell_has_its_own_law():
    listed = solved(cx.PDControl(proportional=0, derivative=[2, 5], transducers="electrodes"))
    each, mixed = solved([pd(2, "inner"), pd(5, "outer")]), solved([pd(2, "inner"), law(5, "outer")])
    np.testing.assert_array_equal(each.normal, listed.normal)
    np.testing.assert_allclose(mixed.normal, listed.normal, rtol=0, atol=1e-12 * np.abs(listed.normal).max())


def test_descriptions_hold_several():
    several = PAIRS.replace(control=[pd(2, "inner"), law(5, "outer", delay="1 us")])
    assert cx.System.from_toml_string(several.to_toml_string()) == several
    assert several.controlled_shells == (0, 1)
    assert several.canonical()["control"][1]["shells"] == [1]
    assert several.with_overrides({"control[1].delay": "2 us"}).control[1].delay == pytest.approx(2e-6)
    assert "2 laws of control" in str(several)
    assert PAIRS.replace(control=[pd(2, "inner")]).control == pd(2, "inner")
    assert PAIRS.replace(control=[]).control is None


@pytest.mark.parametrize(
    ("control", "where", "words"),
    [
        ([pd(2, "inner"), law(5, "inner")], "control[1].shells", "already"),
        ([pd(2, "inner"), pd(5, "outer", saturation=True)], "control[1].saturation", "saturate"),
        ([pd(2, "inner"), pd([1, 2], "outer")], "control[1].derivative", "list has 2"),
        ([pd(2, "inner"), 3], "control[1]", "not a control law"),
    ],
)
def test_what_is_refused(control, where, words):
    with pytest.raises(InputError, match=words) as caught:
        PAIRS.replace(control=control)
    assert caught.value.where == where


def test_the_unstable_law_is_named():
    with pytest.raises(InputError, match="unstable") as caught:
        solved([pd(2, "inner"), pd(-2, "outer")])
    assert caught.value.where == "control[1]"


def test_all_loops_late_together():
    # With several loops the determinant is a polynomial in a common factor: its roots part stable from unstable delays.
    problem = dimensionless(PAIRS.replace(control=[pd(2, "inner"), law(6, "outer")]), settings=Settings(duration=4.0, modes=8))
    found = delay_margin(problem, 8, 4.0)
    for factor, grows in ((0.97, False), (1.03, True)):
        late = factor * found.delay / problem.scales.time
        walls = tuple(wall.with_gains(wall.gains.late(late)) for wall in problem.shells)
        assert (unstable_poles(replace(problem, shells=walls), 8, 4.0).orders.size > 0) is grows
    modes = Modes(np.array([8.0]), sparse=True)
    loops = common_loop(problem, modes, 0.25)
    assert len(loops) == 2
    assert min(margins_of(modes.orders, *loop).delay[0] for loop in loops) == pytest.approx(found.delay / problem.scales.time, rel=1e-9)
