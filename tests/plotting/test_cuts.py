"""Cuts of three-dimensional runs and walls laid flat: what is drawn is what the response says, mirrored where nothing tells z from -z."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.plotting import FieldView, figure_cuts, plot_unrolled
from coaxshell.plotting.unrolled import ANGLES, along_stations
from coaxshell.response.spatial import SpatialResponse

SMALL = FieldView(2.0, 24)
STATIONS = [0.0, 0.5, 1.0]


def solved(system: cx.System | str, stations: Any = STATIONS) -> SpatialResponse:
    found = cx.simulate(system, duration=2.0, time_step=2e-2, modes=12, dimensions=3, stations=stations)
    assert isinstance(found, SpatialResponse)
    return found


@pytest.fixture(scope="module")
def response() -> SpatialResponse:
    return solved("bare")


def test_both_cuts_show_the_pressure(response: SpatialResponse) -> None:
    figure = figure_cuts(response, 1.4, station="50 cm", view=SMALL)
    across, along = (ax for ax in figure.axes if ax.get_xlabel() == "$x/a$")
    assert (across.get_ylabel(), along.get_ylabel()) == ("$y/a$", "$z/a$")
    assert "0.5 m" in across.get_title()
    x = SMALL.centres
    expected = response.pressure(x=x, y=x, z=0.5 / response.system.reference_radius, time=1.4, front="matched")
    np.testing.assert_allclose(across.images[0].get_array(), expected, rtol=1e-5, atol=1e-2)
    np.testing.assert_allclose(along.images[0].get_array(), response.pressure(x=x, z=x, time=1.4, front="matched"), rtol=1e-5, atol=1e-2)
    assert len(along.images) == 5  # the pressure, head and tail of two shells
    labels = [bar.get_ylabel() for bar in along.child_axes]
    assert "hoop stress (MPa)" in labels
    assert "pressure (kPa)" in labels


@pytest.mark.slow
def test_one_station_leaves_shells_along_the_axis_as_lines() -> None:
    figure = figure_cuts(solved("bare", [0.0]), 1.0, view=SMALL)
    along = next(ax for ax in figure.axes if ax.get_ylabel() == "$z/a$")
    assert len(along.images) == 1
    assert len(along.collections) == 4


def test_a_wall_laid_flat_is_mirrored(response: SpatialResponse) -> None:
    z, stress = along_stations(response, 1, ANGLES, 70)
    np.testing.assert_array_equal(z, [-1.0, -0.5, 0.0, 0.5, 1.0])
    np.testing.assert_array_equal(stress, stress[::-1])
    np.testing.assert_array_equal(stress[3], response.stress("outer", ANGLES, station=0.5).isel(time=70))
    _, shear = along_stations(response, 1, ANGLES, 70, "shear")
    np.testing.assert_array_equal(shear, -shear[::-1])
    ax = plot_unrolled(response, "outer", 1.4, component="von_mises")
    assert ax.get_ylabel() == "$z/a$"
    assert "outer shell" in ax.get_title()
    assert "von Mises stress (MPa)" in [one.get_ylabel() for one in ax.child_axes]


def test_a_source_beside_the_middle_is_not_mirrored(response: SpatialResponse) -> None:
    beside = solved(response.system.replace(source=response.system.source.model_copy(update={"z": 0.2})))
    z, _ = along_stations(beside, 0, [0.0], 70)
    np.testing.assert_array_equal(z, STATIONS)


def test_one_station_cannot_be_laid_flat() -> None:
    with pytest.raises(InputError, match="stations: there is one alone"):
        plot_unrolled(solved("bare", [0.0]), "outer", 1.0)
