"""Settings of three-dimensional runs: what is taken, what is refused and in which words, and that two dimensions are told as before."""

from __future__ import annotations

import json
from fractions import Fraction

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.response.dataset import to_dataset
from coaxshell.solver.settings import Settings
from coaxshell.studies import SweepStudy

QUICK = {"duration": 1.0, "time_step": 0.05, "modes": 4}
TWO_DIMENSIONAL = {"duration": 1.0, "time_step": 0.05, "modes": 4, "engine": "spectral", "tolerance": 1e-3, "refinement": 1}
PLANE = "has no effect in two dimensions; use dimensions=3, or leave it out"
POSITIONS = 'give axial positions in m, such as [0.0, 0.7], or texts such as "70 cm"'
LENGTH = "give a length as a finite number in m or as text such as '6 mm'"
TOO_MANY = "a list of stations has 201 axial positions; at most 200 are read"
IN_TWO = {
    "dimensions: 4 is not allowed; give 2 or 3": {"dimensions": 4},
    "dimensions: 2.5 is not allowed; give 2 or 3": {"dimensions": 2.5},
    "dimensions: True is not allowed; give 2 or 3": {"dimensions": True},
    "dimensions: '3D' is not allowed; give 2 or 3": {"dimensions": "3D"},
    f"stations: {PLANE}": {"stations": [0.0, 0.7]},
    f"axial_modes: {PLANE}": {"axial_modes": 60},
    f"axial_period: {PLANE}": {"axial_period": 20},
}
IN_THREE = {
    "engine: 'direct' solves two dimensions only; use engine=\"spectral\", or dimensions=2": {"engine": "direct"},
    f"stations: there is none; {POSITIONS}": {"stations": []},
    f"stations: {{'z': 1}} is not allowed; {POSITIONS}": {"stations": {"z": 1}},
    f"stations: None is not allowed; {POSITIONS}": {"stations": None},
    "stations[1]: 0.7 m stands there twice; give each axial position once": {"stations": [0.7, "70 cm"]},
    "stations[1]: 0 m stands there twice; give each axial position once": {"stations": [0.0, -0.0]},
    f"stations[0]: '1 s' is not a length; {LENGTH}": {"stations": ["1 s"]},
    f"stations[2]: '' is not a length; {LENGTH}": {"stations": "0,0.7,"},
    f"stations: True is not a length; {LENGTH}": {"stations": True},
    f"stations: nan is not finite; {LENGTH}": {"stations": float("nan")},
    f"stations: {TOO_MANY}": {"stations": range(201)},
    f"stations: {TOO_MANY} ": {"stations": "," * 200},
    "axial_modes: 0 is not allowed; give a finite number greater than 0 (axial wavenumber times a)": {"axial_modes": 0},
    "axial_modes: 2001 is not allowed; at most 2000 (axial wavenumber times a)": {"axial_modes": 2001},
    'axial_period: -1 m is not allowed; give a length greater than 0, in m or as text such as "20 m"': {"axial_period": -1},
    f"axial_period: '20 kg' is not a length; {LENGTH}": {"axial_period": "20 kg"},
}
REFUSED = IN_TWO | {text: {"dimensions": 3, **given} for text, given in IN_THREE.items()}


@pytest.mark.parametrize("text", REFUSED)
def test_what_no_run_accepts_is_one_line(text):
    given, expected = REFUSED[text], text.strip()
    with pytest.raises(cx.InputError) as refused:
        Settings(**given)
    assert str(refused.value) == expected
    with pytest.raises(cx.InputError) as refused:
        Settings.of(None, given, where="resolution")
    assert str(refused.value) == f"resolution.{expected}"


def test_positions_as_people_write_them():
    stations = ["70 cm", 0, np.float32(0.5), Fraction(1, 4), "-1.5"]
    found = Settings(dimensions=3, stations=stations, axial_modes="40", axial_period="2000 cm")
    assert found.stations == (0.7, 0.0, 0.5, 0.25, -1.5)  # in the order given
    assert (found.axial_modes, found.axial_period) == (40.0, 20.0)
    for one in ("70 cm", 0.7, np.float64(0.7), np.array(0.7), [0.7], np.array([0.7])):
        assert Settings(dimensions=3, stations=one).stations == (0.7,)
    for text in ("0,0.7", " 0 m, 70 cm", "0,700 mm"):
        assert Settings(dimensions="3", stations=text).stations == (0.0, 0.7)
    assert Settings(dimensions=3.0) == Settings(dimensions=3) != Settings()
    assert len(Settings(dimensions=3, stations=range(200)).stations) == 200
    assert hash(found) == hash(Settings.of(None, found.arguments()))


def test_a_three_dimensional_resolution_is_read_back_from_its_table():
    found = Settings(dimensions=3, stations=(0.0, 0.7), axial_modes=30, axial_period=17.5)
    assert Settings.of(None, json.loads(json.dumps(found.arguments()))) == found == Settings(**found.arguments())
    assert Settings(dimensions=3).arguments() == Settings().arguments() | {"dimensions": 3}
    resolution = '[resolution]\ndimensions = 3\nstations = ["0 m", 0.7]\naxial_modes = 30\naxial_period = "17.5 m"\n'
    import tomllib

    study = SweepStudy(scenario="bare", over={}, metrics=["inner.peak_stress"], **tomllib.loads(resolution))
    assert study.settings(cx.presets.load("bare")) == found


def test_two_dimensions_are_told_as_before(tmp_path):
    assert Settings(**QUICK, dimensions=2, stations=0.0).arguments() == TWO_DIMENSIONAL
    response = cx.simulate("bare", **QUICK)
    assert json.loads(to_dataset(response.solution).attrs["settings"]) == TWO_DIMENSIONAL
    assert response.summary().to_dict()["settings"] == TWO_DIMENSIONAL
    response.save(tmp_path / "run.nc")
    assert cx.load_response(tmp_path / "run.nc").settings == Settings(**QUICK)


BARE = cx.presets.load("bare")
OVER = {"source.peak_pressure": [1e4, 2e4]}
CALLS = {
    "simulate": cx.simulate,
    "prepare": cx.prepare,
    "direct": lambda system, **asked: cx.simulate(system, engine="direct", **asked),
    "sweep": lambda system, **asked: cx.sweep(system, OVER, workers=1, **asked),
    "robustness": lambda system, **asked: cx.robustness(system, {"source.distance": {"relative": 0.1}}, samples=8, workers=1, **asked),
    "optimise": lambda system, **asked: cx.optimise(system, variables=OVER, objectives="inner.peak_stress", workers=1, **asked),
    "prepared problem": lambda system, **asked: cx.prepare("bare", **asked).retuned(system),
}


def test_what_is_prepared_has_two_dimensions():
    with pytest.raises(cx.InputError, match=r"^dimensions: 3 is solved by single runs only; use dimensions=2, or simulate each system$"):
        cx.prepare(BARE, **QUICK, dimensions=3)


@pytest.mark.parametrize("call", CALLS)
def test_what_leaves_the_plane_needs_three_dimensions(call):
    oblique = cx.PlaneShock(peak_pressure=1e4, decay_time=1e-4, inclination=30)
    off, turned = BARE.with_overrides({"source.z": "70 cm"}), BARE.replace(source=[BARE.source, oblique])
    with pytest.raises(
        cx.InputError, match=r"source\.z: (.*: )?0\.7 m is off the plane of a run in two dimensions; use dimensions=3, or z = 0$"
    ):
        CALLS[call](off, **QUICK)
    if call not in ("sweep", "robustness", "optimise"):
        problem = "30 degrees lead out of the plane of a run in two dimensions; use dimensions=3, or inclination = 0"
        with pytest.raises(cx.InputError, match=rf"^source\[1\]\.inclination: {problem}$"):
            CALLS[call](turned, **QUICK)


def test_a_case_off_the_plane_tells_why():
    with pytest.warns(cx.PhysicsWarning, match="off the plane"):
        found = cx.sweep(BARE, {"source.z": [0.0, "70 cm"]}, workers=1, **QUICK)
    assert found["source.z"].attrs["units"] == "m"
    assert np.isfinite(found["inner.peak_stress"]).to_numpy().tolist() == [True, False]
