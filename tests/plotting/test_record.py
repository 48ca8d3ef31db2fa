"""The picture of a record: plain numbers beside its units."""

from __future__ import annotations

import coaxshell as cx
from coaxshell.plotting.record import figure_record


def test_frequencies_are_plain_numbers_beside_their_prefix():
    record = cx.Sampled(time=[0.0, 1e-5, 1e-4, 4e-4, 1.2e-3], pressure=[0.0, 2.5e5, 1.8e5, 4e4, 0.0])
    figure = figure_record(record, "gauge.csv")
    figure.canvas.draw()
    axis = figure.axes[1].xaxis
    low, high = axis.get_view_interval()
    shown = {tick.label1.get_text() for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high}
    assert shown == {"1", "10"}
    assert figure.axes[1].get_xlabel() == "frequency (kHz)"


def test_a_spectrum_of_less_than_two_decades_is_numbered_between_the_powers_of_ten():
    record = cx.Sampled(time=[0.0, 5e-5, 1e-4, 4e-4, 1e-3], pressure=[2.52e5, 2e5, 1.2e5, 2e4, 2e3])
    figure = figure_record(record, "gauge.csv")
    figure.canvas.draw()
    axis = figure.axes[1].yaxis
    low, high = axis.get_view_interval()
    shown = [tick.label1.get_text() for tick in (*axis.get_major_ticks(), *axis.get_minor_ticks()) if low <= tick.get_loc() <= high]
    assert {"10", "20"} <= set(shown)
    assert not any("times" in text for text in shown)
