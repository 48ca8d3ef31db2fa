"""Figures of answers at given frequencies."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell import plotting
from coaxshell.errors import InputError


def test_levels_and_amplitudes_with_their_resonances():
    hertz = np.linspace(50.0, 400.0, 8)
    marks = cx.natural_frequencies("bare", 4, up_to=400.0)
    level = cx.frequency_response("bare", hertz, modes=8)
    figure = plotting.figure_frequency_response({"one": level, "two": level + 3.0}, marks)
    (axes,) = figure.axes
    drawn = axes.lines[:2]
    np.testing.assert_array_equal(drawn[1].get_ydata(), level + 3.0)
    inside = (marks["frequency"] >= 50.0) & (marks["damping_ratio"] <= 0.2)
    assert len(axes.lines) == 2 + int(inside.sum())
    assert axes.get_ylabel() == "target strength (dB re 1 m)"
    stress = cx.frequency_response("bare", hertz, "stress", angle=[0.0, 90.0], modes=8)
    magnitude, phase = plotting.figure_frequency_response(stress).axes
    np.testing.assert_allclose(magnitude.lines[1].get_ydata(), np.abs(stress.values[:, 1]))
    assert phase.get_ylabel() == "phase (degrees)"
    assert magnitude.get_yscale() == "log"


def test_directivity_goes_around():
    found = cx.frequency_response("bare", [300.0, 600.0], angle=np.arange(0.0, 361.0, 10.0), modes=12)
    axes = plotting.plot_directivity(found, 600.0)
    (line,) = axes.lines
    np.testing.assert_allclose(line.get_ydata(), np.maximum(found.values[1], axes.get_ylim()[0]))
    assert axes.get_ylim()[1] >= found.values[1].max()
    figure = plotting.figure_directivity(found)
    assert len(figure.axes[0].lines) == 2
    figure.draw_without_rendering()
    title = figure.get_suptitle()
    assert title == "target strength (dB re 1 m)"
    assert figure.get_tightbbox().y1 < figure.get_size_inches()[1]  # nothing is cut off at the top


def test_what_cannot_be_drawn_is_refused():
    one = cx.frequency_response("bare", 300.0, modes=8)
    with pytest.raises(InputError, match="has no frequencies to draw"):
        plotting.plot_frequency_response(one)
    with pytest.raises(InputError, match="is no answer over the angle alone"):
        plotting.plot_directivity(one)
    many = cx.frequency_response("bare", [300.0, 400.0], angle=range(9), modes=8)
    with pytest.raises(InputError, match="9 curves cannot be drawn"):
        plotting.plot_frequency_response(many)
