"""What is understood of the pressure records in a description is told with it."""

from __future__ import annotations

import numpy as np
from asking import described
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.apps.studio import record_views


def test_what_is_understood_is_told_with_the_description(client):
    time = np.linspace(0.0, 1e-3, 5001)
    pulse = cx.Sampled(time=time, pressure=2e4 * np.exp(-time / 1e-4), start=1e-4)
    system = cx.presets.load("bare").replace(source=cx.PlaneWave(pulse=pulse))
    answer = client.post("/api/validate", json={"system": system.model_dump(mode="json")}).json()
    (view,) = answer["records"]
    assert (view["path"], view["recorded"]) == ("source.pulse", 5001)
    assert_allclose(view["peak"], 2e4 / np.e, rtol=1e-9)
    assert_allclose(view["decay_time"], 1e-4, rtol=1e-4)
    assert_allclose(view["impulse"], 2.0 * (np.exp(-1) - np.exp(-10)), rtol=1e-4)
    assert len(view["time"]) <= 2 * record_views.INTERVALS + 2
    assert max(view["pressure"]) == view["peak"]
    assert client.post("/api/validate", json={"system": described("bare")}).json()["records"] == []
