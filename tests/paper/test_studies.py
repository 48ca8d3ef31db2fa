"""Every curve of a study is that of the system it names, solved by itself."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.apps.paper import Runs
from coaxshell.apps.paper.absorbers import counts

POINTS = [("inner", 0.0), ("inner", 180.0), ("outer", 0.0), ("outer", 180.0)]
BARE = cx.presets.load("bare")


def one(**law):
    return BARE.replace(absorbers=[cx.Absorber(angle=0, **law)])


def ring(count, **law):
    return BARE.replace(absorbers=cx.absorber_ring(count, mass=10, linear_stiffness=1e9, cubic_stiffness=1e20, **law))


def gains(proportional, derivative):
    return BARE.replace(control=cx.PDControl(proportional=proportional, derivative=derivative))


CASES = {
    "5": {"bare": BARE, r"$k_\mathrm{l}$ = $10^{10}$ N/m": one(mass=10, linear_stiffness=1e10)},
    "6": {"bare": BARE, "$m$ = 0 kg": one(mass=0, linear_stiffness=1e9), "$m$ = 50 kg": one(mass=50, linear_stiffness=1e9)},
    "7": {
        r"linear, $k_\mathrm{nl}$ = 0": one(mass=10, linear_stiffness=1e9),
        r"$k_\mathrm{nl}$ = $10^{20}$ N/m³": one(mass=10, linear_stiffness=1e9, cubic_stiffness=1e20),
    },
    "10": {"undamped": ring(25), "$c$ = $10^{6}$ N s/m": ring(25, damping=1e6)},
    "11": {
        "bare": BARE,
        r"$k_\mathrm{p}$ = 0, $k_\mathrm{d}$ = −150": gains(0, -150),
        r"$k_\mathrm{p}$ = $-2 \times 10^{4}$, $k_\mathrm{d}$ = −150": gains(-2e4, -150),
    },
}


def close(found, expected):
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-11 * np.abs(expected).max())


@pytest.mark.slow_for("10")
@pytest.mark.parametrize("number", CASES)
def test_stress_curves(drawn, direct, line, number):
    axes = drawn(number).figure.axes
    panels = [ax for ax in axes if ax.get_title(loc="left")]
    assert len(panels) == (4 if number == "11" else 2)
    for name, system in CASES[number].items():
        for ax, (shell, angle) in zip(panels, POINTS, strict=False):
            assert ax.get_title(loc="left")[3:] == f"{shell.capitalize()} shell, {'tail' if angle else 'head'}"
            close(line(ax, name), direct(system, shell, angle))


@pytest.mark.slow_for("7")
@pytest.mark.parametrize("number", ["5", "6", "7", "10"])
def test_insets_show_the_largest_extremum(drawn, number):
    for ax in drawn(number).figure.axes[:2]:
        (inset,) = ax.child_axes
        bare = ax.lines[0]
        at = np.abs(bare.get_ydata()).argmax()
        (start, end), (low, high) = inset.get_xlim(), inset.get_ylim()
        assert start < bare.get_xdata()[at] < end
        assert low < bare.get_ydata()[at] < high
        np.testing.assert_array_equal(inset.lines[0].get_ydata(), bare.get_ydata())


def test_attachment_position_carries_the_sine_orders(drawn, direct, line):
    panels = drawn("8").figure.axes[:2]
    law = {"mass": 10, "linear_stiffness": 1e9, "cubic_stiffness": 1e20}
    for ax, shell in zip(panels, ("inner", "outer"), strict=True):
        names = {curve.get_label() for curve in ax.lines if not curve.get_label().startswith("_")}
        assert names == {"bare", *(str(angle) for angle in range(0, 61, 3))}
        close(line(ax, "bare"), direct(BARE, shell, 0.0, "displacement", duration=2.0))
        for angle in (0, 33):
            moved = BARE.replace(absorbers=[cx.Absorber(angle=angle, **law)])
            close(line(ax, str(angle)), direct(moved, shell, 0.0, "displacement", duration=2.0))


@pytest.mark.slow
def test_number_of_absorbers(tiny):
    figure = counts(fine=(0, 1, 2), coarse=(0, 10))([BARE], Runs(tiny), None).figure
    for index, (shell, chosen) in enumerate([(0, (0, 10)), (1, (0, 10)), (0, (0, 1, 2)), (1, (0, 1, 2))]):
        ax, right = figure.axes[index], figure.axes[4 + index]
        systems = [ring(n) if n else BARE for n in chosen]
        summaries = [cx.simulate(s, duration=2.5, time_step=1e-2, modes=16).summary().shells[shell] for s in systems]
        curves = {curve.get_label(): curve for curve in (*ax.lines, *right.lines)}
        for label, value in {
            "peak at head": lambda s: s.stress_head.value,
            "peak at tail": lambda s: s.stress_tail.value,
            "peak anywhere": lambda s: s.stress.value,
            "RMS over surface and time (right scale)": lambda s: s.stress_rms,
        }.items():
            np.testing.assert_array_equal(curves[label].get_xdata(), chosen)
            np.testing.assert_allclose(curves[label].get_ydata(), [1e-6 * value(s) for s in summaries], rtol=1e-12)
        for axis in (ax, right):
            low, high = axis.get_ylim()
            values = np.concatenate([curve.get_ydata() for curve in axis.lines])
            assert low < values.min() <= values.max() < high


def test_a_turned_source_turns_the_study(drawn, tiny, line):
    from coaxshell.apps.paper import figure_recipe

    turned = BARE.replace_path("source.angle", 70.0)
    figure = figure_recipe("7").draw([turned], Runs(tiny), None).figure
    for ax, other in zip(figure.axes[:2], drawn("7").figure.axes[:2], strict=True):
        for curve in other.lines[:6]:
            close(line(ax, curve.get_label()), np.asarray(curve.get_ydata()))
