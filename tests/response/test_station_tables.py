"""What is made of all stations of a run in three dimensions: tables, files for other programs, figures, cards."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from scipy.io import loadmat

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.export import export_csv, export_mat, history_table
from coaxshell.plotting import figure_comparison, figure_curves, plot_history
from coaxshell.response.spatial import SpatialResponse

QUICK = {"duration": 1.0, "time_step": 5e-2, "modes": 5}
STATIONS = [0.0, 0.7, -0.25]


@pytest.fixture(scope="module")
def response() -> SpatialResponse:
    found = cx.simulate("bare", **QUICK, dimensions=3, stations=STATIONS)
    assert isinstance(found, SpatialResponse)
    return found


@pytest.fixture(scope="module")
def flat() -> cx.Response:
    return cx.simulate("bare", **QUICK)


def test_tables_have_the_columns_of_every_station(response: SpatialResponse, flat: cx.Response, tmp_path: Path) -> None:
    table = history_table(response)
    for z, text in zip(STATIONS, ("0", "0.7", "-0.25"), strict=True):
        for quantity, unit in (("stress", "Pa"), ("von_mises_stress", "Pa"), ("shell_velocity", "m/s"), ("sensor_voltage", "V")):
            values = response.history("outer", [0, 180], quantity, station=z).to_numpy()
            for column, point in enumerate(("head", "tail")):
                name = f"outer {quantity.replace('_', ' ')} {point} z = {text} m ({unit})"
                np.testing.assert_array_equal(table[name], values[:, column])
    frame = response.to_dataframe()
    assert list(frame.columns) == list(table)[1:]
    with export_csv(response, tmp_path / "run.csv").open(encoding="utf-8", newline="") as file:
        assert next(csv.reader(file)) == list(table)
    assert "inner stress head (Pa)" in flat.to_dataframe()
    assert not any("z =" in name or "von mises" in name for name in flat.to_dataframe())


def test_mat_files_have_a_dimension_of_stations(response: SpatialResponse, tmp_path: Path) -> None:
    content = loadmat(export_mat(response, tmp_path / "run.mat"), simplify_cells=True)
    np.testing.assert_array_equal(content["stations"], STATIONS)
    outer = content["shells"][1]
    for number, z in enumerate(STATIONS):
        np.testing.assert_array_equal(outer["axial_stress"][..., number], response.history("outer", [0, 180], "axial_stress", station=z))
        modal = response.modal("outer", "axial_displacement", station=z).to_numpy()
        np.testing.assert_array_equal(np.squeeze(outer["modal_axial"])[..., number], np.squeeze(modal))


def test_figures_tell_stations_apart(response: SpatialResponse, flat: cx.Response) -> None:
    def names(figure: object) -> list[str]:
        (legend,) = figure.legends  # type: ignore[attr-defined]
        return [text.get_text() for text in legend.get_texts()]

    assert names(response.plot())[:5] == ["0°", "180°", "z = 0 m", "z = 0.7 m", "z = -0.25 m"]
    drawn = response.plot("axial_displacement", "outer", [30.0], station="70 cm")
    (line,) = [one for one in drawn.axes[0].lines if len(one.get_xdata()) == response.time.size]
    np.testing.assert_allclose(line.get_ydata(), 1e6 * response.history("outer", 30.0, "axial_displacement", station=0.7), rtol=1e-12)
    both = names(figure_curves({"sphere": response, "slice": flat}, "stress", "inner", 0.0, station=0.7))
    assert both[1:3] == ["sphere, z = 0.7 m", "slice"]
    against = figure_comparison({"sphere": response, "slice": flat}, station=0.7)
    assert names(against)[:2] == ["sphere, z = 0.7 m", "slice"]
    ax = plot_history(response, "stress", "inner", 180.0)
    np.testing.assert_allclose(ax.lines[0].get_ydata(), 1e-6 * response.stress("inner", 180.0, station=0.0), rtol=1e-12)


def test_many_stations_are_drawn_spread_along_the_axis() -> None:
    many = cx.simulate("bare", duration=0.5, time_step=5e-2, modes=2, dimensions=3, stations=np.linspace(0.0, 1.0, 11))
    (legend,) = many.plot().legends
    assert [text.get_text() for text in legend.get_texts()][2:6] == ["z = 0 m", "z = 0.3 m", "z = 0.7 m", "z = 1 m"]
    with pytest.raises(InputError, match="station: 5 cannot be drawn; give 1 to 4"):
        many.plot(station=[0.0, 0.1, 0.2, 0.3, 0.4])  # type: ignore[call-arg]
    assert "\n0.1 m  " in str(many.summary()), "more stations than stand side by side are told below each other"


def test_what_is_not_there_is_refused_by_name(response: SpatialResponse, flat: cx.Response) -> None:
    for call, message in (
        (lambda: response.plot(station=0.3), r"station: 0\.3 m is none of the run's"),
        (lambda: plot_history(flat, station=0.7), "station: 0.7 belongs to three dimensions"),
        (response.thin(2).energy, "response: holds 11 instants where its run had 21"),
        (response.absorber_force, "absorbers: this system has none"),
    ):
        with pytest.raises(InputError, match=message):
            call()


def test_cards_and_texts_tell_of_all_stations(response: SpatialResponse) -> None:
    card = response._repr_html_()
    assert "stations at z = 0, 0.7, -0.25 m" in card
    assert "<svg" in card
    assert repr(response) == "<SpatialResponse: 'bare', 2 shells, 5 modes, t = 0 to 1 transits, 3 stations>"
    text = str(response.summary())
    assert "three dimensions: axial wavenumbers up to 5 (times a), period " in text
    half = {shell["name"]: shell["sensor_voltage"] for shell in response.summary().largest}
    told = ", ".join(f"{name} {abs(peak['lower_half'] / peak['value'] - 1):.1e}" for name, peak in half.items())
    assert f"half the orders change them by {told}" in text
