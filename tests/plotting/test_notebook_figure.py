"""A figure shows itself in a notebook without a screen and without pyplot."""

from __future__ import annotations

import sys

from coaxshell.plotting.style import new_figure


def test_a_figure_is_an_image_as_the_last_line_of_a_cell():
    figure = new_figure(2.0, 1.0)
    figure.subplots().plot([0, 1], [0, 1])
    assert figure._repr_png_().startswith(b"\x89PNG")


def test_it_keeps_the_canvas_that_saving_needs(tmp_path):
    figure = new_figure(2.0, 1.0)
    figure._repr_png_()
    figure.savefig(tmp_path / "again.svg")
    assert (tmp_path / "again.svg").stat().st_size > 0
    assert "matplotlib.pyplot" not in sys.modules or not sys.modules["matplotlib.pyplot"].get_fignums()
