"""What a field must obey: motion of the walls, balance of the shells, the wave and Euler's equations, transparency, causality."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.acoustics.operators import all_orders
from coaxshell.acoustics.radial_fields import annulus_field, disc_field, exterior_field
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.radial_functions import RadialFunctions
from coaxshell.response import Response
from coaxshell.response.fields.modal_field import modal_field
from coaxshell.response.fields.request import regions
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.excitation import SurfaceLoads

STEP, M = 2e-3, 48
A, C, RHO = 1.0, 1400.0, 1000.0
FINE = {"time_resolution": STEP}
ANGLES = np.array([0.0, 37.0, 90.0, 151.0, 180.0, 260.0])


def smooth(angle: float = 0.0, width: float = 0.13) -> cx.PlaneWave:
    """Return a plane Gaussian that neither the orders nor the band can miss."""
    pulse = cx.Gaussian(peak_pressure=2.5e4, width=width * A / C)
    return cx.PlaneWave(angle=angle, pulse=pulse)


@pytest.fixture(scope="module")
def shells(ring):
    return [ring(0.5, 8e-3), ring(A, 1e-2)]


@pytest.fixture(scope="module")
def sea(water):
    """Return another fluid for the gap, slower and lighter than the water around."""
    return cx.Fluid(density=800, sound_speed=1100)


@pytest.fixture(scope="module")
def answer(shells, water, sea) -> Response:
    system = cx.System(shells=shells, fluids=[water, sea, water], source=smooth(angle=25.0))
    return cx.simulate(system, duration=2.0, time_step=STEP, modes=M)


def inside(radius: float) -> float:
    return float(np.nextafter(radius, 0.0))


def motion(answer: Response, shell: int, derivatives: int, time: np.ndarray) -> np.ndarray:
    """Return the derivatives of w in time at ANGLES, SI, from the spectra, (times, angles)."""
    spectra = answer.motion.spectra
    history = spectra.grid.invert(spectra.normal[shell] * spectra.grid.nodes**derivatives)
    theta, m = np.radians(ANGLES)[:, None], np.arange(M + 1)
    w = np.cos(theta * m) @ history[0] + np.sin(theta * m) @ history[1]
    at = np.rint(time / STEP).astype(int)
    return w[:, at].T * A / (A / C) ** derivatives


TIME = np.array([0.3, 0.8, 1.3, 1.9])


@pytest.mark.parametrize("shell", [0, 1])
def test_the_fluid_moves_with_the_shell_on_both_faces(answer, shell):
    radius = (0.5, 1.0)[shell]
    velocity = answer.velocity(radius=[inside(radius), radius], angle=ANGLES, time=TIME, **FINE)
    wanted = -motion(answer, shell, 1, TIME)
    for face in (0, 1):
        found = velocity.sel(component="radius").values[:, face]
        np.testing.assert_allclose(found, wanted, rtol=0, atol=3e-7 * abs(wanted).max())


@pytest.mark.parametrize("shell", [0, 1])
def test_the_normal_acceleration_is_that_of_the_shell_on_both_faces(answer, shell):
    # From the pressure's slope, dp/dr = rho d2w/dt2, by differences of fourth order into either fluid.
    radius, h = (0.5, 1.0)[shell], 2e-3
    wanted = motion(answer, shell, 2, TIME)
    weights = np.array([-25.0, 48.0, -36.0, 16.0, -3.0]) / 12.0
    for side, density in ((-1, (1000.0, 800.0)[shell]), (1, (800.0, 1000.0)[shell])):
        radii = np.sort(radius + side * h * np.arange(5))
        radii[radii == radius] = radius if side > 0 else inside(radius)
        p = answer.pressure(radius=radii, angle=ANGLES, time=TIME, **FINE).values
        slope = side * np.tensordot(weights if side > 0 else weights[::-1], p, (0, 1)) / h / A
        np.testing.assert_allclose(slope / density, wanted, rtol=0, atol=2e-6 * abs(wanted).max())


@pytest.mark.parametrize("shell", [0, 1])
def test_the_pressure_jump_is_the_shells_load(answer, shell):
    # I w'' + K (v, w) = p outside - p inside, order by order; orders summed at angles.
    spectra, problem = answer.motion.spectra, answer.solution.problem
    radius, grid, m = (0.5, 1.0)[shell], spectra.grid, all_orders(M)
    stiffness = problem.shells[shell].stiffness(Modes(m))
    inertia = problem.shells[shell].mass * grid.nodes**2
    load = (inertia + stiffness.ww[:, None]) * spectra.normal[shell] + stiffness.vw[:, None] * spectra.tangential[shell]
    history = grid.invert(load)[..., np.rint(TIME / STEP).astype(int)] * RHO * C**2
    theta = np.radians(ANGLES)[:, None] * m
    wanted = (np.cos(theta) @ history[0] + np.sin(theta) @ history[1]).T
    p = answer.pressure(radius=[inside(radius), radius], angle=ANGLES, time=TIME, **FINE).values
    np.testing.assert_allclose(p[:, 1] - p[:, 0], wanted, rtol=0, atol=2e-7 * abs(p).max())


def test_order_by_order_walls_and_loads_agree_in_the_laplace_domain(shells, water, sea):
    # A sharp shock, every order and node: slopes are (rho/rho_e) s^2 W on every face, jumps are Z W.
    source = cx.SphericalShock(distance=5.0, peak_pressure=2.5e4, decay_time=1.314e-4)
    answer = cx.simulate(cx.System(shells=shells, fluids=[water, sea, water], source=source), duration=1.0, time_step=5e-3, modes=30)
    spectra, problem = answer.motion.spectra, answer.solution.problem
    grid, ones = spectra.grid, np.ones(spectra.grid.nodes.size)
    modal = ModalSystem(problem, grid.nodes, Modes.up_to(30))
    incident_and_diffracted = SurfaceLoads(problem, grid, modal.modes)(modal.radial, slice(None))[0]
    pressures = {}
    for region in regions(problem):
        field = modal_field(spectra, grid, region, "radiated")
        for shell, radius in ((region.index - 1, region.inner), (region.index, region.outer)):
            if 0 < radius < np.inf:
                for quantity in ("pressure", "slope"):
                    rows = [x[0, 0] for _, x in field.spectra(np.array([radius]), quantity, ones)]
                    pressures[region.index, shell, quantity] = np.stack(rows)
                wanted = region.fluid.density * grid.nodes**2 * spectra.normal[shell, 0]
                found = pressures[region.index, shell, "slope"]
                np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-12 * abs(wanted).max())
    for shell, outside in ((0, 0.0), (1, incident_and_diffracted)):
        jump = pressures[shell + 1, shell, "pressure"] + outside - pressures[shell, shell, "pressure"]
        wanted = modal.shells[shell].impedance * spectra.normal[shell, 0]
        np.testing.assert_allclose(jump, wanted, rtol=0, atol=1e-12 * abs(wanted).max())


def test_the_diffracted_wave_cancels_the_incident_velocity_at_a_rigid_wall(answer):
    parts = {"time": TIME, "angle": ANGLES, "radius": 1.0, **FINE}
    velocity = sum(answer.velocity(part=part, **parts).sel(component="radius").values for part in ("incident", "diffracted"))
    scale = abs(answer.velocity(part="incident", **parts).values).max()
    np.testing.assert_allclose(velocity, 0.0, atol=2e-7 * scale)


@pytest.mark.parametrize(("radius", "speed"), [(0.2, 1400.0), (0.7, 1100.0), (1.6, 1400.0)])
def test_the_wave_equation_holds_in_every_fluid(answer, radius, speed):
    # Second differences in space and time; the residual falls with the square of the step.
    residuals = []
    t, slowness = 1.303, (C / speed) ** 2
    for h in (8e-3, 4e-3):
        theta = 40.0 + np.degrees(h) * np.arange(-1, 2)
        p = answer.pressure(radius=radius + h * np.arange(-1, 2), angle=theta, time=t + h * np.arange(-1, 2), **FINE).values
        middle = p[1, 1, 1]
        in_time = (p[2, 1, 1] - 2 * middle + p[0, 1, 1]) / h**2
        radial = (p[1, 2, 1] - 2 * middle + p[1, 0, 1]) / h**2 + (p[1, 2, 1] - p[1, 0, 1]) / (2 * h * radius)
        around = (p[1, 1, 2] - 2 * middle + p[1, 1, 0]) / (h * radius) ** 2
        residuals.append(abs(radial + around - slowness * in_time) / (abs(radial) + abs(around) + abs(in_time)))
    assert residuals[1] < 5e-4
    assert residuals[0] / residuals[1] > 3.0


def test_velocity_obeys_eulers_equation(answer):
    h, t = 2e-3, np.array([0.9, 1.4])
    for x, y, density in ((0.2, 0.1, 1000.0), (-0.3, 0.65, 800.0), (1.2, -0.9, 1000.0)):
        v = [answer.velocity(x=x, y=y, time=t + d, **FINE).values[:, :, 0, 0] for d in (-h, h)]
        p = [answer.pressure(x=x + np.array([-h, 0, h]), y=y + np.array([-h, 0, h]), time=t, **FINE).values]
        gradient = np.stack([p[0][:, 1, 2] - p[0][:, 1, 0], p[0][:, 2, 1] - p[0][:, 0, 1]], axis=1) / (2 * h * A)
        rate = (v[1] - v[0]) / (2 * h * A / C)
        np.testing.assert_allclose(density * rate, -gradient, rtol=0, atol=3e-4 * abs(gradient).max())


@pytest.mark.parametrize("source", ["plane", "line"])
def test_shells_without_mass_or_stiffness_are_not_there(ring, water, source):
    ghosts = [ring(r, 1e-4, density=1e-6, youngs_modulus=1e-3) for r in (0.5, 1.0)]
    kinds = {"plane": cx.PlaneShock, "line": lambda **k: cx.LineShock(distance=5.0, **k)}
    shock = kinds[source](peak_pressure=1.0, decay_time=1.314e-4)
    answer = cx.simulate(cx.System(shells=ghosts, fluids=[water] * 3, source=shock), duration=3.0, time_step=5e-3, modes=200)
    grid = {"radius": [0.0, 0.2, 0.45, 0.7, 0.9, 1.0, 1.5, 3.0], "angle": np.arange(0, 360, 20.0), "time": [0.4, 0.9, 1.5, 2.6]}
    found = answer.pressure(filter="exponential", **grid)
    r, theta, t = np.array(grid["radius"])[:, None], np.radians(grid["angle"]), np.array(grid["time"])[:, None, None]
    x, y = r * np.cos(theta), r * np.sin(theta)
    path = 1.0 - x if source == "plane" else np.hypot(x - 5.0, y) - 4.0
    since = t - path
    far = abs(since) > 0.15
    if source == "plane":
        free = np.where(since >= 0, np.exp(-since / (1.314e-4 * C)), 0.0)
    else:  # the same wave around nothing: the reach of the incident part is everywhere outside a tiny shell
        tiny = cx.System(shells=[ring(1.0, 1e-2)], fluids=["vacuum", water], source=shock)
        free = cx.simulate(tiny, duration=3.0, time_step=5e-3, modes=2).pressure(part="incident", **grid).values
        far &= r >= 1.0
    assert abs(found.values - free)[far].max() < 1e-5
    outside = np.broadcast_to(r >= 1.0, far.shape)
    assert abs(found.values - free)[outside & far].max() < 1e-10


def test_nothing_outruns_the_fastest_wave(answer):
    # Ahead of the incident front outside, and inside before anything can have crossed the shells' circumference.
    early = answer.pressure(radius=[1.5, 2.5], angle=[25.0, 205.0], time=0.2, part="scattered", **FINE).values
    assert abs(early).max() < 1e-6
    assert abs(answer.pressure(x=0.0, y=0.0, time=0.1, **FINE).values).max() < 1e-6


def test_fast_transfer_equals_the_slow_one(answer):
    spectra, ones = answer.motion.spectra, np.ones(61)
    grid = LaplaceGrid(spectra.grid.period / 120, 59, fewest=0)
    np.testing.assert_allclose(grid.nodes, spectra.grid.nodes[:61], rtol=1e-12)
    orders = all_orders(M)
    for region, radius in zip(regions(spectra.problem), (0.31, 0.77, 2.2), strict=True):
        kappa = region.fluid.slowness * grid.nodes
        here, inner, outer = (RadialFunctions(kappa, r, orders) for r in (radius, region.inner or 1.0, min(region.outer, 9.0)))
        if region.index == 1:
            fields = annulus_field(here, inner, outer)
        else:
            fields = (exterior_field(here, inner),) if region.exterior else (disc_field(here, outer),)
        walls = [i for i in (region.index - 1, region.index) if 0 <= i < 2]
        field = modal_field(spectra, grid, region, "radiated")
        slopes = [region.fluid.density * grid.nodes**2 * spectra.normal[i, :, :, :61] for i in walls]
        for quantity in ("pressure", "slope"):
            found = np.stack([x[:, 0] for _, x in field.spectra(np.array([radius]), quantity, ones)], axis=1)
            wanted = sum(getattr(f, quantity) * g for f, g in zip(fields, slopes, strict=True))
            np.testing.assert_allclose(found, wanted, rtol=1e-12, atol=1e-11 * abs(wanted).max())
