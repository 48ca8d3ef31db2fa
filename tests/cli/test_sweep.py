"""``coaxshell sweep``."""

from __future__ import annotations

import csv
from functools import partial

import pytest
import xarray as xr

import coaxshell as cx
from coaxshell.studies import execution

STUDY = """
scenario = "bare"
metrics = ["inner.peak_stress", "absorbers.mass"]

[set]
absorbers = { count = 3, mass = "10 kg", linear_stiffness = "1 GN/m^2" }
source.peak_pressure = "30 kPa"

[over]
"absorbers.count" = { from = 0, to = 4, step = 2 }
source.distance = ["4 m", 5]

[resolution]
duration = 1
time_step = 0.02
modes = 6
"""


@pytest.mark.slow
def test_a_study_file_is_the_python_call(run, study, tmp_path):
    outcome = run("sweep", study(), "--workers", "1", "--csv", "t.csv", "--figure", "f.png")
    assert outcome.code == 0, outcome.err
    assert outcome.files == ["f.png", "study.nc", "study.toml", "t.csv"]
    assert "cases: 100 %, 0 s left" in outcome.err
    assert "6 cases" in outcome.out
    ring = cx.absorber_ring(3, mass=10, linear_stiffness=1e9)
    base = cx.presets.load("bare").replace(absorbers=ring).with_overrides({"source.peak_pressure": 3e4})
    over = {"absorbers.count": [0, 2, 4], "source.distance": [4.0, 5.0]}
    metrics = ["inner.peak_stress", "absorbers.mass"]
    expected = cx.sweep(base, over, metrics, duration=1, time_step=0.02, modes=6, workers=1)
    found = xr.load_dataset(tmp_path / "study.nc", engine="h5netcdf")
    xr.testing.assert_identical(found, expected)
    with (tmp_path / "t.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [float(row["inner.peak_stress [Pa]"]) for row in rows] == expected["inner.peak_stress"].to_numpy().ravel().tolist()
    assert [float(row["source.distance [m]"]) for row in rows] == [4.0, 5.0] * 3


def test_a_store_of_its_own_is_kept_and_resumed(run, study):
    arguments = ("sweep", study(), "--workers", "1", "--store", "kept", "--quiet")
    assert run(*arguments).code == 0
    assert "--output: 'study.nc' exists already" in run(*arguments).err
    again = run(*arguments, "--force")
    assert again.code == 2
    assert "already holds 6 cases of this study; use resume (--resume)" in again.err
    resumed = run(*arguments, "--resume")
    assert resumed.code == 0
    study(STUDY.replace("30 kPa", "31 kPa"))
    other = run(*arguments, "--resume")
    assert other.code == 2
    assert "holds another study: its scenario" in other.err


def test_ctrl_c_says_what_is_kept(run, study, monkeypatch):
    from coaxshell.studies import running

    work = running.evaluate
    done = []

    def interrupted(batch):
        if len(done) == 2:
            raise KeyboardInterrupt
        done.append(batch)
        return work(batch)

    monkeypatch.setattr(running, "evaluate", interrupted)
    outcome = run("sweep", study(), "--workers", "1", "--quiet")
    assert outcome.code == 130
    cases = sum(len(batch.cases) for batch in done)
    assert outcome.err == f"error: interrupted; {cases} of 6 cases are kept in 'study.store': go on with --resume\n"
    monkeypatch.undo()


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"bare"', '"bear"', "scenario: there is no preset 'bear'; did you mean 'bare'?"),
        ('"bare"', '"missing.toml"', "scenario"),
        ("inner.peak_stress", "inner.peak_stres", "metrics[0]: 'inner.peak_stres' is not a known metric"),
        ("absorbers.count", "absorbers.cuont", "over.absorbers.cuont"),
        (
            "step = 2",
            "stop = 2",
            "over.absorbers.count.stop: is not an entry of a range; did you mean 'step'? allowed: from, to, count, step, scale",
        ),
        ('"4 m"', '"4 kg"', "over.source.distance[0]: '4 kg' is not a length"),
        ("modes = 6", "modes = 0", "resolution.modes: 0 is not allowed"),
        ("modes = 6", "mods = 6", "resolution.mods: is not an entry of a resolution; did you mean 'modes'?"),
        ('"bare"\nmetrics', '"bare"\nmetric', "metric: is not an entry of a sweep; did you mean 'metrics'?"),
        ("30 kPa", "30 kg", "set.source.peak_pressure: '30 kg' is not a pressure"),
        ('metrics = ["inner.peak_stress", "absorbers.mass"]', "", "metrics: is missing"),
        ("[over]", "[over", "must be valid TOML"),
    ],
)
def test_bad_study_files(refused, study, old, new, message):
    assert message in refused("sweep", study(STUDY.replace(old, new)), left=["study.toml"])


def test_bad_options(refused, study, monkeypatch):
    monkeypatch.setattr(execution, "dask_executor", partial(execution.dask_executor, timeout=0.5))
    name = study()
    assert "--workers" in refused("sweep", name, "--workers", "two", left=[name])
    assert "no scheduler answers" in refused("sweep", name, "--dask", "tcp://127.0.0.1:9", left=[name])
    assert "--workers: has no effect beside dask" in refused("sweep", name, "--dask", "x", "--workers", "2", left=[name])
    assert "--output" in refused("sweep", name, "--output", "x.txt", left=[name])
    assert "cannot be read" in refused("sweep", "none.toml", left=[name])
