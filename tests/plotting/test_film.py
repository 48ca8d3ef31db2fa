"""Films: every frame shows its own instant, files are whole, and what is missing is told."""

from __future__ import annotations

import builtins
import subprocess

import numpy as np
import pytest
from PIL import Image

from coaxshell import InputError, presets
from coaxshell.plotting import FieldView, film_files, save_film
from coaxshell.plotting.cut_frames import shown_runs
from coaxshell.plotting.field_scales import FieldScales
from coaxshell.plotting.film_canvas import Canvas, _draw_overlay
from coaxshell.plotting.frames import field_frames, gathered
from coaxshell.plotting.panels import Section

VIEW = FieldView(3.0, 90)
SCALES = FieldScales(2e4, 2e5)


@pytest.fixture
def canvas(waves):
    return Canvas(shown_runs([waves], ["Bare"]), VIEW, SCALES, "auto")


def panel(picture, canvas):
    top, left = canvas._top, canvas._left[0]
    return picture[top : top + VIEW.pixels, left : left + VIEW.pixels].astype(int)


def test_the_field_is_drawn_the_right_way_up(canvas, make_waves):
    tilted = make_waves(presets.load("bare"), symmetric=False)
    parts = gathered(field_frames(tilted, [0.0], VIEW))
    picture = panel(canvas.frame([parts], 0), canvas)
    assert picture[5:85, 3].sum(axis=1).min() > picture[5:85, 63].sum(axis=1).max()  # the front comes from the right
    assert picture[5, 63, 1] < picture[84, 63, 1]  # higher pressure, darker, at the top


@pytest.mark.parametrize("stress", [-1e5, 1e5])
def test_the_shells_show_their_stress(waves, stress):
    """Green in tension, violet in compression, at the degree where it is."""
    close = FieldView(1.2, 120)
    canvas = Canvas(shown_runs([waves], ["Bare"]), close, SCALES, "auto")
    parts = gathered(field_frames(waves, [0.0], close))
    for ring in parts.stress:
        ring[:] = 0.0
    parts.stress[1][0, 80:100] = stress
    picture = canvas.frame([parts], 0)[canvas._top :, canvas._left[0] :].astype(int)
    red, green, _ = picture[10, 60]  # the outer shell's top, r = 0.99
    assert (green > red + 25) if stress > 0 else (red > green + 25)
    assert np.ptp(picture[110, 60]) < 12


def test_no_seam_at_head_or_tail(canvas, waves):
    """A uniform stress gives a ring of one colour."""
    parts = gathered(field_frames(waves, [0.0], VIEW))
    for ring in parts.stress:
        ring[:] = 1e5
    picture = panel(canvas.frame([parts], 0), canvas)
    centres = VIEW.centres
    inside = np.abs(np.hypot(centres, centres[::-1, None]) - 1.0) < 0.01
    colours = picture[inside]
    assert len(colours) > 20
    assert np.ptp(colours, axis=0).max() <= 12


def test_only_the_panel_and_the_stamp_change(canvas, waves):
    parts = gathered(field_frames(waves, [0.2, 1.9], VIEW))
    first, second = canvas.frame([parts], 0), canvas.frame([parts], 1)
    changed = np.argwhere((first != second).any(axis=2))
    assert first.shape == (canvas.height, canvas.width, 3)
    assert first.dtype == np.uint8
    assert canvas.height % 2 == canvas.width % 2 == 0
    assert changed[:, 0].max() < canvas._top + VIEW.pixels
    assert (changed[:, 0] < canvas._top).any()  # the time


def test_webp_has_all_frames_at_the_right_rate(waves, make_waves, tmp_path):
    told = []
    path = save_film(
        waves,
        make_waves(presets.load("hybrid")),
        path=tmp_path / "film.webp",
        frames=12,
        fps=20,
        view=VIEW,
        progress=lambda part, stage: told.append((part, stage)),
    )
    with Image.open(path) as film:
        assert film.n_frames == 12
        first = np.asarray(film.convert("RGB")).astype(int)
        film.seek(11)
        last = np.asarray(film.convert("RGB")).astype(int)
        assert film.info["duration"] == 50
    assert np.abs(first - last).max() > 100
    assert told[-1] == (1.0, "film")
    assert [p.name for p in tmp_path.iterdir()] == ["film.webp"]


def test_mp4_plays_back(waves, tmp_path):
    ffmpeg = pytest.importorskip("imageio_ffmpeg").get_ffmpeg_exe()
    path = save_film(waves, path=tmp_path / "film.mp4", frames=10, fps=10, until=2.0, view=VIEW, units="relative")
    told = subprocess.run([ffmpeg, "-i", path, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"], capture_output=True, check=True)
    canvas = Canvas(shown_runs([waves], ["Bare"]), VIEW, SCALES, "relative")
    pictures = np.frombuffer(told.stdout, np.uint8).reshape(-1, canvas.height, canvas.width, 3).astype(int)
    assert len(pictures) == 10
    assert b"yuv420p" in told.stderr
    assert b"Duration: 00:00:01.00" in told.stderr
    assert np.abs(pictures[0] - pictures[5]).max() > 100
    assert [p.name for p in tmp_path.iterdir()] == ["film.mp4"]


def test_blocks_make_no_difference(waves, tmp_path):
    whole = save_film(waves, path=tmp_path / "whole.webp", frames=9, view=VIEW).read_bytes()
    assert save_film(waves, path=tmp_path / "parts.webp", frames=9, view=VIEW, memory=8 * 90**2 * 2).read_bytes() == whole


def test_without_the_extra_the_remedy_is_told_before_any_work(waves, tmp_path, monkeypatch):
    genuine = builtins.__import__

    def missing(name, *arguments, **keywords):
        if name == "imageio_ffmpeg":
            raise ImportError(name)
        return genuine(name, *arguments, **keywords)

    monkeypatch.setattr(builtins, "__import__", missing)
    with pytest.raises(InputError, match=r'imageio-ffmpeg; install it: pip install "coaxshell\[video\]", or name a \.webp file'):
        save_film(waves, path=tmp_path / "film.mp4", view=VIEW)
    assert waves.asked == []
    assert save_film(waves, path=tmp_path / "film.webp", frames=2, view=VIEW).exists()


@pytest.mark.parametrize("suffix", [".mp4", ".webp"])
def test_nothing_is_left_of_a_film_that_fails(waves, tmp_path, suffix):
    if suffix == ".mp4":
        pytest.importorskip("imageio_ffmpeg")

    def stop(part, stage):
        if part > 0.5 and stage == "film":
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        save_film(waves, path=tmp_path / f"film{suffix}", frames=8, view=VIEW, progress=stop)
    assert list(tmp_path.iterdir()) == []


def test_what_ffmpeg_says_is_told(waves, tmp_path, monkeypatch):
    program = tmp_path / "ffmpeg"
    program.write_text("#!/bin/sh\necho 'no room' >&2\nexit 3\n")
    program.chmod(0o755)
    monkeypatch.setattr(film_files, "_ffmpeg", lambda: str(program))
    with pytest.raises(InputError, match=r"cannot write .*film\.mp4.*no room"):
        save_film(waves, path=tmp_path / "film.mp4", frames=3, view=VIEW)
    assert [p.name for p in tmp_path.iterdir()] == ["ffmpeg"]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"frames": 1}, "frames: 1 is not allowed"),
        ({"frames": 2.5}, "frames: 2.5 is not allowed"),
        ({"fps": 0}, "fps: 0 is not allowed"),
        ({"until": 6.0}, "until: 6.0 is not within the run; give a time up to 5 transits"),
        ({"until": float("nan")}, "until: nan"),
        ({"path": "film.avi"}, r"no known ending; allowed: \.mp4, \.webp"),
        ({"units": "bar"}, "units: 'bar'"),
        ({"pressure_limit": -1.0}, "pressure_limit"),
    ],
)
def test_refusals(waves, tmp_path, options, message):
    arguments = {"path": tmp_path / "film.webp", "view": VIEW, **options}
    with pytest.raises(InputError, match=message):
        save_film(waves, **arguments)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("pixels", "marked"), [(90, False), (300, True)])
def test_axes_are_marked_where_they_can_be_read(waves, pixels, marked):
    overlay = _draw_overlay(Section(waves.system, ""), FieldView(3.0, pixels))
    lower_edge = overlay[-round(0.06 * pixels) :, :, 3]
    assert bool(lower_edge.any()) is marked
