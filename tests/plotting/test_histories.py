"""Histories: what is drawn is what the response says, in the units that the axis names."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure

from coaxshell import InputError
from coaxshell.plotting import QUANTITIES, plot_history


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_curve_is_the_response_in_the_units_of_the_axis(response, quantity):
    ax = plot_history(response, quantity, "inner", 180.0)
    drawn = QUANTITIES[quantity]
    expected = getattr(response, drawn.method)("inner", angle=[180.0], **drawn.options).isel(angle=0).to_numpy()
    np.testing.assert_allclose(ax.lines[0].get_ydata(), drawn.per_si * expected, rtol=1e-12)
    np.testing.assert_allclose(ax.lines[0].get_xdata(), response.time, rtol=0)
    assert drawn.unit in ax.get_ylabel()
    assert "transits" in ax.get_xlabel()


def test_draws_into_the_axes_it_is_given_and_returns_them(response):
    ax = Figure().add_subplot()
    assert plot_history(response, "stress", "outer", 0, ax=ax, color="black", label="mine") is ax
    assert ax.lines[0].get_color() == "black"
    assert ax.lines[0].get_label() == "mine"


def test_leaves_the_callers_settings_alone(response):
    before = dict(mpl.rcParams)
    plot_history(response)
    assert dict(mpl.rcParams) == before


def test_unknown_quantity(response):
    with pytest.raises(InputError, match="'strain' cannot be drawn; allowed: stress, relative_displacement, displacement"):
        plot_history(response, "strain")
