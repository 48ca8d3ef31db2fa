"""What the independent solver makes of an axial wavenumber: its walls, its spherical wave, its order in the time step."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.special import ive, kve

import coaxshell as cx
from coaxshell.acoustics.pulse_transforms import pulse_transform
from coaxshell.apps.verification.independent import RadialElements
from coaxshell.apps.verification.independent.sphere import incident_sphere
from coaxshell.apps.verification.independent.walls import Wall, strains
from coaxshell.numerics.laplace_grid import LaplaceGrid

TRANSIT, PRESSURE = 1 / 1400, 1000 * 1400**2
PULSE = cx.Gaussian(peak_pressure=2.5e4, width=0.1 * TRANSIT)


def frequencies(m, k):
    """Return the natural frequencies (Hz) of a dry steel shell, R = 1 m, h = 20 mm."""
    steel = cx.Elastic(name="steel", density=7800, youngs_modulus=210e9, poisson_ratio=0.3)
    wall = Wall.of(cx.Shell(radius=1.0, layers=[cx.Layer(steel, 0.02)]))
    return np.sqrt(np.linalg.eigvalsh(wall.stiffness(m, k)) / wall.inertia) / (2 * np.pi)


def test_frequencies_of_a_thin_steel_shell():
    # Of a second derivation.
    np.testing.assert_allclose(frequencies(2, 1.0), [147.06160744, 1203.7362975, 2082.8206866], rtol=1e-10)
    np.testing.assert_allclose(frequencies(1, 0.1)[0], 5.7596941819, rtol=1e-9)


@pytest.mark.parametrize("depth", [0.0, 0.04])
def test_a_tilt_about_the_origin_is_free_of_strain(depth):
    # sin k(z - pi/2k)/k -> z: the section at z moves sideways by z, each point of it along the axis by its lever.
    k, radius = 1e-4, 0.7
    mid, slope = strains(1, k, radius)
    strain = (mid + depth * slope) @ np.array([1 / k, 1 / k, -radius])  # V, W, U of that motion
    np.testing.assert_allclose(strain, 0.0, atol=2 * k)


@pytest.mark.parametrize("k", [0.0, 1.0, 6.0])
def test_spherical_wave_by_quadrature_against_its_transform(k):
    # S f e^(sS) eps_m I_m(kappa) K_m(kappa R0) and its slope; measured 1.4e-10 or less.
    grid, distance, orders = LaplaceGrid(2e-3, 1500), 3.0, (0, 1, 5)
    at = slice(None, None, 50)
    pressure, velocity = incident_sphere(PULSE, distance, k, orders, grid.time[at], TRANSIT, PRESSURE)
    s = grid.nodes
    kappa = np.sqrt(s - 1j * k) * np.sqrt(s + 1j * k)
    start = (distance - 1) * pulse_transform(PULSE, s, TRANSIT, PRESSURE) * np.exp((distance - 1) * s)
    for row, m in enumerate(orders):
        behind = start * (1 if m == 0 else 2) * kve(m, kappa * distance) * np.exp(kappa.real - kappa * distance)
        slope = kappa * (ive(m + 1, kappa) + m / kappa * ive(m, kappa))
        for found, spectrum in ((pressure, behind * ive(m, kappa)), (velocity, -behind * slope / s)):
            expected = grid.invert(spectrum)[at]
            np.testing.assert_allclose(found[row], expected, rtol=0, atol=5e-10 * np.abs(expected).max())


def test_other_pulses_are_refused():
    with pytest.raises(NotImplementedError, match="Gaussian"):
        incident_sphere(cx.Step(pressure=1.0), 3.0, 1.0, (0,), np.zeros(1), TRANSIT, PRESSURE)


@pytest.mark.slow
def test_order_in_the_time_step():
    # Gauss's method of two stages: 4, in all three displacements.
    system = cx.presets.load("bare").replace(source=cx.SphericalWave(distance=3.0, pulse=PULSE))
    steps = (1.6e-2, 8e-3, 4e-3, 2e-3)
    found = [RadialElements(system, 2, 1.2, wavenumber=3.0).solve(step, round(1.2 / step)) for step in steps]
    for name in ("w", "v", "u"):
        histories = [getattr(one, name)[..., :: round(1.6e-2 / one.time[1])] for one in found]
        errors = [np.linalg.norm(one - histories[-1]) for one in histories[:-1]]
        rates = np.log2([a / b for a, b in pairwise(errors)])
        assert rates == pytest.approx(4.0, abs=0.2), name
