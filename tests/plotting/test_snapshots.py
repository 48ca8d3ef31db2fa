"""Fields and sheets of them: what is drawn is what the response says, on symmetric scales with units."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.collections import PolyCollection

from coaxshell import InputError, RigidShell, presets
from coaxshell.apps.paper import FIGURES
from coaxshell.plotting import COMPARISON_TIMES, SNAPSHOT_TIMES, FieldView, figure_pressure_rms, figure_snapshots, plot_field
from coaxshell.plotting.field_scales import PRESSURE_COLOURS, FieldScales, compressed, field_scales, mappable, pressure_unit
from coaxshell.plotting.frames import field_frames, gathered

SMALL = FieldView(3.0, 40)


def images(figure):
    return [ax.images[0] for ax in figure.axes if ax.images]


def bars(figure):
    return [ax for ax in figure.axes if "(" in (ax.get_xlabel() + ax.get_ylabel()) and not ax.images]


def test_pixels_are_the_pressure_and_the_source_is_to_the_right(waves):
    ax = plot_field(waves, 0.5, view=SMALL)
    (image,) = ax.images
    x = SMALL.centres
    expected = waves.pressure(x, x, [0.5]).to_numpy()[0]
    np.testing.assert_allclose(image.get_array(), expected, rtol=1e-6)
    assert tuple(image.get_extent()) == (-3.0, 3.0, -3.0, 3.0)
    assert image.origin == "lower"
    assert image.get_array()[:, -1].mean() > image.get_array()[:, 0].mean()


def test_shells_show_the_stress_of_every_degree(waves):
    ax = plot_field(waves, 1.2, view=SMALL, stress_limit=1e6)
    rings = [collection for collection in ax.collections if isinstance(collection, PolyCollection)]
    assert len(rings) == 2
    for ring, shell in zip(rings, ("inner", "outer"), strict=True):
        expected = waves.stress(shell, angle=np.arange(360.0)).sel(time=1.2, method="nearest")
        np.testing.assert_allclose(ring.get_array(), expected, rtol=1e-12)
        assert ring.norm.vmin == -1e6
        assert ring.norm.vmax == 1e6
        corners = ring.get_paths()[0].vertices  # the head's segment straddles theta = 0
        assert corners[:, 1].min() == pytest.approx(-corners[:, 1].max())
        assert corners[:, 0].min() > 0


def test_scales_are_symmetric_round_and_labelled_with_units(waves):
    figure = plot_field(waves, 0.5, view=SMALL).figure
    (image,) = images(figure)
    assert image.norm.vmin == -image.norm.vmax
    assert 5e3 <= image.norm.vmax <= 2e4
    figure.canvas.draw()
    children = [child for ax in figure.axes for child in ax.child_axes]
    assert sorted(child.get_ylabel() for child in children) == ["hoop stress (MPa)", "pressure (kPa)"]


@pytest.mark.parametrize("symmetric", [True, False])
@pytest.mark.parametrize("pixels", [40, 41])
def test_a_mirror_symmetric_field_is_computed_once(make_waves, symmetric, pixels):
    response, view = make_waves(presets.load("bare"), symmetric), FieldView(3.0, pixels)
    frames = gathered(field_frames(response, [0.5, 1.0], view))
    rows = -(-pixels // 2) if symmetric else pixels
    assert response.asked == [(pixels, rows, 2)]
    whole = response.pressure(view.centres, view.centres, [0.5, 1.0]).to_numpy()
    np.testing.assert_allclose(frames.field(1), whole[1], rtol=1e-6)


def test_blocks_join_to_the_whole_and_tell_progress(waves):
    told = []
    blocks = list(
        field_frames(waves, np.linspace(0, 5, 11), SMALL, memory=8 * 40 * 20 * 4, progress=lambda part, stage: told.append((part, stage)))
    )
    assert [len(block) for block in blocks] == [4, 4, 3]
    whole = gathered(field_frames(waves, np.linspace(0, 5, 11), SMALL))
    np.testing.assert_array_equal(gathered(iter(blocks)).pressure, whole.pressure)
    np.testing.assert_array_equal(gathered(iter(blocks)).stress[1], whole.stress[1])
    assert told[-1] == (pytest.approx(1.0), "fields")


def test_the_papers_sheet(waves):
    figure = figure_snapshots(waves, view=SMALL)
    assert len(images(figure)) == len(SNAPSHOT_TIMES) == 10
    assert {1.2, 1.7, 2.0, 3.1, 3.6} <= set(SNAPSHOT_TIMES)
    assert len({image.norm.vmax for image in images(figure)}) == 1
    texts = [text.get_text() for text in figure.texts]
    assert "$t$ = 1.20  (0.857 ms)" in texts
    assert sorted(ax.get_xlabel() for ax in bars(figure)) == ["hoop stress (MPa)", "pressure (kPa)"]


def test_two_systems_side_by_side_on_the_same_scales(waves, make_waves):
    loud = make_waves(presets.load("hybrid"))
    loud.peak = 9e4
    figure = figure_snapshots(waves, loud, times=[0.5, 1.0, 1.5], view=SMALL, units="relative")
    assert len(images(figure)) == 6
    ((low, high),) = {(image.norm.vmin, image.norm.vmax) for image in images(figure)}
    assert low == -high
    assert high > 2e4
    texts = [text.get_text() for text in figure.texts]
    assert texts.count("Bare") == texts.count("Hybrid") == 3
    (pressure,) = (ax for ax in bars(figure) if "rho_e c_e^2" in ax.get_xlabel())
    figure.canvas.draw()
    marks = [label.get_text() for label in pressure.get_xticklabels()]
    assert all(len(mark.strip("\N{MINUS SIGN}")) <= 4 for mark in marks), marks


def test_default_times_end_with_the_run(waves):
    figure = figure_snapshots(waves, waves, view=SMALL, names=["a", "b"])
    assert len(images(figure)) == 2 * sum(time <= 5 for time in COMPARISON_TIMES) == 36


@pytest.mark.slow_for("2-times2", "2-times1")
@pytest.mark.parametrize("times", [(1.0,), (0.5, 1.0, 1.5, 2.0), (0.5, 1.0, 1.5, 2.0, 2.5)])
@pytest.mark.parametrize("count", [1, 2])
def test_no_two_panels_or_bars_overlap(waves, times, count):
    figure = figure_snapshots(*[waves] * count, times=times, view=SMALL, names=["a", "b"][:count])
    figure.canvas.draw()
    boxes = [ax.get_tightbbox(figure.canvas.get_renderer()) for ax in figure.axes] + [text.get_window_extent() for text in figure.texts]
    page = figure.bbox
    for i, box in enumerate(boxes):
        assert page.x0 <= box.x0, (i, box)
        assert box.x1 <= page.x1, (i, box)
        assert page.y0 <= box.y0, (i, box)
        assert box.y1 <= page.y1 + 0.5, (i, box)
        assert not any(box.padded(-1.5).overlaps(other.padded(-1.5)) for other in boxes[i + 1 :])


def test_a_rigid_core_and_quiet_water_are_drawn(make_waves):
    bare = presets.load("bare")
    core = make_waves(bare.replace(shells=[RigidShell(radius=0.5), bare.shells[1]], fluids=["vacuum", *bare.fluids[1:]]))
    core.peak = 0.0
    plot_field(core, 0.0, view=SMALL).figure.canvas.draw()


def test_quiet_water_does_not_set_the_scale(waves):
    early = gathered(field_frames(waves, [0.01], FieldView(1.5, 60)))
    assert np.mean(np.abs(early.pressure) > 0) < 0.3
    assert field_scales([early]).pressure >= 0.5 * float(early.pressure.max())


@pytest.mark.parametrize(
    ("limit", "unit", "label", "per_pascal"),
    [
        (2e4, "auto", "pressure (kPa)", 1e-3),
        (5e6, "auto", "pressure (MPa)", 1e-6),
        (50.0, "auto", "pressure (Pa)", 1.0),
        (2e4, "Pa", "pressure (Pa)", 1.0),
    ],
)
def test_units_of_pressure(waves, limit, unit, label, per_pascal):
    drawn = pressure_unit(waves, unit, limit)
    assert (drawn.label, drawn.per_pascal) == (label, per_pascal)


def test_relative_pressure_counts_in_the_stiffness_of_water(waves):
    drawn = pressure_unit(waves, "relative", 2e4)
    assert 2e4 * drawn.per_pascal == pytest.approx(1e5 * 2e4 / (1000 * 1400**2), rel=1e-12)
    assert "10^{-5}" in drawn.label


def test_refusals(waves):
    with pytest.raises(InputError, match="7 is outside the run; give times from 0 to 5 transits"):
        plot_field(waves, 7.0)
    with pytest.raises(InputError, match="'bar' is unknown; allowed: auto, Pa"):
        plot_field(waves, 1.0, units="bar", view=SMALL)
    with pytest.raises(InputError, match="there are none"):
        figure_snapshots()
    with pytest.raises(InputError, match="pixels: 3 is not allowed"):
        FieldView(3.0, 3)
    with pytest.raises(InputError, match="width: -6"):
        FieldView(-3.0)
    with pytest.raises(InputError, match="pressure_limit: 0"):
        FieldScales(0.0, 1.0)


def test_rms_of_both_domains(waves, make_waves):
    figure = figure_pressure_rms(waves, make_waves(presets.load("hybrid")))
    exterior, interior = figure.axes
    assert [ax.get_ylabel() for ax in figure.axes] == ["RMS pressure (kPa)"] * 2
    np.testing.assert_allclose(exterior.lines[0].get_ydata(), waves.time, rtol=1e-12)
    np.testing.assert_allclose(interior.lines[1].get_ydata(), 0.5 * waves.time, rtol=1e-12)
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["Bare", "Hybrid"]
    with pytest.raises(InputError, match="give 1 to 4"):
        figure_pressure_rms()


@pytest.mark.parametrize("number", ["13", "14"])
def test_recipes_of_two_systems(number):
    assert FIGURES[number].presets == ("bare", "hybrid")


def test_colours_of_the_pressure_reach_to_the_front_and_keep_what_is_faint():
    assert compressed(0.0) == 0.0
    assert compressed(np.array([-1.0, 1.0])) == pytest.approx([-1.0, 1.0])
    faint = compressed(np.array([1e-3, 1e-2]))
    assert faint[1] / faint[0] == pytest.approx(10.0, rel=0.01)  # in proportion
    assert 0.2 < compressed(0.1) < 0.4
    drawn = mappable(2e4, PRESSURE_COLOURS)
    assert float(drawn.norm(1e4)) == pytest.approx(0.5 + 0.5 * float(compressed(0.5)))
