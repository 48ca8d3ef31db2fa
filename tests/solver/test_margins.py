"""Margins of feedback: a textbook loop, and against the count of poles."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.numerics.modes import Modes
from coaxshell.plotting import figure_margins
from coaxshell.response.margins import worst_loops
from coaxshell.solver.margins import followed, loop_margins, loops, margins_of
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.segmented_margins import segmented_loops
from coaxshell.solver.settings import Settings
from coaxshell.solver.stability import unstable_poles
from coaxshell.solver.tied_stability import Tied, growing

BARE = cx.presets.load("bare")
TIME = BARE.transit_time
PAIRS = BARE.with_overrides({f"shells[{i}].layers[{j}].role": "self-sensing" for i in (0, 1) for j in (0, 2)})


def pairs(**law) -> cx.System:
    return PAIRS.replace(control=cx.Feedback(transducers="electrodes", **law))


def test_a_textbook_loop():
    # 4/(s + 1)^3 under negative feedback: gain margin 2 at sqrt(3), phase margin 27.1 degrees at 1.233 (Franklin, Powell).
    s = 1e-9 + 1j * np.linspace(0.0, 10.0, 20001)
    found = margins_of(np.zeros(1), s, -4.0 / (s[None, :] + 1.0) ** 3)
    crossing = np.sqrt(4.0 ** (2.0 / 3.0) - 1.0)
    phase = np.pi - 3.0 * np.arctan(crossing)
    assert (found.gain[0], found.gain_frequency[0]) == pytest.approx((2.0, np.sqrt(3.0)), rel=1e-6)
    assert (found.phase[0], found.phase_frequency[0]) == pytest.approx((phase, crossing), rel=1e-6)
    assert found.delay[0] == pytest.approx(phase / crossing, rel=1e-6)
    assert found.lesser_gain[0] == 0.0


def test_a_loop_that_needs_its_gain():
    # 6/(s - 1)/(s + 2): stable above a gain of 1/3 only.
    s = 1e-9 + 1j * np.linspace(0.0, 20.0, 20001)
    found = margins_of(np.zeros(1), s, -6.0 / (s - 1.0)[None, :] / (s + 2.0))
    assert found.lesser_gain[0] == pytest.approx(1.0 / 3.0, rel=1e-6)
    assert np.isinf(found.gain[0])


def test_a_loop_that_gives_way_at_rest():
    # 0.4/(s + 1) under positive feedback: the pole at 0.4 k - 1 grows beyond a gain of 2.5.
    s = 1e-9 + 1j * np.linspace(0.0, 20.0, 2001)
    found = margins_of(np.zeros(1), s, 0.4 / (s[None, :] + 1.0))
    assert (found.gain[0], found.gain_frequency[0]) == pytest.approx((2.5, 0.0), rel=1e-6)
    assert np.isinf(found.phase[0])


@pytest.mark.parametrize(
    "system",
    [
        pairs(numerator=[2 * TIME, 0.0]),
        pairs(numerator=[2 * TIME, 3.0], amplifier_corner="50 kHz"),
        pairs(numerator=[0.2 * TIME, 3.0], amplifier_corner="50 kHz", weights=4, delay="1 us"),
        cx.presets.load("active"),
    ],
    ids=["rate", "corner", "late", "paper"],
)
def test_delay_margins_part_stable_from_unstable(system):
    problem, modes = dimensionless(system), Modes.up_to(8)
    for shell, margins in loop_margins(problem, modes, 0.25).items():
        worst = float(margins.delay.min())
        grown = [unstable_poles(_later(problem, shell, factor * worst), 8, 4.0).orders for factor in (0.97, 1.03)]
        assert grown[0].size == 0
        assert float(margins.delay.argmin()) in grown[1]


def test_gain_margins_part_stable_from_unstable():
    law = {"numerator": [0.3 * TIME, 1.0], "delay": "20 us", "weights": 3, "amplifier_corner": "20 kHz"}
    margins = cx.stability_margins(pairs(**law), modes=4, duration=4)
    least = float(margins["gain_margin"].min())
    assert 1.0 < least < 100.0
    assert margins["gain_margin"].attrs["units"] == "1"
    for factor, many in ((0.97, False), (1.03, True)):
        scaled = [factor * least * one for one in law["numerator"]]
        shell = str(margins["shell"].values[int(margins["gain_margin"].min("order").argmin("shell"))])
        problem = dimensionless(pairs(**law))
        stronger = dimensionless(pairs(**{**law, "numerator": scaled}))
        place = {"inner": 0, "outer": 1}[shell]
        walls = tuple(stronger.shells[i] if i == place else problem.shells[i] for i in (0, 1))
        assert bool(unstable_poles(replace(problem, shells=walls), 4, 4.0).orders.size) == many


def test_the_loops_themselves_tell_whether_they_are_stable():
    """Or leave it to the count, which refuses what they are not sure of: a pole, or turns too fast between nodes."""
    law = {"numerator": [0.2 * TIME, 3.0], "amplifier_corner": "50 kHz", "weights": 3}
    for matrix in (None, [[1.0, 0.5], [0.3, 0.8]]):
        for delay, stable in (("1 us", True), ("40 us", False)):
            problem = dimensionless(pairs(**law, delay=delay, matrix=matrix))
            found = loops(problem, Tied(Modes.up_to(4)), 0.25)
            assert found.surely_stable == stable
            assert found.ratio.shape == (4, found.each[0].nodes.size)
            assert not found.each[0].values[4].any()
    doubtful = found.ratio.copy()
    doubtful[:] = 1.0
    doubtful[0, found.even + 3] = 1j
    assert not found._replace(ratio=doubtful).surely_stable


def _later(problem, shell, delay):
    walls = list(problem.shells)
    walls[shell] = walls[shell].with_gains(walls[shell].gains.late(delay))
    return replace(problem, shells=tuple(walls))


def test_labelled_and_drawn():
    system = pairs(numerator=[2 * TIME, 3.0], weights=2)
    response = cx.simulate(system, duration=0.5, time_step=0.02, modes=4)
    margins = response.stability_margins()
    assert margins["delay_margin"].dims == ("shell", "order")
    assert margins["shell"].values.tolist() == ["inner", "outer"]
    assert np.isinf(margins["delay_margin"].sel(order=[3, 4])).all()  # nothing is fed back there
    assert 1e-6 < float(margins["delay_margin"].min()) < 1e-4
    shares: list[float] = []
    figure = figure_margins(*worst_loops(system, Settings(duration=0.5, modes=4), lambda share, _: shares.append(share)))
    assert shares == sorted(shares)
    assert 0.0 < shares[0] < shares[-1] < 1.0, "it tells how far it is"
    assert [ax.get_xlabel() for ax in figure.axes] == ["circumferential order $m$", "Re $L$", "frequency (Hz)", "frequency (Hz)"]
    assert all(float(order).is_integer() for order in figure.axes[0].get_xticks())


@pytest.mark.parametrize("cut", [{"segments": 6}, {"segments": 5, "dead": [2]}], ids=["live", "dead"])
def test_delay_margins_of_segments_part_stable_from_unstable(cut):
    # Counted by the argument of the determinant of all tied orders, which knows of no loop.
    system = pairs(numerator=[2 * TIME, 3.0], amplifier_corner="50 kHz", **cut)
    problem, modes = dimensionless(system), Modes.up_to(8)
    for shell, found in segmented_loops(problem, Tied(modes), 1.0).items():
        least = found.margins.delay.min()
        assert growing(_later(problem, shell, 0.97 * least), 8, 1.0) is None
        grown = growing(_later(problem, shell, 1.03 * least), 8, 1.0)
        assert "dead" in cut or found.margins.delay.argmin() in grown.patterns


def test_margins_of_segments_are_told_by_pattern():
    law = {"numerator": [2 * TIME, 3.0], "amplifier_corner": "50 kHz", "segments": 6}
    live, worst = worst_loops(pairs(**law), Settings(duration=0.5, modes=6))
    dead, _ = worst_loops(pairs(**law, dead=[1]), Settings(duration=0.5, modes=6))
    assert live["order"].values.tolist() == dead["order"].values.tolist() == [0, 1, 2, 3]
    assert "pattern" in live["order"].attrs["long_name"]
    for place, loop in enumerate(worst):
        assert live["delay_margin"].values[place].argmin() == loop.order
    # One dead segment leaves every pattern that vanishes on it as it is: of each pair cos q, sin q a mixture.
    np.testing.assert_allclose(dead["delay_margin"].sel(order=2), live["delay_margin"].sel(order=2), rtol=1e-9)
    assert figure_margins(live, worst).axes[0].get_xlabel() == "pattern $q$ of 6 segments"


def test_loops_that_cross_are_followed():
    t = np.linspace(-1.0, 1.0, 401)
    lines = np.stack([t + 0.3j, -t - 0.1j, 0.2 * t - 0.3j, np.full(401, 0.5 + 0.5j)])
    order = np.argsort(np.random.default_rng(2).normal(size=lines.shape), axis=0)
    found = followed(np.take_along_axis(lines, order, 0)[:, None])[:, 0]
    np.testing.assert_allclose(found, lines[order[:, 0]], rtol=0, atol=0)


def test_margins_by_axial_wavenumber():
    # Those of k = 0 are those of two dimensions; beyond the ellipse of the run's waves there is none.
    system = pairs(numerator=[2 * TIME, 3.0])
    margins, worst = worst_loops(system, Settings(duration=0.5, modes=3, dimensions=3, stations=[0.0]))
    flat, _ = worst_loops(system, Settings(duration=0.5, modes=3))
    assert margins["delay_margin"].dims == ("shell", "wavenumber", "order")
    for name in ("gain_margin", "phase_margin", "delay_margin"):
        np.testing.assert_array_equal(margins[name].values[:, 0], flat[name].values)
    assert margins["wavenumber"].values[[0, -1]] == pytest.approx([0.0, 3.0])  # a = 1 m
    assert np.isnan(margins["delay_margin"].values[:, -1, 1:]).all()
    for place, loop in enumerate(worst):
        least = margins["delay_margin"].isel(shell=place).sel(order=loop.order).sel(wavenumber=loop.wavenumber, method="nearest")
        assert float(least) == float(np.nanmin(margins["delay_margin"].values[place]))
    assert "/m" in figure_margins(margins, worst).axes[1].get_legend().get_texts()[0].get_text() or worst[0].wavenumber == 0.0


@pytest.mark.parametrize(
    ("system", "changes", "words"),
    [
        (BARE, {}, ("control: nothing is fed back", "PDControl or a Feedback")),
        (pairs(numerator=[0.0]), {}, ("nothing is fed back",)),
        (pairs(numerator=[-TIME, 0.0]), {}, ("unstable",)),
        (pairs(numerator=[1.0]), {"modes": "auto"}, ("modes: 'auto'", "highest order")),
        (pairs(numerator=[-TIME, 0.0]), {"dimensions": 3}, ("unstable",)),
    ],
)
def test_refused_in_one_line(system, changes, words):
    with pytest.raises(InputError) as caught:
        cx.stability_margins(system, **{"modes": 4, **changes})
    for word in words:
        assert word in str(caught.value)
