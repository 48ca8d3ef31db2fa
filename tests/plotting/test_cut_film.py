"""Sheets and films of three-dimensional runs: both cuts side by side, and walls laid flat."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.plotting import FieldView, figure_snapshots, save_film, save_wall_film
from coaxshell.plotting.cut_frames import shown_runs
from coaxshell.plotting.field_scales import STRESS_COLOURS, FieldScales
from coaxshell.plotting.film import films_cost
from coaxshell.plotting.film_canvas import Canvas, colour_table
from coaxshell.plotting.frames import gathered
from coaxshell.plotting.panels import AlongAxis
from coaxshell.plotting.unrolled import ANGLES
from coaxshell.plotting.wall_film import _WallCanvas
from coaxshell.response import Response
from coaxshell.response.spatial import SpatialResponse

VIEW = FieldView(2.0, 40)
SIZE: dict[str, Any] = {"duration": 1.0, "time_step": 5e-2, "modes": 5}
TIMES = [0.3, 0.6, 0.9]


@pytest.fixture(scope="module")
def response() -> SpatialResponse:
    found = cx.simulate("bare", dimensions=3, stations=[0.0, 0.5, 1.0], **SIZE)
    assert isinstance(found, SpatialResponse)
    return found


@pytest.fixture(scope="module")
def flat() -> Response:
    return cx.simulate("bare", **SIZE)


def test_frames_are_both_cuts_and_the_stress_on_the_walls(response: SpatialResponse) -> None:
    (run,) = shown_runs([response], ["Bare"], "50 cm")
    assert [panel.name for panel in run.panels] == ["across, z = 0.5 m", "along, y = 0"]
    blocks = list(run.solved(TIMES, VIEW).frames(None, memory=16.0 * VIEW.pixels**2 * 2))
    assert [len(parts[0]) for parts in blocks] == [2, 1]
    across, along = (gathered(iter(parts)) for parts in zip(*blocks, strict=True))
    x = VIEW.centres
    for frames, expected in (
        (across, response.pressure(x=x, y=x, z=0.5, time=TIMES, front="matched")),
        (along, response.pressure(x=x, z=x, y=0.0, time=TIMES, front="matched")),
    ):
        assert frames.pressure.shape[1] == VIEW.pixels // 2  # the other half is its mirror image
        drawn = np.stack([frames.field(i) for i in range(3)])
        np.testing.assert_allclose(drawn, expected, rtol=0, atol=1e-5 * float(abs(expected).max()))
    assert across.stress[0] is not None
    np.testing.assert_array_equal(
        across.stress[0], response.stress("inner", np.arange(360.0), station=0.5).sel(time=TIMES, method="nearest")
    )
    panel, tail = run.panels[1], along.stress[3]
    assert isinstance(panel, AlongAxis)
    assert tail is not None
    heights = panel.covered(VIEW)
    assert (heights[0], heights[-1]) == pytest.approx((-0.95, 0.95))
    ends = response.stress("outer", 180.0).sel(time=0.9, method="nearest").to_numpy().ravel()
    np.testing.assert_allclose(tail[2], np.interp(abs(heights), [0.0, 0.5, 1.0], ends), rtol=1e-9)


def test_walls_along_the_axis_show_their_stress_where_it_is(response: SpatialResponse) -> None:
    runs = shown_runs([response], ["Bare"])
    parts = [frames.one(0) for frames in next(runs[0].solved([0.6], VIEW).frames(None))]
    for around in (around for part in parts for around in part.stress if around is not None):
        around[:] = 0.0
    head = parts[1].stress[2]  # of the outer shell
    assert head is not None
    head[0, -3:] = 1e5
    canvas = Canvas(runs, VIEW, FieldScales(1e9, 2e5), "auto")
    picture = canvas.frame(parts, 0)[canvas._top : canvas._top + 40, canvas._left[1] : canvas._left[1] + 40].astype(int)
    red, green, _ = picture[11, 29]  # x = 0.95, z = 0.85
    assert green > red + 20
    assert np.ptp(picture[28, 29]) < 30  # its mirror image below is not the same place


@pytest.mark.slow
def test_a_film_of_a_plane_beside_both_cuts(response: SpatialResponse, flat: Response, tmp_path: Path) -> None:
    told: list[tuple[float, str]] = []
    path = save_film(
        flat, response, path=tmp_path / "film.webp", frames=4, view=VIEW, progress=lambda share, stage: told.append((share, stage))
    )
    canvas = Canvas(shown_runs([flat, response], ["a", "b"]), VIEW, FieldScales(1e4, 1e5), "auto")
    with Image.open(path) as film:
        assert getattr(film, "n_frames", 0) == 4
        assert film.size == (canvas.width, canvas.height)
    assert len(canvas._left) == 3
    assert told[-1] == (1.0, "film")
    assert [p.name for p in tmp_path.iterdir()] == ["film.webp"]
    assert films_cost(shown_runs([response], [""]), 4, VIEW).seconds > films_cost(shown_runs([flat, flat], ["", ""]), 4, VIEW).seconds


def test_a_sheet_of_both_cuts(response: SpatialResponse) -> None:
    figure = figure_snapshots(response, times=TIMES[:2], view=VIEW, station=1.0)
    panels = [ax for ax in figure.axes if ax.images]
    assert len(panels) == 4
    assert panels[0].get_ylabel() == "$y/a$, $z/a$"
    texts = [text.get_text() for text in figure.texts]
    assert texts.count("across, z = 1 m") == texts.count("along, y = 0") == 2
    assert len(panels[1].images) == 5  # the pressure, head and tail of two shells


def test_a_wall_laid_flat_is_a_film(response: SpatialResponse, tmp_path: Path) -> None:
    path = save_wall_film(response, path=tmp_path / "walls.webp", component="von-mises", frames=3, size=100)
    with Image.open(path) as film:
        assert getattr(film, "n_frames", 0) == 3
    canvas = _WallCanvas(["outer shell"], np.array([0.0, 0.5, 1.0]), 101, "shear", 1e5)
    stress = np.zeros((3, ANGLES.size))
    stress[1, abs(ANGLES - 90.0) < 7.0] = 1e5
    picture = canvas.frame([stress], "t = 1")
    column = canvas._left[0] + round((canvas._width - 1) * 0.75)
    table = colour_table(STRESS_COLOURS)
    np.testing.assert_allclose(picture[canvas._top + 50, column].astype(int), table[-1].astype(int), atol=12)
    np.testing.assert_allclose(picture[canvas._top + 2, column].astype(int), table[512].astype(int), atol=12)


def test_what_cannot_be_shown_is_refused(response: SpatialResponse, flat: Response, tmp_path: Path) -> None:
    target = tmp_path / "film.webp"
    with pytest.raises(InputError, match=r"station: 0\.5 belongs to three dimensions"):
        save_film(flat, path=target, frames=2, view=VIEW, station=0.5)
    with pytest.raises(InputError, match=r"station: 0\.3 m is none of the run's"):
        save_film(response, path=target, frames=2, view=VIEW, station=0.3)
    with pytest.raises(InputError, match="response: is of a run in two dimensions"):
        save_wall_film(flat, path=target)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="stations: there is one alone"):
        save_wall_film(response.at(0.0), path=target)
    with pytest.raises(InputError, match="component: 'radial'"):
        save_wall_film(response, path=target, component="radial")
    with pytest.raises(InputError, match="shell"):
        save_wall_film(response, "middle", path=target)
    assert list(tmp_path.iterdir()) == []


def test_films_that_do_not_fit_into_memory_are_refused_beforehand(
    response: SpatialResponse, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COAXSHELL_MEMORY", "1 MB")
    with pytest.raises(InputError, match="memory: a film of 5,000 frames of 3 stations needs about"):
        save_wall_film(response, path=tmp_path / "film.webp", frames=5000, until=1.0)
