"""What an axial wavenumber must leave as it is: two dimensions at k -> 0, the line source, an undisturbed spherical wave, reciprocity."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import ive, kve

import coaxshell as cx
from coaxshell.acoustics.basis import RadialBasis
from coaxshell.acoustics.pulse_transforms import pulse_transform
from coaxshell.acoustics.sources import LineGeometry, SphericalFrontGeometry
from coaxshell.apps.verification.modal import modal_spectra
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.scaling import dimensionless

GRID = LaplaceGrid(2e-2, 250)
S = GRID.nodes
EVERYTHING = slice(0, S.size)
PULSE = cx.Gaussian(peak_pressure=2.5e4, width=0.1 / 1400)


@pytest.fixture(scope="module")
def bare():
    return cx.presets.load("bare").replace(source=cx.SphericalWave(distance=3.0, pulse=PULSE))


class TestTwoDimensions:
    @pytest.mark.parametrize("control", [None, cx.PDControl(proportional=-2e4, derivative=-150)])
    def test_a_vanishing_wavenumber(self, bare, control):
        # Measured 2e-13 or less.
        system = bare.replace(control=control)
        plane, nearly = (modal_spectra(system, GRID, Modes.up_to(40, k)) for k in (0.0, 1e-9))
        for which in (0, 1):
            scale = np.abs(plane[which]).max(axis=-1, keepdims=True)
            np.testing.assert_allclose(
                nearly[which] / np.where(scale, scale, 1), plane[which] / np.where(scale, scale, 1), rtol=0, atol=1e-12
            )
        # What is left along the axis is as small as the wavenumber.
        assert np.abs(nearly[2]).max() < 1e-8 * np.abs(plane[0]).max()

    def test_the_integral_along_the_axis_is_the_line_source_s(self):
        # F(k_0), a half of the integral over z: a line source whose pressure at the head is S f e^(sS) K_0(sS).
        modes = Modes.up_to(40)
        distance = 3.0
        near = distance - 1
        sphere, line = (g(distance).prepare(GRID, modes)(RadialBasis(modes, S), EVERYTHING) for g in (SphericalFrontGeometry, LineGeometry))
        expected = near * kve(0, S * near) * line
        np.testing.assert_allclose(sphere, expected, rtol=1e-12, atol=1e-290)


@pytest.mark.parametrize("k", [0.0, 0.3, 2.0, 15.0, 60.0])
def test_massless_walls_let_the_spherical_wave_pass(water, ring, k):
    # W of a wall that is not there is the wave's own: s^2 W = dp/dr, p = S f e^(sS) eps_m I_m(kappa r) K_m(kappa R0).
    radii, distance = (0.5, 1.0), 3.0
    ghosts = [ring(radius, 1e-3, density=1e-9, youngs_modulus=1e-3) for radius in radii]
    system = cx.System(shells=ghosts, fluids=[water] * 3, source=cx.SphericalWave(distance=distance, pulse=PULSE))
    modes = Modes.up_to(40, k)
    found = modal_spectra(system, GRID, modes)[0]
    kappa, m = modes.kappa(1.0, S), modes.column
    pulse = pulse_transform(PULSE, S, 1 / 1400, 1000 * 1400**2)
    ahead = -(k**2) / (kappa + S)  # s - kappa
    for index, r in enumerate(radii):
        z = kappa * r
        slope = kappa * (ive(m + 1, z) + m / z * ive(m, z)) * np.exp(z.real - z)
        decay = np.exp(ahead * (distance - 1) + kappa * (r - 1))
        expected = (distance - 1) * pulse * modes.neumann * slope * kve(m, kappa * distance) * decay / S**2
        np.testing.assert_allclose(found[index], expected, rtol=1e-9)  # measured 1.8e-13 or less


def test_a_rigid_cylinder_doubles_the_front_at_the_head():
    # Initial value theorem: the sum over all waves of P_m at z = 0 tends to 2 f as s grows; what is left falls as 1/s.
    period, found = 12.0, {}
    k = 2 * np.pi * np.arange(200) / period
    for s in (100.0, 200.0):
        nodes = np.array([s + 0j])
        geometry, waves = SphericalFrontGeometry(3.0), []
        for wavenumber in k:
            modes = Modes.up_to(150, wavenumber)
            waves.append(geometry.prepare(GRID, modes)(RadialBasis(modes, nodes), slice(0, 1)).sum().real)
        found[s] = 2 / period * (waves[0] + 2 * sum(waves[1:]))
    assert found[200.0] == pytest.approx(2.0, abs=0.02)
    assert 2 * found[200.0] - found[100.0] == pytest.approx(2.0, abs=2e-4)


@pytest.mark.parametrize("k", [0.4, 7.0])
def test_reciprocity_between_a_wall_and_a_point_outside(bare, k):
    """The motion of a wall under a source at R0 is the pressure at R0 of a force on that wall, wave by wave.

    With the force F eps_m/(2 pi R_i) (2/L) of every wave: F_i(m, k) = -eps_m C_ni K_m(kappa R0)/(kappa K_m'(kappa) R_i), C_ni the motion of
    the outer shell under a pressure on shell i.
    """
    problem, modes, distance = dimensionless(bare), Modes.up_to(20, k), 2.2
    system = ModalSystem(problem, S, modes)
    at_walls = system.solve(1, SphericalFrontGeometry(distance).prepare(GRID, modes)(system.radial, EVERYTHING))
    kappa, m = modes.kappa(1.0, S), modes.column
    away = (
        kve(m, kappa * distance) / (m / kappa * kve(m, kappa) - kve(m + 1, kappa)) / kappa * np.exp(-(k**2) / (kappa + S) * (distance - 1))
    )
    for index, wall in enumerate(problem.shells):
        outer = system.solve(index, np.ones((modes.count, S.size), complex))[-1]
        expected = -(distance - 1) * modes.neumann * outer * away / wall.radius
        scale = np.abs(expected).max(axis=-1, keepdims=True)
        np.testing.assert_allclose(at_walls[index] / scale, expected / scale, rtol=0, atol=1e-10)
