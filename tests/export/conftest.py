"""A small run of the hybrid system with a pressure field that is known."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from coaxshell import RigidShell, presets, simulate
from coaxshell.response import Response


class Answer(Response):
    """A response whose pressure is x + 10 y + 100 t, so that every transposition shows."""

    def pressure(self, x, y, time, **options):
        values = np.asarray(x)[None, None, :] + 10 * np.asarray(y)[None, :, None] + 100 * np.asarray(time)[:, None, None]
        return xr.DataArray(values, dims=("time", "y", "x"))


@pytest.fixture(scope="session")
def hybrid():
    return Answer(simulate(presets.load("hybrid"), duration=1.0, time_step=0.02, modes=8).solution)


@pytest.fixture(scope="session")
def rigid_core():
    bare = presets.load("bare")
    core = bare.replace(shells=[RigidShell(radius=0.5), bare.shells[1]], fluids=["vacuum", *bare.fluids[1:]])
    return Answer(simulate(core, duration=1.0, time_step=0.02, modes=8).solution)
