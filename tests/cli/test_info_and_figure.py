"""``coaxshell info`` and ``coaxshell figure``."""

from __future__ import annotations

import pytest
import xarray as xr


def test_info_tells_system_settings_versions_and_peaks(run, saved):
    outcome = run("info", saved)
    assert outcome.code == 0
    for word in ("bare", "modes", "numpy", "coaxshell", "peak_pressure", "stress at tail", "inner"):
        assert word in outcome.out
    assert outcome.err == "" or outcome.err.startswith("warning: ")


@pytest.mark.slow_for("pdf", "png")
@pytest.mark.parametrize("suffix", ["png", "pdf", "svg"])
def test_figure_from_a_saved_run(run, saved, suffix):
    outcome = run("figure", "3", "--from", saved, "--output", f"three.{suffix}")
    assert outcome.code == 0, outcome.err
    assert outcome.files == [f"three.{suffix}"]
    assert f"wrote three.{suffix}" in outcome.out


@pytest.mark.parametrize("whole", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["by name", "changed too"])
def test_figure_computes_what_it_needs(run, small, whole):
    outcome = run("figure", "3", *small, "--quiet")
    assert outcome.code == 0, outcome.err
    assert outcome.files == ["figure-3.png"]
    if not whole:
        return
    assert run("figure", "3", "--preset", "iakovlev-filled", *small, "-s", "source.distance=4", "-o", "other.svg").code == 0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["99"], ["'99'", "allowed: 2, 3"]),
        (["3", "--from", "missing.nc"], ["missing.nc", "exist"]),
        (["3", "--from", "x.nc", "--preset", "bare"], ["--from", "--preset"]),
        (["3", "--from", "x.nc", "--set", "a=1"], ["--from", "--set"]),
        (["3", "--preset", "bear"], ["'bear'", "bare"]),
        (["3", "--output", "three.jpeg"], ["--output", "'three.jpeg'", ".png, .pdf, .svg"]),
        (["3", "--output", "nowhere/three.png"], ["--output", "'nowhere'"]),
        (["3", "--modes", "0"], ["--modes", "0", "1 to 2000"]),
        (["3", "--time-step", "soon"], ["--time-step", "'soon'"]),
        ([], ["NUMBER"]),
    ],
    ids=" ".join,
)
def test_bad_figure_input(refused, arguments, words):
    message = refused("figure", *arguments)
    for word in words:
        assert word in message, message


@pytest.mark.parametrize("command", [["info"], ["figure", "3", "--from"]], ids=" ".join)
@pytest.mark.parametrize("content", [b"", b"hello", b"\x89HDF\r\n\x1a\n" + bytes(64)], ids=["empty", "text", "torn"])
def test_files_that_are_not_ours(refused, tmp_path, command, content):
    (tmp_path / "other.nc").write_bytes(content)
    assert "other.nc" in refused(*command, "other.nc", left=["other.nc"])


def test_somebody_elses_netcdf(refused, tmp_path):
    xr.Dataset({"temperature": ("time", [1.0, 2.0])}).to_netcdf(tmp_path / "other.nc", engine="h5netcdf")
    assert "other.nc" in refused("info", "other.nc", left=["other.nc"])


def test_info_of_a_folder_and_of_a_cut_file(refused, tmp_path, saved):
    (tmp_path / "folder.nc").mkdir()
    assert "folder.nc" in refused("info", "folder.nc", left=["folder.nc"])
    whole = saved.read_bytes()
    (tmp_path / "cut.nc").write_bytes(whole[: len(whole) // 2])
    assert "cut.nc" in refused("info", "cut.nc", left=["cut.nc", "folder.nc"])
