"""Gradients of runs on exact elastic walls, against differences of runs: walls, fluids, absorbers on their faces, control, losses."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.numerics.modes import Modes
from coaxshell.structure.elastic_basis import elastic_basis
from coaxshell.structure.solid import SolidLayer
from coaxshell.studies.gradients.sensitivity import MetricSensitivity
from coaxshell.studies.metrics import metrics_of
from coaxshell.studies.varied_fields import field_of, varied

RUN = {"duration": 0.7, "time_step": 0.02, "modes": 4}
WALLS = {"shells[0].layers[1].thickness": 1e-3, "shells[1].radius": 1e-4, "fluids[1].sound_speed": 1e-4, "source.distance": 1e-3}
LINKS = {"absorbers[0].mass": 0.01, "absorbers[1].damping": 0.01, "absorbers[1].linear_stiffness": 0.01, "absorbers[0].angle": 0.005}


def system(name="bare", *, exact=(0, 1), cubic=None):
    """A preset whose walls are exact, with two unequal absorbers if told how they bend."""
    found = cx.presets.load(name).replace(absorbers=())
    found = found.replace(shells=[one.replace(theory="elastic") if i in exact else one for i, one in enumerate(found.shells)])
    if cubic is None:
        return found
    rows = ((10.0, 8.0, 5e5, 1e9), (130.0, 12.0, 2e6, 5e8))
    names = ("angle", "mass", "damping", "linear_stiffness")
    return found.replace(absorbers=[cx.Absorber(cubic_stiffness=cubic, **dict(zip(names, row, strict=True))) for row in rows])


def sensitivity(described, metric):
    return MetricSensitivity(described, metrics_of([metric], described)[0], 16.0, cx.simulate(described, **RUN))


def agrees(described, steps, metric="inner.rms_stress", rtol=1e-6):
    """Compare the slope along a change of all fields with central differences of runs of fourth order."""
    at = {path: field_of(described, path).present for path in steps}

    def value(part):
        return sensitivity(varied(described, {path: at[path] + part * steps[path] * abs(at[path]) for path in at}), metric).value

    found = sensitivity(described, metric)
    slope = sum(steps[path] * abs(at[path]) * found.of(path) for path in at)
    coarse, fine = ((value(part) - value(-part)) / (2.0 * part) for part in (0.5, 0.25))
    assert_allclose(slope, (4.0 * fine - coarse) / 3.0, rtol=rtol)


def test_walls_fluids_and_sources():
    agrees(system(), WALLS | {"shells[1].layers[1].material.youngs_modulus": 1e-3})


@pytest.mark.parametrize("cubic", [0.0, 1e22])
def test_absorbers_on_the_faces(cubic):
    agrees(system(cubic=cubic), WALLS | LINKS)


def test_a_law_on_a_thin_wall_beside_an_exact_one():
    described = system(exact=(1,), cubic=1e22)
    law = cx.laws.Polynomial(coefficients=(1e9, 1e16, 1e23))
    described = described.replace(absorbers=[one.replace(law=law, footprint=0.05) for one in described.absorbers])
    agrees(described, WALLS | {"absorbers[0].law.coefficients[1]": 0.01, "absorbers[1].footprint": 0.01}, metric="outer.peak_stress")


@pytest.mark.parametrize(
    ("name", "metric"),
    [("active", "outer.actuator_field_ratio"), ("electrodes", "inner.rms_stress")],
)
def test_control(name, metric):
    layer = {"active": {"shells[1].layers[0].thickness": 3e-3}, "electrodes": {"shells[1].layers[1].thickness": 1e-3}}
    agrees(system(name), {"control.derivative": 0.01, **layer[name]}, metric)


def test_losses_and_sensors():
    lossy = {f"shells[0].layers[1].material.{name}": value for name, value in (("loss_factor", 0.03), ("reference_frequency", 1000.0))}
    described = system(exact=(0,)).with_overrides(lossy)
    agrees(
        described, {"shells[0].layers[1].material.loss_factor": 0.01, "shells[0].layers[0].thickness": 1e-3}, "inner.peak_sensor_voltage"
    )


def test_a_wall_beside_another_may_take_its_mesh():
    """Points through a layer jump in number as it grows, and what a run prints by up to 1e-6: more than a small step changes."""
    modes, stiffness = Modes.up_to(2), tuple(map(tuple, np.diag([3.0, 3.0, 3.0, 1.0, 1.0, 1.0]) + np.pad(np.ones((3, 3)), (0, 3))))
    thin = SolidLayer(inner=0.99, outer=1.0, density=2.0, stiffness=stiffness)
    thick = replace(thin, outer=1.01)
    alone, held = (elastic_basis((thick,), modes, 4000.0, meshed_as) for meshed_as in (None, (thin,)))
    assert held[0].squares.shape == elastic_basis((thin,), modes, 4000.0)[0].squares.shape != alone[0].squares.shape
    assert_allclose(held[0].squares[:, :2], alone[0].squares[:, :2], rtol=1e-9, atol=1e-9)
