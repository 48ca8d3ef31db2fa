"""Equipment that a shell feels: without mass its spectrum is the shock spectrum, with mass it dips."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.studies.metrics import metrics_of

SETTINGS = {"duration": 4.0, "time_step": 0.02, "modes": 6}


@pytest.mark.parametrize(
    ("kind", "shell"), [("pseudo-velocity", "inner"), ("absolute-acceleration", "outer"), ("relative-displacement", 0)]
)
def test_light_equipment_feels_the_shock_spectrum(kind, shell):
    found = cx.mounted_spectrum("bare", shell, [800.0, 1500.0], 1e-4, 30.0, kind=kind, **SETTINGS)
    np.testing.assert_allclose(found["ratio"], 1.0, atol=6e-3)
    assert found["mounted"].attrs["units"] == found.attrs["units"]


def test_heavy_equipment_feels_less_at_its_resonance():
    light, heavy = (cx.mounted_spectrum("bare", "inner", [1000.0], mass, **SETTINGS) for mass in (5.0, 50.0))
    assert float(heavy["ratio"][0]) < 0.7 < float(light["ratio"][0]) < 0.95


def test_equipment_inside_the_only_shell():
    bare = cx.presets.load("bare")
    alone = bare.replace(shells=[bare.shells[1]], fluids=[cx.VACUUM, bare.exterior])
    settings = SETTINGS | {"time_step": 0.01}  # 1.3, 0.4, 0.15 % of the light one at 0.02, 0.01, 0.005
    light, heavy = (cx.mounted_spectrum(alone, 0, [1500.0], mass, 20.0, **settings) for mass in (1e-3, 50.0))
    np.testing.assert_allclose(light["ratio"], 1.0, atol=6e-3)
    assert float(heavy["ratio"][0]) < 0.7
    (metric,) = metrics_of(["shell.mounted_pseudo_velocity_head@2000 Hz, 50 kg/m"], alone)
    assert metric.units == "m/s"


def test_equipment_at_a_point_of_three_dimensions():
    """Without mass it feels the spectrum of its station, with mass less at its resonance."""
    settings = {"dimensions": 3, "duration": 2.0, "time_step": 0.04, "modes": 4, "axial_modes": 4}
    light, heavy = (cx.mounted_spectrum("bare", "inner", [900.0], mass, 30.0, z=0.5, **settings) for mass in (1e-3, 200.0))
    np.testing.assert_allclose(light["ratio"], 1.0, atol=2e-2)
    assert float(heavy["ratio"][0]) < 0.95
    assert light.attrs["z"] == 0.5


def test_it_is_an_absorber_on_one_shell_whose_stroke_and_force_agree():
    omega, mass = 2.0 * np.pi * 900.0, 20.0
    one = cx.Absorber(mass=mass, linear_stiffness=mass * omega**2, damping=0.0, angle=40.0, links="outer")
    response = cx.simulate(cx.presets.load("bare").replace(absorbers=[one]), **SETTINGS)
    strokes, force = response.absorber_stroke(), response.absorber_force()
    assert bool(np.isnan(strokes[0, 0]).all())
    expected = mass * omega**2 * strokes[0, 1].to_numpy()
    np.testing.assert_allclose(force[0, 1], expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())


def test_strokes_are_taken_from_the_mean_over_a_footprint():
    one = cx.Absorber(mass=10.0, linear_stiffness=1e9, angle=20.0, footprint=0.2)
    response = cx.simulate(cx.presets.load("bare").replace(absorbers=[one]), **SETTINGS)
    expected = 1e9 * response.absorber_stroke()[0].to_numpy()
    np.testing.assert_allclose(response.absorber_force()[0], expected, rtol=1e-8, atol=1e-8 * np.abs(expected).max())


def test_what_is_refused():
    with pytest.raises(cx.InputError, match=r"mass: 0\.0 is not allowed"):
        cx.mounted_spectrum("bare", "inner", [100.0], 0.0)
    with pytest.raises(cx.InputError, match="z: 1 m has no meaning in two dimensions"):
        cx.mounted_spectrum("bare", "inner", [100.0], 1.0, z=1.0)
    with pytest.raises(cx.InputError, match="frequency: -1 Hz"):
        cx.mounted_spectrum("bare", "inner", [-1.0], 1.0)
