"""A response made of simple curves, so that figures are tested without a solver."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from coaxshell import presets

TRANSIT = 1 / 1400


class FakeResponse:
    """Damped oscillations that start at each point's own arrival."""

    def __init__(self, system, amplitude=1.0):
        self.system = system
        self.amplitude = amplitude
        self.time = np.linspace(0, 5, 1001)

    def stress(self, shell, angle):
        return self._array(shell, angle, 2e5, 9.0)

    def displacement(self, shell, angle):
        return -self._array(shell, angle, 1.2e-6, 4.0) * 0.7

    def sensor_voltage(self, shell, angle):
        return self._array(shell, angle, 300.0, 7.0)

    def _array(self, shell, angle, scale, frequency):
        index = self.system.shell_index(shell)
        columns = []
        for degrees in angle:
            since = np.clip(self.time - 0.5 * (1 - index) - 0.6 * (degrees > 90), 0, None)
            columns.append(-scale * self.amplitude * np.sin(frequency * since) * np.exp(-since / (1.4 + index)) * (1 + degrees / 360))
        coords = {"time": self.time, "time_seconds": ("time", self.time * TRANSIT), "angle": list(angle)}
        return xr.DataArray(np.stack(columns, axis=1), dims=("time", "angle"), coords=coords)


@pytest.fixture
def response():
    return FakeResponse(presets.load("bare"))


@pytest.fixture
def make_response():
    return FakeResponse
