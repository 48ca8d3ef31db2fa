"""What the energy balance is made of, each against a closed form that shares nothing with it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.special import gammainc, iv

import coaxshell as cx
from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.acoustics.operators import all_orders
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.response.energy.fluids import Sampler, fluid_energy
from coaxshell.response.energy.motion import Motion
from coaxshell.response.energy.work import SurfaceWork
from coaxshell.solver.excitation import SurfaceLoads, incident_on_surface
from coaxshell.solver.interface.absorbers import absorber_set
from coaxshell.solver.scaling import FluidRegion, Problem, dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.solver.structure_spectra import StructureSpectra

M, GRID = 3, LaplaceGrid(0.25, 1600)
SLOW = 30.0
"""Time constant of the walls' motion, in transits."""


def run_of(problem: Problem) -> Any:
    """Return what stands in for a run of which only the transforms are looked at."""
    return SimpleNamespace(problem=problem, settings=Settings(modes=M))


def spectra_of(problem: Problem, normal: np.ndarray) -> SolvedSpectra:
    """Return the transforms of a run without absorbers in which the walls have no tangential motion."""
    structure, nothing = StructureSpectra(problem, GRID, Modes.up_to(M)), np.zeros((0, 2, GRID.time.size))
    return SolvedSpectra(structure, absorber_set(problem, (), 1), normal, np.zeros_like(normal), None, nothing, nothing[:, 0])


@pytest.fixture
def moved(double: cx.System) -> Callable[[dict[tuple[int, int, int], float]], Motion]:
    """Return a maker of slow motions x(t) = (t/SLOW)^4 e^{-t/SLOW} of given (shell, half, order), fluids of odd density and speed."""

    def make(amplitudes: dict[tuple[int, int, int], float]) -> Motion:
        problem = replace(dimensionless(double), fluids=(FluidRegion(0.7, 1.3), FluidRegion(1.9, 0.8), FluidRegion(1.0, 1.0)))
        normal = np.zeros((2, 2, M + 1, GRID.nodes.size), np.complex128)
        for place, amplitude in amplitudes.items():
            normal[place] = amplitude * 24.0 / SLOW**4 / (GRID.nodes + 1 / SLOW) ** 5
        spectra = spectra_of(problem, normal)
        return Motion.of(run_of(problem), 10, spectra)

    return make


def slow_history() -> tuple[np.ndarray, np.ndarray]:
    t = GRID.time[::10] / SLOW
    return t**4 * np.exp(-t), (4 * t**3 - t**4) * np.exp(-t) / SLOW


def test_a_disc_squeezed_slowly_is_a_spring(moved) -> None:
    # Area change 2 w/r1 everywhere: E = (1/2)(rho/alpha^2)(2 w/r1)^2 pi r1^2, up to inertia of order (transit/SLOW)^2.
    found = fluid_energy(moved({(0, 0, 0): 1e-3}), 0)
    w = 1e-3 * slow_history()[0]
    np.testing.assert_allclose(found.compression, 2 * np.pi * 0.7 / 1.3**2 * w**2, rtol=0, atol=1e-5 * found.compression.max())
    assert found.kinetic.max() < 1e-4 * found.compression.max()


def test_a_gap_squeezed_slowly_is_a_spring(moved) -> None:
    found = fluid_energy(moved({(0, 0, 0): -1e-3, (1, 0, 0): 2e-3}), 1)
    ra, area = 0.5, np.pi * (1 - 0.5**2)
    strain = 2 * np.pi * (2e-3 * 1.0 + 1e-3 * ra) * slow_history()[0] / area
    expected = 0.5 * 1.9 / 0.8**2 * strain**2 * area
    np.testing.assert_allclose(found.compression, expected, rtol=0, atol=1e-5 * expected.max())


@pytest.mark.parametrize("half", [0, 1])
def test_a_disc_shaken_slowly_moves_as_one_body(moved, half: int) -> None:
    found = fluid_energy(moved({(0, half, 1): 1e-3}), 0)
    expected = 0.5 * 0.7 * np.pi * 0.5**2 * (1e-3 * slow_history()[1]) ** 2
    np.testing.assert_allclose(found.kinetic, expected, rtol=0, atol=3e-3 * expected.max())


def test_a_gap_shaken_slowly_has_the_added_mass_of_potential_flow(moved) -> None:
    # Outer wall m = 2, inner at rest: potential b r^2 + c r^-2; kinetic energy from the wall's pressure, (1/2) rho pi v^2 phi(1)/phi'(1).
    found = fluid_energy(moved({(1, 0, 2): 1e-3}), 1)
    q = 0.5**4
    expected = 0.5 * 1.9 * np.pi * (1e-3 * slow_history()[1]) ** 2 * (1 + q) / (2 * (1 - q))
    np.testing.assert_allclose(found.kinetic, expected, rtol=0, atol=1e-3 * expected.max())


def test_a_vacuum_holds_nothing(double: cx.System) -> None:
    problem = dimensionless(double.replace(fluids=[cx.VACUUM, double.fluids[1], double.fluids[2]]))
    empty = np.zeros((2, 1, M + 1, GRID.nodes.size), np.complex128)
    motion = Motion.of(run_of(problem), 10, spectra_of(problem, empty))
    assert fluid_energy(motion, 0) is None


def test_more_radii_change_nothing(moved) -> None:
    motion = moved({(0, 0, 1): 1e-3, (1, 1, 3): 1e-3})
    for region in (0, 1):
        few, many = fluid_energy(motion, region), fluid_energy(motion, region, radii=90)
        np.testing.assert_allclose(few.kinetic, many.kinetic, rtol=0, atol=1e-12 * many.kinetic.max())


@pytest.mark.parametrize("steps", [300, 333])
def test_work_is_exact(steps: int) -> None:
    # p = t^4 e^{-t}/24, v = t^4 e^{-2t}/24: integral of t^8 e^{-3t}/576.
    grid = LaplaceGrid(0.02, steps)
    s = grid.nodes
    pressure, velocity = (np.zeros((2, 4, s.size), np.complex128) for _ in range(2))
    pressure[1, 2], velocity[1, 2] = (s + 1) ** -5.0, (s + 2) ** -5.0
    found = SurfaceWork(grid, np.array([1.0, 1.0, 2.5, 1.0]), velocity)(pressure)
    exact = 2.5 * 40320 / 3**9 / 576 * gammainc(9, 3 * grid.time)
    np.testing.assert_allclose(found, exact, rtol=0, atol=1e-9 * exact.max())


@pytest.mark.parametrize("every", [1, 3, 7, 10, 64])
def test_sampling_is_inverting_and_leaving_out(every: int) -> None:
    grid = LaplaceGrid(0.02, 333)
    spectrum = np.stack([(grid.nodes + 1) ** -3.0, np.exp(-grid.nodes) * (grid.nodes + 2) ** -4.0])
    sampler = Sampler(grid, every)
    weight = grid.taper() * np.where(grid.nodes.imag > 0, 2.0, 1.0)
    sums = np.zeros((2, sampler.length), np.complex128)
    for block in sampler.blocks(grid.nodes.size, 50):
        sampler.add(sums, spectrum[:, block] * weight[block], block)
    np.testing.assert_allclose(sampler.finish(sums), grid.invert(spectrum)[:, ::every], rtol=1e-9, atol=1e-12)


ORDERS = all_orders(12)
COARSE = LaplaceGrid(0.02, 200)


def parts(system: cx.System) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    problem, radial = dimensionless(system), RadialBasis(Modes(ORDERS), COARSE.nodes)
    total = np.stack(SurfaceLoads(problem, COARSE, radial.modes)(radial, slice(None)))
    incident, slope = incident_on_surface(problem, COARSE, radial)
    return incident, -radial.surface.exterior * slope, total


def test_the_incident_part_of_a_plane_wave(double: cx.System) -> None:
    step = cx.PlaneWave(pulse={"type": "step", "pressure": 1.0})
    incident, scattered, total = parts(double.replace(source=step))
    s = COARSE.nodes[:60]
    scale = dimensionless(double).scales.pressure
    exact = np.where(ORDERS == 0, 1, 2)[:, None] * np.exp(-s) * iv(ORDERS[:, None], s) / s / scale
    np.testing.assert_allclose(incident[0, :, :60], exact, rtol=1e-12, atol=1e-14 * abs(exact).max())
    np.testing.assert_allclose(incident + scattered, total, rtol=1e-12, atol=1e-18)


def test_a_distant_spherical_source_is_a_plane_wave(double: cx.System) -> None:
    shock = {"peak_pressure": 1e5, "decay_time": 1e-4}
    plane = parts(double.replace(source=cx.PlaneShock(**shock)))
    far = parts(double.replace(source=cx.SphericalShock(distance=1e4, **shock)))
    for one, other in zip(plane, far, strict=True):
        # Fronts differ by at most r^2/(2 R0); compare where that is far less than a wave.
        np.testing.assert_allclose(one[..., :60], other[..., :60], rtol=0, atol=3e-4 * abs(one).max())


def test_parts_of_sources_of_all_kinds_add_up(double: cx.System) -> None:
    shock = {"peak_pressure": 1e5, "decay_time": 1e-4}
    sources = [cx.PlaneShock(angle=20.0, **shock), cx.SphericalShock(distance=4.0, **shock), cx.LineShock(distance=3.0, **shock)]
    incident, scattered, total = parts(double.replace(source=sources))
    assert incident.shape == total.shape == (2, ORDERS.size, COARSE.nodes.size)
    np.testing.assert_allclose(incident + scattered, total, rtol=1e-10, atol=1e-14 * abs(total).max())
