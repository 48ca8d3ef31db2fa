"""Pictures and data of a report."""

from __future__ import annotations

import numpy as np

from coaxshell.apps.report.parts import MOST_ROWS, Picture, drawn
from coaxshell.plotting.style import new_figure


def test_letters_of_pictures_are_outlines_which_look_alike_everywhere():
    figure = new_figure(1.0, 1.0)
    figure.text(0.5, 0.5, "stress")
    found = drawn(figure, "name", "what it shows", "caption")
    assert (found.form, b"<text" in found.content, b"<path" in found.content) == ("svg+xml", False, True)


def test_long_data_are_thinned_evenly():
    time = np.arange(4.0 * MOST_ROWS)
    head, *rows = Picture("name", "png", b"", "", "", {"time (s)": time, "a, b": -time}).table.splitlines()
    assert head == "time (s),a; b"
    assert len(rows) == MOST_ROWS
    assert rows[1] == "4,-4"
