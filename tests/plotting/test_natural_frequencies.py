"""Figures of natural frequencies."""

from __future__ import annotations

import pytest

import coaxshell as cx
from coaxshell import plotting
from coaxshell.errors import InputError


def test_figures_show_every_mode():
    found = cx.natural_frequencies("bare", [2, 3], up_to=100.0)
    axes = plotting.plot_natural_frequencies(found)
    wet = sum(line.get_xdata().size for line in axes.lines if line.get_marker() == "o")
    dry = sum(line.get_xdata().size for line in axes.lines if line.get_marker() == "_")
    assert (wet, dry) == (4, 4)
    shape = plotting.plot_mode_shape("bare", found, 2, 1)
    assert shape.get_title().startswith("$m$ = 2: 8.844 Hz")
    along = cx.natural_frequencies("bare", [2, 3], [20.0, 30.0], up_to=100.0)
    assert plotting.plot_natural_frequencies(along).get_xlabel() == "axial wavenumber (rad/m)"
    with pytest.raises(InputError, match="has several axial half wavelengths"):
        plotting.plot_mode_shape("bare", along, 2)
    with pytest.raises(InputError, match="order: 7 was not asked for"):
        plotting.plot_mode_shape("bare", found, 7)
    with pytest.raises(InputError, match="mode: order 2 has no mode 4"):
        plotting.plot_mode_shape("bare", found, 2, 4)
