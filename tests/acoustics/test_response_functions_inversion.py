"""Response functions against plain inversion of the radial operators, at times well away from fronts.

Neither resonances nor echoes: the transforms on a fine Laplace grid, cut off by a window without a corner, are inverted by one FFT.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import erfc

from coaxshell.acoustics.operators import annulus
from coaxshell.acoustics.radial_fields import annulus_field, disc_field, exterior_field
from coaxshell.acoustics.response_functions import exterior, gap, interior
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.radial_functions import RadialFunctions

RA, RB, ALPHA = 0.5, 1.0, 0.8
LOW = np.array([0, 1, 5, 20])
HIGH = np.array([150, 300])


class Inversion:
    def __init__(self, step, steps, orders):
        self.grid, self.orders = LaplaceGrid(step, steps, 1e-11), orders
        self.window = 0.5 * erfc(24.0 * (np.linspace(0.0, 1.0, self.grid.nodes.size) - 0.5))

    def at(self, radius, slowness):
        return RadialFunctions(slowness * self.grid.nodes, radius, self.orders.astype(float))

    def error(self, spectrum, function, fronts, margin):
        time = self.grid.time
        clear = np.min(np.abs(time[:, None] - np.asarray(fronts)), axis=1) > margin
        chosen = np.flatnonzero(clear)[::41]
        return np.abs(self.grid.invert(spectrum, self.window)[:, chosen] - function(self.orders, time[chosen])).max()


@pytest.fixture(scope="module")
def low():
    return Inversion(1e-4, 25000, LOW)


def test_gap_walls(low):
    operator = annulus(low.at(RA, ALPHA), low.at(RB, ALPHA))
    fronts = ALPHA * (RB - RA) * np.arange(9)
    for spectrum, at, driven in zip(operator, (RA, RA, RB, RB), ("inner", "outer") * 2, strict=True):
        assert (
            low.error(
                spectrum, lambda m, t, a=at, d=driven: gap(m, t, inner=RA, outer=RB, radius=a, driven=d, slowness=ALPHA), fronts, 0.05
            )
            < 2e-9
        )


def test_gap_field(low):
    fields = annulus_field(low.at(0.8, ALPHA), low.at(RA, ALPHA), low.at(RB, ALPHA))
    fronts = ALPHA * (np.arange(5)[:, None] + [0.2, 0.3, 0.7, 0.8]).ravel()
    for field, driven in zip(fields, ("inner", "outer"), strict=True):
        assert (
            low.error(
                field.pressure, lambda m, t, d=driven: gap(m, t, inner=RA, outer=RB, radius=0.8, driven=d, slowness=ALPHA), fronts, 0.03
            )
            < 4e-9
        )


def test_interior_wall_and_field(low):
    wall, here = low.at(RA, 1.3), low.at(0.2, 1.3)
    fronts = 1.3 * np.arange(4)
    assert low.error(wall.disc, lambda m, t: interior(m, t, disc_radius=RA, slowness=1.3), fronts, 0.05) < 2e-9
    inside = 1.3 * (np.arange(3)[:, None] + [0.3, 0.7]).ravel()
    assert (
        low.error(disc_field(here, wall).pressure, lambda m, t: interior(m, t, radius=0.2, disc_radius=RA, slowness=1.3), inside, 0.05)
        < 2e-9
    )


def test_exterior_field(low):
    spectrum = -exterior_field(low.at(1.7, 1.0), low.at(1.0, 1.0)).pressure
    assert low.error(spectrum, lambda m, t: exterior(m, t, radius=1.7), [0.7], 0.05) < 1e-10


@pytest.mark.slow
def test_high_orders():
    high = Inversion(1e-4, 15000, HIGH)
    operator = annulus(high.at(RA, 1.0), high.at(RB, 1.0))
    assert high.error(operator.aa, lambda m, t: gap(m, t, inner=RA, outer=RB), [0.0, 1.0], 0.1) < 2e-10
    assert high.error(operator.bb, lambda m, t: gap(m, t, inner=RA, outer=RB, driven="outer"), [0.0, 1.0], 0.1) < 1e-8
    assert high.error(high.at(RA, 1.0).disc, lambda m, t: interior(m, t, disc_radius=RA), [0.0, 1.0], 0.1) < 1e-8
