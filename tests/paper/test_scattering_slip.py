"""The missing delay of the diffracted pressure against the printed convolution itself, order by order."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.acoustics.response_functions import exterior
from coaxshell.apps.paper.slips import scattering_delay
from coaxshell.solver.direct.loads import arc_integrals
from coaxshell.solver.scaling import dimensionless

BARE = cx.presets.load("bare")
STEP = 2.5e-3


def projected(field, order, angles):
    """Return the cosine amplitude of one order of a field (times, 1, angles)."""
    return np.asarray(field)[:, 0] @ np.cos(np.radians(order * angles)) * (1.0 if order == 0 else 2.0) / angles.size


@pytest.mark.parametrize("order", [0, 3])
def test_the_printed_convolution_is_the_corrected_field_and_the_missing_delay(order):
    radius, instants = 1.5, [0.9, 1.3, 2.2]
    problem, times = dimensionless(BARE), np.arange(0.0, 2.2 + STEP / 2, STEP)
    _, velocity = arc_integrals(problem, BARE.source, problem.sources[0], times, Modes.up_to(order))
    b = velocity[order]
    # -b(t)/sqrt(r) - integral of b(eta) dxi/dt(t - eta), xi smooth from its front at t = r - 1 on (Eq. B.13 as printed).
    late = times[times >= radius - 1.0 - STEP / 2]
    slope = np.gradient(exterior([order], np.maximum(late, radius - 1.0 + 1e-9), radius=radius)[0], STEP, edge_order=2)
    reach = np.rint(np.array(instants) / STEP).astype(int)
    start = times.size - late.size
    memory = [np.trapezoid(b[: n - start + 1][::-1] * slope[: n - start + 1], dx=STEP) for n in reach]
    printed = (-b[reach] / np.sqrt(radius) - np.array(memory)) * problem.scales.pressure

    response = cx.simulate(BARE, duration=2.3, time_step=STEP, modes=8)
    coarse = np.arange(0.0, 360.0, 5.0)
    corrected = projected(response.pressure(radius=[radius], angle=coarse, time=instants, part="diffracted"), order, coarse)
    fine = np.arange(0.0, 360.0, 0.02)  # v0 jumps at its front
    added = projected(scattering_delay(BARE, radius, fine, instants), order, fine)
    scale = np.abs(printed).max()
    np.testing.assert_allclose(corrected + added, printed, rtol=0, atol=1.5e-3 * scale)
    assert np.abs(added).max() > 0.1 * scale


def test_at_the_shell_nothing_is_added():
    np.testing.assert_array_equal(scattering_delay(BARE, 1.0, [0.0, 60.0], [0.3, 1.1]), 0.0)
