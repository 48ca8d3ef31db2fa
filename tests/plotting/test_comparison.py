"""Two systems over each other."""

from __future__ import annotations

import numpy as np
import pytest

from coaxshell import InputError, RigidShell, presets
from coaxshell.plotting import figure_comparison, plot_comparison
from coaxshell.plotting.histories import history
from coaxshell.plotting.style import new_figure


@pytest.fixture
def pair(make_response):
    return {"hybrid": make_response(presets.load("hybrid"), amplitude=0.6), "bare": make_response(presets.load("bare"))}


@pytest.fixture
def figure(pair):
    figure = figure_comparison(pair)
    figure.canvas.draw()
    return figure


def test_four_panels_with_one_scale(figure):
    titles = [ax.get_title(loc="left") for ax in figure.axes]
    assert titles == ["a  Inner shell, head", "b  Inner shell, tail", "c  Outer shell, head", "d  Outer shell, tail"]
    assert len({ax.get_ylim() for ax in figure.axes}) == 1
    assert {ax.get_ylabel() for ax in figure.axes[::2]} == {"hoop stress (MPa)"}
    assert all("transits" in ax.get_xlabel() for ax in figure.axes[2:])
    assert figure.get_suptitle() == "Hoop stress: hybrid against bare"


def test_every_curve_has_its_circle_and_the_change_stands_above(figure, pair):
    for ax in figure.axes:
        assert ax.get_title(loc="right") == "peak smaller by 40 %"
        curves = [line for line in ax.lines if len(line.get_xdata()) == len(pair["bare"].time)]
        circles = [line for line in ax.lines if line.get_marker() == "o"]
        assert len(curves) == len(circles) == 2
        for curve, circle in zip(curves, circles, strict=True):
            at = int(np.argmax(np.abs(curve.get_ydata())))
            assert circle.get_xdata()[0] == curve.get_xdata()[at]
            assert circle.get_ydata()[0] == curve.get_ydata()[at]
            assert circle.get_color() == curve.get_color()


def test_legend_names_the_systems_as_drawn(figure):
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["hybrid", "bare", "largest magnitude"]
    first, second, _ = legend.get_lines()
    drawn = {line.get_color(): np.abs(line.get_ydata()).max() for line in figure.axes[0].lines if len(line.get_xdata()) > 2}
    assert drawn[first.get_color()] == pytest.approx(0.6 * drawn[second.get_color()])


def test_no_two_texts_overlap(figure):
    renderer = figure.canvas.get_renderer()
    texts = [t for ax in figure.axes for t in (ax.yaxis.label, ax.xaxis.label, ax._left_title, ax._right_title) if t.get_text()]
    boxes = [text.get_window_extent(renderer) for text in [*texts, figure._suptitle]]
    assert not [(i, j) for i, a in enumerate(boxes) for j, b in enumerate(boxes) if i < j and a.overlaps(b)]


def test_different_transits_are_drawn_in_milliseconds(make_response):
    class Slower(make_response):
        def stress(self, shell, angle):
            array = super().stress(shell, angle)
            return array.assign_coords(time_seconds=("time", 2 * array["time_seconds"].to_numpy()))

    bare = presets.load("bare")
    figure = figure_comparison({"slow": Slower(bare), "bare": make_response(bare)})
    assert {ax.get_xlabel() for ax in figure.axes[2:]} == {"time (ms)"}
    assert figure.axes[0].get_xlim()[1] == pytest.approx(2 * 5 * 1e3 / 1400)


def test_shells_that_both_have(make_response):
    single, double = (make_response(presets.load(name)) for name in ("iakovlev-filled", "bare"))
    assert [ax.get_title(loc="left") for ax in figure_comparison({"a": single, "b": single}).axes] == ["a  Shell, head", "b  Shell, tail"]
    assert len(figure_comparison({"a": single, "b": double}).axes) == 4
    bare = presets.load("bare")
    core = bare.replace(shells=[RigidShell(radius=0.5), bare.shells[1]], fluids=["vacuum", *bare.fluids[1:]])
    assert len(figure_comparison({"a": make_response(core), "b": double}).axes) == 2
    rigid = core.replace(shells=[RigidShell(radius=1.0)], fluids=["vacuum", bare.fluids[2]])
    with pytest.raises(InputError, match="no shell is elastic in all systems"):
        figure_comparison({"a": make_response(rigid), "b": double})


def test_other_quantities_and_numbers_of_systems(pair, response):
    assert "Inward displacement" in figure_comparison(pair, "displacement").get_suptitle()
    assert figure_comparison({"one": response}).get_suptitle() == "Hoop stress: one"
    with pytest.raises(InputError, match="0 systems cannot be drawn; give 1 to 5"):
        figure_comparison({})
    with pytest.raises(InputError, match="'colour' cannot be drawn"):
        figure_comparison(pair, "colour")


def test_draws_where_it_is_told(pair):
    ax = new_figure().add_subplot()
    assert plot_comparison({name: history(r, "stress", "outer", 0.0) for name, r in pair.items()}, ax) is ax


def test_nothing_but_zeros_is_drawn(make_response):
    still = make_response(presets.load("bare"), amplitude=0.0)
    figure_comparison({"a": still, "b": still}).canvas.draw()
