"""Fields between true faces: none within a wall, the walls' accelerations on both of its faces, alike in two and three dimensions."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.response import Response

WATER = cx.Fluid(density=1000, sound_speed=1400)
STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=210e9, poisson_ratio=0.3)
TRANSIT = 1.0 / 1400.0
SMOOTH = cx.LineWave(distance=4.0, pulse=cx.Gaussian(peak_pressure=2.5e4, width=0.1 * TRANSIT, centre=0.6 * TRANSIT))
SETTINGS = {"modes": 8, "duration": 2.0, "time_step": 1e-2}
FACES = ((0.44, 0.56), (0.93, 1.07))


def system() -> cx.System:
    shells = [cx.Shell(radius=0.5 * sum(pair), layers=[cx.Layer(STEEL, pair[1] - pair[0])], wetted="faces") for pair in FACES]
    return cx.System(shells=shells, fluids=[WATER, cx.Fluid(density=900, sound_speed=1200), WATER], source=SMOOTH)


@pytest.fixture(scope="module")
def response() -> Response:
    return cx.simulate(system(), **SETTINGS)


def test_there_is_no_pressure_within_a_wall(response: Response) -> None:
    radii = [0.2, 0.45, 0.55, 0.7, 0.94, 1.06, 1.2]
    pressure = np.abs(np.asarray(response.pressure(radius=radii, angle=[40.0], time=[1.5, 1.8]))).max(axis=(0, 2))
    np.testing.assert_array_equal(pressure > 1.0, [True, False, False, True, False, False, True])
    assert not pressure[[1, 2, 4, 5]].any()


@pytest.mark.parametrize("shell", [0, 1])
@pytest.mark.parametrize("side", [0, 1])
def test_the_pressure_rises_from_a_face_as_its_acceleration_asks(response: Response, shell: int, side: int) -> None:
    when, angle, step = [1.2, 1.5, 1.8], 40.0, 2e-3
    out = 1 if side == 1 else -1
    radii = np.sort(FACES[shell][side] + out * step * np.array([1e-9, 1.0, 2.0]))
    p = np.asarray(response.pressure(radius=radii, angle=[angle], time=when, part="radiated"))[:, :, 0]
    p = p if out == 1 else p[:, ::-1]
    slope = out * (-1.5 * p[:, 0] + 2.0 * p[:, 1] - 0.5 * p[:, 2]) / step
    inward = np.asarray(response.shell_acceleration(shell, angle=angle).sel(time=when, method="nearest")).ravel()
    density = 1000.0 if (shell, side) in ((0, 0), (1, 1)) else 900.0
    np.testing.assert_allclose(slope, density * inward, rtol=0, atol=0.01 * np.abs(density * inward).max())


def test_three_dimensions_see_the_same_of_a_line_source(response: Response) -> None:
    place = {"radius": [0.2, 0.5, 0.7, 1.0, 1.07, 1.5], "angle": [0.0, 130.0], "time": [0.9, 1.6]}
    space = cx.simulate(system(), dimensions=3, stations=[0.0], **SETTINGS)
    expected = np.asarray(response.pressure(**place, time_resolution=1e-2))
    found = np.asarray(space.pressure(**place, z=0.3, time_resolution=1e-2))
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-8 * np.abs(expected).max())
