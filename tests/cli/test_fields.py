"""``coaxshell snapshots``, ``animate`` and ``export``, and the figures of fields."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

from coaxshell import InputError
from coaxshell.apps.cli.options import times

FAST = ("--quiet", "--width", "4")


@pytest.mark.parametrize(
    ("text", "expected"),
    [("1.2", [1.2]), ("0.2, 1.2,3", [0.2, 1.2, 3.0]), ("0:1:0.25", [0, 0.25, 0.5, 0.75, 1]), ("0:0.3:0.1,2", [0, 0.1, 0.2, 0.3, 2])],
)
def test_times(text, expected):
    assert times(text) == expected


@pytest.mark.parametrize("text", ["", "soon", "1,,2", "0:1", "1:0:0.1", "0:1:0", "0:1:-1", "nan", "0:inf:1", "0:1:1e-9"])
def test_bad_times(text):
    with pytest.raises(InputError, match="--times"):
        times(text)


def test_snapshots_of_a_saved_run(run, saved):
    outcome = run("snapshots", saved, "--times", "0.4,0.8", "--pixels", "48", *FAST)
    assert outcome.code == 0, outcome.err
    assert outcome.files == ["snapshots.png"]
    assert outcome.out == "wrote snapshots.png\n"


@pytest.mark.slow
def test_snapshots_of_two_systems_by_name(run, small):
    outcome = run(
        "snapshots",
        "bare",
        "--compare",
        "hybrid",
        *small,
        "--times",
        "0.4,0.8",
        "--pixels",
        "32",
        "--units",
        "relative",
        "-o",
        "two.svg",
        *FAST,
    )
    assert outcome.code == 0, outcome.err
    assert outcome.files == ["two.svg"]


def test_progress_is_told_on_stderr(run, saved):
    outcome = run("snapshots", saved, "--times", "0.4", "--pixels", "32")
    assert "fields: 100 %" in outcome.err


def test_film_as_webp(run, saved):
    outcome = run("animate", saved, "--compare", saved, "--frames", "4", "--size", "48", "--fps", "10", "-o", "film.webp", *FAST)
    assert outcome.code == 0, outcome.err
    assert outcome.out == "wrote film.webp: 4 frames, 0.4 s\n"
    with Image.open("film.webp") as film:
        assert film.n_frames == 4


def test_film_as_mp4(run, saved):
    pytest.importorskip("imageio_ffmpeg")
    outcome = run("animate", saved, "--frames", "4", "--size", "48", "--until", "0.5", *FAST)
    assert outcome.code == 0, outcome.err
    assert outcome.files == ["film.mp4"]


def test_film_without_the_extra_is_refused_at_once(refused, saved, monkeypatch):
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    assert 'install it: pip install "coaxshell[video]", or name a .webp file' in refused("animate", "bare")


@pytest.mark.parametrize("kind", ["csv", "mat"])
def test_export_of_histories(run, saved, kind):
    outcome = run("export", saved, "--to", kind)
    assert outcome.code == 0, outcome.err
    assert outcome.files == [f"bare.{kind}"]
    again = run("export", saved, "--to", kind)
    assert again.code == 2
    assert "exists already" in again.err
    assert run("export", saved, "--to", kind, "--force").code == 0


def test_export_for_paraview(run, saved):
    arguments = ("export", saved, "--to", "paraview", "--times", "0:1:0.5", "--points", "9", "-o", "out")
    outcome = run(*arguments)
    assert outcome.code == 0, outcome.err
    assert {"field.pvd", "shells.pvd", "field_00002.vti", "shells_00002.vtp"} <= set(outcome.files)
    assert "not empty" in run(*arguments).err
    assert run(*arguments, "--force").code == 0


@pytest.mark.slow_for("13")
@pytest.mark.parametrize("number", ["4", "13", "14"])
def test_figures_of_the_paper(run, saved, number):
    sources = ["--from", saved] * (1 if number == "4" else 2)
    outcome = run("figure", number, *sources, "--quiet")
    assert outcome.code == 0, outcome.err
    assert outcome.files == [f"figure-{number}.png"]
    with Image.open(f"figure-{number}.png") as picture:
        assert np.ptp(np.asarray(picture.convert("L"))) > 200


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["snapshots", "bear"], ["'bear'"]),
        (["snapshots", "missing.nc"], ["missing.nc"]),
        (["snapshots", "bare", "--times", "soon"], ["--times", "'soon'"]),
        (["snapshots", "bare", "--units", "bar"], ["--units", "'bar'", "relative"]),
        (["snapshots", "bare", "--pixels", "3"], ["--pixels", "3", "16 to 4000"]),
        (["snapshots", "bare", "--columns", "0"], ["--columns: 0 is", "1 to 20"]),
        (["snapshots", "bare", "--width", "-1"], ["--width", "-1"]),
        (["snapshots", "bare", "--pressure-limit", "0"], ["--pressure-limit", "0", "positive"]),
        (["snapshots", "bare", "--stress-limit", "x"], ["--stress-limit", "'x'"]),
        (["snapshots", "bare", "-o", "sheet.gif"], ["--output", ".png, .pdf, .svg"]),
        (["animate", "bare", "-o", "film.gif"], ["--output", ".mp4, .webp"]),
        (["animate", "bare", "-o", "nowhere/film.webp"], ["--output", "'nowhere'"]),
        (["animate", "bare", "-o", "film.webp", "--frames", "1"], ["--frames", "1"]),
        (["animate", "bare", "-o", "film.webp", "--fps", "0"], ["--fps"]),
        (["animate", "bare", "-o", "film.webp", "--size", "9"], ["--size", "9"]),
        (["animate", "bare", "-o", "film.webp", "--until", "never"], ["--until", "'never'"]),
        (["export", "bare"], ["--to"]),
        (["export", "bare", "--to", "stl"], ["--to", "'stl'", "paraview, csv, mat"]),
        (["export", "bare", "--to", "csv", "-o", "x.txt"], ["--output", "'x.txt'", ".csv"]),
        (["export", "bare", "--to", "paraview", "-o", "nowhere/out"], ["--output", "nowhere"]),
        (["export", "bare", "--to", "paraview", "--points", "1"], ["--points", "1"]),
        (["export", "bare", "--to", "paraview", "--displaced", "much"], ["--displaced", "'much'"]),
        (["figure", "13", "--preset", "bare"], ["--preset", "1 given", "shows 2"]),
    ],
    ids=" ".join,
)
def test_bad_input(refused, arguments, words):
    message = refused(*arguments)
    for word in words:
        assert word in message, message


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["snapshots", "--times", "7"], ["--times", "7", "0 to 1"]),
        (["animate", "-o", "film.webp", "--until", "7"], ["--until", "7"]),
        (["export", "--to", "paraview", "--times", "7"], ["--times", "7"]),
        (["snapshots", "--modes", "5"], ["--modes", "saved run"]),
        (["export", "--to", "csv", "--set", "source.angle=3"], ["--set", "saved run"]),
    ],
    ids=" ".join,
)
def test_what_does_not_fit_a_saved_run(refused, saved, arguments, words):
    command, *options = arguments
    message = refused(command, saved, "-q", *options)
    for word in words:
        assert word in message, message


@pytest.mark.slow_for("animate", "export")
@pytest.mark.parametrize("command", ["snapshots", "animate", "export"])
def test_help_imports_nothing_heavy(command):
    code = (
        "import sys\nfrom coaxshell.apps.cli import main\n"
        f"assert main([{command!r}, '--help']) == 0\n"
        "print('HEAVY', sorted(set(sys.modules) & {'xarray', 'matplotlib', 'scipy', 'numpy', 'PIL'}))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "HEAVY []"
