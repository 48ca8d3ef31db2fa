"""The call for a gradient: what it gives, its norms, and what it refuses."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.studies.gradients.norms import power_mean, root_mean_square
from coaxshell.studies.reading import MetricSource
from coaxshell.studies.varied_fields import varied

SETTINGS = {"duration": 1.0, "time_step": 0.02, "modes": 6}
BARE = cx.presets.load("bare")
LISTED = BARE.replace(absorbers=[cx.Absorber(angle=a, mass=8, damping=1e6, linear_stiffness=1e9) for a in (20, 150, 260)])


def test_value_gradient_and_labels():
    found = cx.gradient(LISTED, metric="inner.peak_stress", variables=["absorbers[*].mass", "shells[0].radius"], **SETTINGS)
    assert list(found["variable"].values) == [*(f"absorbers[{i}].mass" for i in range(3)), "shells[0].radius"]
    assert list(found["per"].values) == ["kg/m"] * 3 + ["m"]
    assert_allclose(found["at"], [8, 8, 8, BARE.shells[0].radius])
    assert found["value"].attrs["units"] == "Pa"
    exact = MetricSource(cx.simulate(LISTED, **SETTINGS)).number("peak_stress", 0)
    assert 0.5 * found["peak"] < found["value"] < found["peak"]
    assert float(found["peak"]) == exact
    assert np.all(found["gradient"] != 0)


def test_a_ring_moves_as_a_whole():
    ring = BARE.replace(absorbers=cx.AbsorberRing(count=3, mass=8, damping=1e6, linear_stiffness=1e9, offset=20))
    listed = BARE.replace(absorbers=ring.absorber_list)
    of_ring = cx.gradient(ring, metric="inner.rms_stress", variables=["absorbers.mass", "absorbers.offset"], **SETTINGS)
    each = cx.gradient(
        listed, metric="inner.rms_stress", variables=["absorbers[*].mass", "absorbers[*].angle", "absorbers.mass"], **SETTINGS
    )
    slopes = each["gradient"].values
    assert_allclose(of_ring["gradient"], [slopes[:3].sum(), slopes[3:6].sum()], rtol=1e-9)
    assert_allclose(slopes[6], slopes[:3].sum(), rtol=1e-9)


def test_the_peak_itself_has_a_gradient():
    itself = cx.gradient(LISTED, metric="outer.peak_stress", variables="absorbers[1].mass", smooth=None, **SETTINGS)

    def peak(mass):
        return MetricSource(cx.simulate(varied(LISTED, {"absorbers[1].mass": mass}), **SETTINGS)).number("peak_stress", 1)

    assert float(itself["value"]) == float(itself["peak"]) == peak(8.0)
    assert_allclose(itself["gradient"], (peak(8.01) - peak(7.99)) / 0.02, rtol=1e-5)


def test_masses_and_distances_need_no_run():
    mass = cx.gradient(LISTED, metric="system.mass", variables=["absorbers[*].mass", "shells[0].layers[1].thickness"], **SETTINGS)
    density, radius = BARE.shells[0].layers[1].material.density, BARE.shells[0].radius
    assert_allclose(mass["gradient"][:3], 1.0)
    assert_allclose(mass["gradient"][3], 2 * np.pi * radius * density, rtol=0.02)
    spacing = cx.gradient(LISTED, metric="absorbers.spacing", variables="absorbers[*].angle", **SETTINGS)
    assert_allclose(spacing["gradient"], np.radians(radius) * np.array([0.0, -1.0, 1.0]))


@pytest.mark.parametrize("parities", [1, 2])
@pytest.mark.parametrize("norm", ["rms", "anywhere", "head", "tail"])
def test_slopes_of_norms(parities, norm):
    rng = np.random.default_rng(3)
    modal, change = rng.normal(size=(2, parities, 6, 9))
    modal[1:, 0] = change[1:, 0] = 0.0
    time = np.linspace(0.0, 1.0, 9)

    def of(values):
        return root_mean_square(values, time) if norm == "rms" else power_mean(values, time, 6.0, norm, 30.0)

    moved = [of(modal + sign * 1e-5 * change).value for sign in (1, -1)]
    assert_allclose((of(modal).slope * change).sum(), (moved[0] - moved[1]) / 2e-5, rtol=1e-8)
    assert of(modal).value <= of(modal).peak * (1 + 1e-9)


@pytest.mark.parametrize(
    ("changes", "settings", "told"),
    [
        ({"metric": "inner.strength_margin"}, {}, "known|gradient|margin|metric"),
        ({"metric": "interior.rms_pressure"}, {}, "metric: .*has no gradient"),
        ({"metric": lambda response: 1.0}, {}, "metric: .*has no gradient"),
        ({"variables": []}, {}, "variables: "),
        ({"variables": ["absorbers.count"]}, {}, "variables"),
        ({"variables": ["absorbers[7].mass"]}, {}, "variables"),
        ({"variables": ["absorbers[0].cubic_stiffness"]}, {}, "linear"),
        ({"smooth": 1.0}, {}, "smooth: 1.0 is not allowed"),
        ({}, {"engine": "direct"}, "engine"),
        ({}, {"dimensions": 3}, "dimensions"),
    ],
)
def test_what_has_no_gradient_is_refused(changes, settings, told):
    with pytest.raises(cx.InputError, match=told):
        cx.gradient(LISTED, **{"metric": "inner.rms_stress", "variables": ["absorbers[0].mass"], **changes}, **SETTINGS, **settings)


def test_saturation_is_refused_where_it_is_reached():
    system = cx.presets.load("hybrid").with_overrides({"control.saturation": True, "control.field_limit": "1 V/mm"})
    with pytest.raises(cx.InputError, match="saturation"):
        cx.gradient(system, metric="inner.rms_stress", variables="control.derivative", **SETTINGS)


def test_voltages_of_a_law_that_remembers_have_no_gradient():
    law = cx.Feedback(numerator=[-2e-4], denominator=[1e-4, 1.0])
    system = cx.presets.load("active").replace(control=law)
    with pytest.raises(cx.InputError, match="remembers earlier instants"):
        cx.gradient(system, metric="inner.peak_actuator_voltage", variables="shells[0].radius", **SETTINGS)


def test_the_end_of_a_range_has_no_gradient():
    with pytest.raises(cx.InputError, match="end of what is allowed"):
        cx.gradient(BARE, metric="inner.rms_stress", variables="source.delay", **SETTINGS)
