"""Nothing moves before the first arrival, through solid or fluid."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx

STEP = 1e-3


@pytest.fixture(scope="module")
def bare() -> cx.Response:
    return cx.simulate(cx.presets.load("bare"), duration=2.0, time_step=STEP)


def first_arrival(system: cx.System, angle: float) -> float:
    """Return the least time from the front's touch at the head to the inner shell at an angle, by Fermat's principle.

    The front runs outside, a membrane wave may run along the outer shell, a straight ray crosses the gap, another membrane wave
    runs along the inner shell; all in transits, membrane speeds sqrt(a22/I)/c.
    """
    membrane = np.sqrt(9.852e8 / 61.2) / 1400
    inner = system.shells[0].radius
    distance = system.source_distances[0]
    x = np.radians(np.linspace(0, angle, 91))
    hit = np.sqrt(1 + distance**2 - 2 * distance * np.cos(x)) - (distance - 1)
    outer = np.min(hit[:, None] + np.where(x >= x[:, None], (x - x[:, None]) / membrane, np.inf), axis=0)
    ray = np.sqrt(1 + inner**2 - 2 * inner * np.cos(np.maximum(0, x - x[:, None])))
    crossed = np.min(np.where(x >= x[:, None], outer[:, None] + ray, np.inf), axis=0)
    return float(np.min(crossed + (x[-1] - x) * inner / membrane))


def test_every_order_of_the_inner_shell_waits_for_the_water(bare: cx.Response) -> None:
    # The gap is half a transit wide. Measured: 1.5e-10 until the last ten steps, the level of rounding.
    still = bare.time < 0.5 - 10 * STEP
    w = abs(bare.solution.normal[0])
    assert w[..., still].max() < 1e-9 * w.max()
    assert w[..., bare.time < 0.55].max() > 1e-6 * w.max()


@pytest.mark.parametrize(("angle", "level"), [(0.0, 1e-8), (90.0, 1e-5), (180.0, 1e-5)])
def test_inner_shell_at_an_angle(bare: cx.Response, angle: float, level: float) -> None:
    # Away from the head the cut at M = 150 and the dispersion of thin-shell bending, which knows no greatest speed, show first.
    arrival = first_arrival(bare.system, angle)
    w = abs(np.asarray(bare.displacement("inner", [angle]))[:, 0])
    largest = abs(np.asarray(bare.displacement("inner"))).max()
    assert w[bare.time < arrival - 0.02].max() < level * largest
    assert w[bare.time < arrival + 0.1].max() > 1e-4 * largest


def test_the_arrivals_are_those_of_the_paper(bare: cx.Response) -> None:
    np.testing.assert_allclose(first_arrival(bare.system, 0.0), 0.5, rtol=1e-12)
    assert 1.0 < first_arrival(bare.system, 180.0) < 1.1  # through the inner shell, long before the front's 2


def test_a_late_source_leaves_everything_at_rest() -> None:
    bare = cx.presets.load("bare")
    late = bare.replace(source=bare.source.replace(delay=1.5 / 1400))
    response = cx.simulate(late, duration=2.5, time_step=2e-3, modes=60)
    w = abs(response.solution.normal)
    assert w[..., response.time < 1.48].max() < 5e-8 * w.max()
