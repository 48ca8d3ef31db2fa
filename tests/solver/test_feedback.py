"""The feedback in a shell's dynamic stiffness, by hand from Table 1 and Eqs. 4, 13, 17 and 20, and the sense in which it acts."""

from __future__ import annotations

import math

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.numerics.modes import Modes
from coaxshell.solver.scaling import dimensionless

S = np.array([0.4 + 0.3j, 1.0 + 9.0j])
ORDERS = np.array([0.0, 1.0, 2.0, 7.0, 40.0])


@pytest.mark.parametrize("shell", [0, 1])
def test_by_hand(shell: int) -> None:
    radius, thickness, c = [0.5, 1.0][shell], 3e-3, 1400.0
    closed, opened = (dimensionless(cx.presets.load(name)).shells[shell].operator(Modes(ORDERS), S) for name in ("active", "bare"))
    m = ORDERS[:, None]
    reduced = -4.1 - 73 / 115 * 14.1
    zeta33 = (5.841e-9 - 14.1**2 / 115e9) * math.pi**2 / (2 * thickness)
    zeta22 = 7.124e-9 * thickness / 2
    sensed = reduced * 2 * thickness / math.pi * (m * opened.tangential - m**2) / (zeta33 * radius**2 + m**2 * zeta22)  # V/m, per W
    control = cx.presets.load("active").control
    volts = (control.proportional + control.derivative * S) * sensed
    pressure = 4.1 / radius * volts  # Pa/m, inward: -(e32/R) u on the load's side, e32 = -4.1 C/m^2
    expected = -pressure * 1.0 / (1000 * c**2)  # the load's side goes to the left; a = 1 m
    found = closed.impedance - opened.impedance
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12 * np.abs(expected).max())


def test_the_papers_gains_stiffen_and_damp() -> None:
    closed, opened = (dimensionless(cx.presets.load(name)).shells[0].operator(Modes(ORDERS), 1j * S.imag) for name in ("active", "bare"))
    added = (closed.impedance - opened.impedance)[2:]
    assert (added.real > 0).all()
    assert (added.imag > 0).all()
