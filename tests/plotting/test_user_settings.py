"""A user's names and a user's matplotlibrc leave our figures as they are."""

from __future__ import annotations

import warnings
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest

import coaxshell as cx
from coaxshell.plotting import FieldView, figure_comparison, save_figure
from coaxshell.plotting.film import save_film
from coaxshell.plotting.style import literal, new_figure, style

NAMES = ["$x_$", "a $ b", "$$", r"\frac{", "$\\undefined$", "tab\there", "\x1b[31m", "x^{", "_hidden", "#%&~{}", "$\ud800$"]

LEAKING = {
    "text.usetex": True,
    "savefig.bbox": "tight",
    "savefig.transparent": True,
    "savefig.facecolor": "red",
    "font.family": "serif",
    "font.size": 30,
    "axes.facecolor": "black",
    "figure.facecolor": "black",
    "axes.prop_cycle": mpl.cycler(color=["magenta"]),
    "axes.formatter.use_locale": True,
    "lines.marker": "o",
    "figure.autolayout": True,
    "svg.fonttype": "path",
}


@pytest.fixture(scope="module")
def response() -> cx.Response:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return cx.simulate(cx.presets.load("bare"), modes=4, time_step=0.05, duration=1.0)


def test_any_name_is_drawn_as_it_stands(response: cx.Response, tmp_path: Path) -> None:
    pair = {"$x_$": response, "$\\undefined{$": response}
    text = save_figure(figure_comparison(pair), tmp_path / "named.svg").read_text(encoding="utf-8")
    assert all(name in text for name in pair)  # letters, as fonts of SVG are text
    with style():
        figure = new_figure(2.0, 2.0)
        for name in NAMES:
            figure.text(0.5, 0.5, literal(name))
        save_figure(figure, tmp_path / "all.png")
    assert literal("$x_$") == r"\$x_\$"


def test_any_name_is_drawn_in_films_and_fields(response: cx.Response, tmp_path: Path) -> None:
    save_film(response, response, path=tmp_path / "film.webp", frames=2, view=FieldView(3.0, 64), names=["$x_$", "$\\bad{"])
    assert (tmp_path / "film.webp").stat().st_size > 100


def drawn(response: cx.Response, folder: Path) -> list[bytes]:
    folder.mkdir()
    figure = figure_comparison({"one": response})
    paths = [save_figure(figure, folder / f"figure.{suffix}") for suffix in ("png", "svg")]
    return [path.read_bytes() for path in paths]


def test_the_users_settings_do_not_leak_in(response: cx.Response, tmp_path: Path) -> None:
    plain = drawn(response, tmp_path / "plain")
    with mpl.rc_context(LEAKING):
        ours = drawn(response, tmp_path / "leaking")
        assert mpl.rcParams["font.size"] == 30  # and theirs are as before
    for one, other in zip(plain, ours, strict=True):
        assert np.array_equal(np.frombuffer(one, np.uint8), np.frombuffer(other, np.uint8))
