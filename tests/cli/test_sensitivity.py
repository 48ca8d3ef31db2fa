"""``coaxshell sensitivity``."""

from __future__ import annotations

import pytest
import xarray as xr

import coaxshell as cx

STUDY = """
scenario = "bare"
metrics = ["inner.peak_stress"]
samples = 8

[uncertain]
source.peak_pressure = { relative = 0.1 }
"source.distance" = { normal = { mean = "5 m", deviation = "20 cm" } }

[resolution]
duration = 1
time_step = 0.02
modes = 6
"""


def test_a_study_file_is_the_python_call(run, study, tmp_path):
    outcome = run("sensitivity", study(), "--workers", "1", "--figure", "f.png")
    assert outcome.code == 0, outcome.err
    assert outcome.files == ["f.png", "study.nc", "study.toml"]
    assert "32 runs" in outcome.out
    over = {"source.peak_pressure": cx.Normal(1, 0.1, relative=True), "source.distance": cx.Normal(5, "0.2 m")}
    settings = {"duration": 1, "time_step": 0.02, "modes": 6}
    expected = cx.sensitivity(cx.presets.load("bare"), over, ["inner.peak_stress"], samples=8, workers=1, **settings)
    xr.testing.assert_identical(xr.load_dataset(tmp_path / "study.nc", engine="h5netcdf"), expected)


def test_statistics_alone_and_failures(run, study):
    text = STUDY.replace("samples = 8", "samples = 12\nindices = false")
    outcome = run("sensitivity", study(text), "--workers", "1", "--figure", "f.svg", "--quiet")
    assert outcome.code == 0, outcome.err
    assert "12 runs" in outcome.out
    assert "alone" not in outcome.out
    failing = text.replace("[uncertain]", "[uncertain]\nshells.inner.radius = [0.5, 1.2]")
    outcome = run("sensitivity", study(failing), "--workers", "1", "--figure", "g.svg", "--quiet", "--force")
    assert outcome.code == 0
    assert "of them failed: no statistics" in outcome.out
    assert "cases failed" in outcome.err
    assert "g.svg" not in outcome.files
    assert any("study.store" in name for name in outcome.files)  # kept for --resume


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("source.peak_pressure", "source.peak_presure", "uncertain.source.peak_presure"),
        ("20 cm", "20 kg", "uncertain.source.distance.deviation: '20 kg' is not a length"),
        ("relative = 0.1", "relative = -0.1", "uncertain.source.peak_pressure: a standard deviation of -0.1 is not allowed"),
        ("samples = 8", "samples = 12", "samples: 12 is not a power of two"),
        ("samples = 8", "sample = 8", "sample: is not an entry of a study of uncertain properties; did you mean 'samples'?"),
        ("mean = ", "middle = ", "uncertain.source.distance.normal.middle: is not an entry of a normal distribution"),
        ("[uncertain]", "[over]", "over: is not an entry of a study of uncertain properties; allowed: scenario, set"),
    ],
)
def test_bad_study_files(refused, study, old, new, message):
    assert message in refused("sensitivity", study(STUDY.replace(old, new)), left=["study.toml"])
