"""Histories of the absorbers."""

from __future__ import annotations

import numpy as np
import pytest

from coaxshell.errors import InputError
from coaxshell.model import presets
from coaxshell.response import Response, simulate


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


def test_links_of_linear_springs_pull_with_their_stroke() -> None:
    system = presets.load("absorbers").with_overrides({"absorbers.damping": 0, "absorbers.cubic_stiffness": 0, "absorbers.count": 3})
    response = simulate(system, duration=1.0, time_step=0.02, modes=6)
    strokes, force = response.absorber_stroke(), response.absorber_force()
    assert (strokes.dims, strokes.attrs["units"]) == (force.dims, "m")
    np.testing.assert_allclose(system.absorber_list[0].linear_stiffness * strokes, force, rtol=1e-9, atol=1e-12 * float(abs(force).max()))


def test_strokes_are_of_two_dimensions() -> None:
    response = simulate("absorbers", duration=0.5, time_step=0.05, modes=2, dimensions=3)
    with pytest.raises(InputError, match="strokes are read in two dimensions"):
        response.absorber_stroke()
