"""Adding orders: observed decay of what is left out, for smooth and sharp excitations."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.response.synthesis import mean_square

SETTINGS = {"duration": 3.0, "time_step": 2e-3}
CUTS = (15, 30, 60, 120)
MANY = 400


def left_out(source: object, quantity: str, shell: str = "outer") -> np.ndarray:
    """Return the relative L2 norm, over surface and time, of the orders above each cut."""
    system = cx.presets.load("bare").replace(source=source)
    modal = np.asarray(cx.simulate(system, modes=MANY, **SETTINGS).modal(shell, quantity))
    whole = mean_square(modal).sum()
    tails = []
    for cut in CUTS:
        tail = modal.copy()
        tail[:, : cut + 1] = 0.0
        tails.append(np.sqrt(mean_square(tail).sum() / whole))
    return np.array(tails)


class Decay:
    """Assert that every doubling of M gains at least ``rate``."""

    rate: float
    quantity: str
    shell = "outer"
    source: object = cx.SphericalShock(distance=5.0, peak_pressure=2.5e4, decay_time=1.314e-4)

    def test_rate(self) -> None:
        found = left_out(self.source, self.quantity, self.shell)
        assert (np.log2(found[:-1] / found[1:]) > self.rate).all(), found


class TestDisplacement(Decay):
    rate = 1.4
    quantity = "displacement"


class TestOuterStress(Decay):
    """The membrane wave: modal stress hardly decays from m = 100 to 250."""

    rate = 0.5
    quantity = "stress"


class TestInnerStress(Decay):
    rate = 0.9
    quantity = "stress"
    shell = "inner"


class TestSmoothPulse(Decay):
    rate = 5.0
    quantity = "stress"
    source = cx.PlaneWave(pulse=cx.Gaussian(peak_pressure=2.5e4, width=8e-5))

    def test_rate(self) -> None:
        # Beyond 1e-8 only rounding is left.
        found = np.maximum(left_out(self.source, self.quantity), 1e-8)
        assert np.log2(found[0] / found[1]) > self.rate, found
        assert found[2] < 1e-7, found


@pytest.mark.slow
def test_the_papers_150_orders() -> None:
    # The outer shell's stress differs by 1.2e-3 from that of many more orders, the inner's by about 1e-4.
    for shell, expected in (("outer", 1.2e-3), ("inner", 9e-5)):
        modal = np.asarray(cx.simulate(cx.presets.load("bare"), modes=MANY, duration=5.0, time_step=2e-3).modal(shell, "stress"))
        tail = modal.copy()
        tail[:, :151] = 0.0
        error = np.sqrt(mean_square(tail).sum() / mean_square(modal).sum())
        assert expected / 3 < error < 3 * expected
