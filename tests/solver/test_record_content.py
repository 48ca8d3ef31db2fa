"""A record with much energy above what the orders and the time step resolve is remarked, with the numbers that would do."""

from __future__ import annotations

import re

import numpy as np
import pytest
from numpy.testing import assert_allclose

import coaxshell.model as cx
from coaxshell.model import presets
from coaxshell.model.records.measures import energy_above
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver import checks
from coaxshell.solver.scaling import dimensionless

TIME = np.linspace(0, 2e-3, 20_001)
SMOOTH = 1e5 * np.exp(-TIME / 3e-4)


def warned(pressure, modes=150, time_step=1e-3):
    system = presets.load("bare").replace(source=cx.PlaneWave(pulse=cx.Sampled(time=TIME, pressure=pressure)))
    found = checks.before(dimensionless(system), LaplaceGrid(time_step, 3000), modes)
    return [text for text in found if "record's energy" in text]


def test_energy_above_a_frequency_is_that_of_the_closed_form():
    """An exponential decay in tau has the share 1 - (2/pi) atan(omega tau) above omega."""
    record = cx.Sampled(time=TIME, pressure=SMOOTH)
    for frequency in (300.0, 1e3, 5e3):
        assert_allclose(
            energy_above(*record.spectrum, frequency), 1 - 2 / np.pi * np.arctan(2 * np.pi * frequency * 3e-4), rtol=5e-3, atol=2e-3
        )


def test_a_shock_is_resolved_and_ringing_is_not():
    assert warned(SMOOTH) == []
    ringing = SMOOTH * (1 + np.sin(2 * np.pi * 90e3 * TIME))
    (told,) = warned(ringing)
    share = float(re.search(r"source: ([\d.]+) %", told)[1]) / 100
    assert_allclose(share, 0.5 / 1.5, atol=0.03)  # of 1 + sin, squared and averaged: 1 and a half; the front adds to both
    enough = int(re.search(r"use modes=(\d+)", told)[1])
    assert warned(ringing, modes=enough + 1) == []
    assert warned(ringing, modes=enough - 20)


def test_the_coarser_of_the_two_is_told():
    ringing = SMOOTH * (1 + np.sin(2 * np.pi * 20e3 * TIME))
    assert warned(ringing) == []
    (told,) = warned(ringing, time_step=4e-2)
    step = float(re.search(r"use time_step = ([\d.e-]+)", told)[1])
    assert warned(ringing, time_step=0.95 * step) == []
    (both,) = warned(ringing, modes=8, time_step=4e-2)
    assert re.search(r"order 8 resolves up to .*Hz at the wall, time_step = 0.04 up to .*Hz; use modes=\d+ and time_step = ", both)


@pytest.mark.parametrize("pressure", [np.zeros_like(TIME), np.where(TIME < 1e-4, TIME, 1e-4) * 1e9])
def test_nothing_is_said_of_what_has_no_such_content(pressure):
    assert warned(pressure, modes=60) == []
