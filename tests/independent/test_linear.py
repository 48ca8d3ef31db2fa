"""Shells, fluids, sources and feedback against spectral elements in r and implicit Gauss integration in t."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

import coaxshell as cx

PAPERS_GAINS = {"proportional": -2e4, "derivative": -150}


def test_bare(struck, distances):
    # Measured 1.7e-7 or less.
    assert max(distances(struck(), 1e-3, 2e-3).values()) < 5e-7


def test_active_control(struck, distances):
    # Measured 1.8e-7 or less.
    assert max(distances(struck(control=cx.PDControl(**PAPERS_GAINS)), 1e-3, 2e-3).values()) < 5e-7


def test_one_shell_controlled(struck, distances):
    control = cx.PDControl(proportional=-3e4, derivative=-400, shells=["inner"])
    assert max(distances(struck(control=control), 1e-3, 2e-3).values()) < 5e-7


def test_plane_wave_off_the_axis(struck, distances, pulse):
    # Measured 1.2e-7 or less.
    assert max(distances(struck().replace(source=cx.PlaneWave(angle=40.0, pulse=pulse)), 1e-3, 2e-3).values()) < 5e-7


def test_three_shells_and_four_fluids(struck, distances):
    # Measured 8.4e-8 or less.
    wall, outer = struck().shells
    system = struck().replace(
        shells=[wall.replace(radius=0.4), wall.replace(radius=0.7), outer],
        fluids=[cx.VACUUM, cx.Fluid(density=900, sound_speed=1200), cx.Fluid(density=1200, sound_speed=1700), struck().fluids[2]],
    )
    assert max(distances(system, 1e-3, 2e-3).values()) < 5e-7


def test_lopsided_layup(struck, distances):
    # The sensor inside, the actuator thicker: b22 is not zero.
    wall, outer = struck().shells
    sensor, core, actuator = wall.layers
    system = struck(control=cx.PDControl(**PAPERS_GAINS))
    system = system.replace(shells=[wall.replace(layers=[sensor, core, actuator.replace(thickness=9e-3)]), outer])
    assert max(distances(system, 1e-3, 2e-3).values()) < 5e-7


@pytest.mark.slow_for("charge sensor and bridge")
@pytest.mark.parametrize(
    ("layers", "gains"),
    [
        (("passive", "self-sensing"), ([2.0, 20.0], [0.5, 1.0])),
        (("sensor", "self-sensing"), (-3.0, 0.2)),
        (("charge-sensor", "self-sensing"), (3.0, 0.2)),
    ],
    ids=["one layer", "sensor and bridge", "charge sensor and bridge"],
)
def test_control_by_electrodes(struck, distances, layers, gains):
    # Loads of charged layers from their electric enthalpy. Measured 1.7e-7 or less.
    roles = {f"shells[{i}].layers[{j}].role": role for i in (0, 1) for j, role in zip((0, 2), layers, strict=True)}
    control = cx.PDControl(proportional=gains[0], derivative=gains[1], transducers="electrodes")
    assert max(distances(struck().with_overrides({**roles, "control": control}), 1e-3, 2e-3).values()) < 5e-7


@pytest.mark.slow
def test_the_papers_own_shock(distances):
    # A sharp front: both methods pay for it, each with its own step. Measured 2.2e-5 or less (1.6e-4 at twice the element and step).
    assert max(distances(cx.presets.load("bare"), 2.5e-4, 1e-3, element=0.03125).values()) < 4e-5


class TestOrder:
    """The independent solver itself: Gauss's method of two stages."""

    rate = 4.0

    def test_rate(self, struck, distances):
        errors = [distances(struck(), 1e-3, step) for step in (1.6e-2, 8e-3, 4e-3)]
        for key in errors[0]:
            rates = np.log2([a[key] / b[key] for a, b in pairwise(errors)])
            assert rates == pytest.approx(self.rate, abs=0.15), key
