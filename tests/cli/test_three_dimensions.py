"""Runs in three dimensions from the command line, end to end: solved, told, saved, read, drawn, exported, compared, refused."""

from __future__ import annotations

import csv
import json

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.response.spatial import SpatialResponse

QUICK = ["--duration", "1", "--time-step", "0.05", "--modes", "4", "--quiet"]
SPATIAL = [*QUICK, "--dimensions", "3", "--stations", "0,0.7"]


@pytest.fixture
def saved(tmp_path):
    found = cx.simulate("bare", duration=1.0, time_step=0.05, modes=4, dimensions=3, stations=[0.0, 0.7])
    return found.save(tmp_path / "bare.nc").name


def test_a_run_is_told_saved_and_drawn(run):
    outcome = run("run", "bare", *SPATIAL, "--output", "x.nc", "--figure", "f.png", "--json")
    assert outcome.code == 0
    assert outcome.files == ["f.png", "x.nc"]
    document = json.loads(outcome.out)
    (told,) = document["runs"]
    assert [one["station"] for one in told["stations"]] == [0.0, 0.7]
    assert {"von_mises_stress", "axial_stress", "stress"} <= set(told["largest"][0])
    assert document["units"]["station"] == "m"
    assert document["units"]["von_mises_stress"] == "Pa"
    loaded = cx.load_response("x.nc")
    assert isinstance(loaded, SpatialResponse)
    assert told["largest"][1]["stress"] == json.loads(json.dumps(loaded.summary().largest[1]["stress"]))
    assert "saved x.nc" in outcome.err
    text = run("run", "bare", *SPATIAL)
    assert "largest anywhere at z =" in text.out
    assert "axial wavenumbers above 4 (times a) would change the stress" in text.err


def test_a_saved_run_is_told(run, saved):
    outcome = run("info", saved)
    assert outcome.code == 0
    assert "stations 2, shells 2, orders 0 to 4, instants 21" in outcome.out
    assert "normal_zz (station 2, shell 2, half 1, mode 5, time 21)" in outcome.out
    assert "largest anywhere at z =" in outcome.out
    document = json.loads(run("info", saved, "--json").out)
    assert document["runs"][0]["stations"][1]["station"] == 0.7


def test_a_saved_run_is_drawn_and_exported(run, saved):
    assert run("plot", saved, "--quantity", "axial-displacement", "--stations", "70 cm", "--output", "u.png").code == 0
    assert run("export", saved, "--to", "csv", "--output", "all.csv").code == 0
    assert run("export", saved, "--to", "csv", "--stations", "0.7", "--output", "one.csv").code == 0
    assert run("export", saved, "--to", "mat", "--output", "x.mat").code == 0
    tables = []
    for name in ("all.csv", "one.csv"):
        with open(name, encoding="utf-8", newline="") as file:
            tables.append(list(csv.DictReader(file)))
    assert "inner von mises stress tail z = 0.7 m (Pa)" in tables[1][0]
    told = run("verify", "--against", "one.csv", "--case", "bare")
    assert (told.code, told.err.count("\n")) == (2, 1)
    assert "is of a run in three dimensions, and runs in two are compared here" in told.err
    assert set(tables[1][0]) < set(tables[0][0])
    np.testing.assert_array_equal(*[[row["outer stress head z = 0.7 m (Pa)"] for row in table] for table in tables])


def test_a_solved_run_is_drawn_and_exported_too(run):
    assert run("plot", "bare", *SPATIAL, "--output", "p.png").code == 0
    assert run("export", "bare", *SPATIAL, "--to", "csv", "--output", "x.csv").code == 0


@pytest.mark.slow
def test_a_saved_run_is_filmed_and_opened_in_paraview(run, saved):
    assert run("snapshots", saved, "--section", "70 cm", "--times", "0.4", "--pixels", "16", "--output", "s.png").code == 0
    assert run("animate", saved, "--frames", "2", "--size", "16", "--output", "f.webp").code == 0
    assert run("animate", saved, "--frames", "2", "--size", "100", "--wall", "1", "--component", "axial", "--output", "w.webp").code == 0
    outcome = run("export", saved, "--to", "paraview", "--times", "0.5", "--points", "5", "--volume", "5", "--width", "3", "--output", "p")
    assert outcome.code == 0, outcome
    assert "wrote p: open across.pvd, along.pvd, volume.pvd and shells.pvd in ParaView" in outcome.out


def test_two_runs_are_compared_at_the_stations_that_both_have(run, saved):
    outcome = run("run", "iakovlev-double", *SPATIAL, "--compare", "bare", "--figure", "f.png")
    assert outcome.code == 0, outcome
    assert "von Mises stress" in outcome.out
    assert "three dimensions, largest over z = 0, 0.7 m" in outcome.out
    outcome = run("run", "bare", *QUICK, "--dimensions", "3", "--stations", "0.7,1", "--compare", saved)
    assert outcome.out.count("largest over z = 0.7 m") == 2
    outcome = run("run", "bare", *QUICK, "--dimensions", "3", "--stations", "1", "--compare", saved)
    assert outcome.code == 2
    assert "--compare: the runs have no station in common" in outcome.err


def test_the_hybrid_system_runs_and_is_compared(run):
    outcome = run("run", "hybrid", *SPATIAL, "--output", "hybrid.nc", "--compare", "bare")
    assert outcome.code == 0, outcome
    assert "force on a shell" in outcome.out
    loaded = cx.load_response("hybrid.nc")
    assert loaded.absorber_force("70 cm").dims == ("absorber", "side", "time")
    assert run("export", "hybrid.nc", "--to", "csv", "--output", "x.csv").code == 0
    with open("x.csv", encoding="utf-8", newline="") as file:
        assert "absorber 24 displacement z = 0.7 m (m)" in next(csv.reader(file))


def test_a_sphere_is_compared_with_a_slice(run, saved):
    outcome = run("run", "bare", *QUICK, "--output", "slice.nc", "--compare", saved, "--figure", "f.png")
    assert outcome.code == 0, outcome
    assert "three dimensions, largest over z = 0 m" in outcome.out
    assert outcome.out.startswith("bare, two dimensions against bare, three dimensions")
    row = next(line for line in outcome.out.splitlines() if line.startswith("outer  stress at head"))
    flat, space = cx.load_response("slice.nc").summary(), cx.load_response(saved).summary().at(0.0)
    assert ("larger" if flat.shells[1].stress_head.value > space.shells[1].stress_head.value else "smaller") in row
    assert run("plot", saved, "--compare", "slice.nc", "--stations", "0", "--output", "p.png").code == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["run", "bare", "--stations", "0,0.7"], "--stations: has no effect in two dimensions; use dimensions=3, or leave it out"),
        (["run", "bare", "--dimensions", "3", "--stations", "0,70 cm,0.7"], "--stations: 0.7 m stands there twice; give each"),
        (["run", "bare", "--dimensions", "3", "--stations", ""], "--stations: "),
        (["run", "bare", "--dimensions", "3", "--axial-period", "2 m"], "--axial-period: 2 m is too short: images of the source"),
        (["run", "bare", "--dimensions", "3", "--axial-period", "1e7 m"], "--axial-period: an axial period of 1e+07 m asks for"),
        (["run", "bare", "--dimensions", "3", "--stations", "1000 km"], "--stations: an axial period of"),
        (["run", "bare", "--dimensions", "3", "--set", "source.distance=0.5", "--set", "source.z=3"], "source.distance"),
        (
            ["run", "hybrid", "--dimensions", "3", "--set", "control.saturation=true"],
            "control.saturation: beside absorbers ",
        ),
        (
            ["run", "iakovlev-evacuated", "--dimensions", "3", "--set", "source.inclination=5", "--energy", "e.png"],
            "source.inclination: 5 degrees: an inclined wave carries energy along the shells",
        ),
        (["run", "bare", "--dimensions", "3", "--engine", "direct"], "--engine: 'direct' solves two dimensions only"),
        (["animate", "bare", "--dimensions", "3", "--wall", "outer", "--section", "0"], "--wall: cannot be combined with --section"),
        (["animate", "bare", "--dimensions", "3", "--component", "loud"], "--component: 'loud'"),
    ],
)
def test_bad_input_is_one_line_before_anything_is_solved(refused, arguments, message):
    assert message in refused(*arguments)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["plot", "bare.nc", "--stations", "0.3"], "--stations: 0.3 m is none of the run's; it has 0, 0.7 m"),
        (["plot", "bare.nc", "--modes", "8"], "--modes: has no effect on a saved run"),
        (["figure", "3", "--from", "bare.nc"], "bare.nc: is a run in three dimensions"),
        (["snapshots", "bare.nc", "--section", "0.2"], "--section: 0.2 m is none of the run's"),
        (["animate", "bare.nc", "--wall", "middle", "--output", "f.webp"], "--wall: 'middle'"),
        (["export", "bare.nc", "--to", "paraview", "--volume", "3"], "--volume: 3 is not allowed"),
    ],
)
def test_a_saved_run_is_refused_by_name_where_two_dimensions_are_shown(refused, saved, arguments, message):
    assert message in refused(*arguments, left=[saved])


def test_quantities_of_space_are_not_drawn_of_a_plane(refused):
    assert "--quantity: 'von_mises_stress' belongs to three dimensions" in refused("plot", "bare", *QUICK, "--quantity", "von-mises-stress")


def test_progress_and_the_time_it_takes_are_told(run):
    outcome = run("run", "bare", "--dimensions", "3", "--duration", "1", "--time-step", "0.05", "--modes", "4")
    assert "axial wavenumbers: 100 %" in outcome.err
