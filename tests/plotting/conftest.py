"""A response made of simple curves, so that figures are tested without a solver."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from coaxshell import presets

TRANSIT = 1 / 1400


class FakeResponse:
    """Damped oscillations that start at each point's own arrival."""

    stations = None

    def __init__(self, system, amplitude=1.0):
        self.system = system
        self.amplitude = amplitude
        self.time = np.linspace(0, 5, 1001)

    def stress(self, shell, angle):
        return self._array(shell, angle, 2e5, 9.0)

    def displacement(self, shell, angle, component="normal", relative=False):
        return -self._array(shell, angle, 1.2e-6, 4.0) * (0.7 if component == "normal" else 0.4) * (0.5 if relative else 1.0)

    def sensor_voltage(self, shell, angle):
        return self._array(shell, angle, 300.0, 7.0)

    def actuator_voltage(self, shell, angle):
        return self._array(shell, angle, 3e3, 7.0)

    def history(self, shell, angle, quantity):
        component = "tangential" if "tangential" in quantity else "normal"
        if "displacement" in quantity:
            return self.displacement(shell, angle, component, relative="relative" in quantity)
        if quantity.endswith(("velocity", "acceleration")):
            return self._array(shell, angle, 1e-2 if quantity.endswith("velocity") else 1e3, 9.0)
        if quantity.endswith("_stress"):
            return self._array(shell, angle, 1e5, 9.0)
        if quantity in ("actuator_charge", "actuator_current"):
            return self._array(shell, angle, 1e-3, 7.0)
        return getattr(self, quantity)(shell, angle)

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


class Waves(FakeResponse):
    """A response with a pressure field: a front from the right with a tail behind it, and the same from any side angle."""

    peak = 2e4

    def __init__(self, system, symmetric=True):
        super().__init__(system)
        self.time_seconds = self.time * TRANSIT
        self.warnings = ()
        self.solution = SimpleNamespace(normal=np.empty((2, 1 if symmetric else 2, 7, len(self.time))))
        self.asked = []

    def pressure(self, x, y, time, front="sharp", progress=None):
        self.asked.append((len(x), len(y), len(time)))
        since = np.asarray(time)[:, None, None] - (1.0 - np.asarray(x)[None, None, :]) + 0.0 * np.asarray(y)[None, :, None]
        tilt = 1.0 if self.solution.normal.shape[1] == 1 else 1.0 + 0.2 * np.asarray(y)[None, :, None]
        values = self.peak * tilt * np.exp(-np.clip(since, 0, None) / 0.2) * (since > 0)
        if progress is not None:
            progress(1.0, "pressure")
        return xr.DataArray(values, dims=("time", "y", "x"))

    def pressure_rms(self, region, radius=None):
        return xr.DataArray(1e3 * self.time * (0.5 if region == "interior" else 1.0), dims="time", coords={"time": self.time})


@pytest.fixture
def waves():
    return Waves(presets.load("bare"))


@pytest.fixture
def make_waves():
    return Waves
