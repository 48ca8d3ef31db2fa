"""The paper's Figure 3."""

from __future__ import annotations

import numpy as np
import pytest

from coaxshell import InputError, RigidShell, presets
from coaxshell.apps.paper import FIGURES, figure_recipe
from coaxshell.plotting import figure_bare_histories, save_figure


def panels(figure):
    """Return (stress axes, displacement axes) of each panel, in reading order."""
    left = [ax for ax in figure.axes if "," in ax.get_title(loc="left")]
    pairs = [(ax, next(twin for twin in figure.axes if twin is not ax and twin.bbox.bounds == ax.bbox.bounds)) for ax in left]
    return sorted(pairs, key=lambda pair: pair[0].get_title(loc="left"))


@pytest.fixture
def figure(response):
    figure = figure_bare_histories(response)
    figure.canvas.draw()
    return figure


def test_four_panels_in_the_papers_order(figure):
    titles = [left.get_title(loc="left") for left, _ in panels(figure)]
    assert titles == ["a  Inner shell, head", "b  Inner shell, tail", "c  Outer shell, head", "d  Outer shell, tail"]


def test_identical_scales_and_aligned_zero_lines(figure):
    assert len({left.get_ylim() for left, _ in panels(figure)}) == 1
    assert len({right.get_ylim() for _, right in panels(figure)}) == 1
    for left, right in panels(figure):
        zeros = [ax.transData.transform((0.0, 0.0))[1] for ax in (left, right)]
        assert zeros[0] == pytest.approx(zeros[1], abs=0.01)
        assert len(left.get_yticks()) == len(right.get_yticks())


def test_circles_and_titles_tell_the_peaks(figure, response):
    for (left, _), (shell, angle) in zip(panels(figure), [("inner", 0), ("inner", 180), ("outer", 0), ("outer", 180)], strict=True):
        stress = response.stress(shell, angle=[angle]).isel(angle=0)
        at = int(np.argmax(np.abs(stress.to_numpy())))
        curve, circle = left.lines[:2]
        assert circle.get_xdata()[0] == pytest.approx(float(stress["time"][at]))
        assert circle.get_ydata()[0] == pytest.approx(1e-6 * float(stress[at]))
        assert len(curve.get_xdata()) == len(response.time)
        assert f"{abs(1e-6 * float(stress[at])):.3g} MPa" in left.get_title(loc="right")


def test_no_two_texts_overlap(figure):
    renderer = figure.canvas.get_renderer()
    texts = [t for ax in figure.axes for t in (ax.yaxis.label, ax.xaxis.label, ax.title, ax._left_title, ax._right_title) if t.get_text()]
    boxes = [text.get_window_extent(renderer) for text in texts]
    clashes = [
        (a.get_text(), b.get_text()) for i, a in enumerate(texts) for j, b in enumerate(texts) if i < j and boxes[i].overlaps(boxes[j])
    ]
    assert not clashes


def test_head_follows_the_source(make_response):
    turned = presets.load("bare").with_overrides({"source.angle": 30})
    asked = []

    class Recording(make_response):
        def stress(self, shell, angle):
            asked.extend(angle)
            return super().stress(shell, angle)

    figure_bare_histories(Recording(turned))
    assert set(asked) == {30.0, 210.0}


def test_single_shell_gives_two_panels(make_response):
    figure = figure_bare_histories(make_response(presets.load("iakovlev-filled")))
    assert [left.get_title(loc="left") for left, _ in panels(figure)] == ["a  Shell, head", "b  Shell, tail"]


def test_rigid_core_is_left_out_and_only_rigid_is_refused(make_response):
    bare = presets.load("bare")
    core = bare.replace(shells=[RigidShell(radius=0.5), bare.shells[1]], fluids=["vacuum", *bare.fluids[1:]])
    assert len(panels(figure_bare_histories(make_response(core)))) == 2
    rigid = core.replace(shells=[RigidShell(radius=1.0)], fluids=["vacuum", bare.fluids[2]])
    with pytest.raises(InputError, match="rigid"):
        figure_bare_histories(make_response(rigid))


@pytest.mark.slow
def test_a_response_of_nothing_but_zeros_is_drawn(make_response):
    figure_bare_histories(make_response(presets.load("bare"), amplitude=0.0)).canvas.draw()


@pytest.mark.slow_except(".png-\\x89PNG")
@pytest.mark.parametrize(("suffix", "magic"), [(".png", b"\x89PNG"), (".pdf", b"%PDF"), (".svg", b"<?xml")])
def test_saves_whole_and_repeatably(response, tmp_path, suffix, magic):
    contents = []
    for name in ("a", "b"):
        path = save_figure(figure_bare_histories(response), tmp_path / f"{name}{suffix}")
        contents.append(path.read_bytes())
    assert contents[0].startswith(magic)
    assert contents[0] == contents[1]
    assert sorted(path.name for path in tmp_path.iterdir()) == [f"a{suffix}", f"b{suffix}"]


def test_refuses_other_endings_and_places(figure, tmp_path):
    with pytest.raises(InputError, match=r"'.*figure\.jpeg' has no known ending; allowed: \.png, \.pdf, \.svg"):
        save_figure(figure, tmp_path / "figure.jpeg")
    with pytest.raises(InputError, match="cannot write"):
        save_figure(figure, tmp_path / "nowhere" / "figure.png")
    assert list(tmp_path.iterdir()) == []


def test_recipes():
    assert figure_recipe("3") is FIGURES["3"]
    with pytest.raises(InputError, match="there is no figure '99'; allowed: 2, 3"):
        figure_recipe("99")
