"""Sweeps from the page are those of the library."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from asking import SMALL, described, ended, start
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.model import presets

OVER = {"absorbers.mass": [5, "20 kg"], "source.peak_pressure": {"from": 1e4, "to": 3e4, "count": 2}}


def test_a_sweep_is_that_of_the_library(client, tmp_path):
    metrics = ["inner.peak_stress", "outer.rms_stress"]
    job = ended(client, start(client, kind="sweep", system=described("absorbers"), over=OVER, metrics=metrics, resolution=SMALL))
    assert job["state"] == "done", job
    told = client.get(f"/api/jobs/{job['id']}/result").json()
    expected = cx.sweep(presets.load("absorbers"), OVER, metrics, workers=1, **SMALL)
    assert told["dims"] == list(OVER)
    for metric in told["metrics"]:
        assert_allclose(metric["values"], expected[metric["name"]].values, rtol=1e-9)
        assert metric["unit"] == expected[metric["name"]].attrs["units"]
    path = tmp_path / "sweep.nc"
    path.write_bytes(client.get(f"/api/jobs/{job['id']}/file").content)
    with xr.open_dataset(path, engine="h5netcdf") as written:
        assert_allclose(written["inner.peak_stress"].values, expected["inner.peak_stress"].values, rtol=1e-9)


def test_cases_that_fail_are_told_and_the_others_go_on(client):
    job = start(client, kind="sweep", system=described("active"), over={"control.derivative": [-150, 150]}, resolution=SMALL)
    assert ended(client, job)["state"] == "done"
    told = client.get(f"/api/jobs/{job['id']}/result").json()
    values = told["metrics"][0]["values"]
    assert values[1] is None
    assert np.isfinite(values[0])
    assert [failure["case"] for failure in told["failures"]] == [1]
    assert "unstable" in told["failures"][0]["reason"]


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"metrics": ["/elsewhere/user.py:metric"]}, "metrics[0]"),
        ({"metrics": [["inner.peak_stress"]]}, "metrics[0]"),
        ({"over": {"absorbers.mass": {"from": 1, "to": 2, "count": 10**9}}}, "over.absorbers.mass"),
        ({"over": {"absorbers.mass": {"from": 1, "to": 2, "step": 1e-9}}}, "over.absorbers.mass.step"),
        ({"over": {"absorbers.count": list(range(25)), "absorbers.mass": list(range(1, 21))}}, "over"),
        ({"over": {"absorbers.colour": [1]}}, "over.absorbers.colour"),
        ({"over": {"absorbers.count": [10**9]}}, "over.absorbers.count"),
        ({"over": {"source.pulse": [{"type": "sampled", "file": "/etc/passwd"}]}}, "over.source.pulse[0]"),
        ({"over": {"x" * 300: [1]}}, "over"),
        ({"over": None}, "over"),
    ],
)
def test_a_sweep_out_of_bounds_is_told(client, change, where):
    body = {"client": "tab", "kind": "sweep", "system": described("absorbers"), "over": OVER, "resolution": SMALL, **change}
    answer = client.post("/api/jobs", json=body)
    assert answer.status_code == 200
    assert answer.json()["problem"]["where"].startswith(where)
