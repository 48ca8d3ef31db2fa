"""The independent solver, the systems it is tried on, and the distance between two answers."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.apps.verification.independent import RadialElements

ANGLES = [0.0, 70.0, 180.0]


@pytest.fixture(scope="session")
def pulse():
    """Return a smooth pulse 0.05 transits wide, so that neither method pays for fronts."""
    return cx.Gaussian(peak_pressure=2.5e4, width=0.05 / 1400)


@pytest.fixture(scope="session")
def struck(pulse):
    """Return a maker of the paper's double shell under the smooth pulse."""

    def build(preset="bare", angle=0.0, **changes):
        return cx.presets.load(preset).replace(source=cx.SphericalWave(distance=5.0, angle=angle, pulse=pulse), **changes)

    return build


@pytest.fixture(scope="session")
def absorber():
    """Return a maker of absorbers whose cubic stiffness rules: k_nl 1e22 doubles the forces of k_nl = 0."""

    def build(**changes):
        usual = {"angle": 0.0, "mass": 10, "damping": 1e5, "linear_stiffness": 1e9, "cubic_stiffness": 1e22}
        return cx.Absorber(**{**usual, **changes})

    return build


@pytest.fixture(scope="session")
def distances():
    """Return a function from a system and steps to {(shell, quantity): relative L2 distance} between package and independent solver."""

    def measure(system, time_step, independent_step, duration=2.0, modes=8, angles=0, **options):
        model = RadialElements(system, modes, duration, angles, **options)
        model.solve(independent_step, round(duration / independent_step))
        response = cx.simulate(system, duration=duration, time_step=time_step, modes=modes)
        coarse = max(time_step, independent_step)
        ours, theirs = round(coarse / time_step), round(coarse / independent_step)
        found = {}
        for shell in range(len(system.shells)):
            for quantity in ("displacement", "stress"):
                got = np.asarray(getattr(response, quantity)(shell, ANGLES))[::ours]
                wanted = np.stack([getattr(model, quantity)(shell, angle) for angle in ANGLES], axis=1)[::theirs]
                found[shell, quantity] = float(np.linalg.norm(got - wanted) / np.linalg.norm(wanted))
        return found

    return measure
