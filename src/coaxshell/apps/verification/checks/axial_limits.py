"""What an axial wavenumber must leave as it is, wave by wave: two dimensions, an undisturbed wave, a doubled front, reciprocity."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.special import ive, kve

from coaxshell.acoustics.basis import RadialBasis
from coaxshell.acoustics.pulse_transforms import pulse_transform
from coaxshell.acoustics.radial_fields import exterior_field
from coaxshell.acoustics.sources import LineGeometry, SphericalFrontGeometry
from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.modal import modal_spectra
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Finding, close, within
from coaxshell.apps.verification.systems import BROAD, GAINS, SMOOTH_SPHERE, WATER, thin_shell
from coaxshell.model import presets
from coaxshell.model.system import System
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.scaling import dimensionless

GRID = LaplaceGrid(0.02, 250)
S, EVERYWHERE = GRID.nodes, slice(0, GRID.nodes.size)
DISTANCE = SMOOTH_SPHERE.distance
START = DISTANCE - 1.0
WAVENUMBERS = (0.0, 0.3, 2.0, 15.0, 60.0)
THEORY = "theory 4"
PER_WAVE = "relative, largest of all waves and nodes"


@check("axial-limits", "Limits of an axial wavenumber")
def axial_limits(bench: Bench) -> Iterator[Finding]:
    """Compare single waves (m, k) of three dimensions with what they must be, at every order to 40 and Laplace node.

    Two dimensions as k tends to 0; a line source at k = 0, which is the integral along the axis; the spherical wave itself through massless
    walls; a front at the head of a rigid cylinder; and reciprocity between a wall and a point outside.
    """
    bare = presets.load("bare").replace(source=SMOOTH_SPHERE)
    for name, system in {"bare": bare, "active control": bare.replace(control=GAINS)}.items():
        yield within(f"{name}: ka = 1e-9 against k = 0, W and V", THEORY, "the same", vanishing(system), 1e-12, measure=PER_WAVE)
    yield within("load at k = 0: a line source with the history K_0", THEORY, "the same", line_source(), 1e-12, measure=PER_WAVE)
    for k in WAVENUMBERS:
        what = f"massless walls, ka = {k:g}: motion of both as in the free wave"
        yield within(what, "closed form, free field", "the wave itself", transparency(k), 1e-9, measure=PER_WAVE)
    bench.done(0.6)
    doubled = 2 * front_at_head(200.0) - front_at_head(100.0)
    yield close("rigid cylinder, head, all waves added up: pressure at the front over that of the wave", THEORY, 2.0, doubled, 1e-3)
    bench.done(0.9)
    for k in (0.4, 7.0):
        what = f"reciprocity of a wall and a point at 3 a, ka = {k:g}"
        yield within(what, "reciprocity", "the same", reciprocity(bare, k), 1e-10, measure=PER_WAVE)
        what = f"reciprocity of points at 3 a and 1.4 a, ka = {k:g}: the scattered wave of one source at the place of the other"
        yield within(what, "reciprocity", "the same", reciprocity_outside(bare, k), 1e-10, measure=PER_WAVE)


def vanishing(system: System) -> float:
    """Return how far W and V at ka = 1e-9 are from two dimensions, of the largest of each order."""
    plane, nearly = (modal_spectra(system, GRID, Modes.up_to(40, k))[:2] for k in (0.0, 1e-9))
    size = np.abs(plane).max(axis=-1, keepdims=True)
    return float((np.abs(nearly - plane) / np.where(size, size, 1.0)).max())


def line_source() -> float:
    """Return how far the load at k = 0 is from S e^(sS) K_0(sS) times that of a line source of unit pressure at the head."""
    basis = RadialBasis(Modes.up_to(40), S)
    sphere, line = (geometry(DISTANCE).prepare(GRID, basis.modes)(basis, EVERYWHERE) for geometry in (SphericalFrontGeometry, LineGeometry))
    return float(np.abs(sphere / (START * kve(0, S * START) * line) - 1).max())


def transparency(k: float) -> float:
    """Return how far massless walls are from s^2 W = dp/dr of the wave p = S f e^(sS) eps_m I_m(kappa r) K_m(kappa R0)."""
    radii = (0.5, 1.0)
    ghosts = [thin_shell(radius, 1e-3, density=1e-9, youngs_modulus=1e-3) for radius in radii]
    system, modes = System(shells=ghosts, fluids=[WATER] * 3, source=SMOOTH_SPHERE), Modes.up_to(40, k)
    pulse = pulse_transform(BROAD, S, 1 / 1400, WATER.density * WATER.sound_speed**2)
    kappa, m = _kappa(k), modes.column
    found = []
    for r, normal in zip(radii, modal_spectra(system, GRID, modes)[0], strict=True):
        z = kappa * r
        slope = kappa * (ive(m + 1, z) + m / z * ive(m, z)) * np.exp(z.real - kappa)  # I_m'(kappa r) e^(-kappa)
        wave = START * pulse * modes.neumann * slope * _at_source(modes.column, k) / S**2
        found.append(np.abs(normal / wave - 1).max())
    return float(max(found))


def _kappa(k: float) -> ComplexArray:
    """Return sqrt(s^2 + k^2), by itself."""
    return np.sqrt(S - 1j * k) * np.sqrt(S + 1j * k)


def _at_source(m: FloatArray, k: float) -> ComplexArray:
    """Return e^(sS) K_m(kappa R0) e^kappa: bounded, s - kappa being -k^2/(kappa + s)."""
    kappa = _kappa(k)
    return np.asarray(kve(m, kappa * DISTANCE) * np.exp(-(k**2) / (kappa + S) * START))


def front_at_head(s: float) -> float:
    """Return the pressure at the head of a rigid cylinder over that of the wave at a real s: 2 - O(1/s)."""
    period, geometry, waves = 12.0, SphericalFrontGeometry(DISTANCE), []
    for k in 2 * np.pi * np.arange(200) / period:
        modes = Modes.up_to(150, float(k))
        waves.append(geometry.prepare(GRID, modes)(RadialBasis(modes, np.array([s + 0j])), slice(0, 1)).sum().real)
    return float(2 / period * (waves[0] + 2 * sum(waves[1:])))


def reciprocity(system: System, k: float) -> float:
    """Return how far the motion of walls under a source at R0 is from the pressure there of a force on them.

    Wall i moves by -S e^(sS) eps_m C_ni K_m(kappa R0)/(kappa K_m'(kappa) R_i), C_ni the motion of the outer wall per pressure on wall i.
    """
    problem, modes = dimensionless(system), Modes.up_to(20, k)
    modal = ModalSystem(problem, S, modes)
    moved = modal.solve_outside(SphericalFrontGeometry(DISTANCE).prepare(GRID, modes)(modal.radial, EVERYWHERE))
    kappa, m = _kappa(k), modes.column
    radiated = _at_source(m, k) / (m * kve(m, kappa) - kappa * kve(m + 1, kappa))
    found = []
    for i, wall in enumerate(problem.shells):
        expected = -START * modes.neumann * modal.solve(i, 1.0)[-1] * radiated / wall.radius
        size = np.abs(expected).max(axis=-1, keepdims=True)
        found.append((np.abs(moved[i] - expected) / size).max())
    return float(max(found))


def reciprocity_outside(system: System, k: float) -> float:
    """Return how far the wave that walls scatter of a source at 3 a, at 1.4 a, is from that of an equal source at 1.4 a, at 3 a."""
    problem, modes, places = dimensionless(system), Modes.up_to(20, k), (DISTANCE, 1.4)
    modal = ModalSystem(problem, S, modes)
    scattered = []
    for source, point in (places, places[::-1]):
        geometry, start = SphericalFrontGeometry(source), source - 1.0
        moved = modal.solve_outside(geometry.prepare(GRID, modes)(modal.radial, EVERYWHERE))[-1]
        slope = S**2 * moved - geometry.incident(GRID, modal.radial)[1]
        scattered.append(slope * exterior_field(modal.radial(1.0, point), modal.radial.surface).pressure / start * np.exp(-S * start))
    size = np.abs(scattered[0]).max(axis=-1, keepdims=True)
    return float((np.abs(scattered[1] - scattered[0]) / size).max())
