"""Shock response spectra of shells."""

from __future__ import annotations

import csv

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.export import export_spectra_csv
from coaxshell.plotting import figure_shock_spectra

PULSE = cx.Gaussian(peak_pressure=2.5e4, width=1.5e-4, centre=9e-4)


@pytest.fixture(scope="module")
def response():
    system = cx.presets.load("bare").replace(source=cx.PlaneWave(pulse=PULSE))
    return cx.simulate(system, modes=8, time_step=1e-2, duration=5)


def test_slow_equipment_stays_where_it_is(response):
    """Far below all frequencies the mass rests: its displacement relative to the shell is that of the shell."""
    found = response.shock_spectrum("inner", [0, 90], 0.5, kind="relative-displacement", during="primary")
    np.testing.assert_allclose(found[0], abs(response.displacement("inner", [0, 90])).max("time"), rtol=2e-2)


def test_fast_equipment_moves_with_the_shell(response):
    highest = 0.4 / (1e-2 / 1400)
    found = response.shock_spectrum("outer", [0, 180], 0.6 * highest, kind="absolute-acceleration", quality_factor=2.0)
    np.testing.assert_allclose(found[0], abs(response.shell_acceleration("outer", [0, 180])).max("time"), rtol=3e-2)


def test_kinds_extremes_and_phases_belong_together(response):
    f = [300.0, 2000.0]
    omega = 2 * np.pi * np.array(f)[:, None]
    z = response.shock_spectrum("inner", [0, 60], f, kind="relative-displacement")
    np.testing.assert_allclose(response.shock_spectrum("inner", [0, 60], f), omega * z, rtol=1e-12)
    sides = [response.shock_spectrum("inner", [0, 60], f, extreme=side) for side in ("positive", "negative")]
    np.testing.assert_array_equal(response.shock_spectrum("inner", [0, 60], f), np.maximum(*sides))
    phases = [response.shock_spectrum("inner", [0, 60], f, during=phase) for phase in ("primary", "residual")]
    np.testing.assert_array_equal(response.shock_spectrum("inner", [0, 60], f), np.maximum(*phases))
    assert z.dims == ("frequency", "angle")
    assert z.attrs["units"] == "m"
    assert response.shock_spectrum("inner", 0, f).dims == ("frequency",)


def test_mirror_images_are_equal_where_there_are_any(response):
    f = [300.0, 2000.0]
    found = response.shock_spectrum("outer", [-40.0, 40.0, 320.0, 50.0], f).values
    assert np.all(found[:, :3] == found[:, 1:2])
    assert np.all(found[:, 3] != found[:, 1])
    turned = response.system.replace(source=(cx.PlaneShock(peak_pressure=1e5, decay_time=1e-4, angle=60.0),))
    run = cx.simulate(turned, modes=4, time_step=0.02, duration=1.0)
    left, right = run.shock_spectrum("outer", [-40.0, 40.0], 300.0).values.ravel()
    assert abs(left - right) > 1e-2 * right


def test_stations():
    system = cx.presets.load("bare").replace(source=cx.LineShock(peak_pressure=2.5e4, decay_time=1.3e-4, distance=5))
    settings = {"modes": 4, "time_step": 0.04, "duration": 2}
    flat = cx.simulate(system, **settings).shock_spectrum("inner", [0, 180], [500, 1500])
    found = cx.simulate(system, dimensions=3, stations=[0, 0.7], **settings).shock_spectrum("inner", [0, 180], [500, 1500])
    assert found.dims == ("station", "frequency", "angle")
    np.testing.assert_allclose(found, np.broadcast_to(flat, found.shape), rtol=1e-9)


def test_sheet_and_table(response, tmp_path):
    figure = figure_shock_spectra({"a": response}, frequency=[100.0, 500.0, 2500.0], angle=[0.0])
    curve = next(line for line in figure.axes[1].lines if line.get_linewidth() == 1.1)
    np.testing.assert_allclose(curve.get_ydata(), response.shock_spectrum("outer", 0.0, [100.0, 500.0, 2500.0]), rtol=2e-3)
    around = next(line for line in figure.axes[1].lines if line.get_linewidth() == 1.3)
    assert np.all(around.get_ydata() >= curve.get_ydata())
    slanted = {text.get_text() for text in figure.axes[0].texts}
    assert any("m/s²" in text for text in slanted)
    assert any(text.endswith(" µm") for text in slanted)
    path = export_spectra_csv(response, tmp_path / "spectra.csv", "inner", [0.0], frequency=[100.0, 500.0])
    heading, *rows = list(csv.reader(path.read_text(encoding="utf-8").splitlines()))
    assert heading[:2] == ["natural frequency (Hz)", "inner 0 deg pseudo velocity (m/s)"]
    np.testing.assert_allclose([float(row[1]) for row in rows], response.shock_spectrum("inner", 0.0, [100.0, 500.0]), rtol=1e-10)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"frequency": 1e9}, r"frequency: 1e\+09 Hz is above 5.6e\+04 Hz"),
        ({"frequency": [100.0, -1.0]}, "frequency: -1 Hz is not allowed"),
        ({"frequency": "low"}, "frequency: 'low' is not a number"),
        ({"frequency": []}, "frequency: an array of shape"),
        ({"quality_factor": 0.5}, "quality_factor: 0.5 is not allowed"),
        ({"quality_factor": True}, "quality_factor: True is not allowed"),
        ({"kind": "velocity"}, "kind: 'velocity' is unknown"),
        ({"extreme": "largest"}, "extreme: 'largest' is unknown"),
        ({"during": "after"}, "during: 'after' is unknown"),
        ({"component": "axial"}, "component: 'axial' is unknown"),
    ],
)
def test_bad_spectra(response, arguments, words):
    with pytest.raises(InputError, match=words):
        response.shock_spectrum("inner", 0, **arguments)
