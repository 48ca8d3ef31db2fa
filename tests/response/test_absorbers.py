"""Histories of the absorbers."""

from __future__ import annotations

import numpy as np
import pytest

from coaxshell.errors import InputError
from coaxshell.response import Response


def test_displacement(response: Response) -> None:
    found = response.absorber_displacement()
    assert found.dims == ("absorber", "time")
    assert found.attrs["units"] == "m"
    np.testing.assert_array_equal(found.angle, [20.0, -70.0])
    np.testing.assert_allclose(found, 1.25 * response.solution.absorber_displacement, rtol=1e-15)


def test_force(response: Response) -> None:
    found = response.absorber_force()
    assert found.dims == ("absorber", "side", "time")
    assert list(found.side.values) == ["inner", "outer"]
    assert found.attrs["units"] == "N/m"
    np.testing.assert_allclose(found.sel(side="outer"), 1000 * 1400**2 * 1.25 * response.solution.absorber_force[:, 1], rtol=1e-15)
    np.testing.assert_allclose(found.time_seconds, response.time_seconds, rtol=1e-15)


def test_without_absorbers(rigid_core: Response) -> None:
    for call in (rigid_core.absorber_displacement, rigid_core.absorber_force):
        with pytest.raises(InputError, match="absorbers: this system has none"):
            call()
