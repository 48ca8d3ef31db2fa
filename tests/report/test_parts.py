"""Pictures and data of a report."""

from __future__ import annotations

import numpy as np

from coaxshell.apps.report.page import page
from coaxshell.apps.report.parts import MOST_ROWS, Picture, Section, Table, drawn
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


def test_numbers_of_tables_stand_as_in_print():
    table = Table("what", ("peak", "error", "none"), [("-250 m/s^2", "4.5e-03", "-")])
    cells = page("title", "under it", [Section("section", [table])]).split("<tbody>")[1].split("</tbody>")[0]
    assert [cell in cells for cell in ("−250 m/s²<", ">4.5e-3<", ">–<")] == [True, True, True]
