"""Walls of elastic solids: an independent solution of thick walls, Lame's, the series of an elastic tube, balances, reciprocity."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np
from scipy.special import h1vp, hankel1, jv, jvp, yv, yvp

from coaxshell.apps.verification.bench import Bench, elastic_thick
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Finding, close, distance, within
from coaxshell.apps.verification.systems import BROAD, SMOOTH, WATER
from coaxshell.model import presets
from coaxshell.model.elastic import Elastic
from coaxshell.model.fluids import VACUUM
from coaxshell.model.layers import Layer
from coaxshell.model.pulses import Gaussian
from coaxshell.model.shells import Shell
from coaxshell.model.sources import PlaneWave, SphericalShock, SphericalWave
from coaxshell.model.system import System
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.modes import Modes
from coaxshell.response.frequency import frequency_response
from coaxshell.response.spatial import SpatialResponse
from coaxshell.solver.scaling import dimensionless
from coaxshell.structure.elastic_wall import Asked, ElasticWall

STEEL = Elastic(name="steel", density=7800, youngs_modulus=210e9, poisson_ratio=0.3)
INDEPENDENT = "reference/elastic_thick_plane.npz: finite elements through the walls, other fluids"
ANGLES = (0.0, 60.0, 180.0)
INNER, OUTER = 0.9, 1.1
"""Faces of the tube of the closed forms, m."""


def thick(radius: float, thickness: float) -> Shell:
    """Return a wall of steel as an elastic solid."""
    return Shell(radius=radius, layers=[Layer(STEEL, thickness)], theory="elastic")


@check("exact-walls", "Walls of elastic solids")
def exact_walls(bench: Bench) -> Iterator[Finding]:
    """Compare thick walls of steel, 30 mm at R = 0.5 and 50 mm at R = 1, and a tube of a tenth of its radius, with other solutions.

    Losses and rubber by their balance of energy, in two dimensions and over the whole length in three; two points by reciprocity.
    """
    parts = (_histories, _lame, _backscatter, _balance, *bench.choose((), (_balance_in_space, _reciprocity)))
    for number, part in enumerate(parts):
        yield from part(bench)
        bench.done((number + 1) / len(parts))


def _histories(bench: Bench) -> Iterator[Finding]:
    known, duration = elastic_thick(), bench.choose(1.5, 3.0)
    walls = System(shells=[thick(0.5, 0.03), thick(1.0, 0.05)], fluids=[WATER] * 3, source=PlaneWave(pulse=BROAD))
    response = bench.simulate(walls, duration=duration, time_step=4e-3, modes=60)
    instants = np.searchsorted(response.time, known["t"][known["t"] <= duration] - 1e-9)
    reads: dict[str, Callable[..., Any]] = {"w": response.displacement, "hoop": response.stress}
    reads["axial"] = partial(response.stress, component="axial")
    labels = {"w": "normal displacement", "hoop": "hoop stress", "axial": "axial stress"}
    for shell, place in enumerate(("inner", "outer")):
        for name, read in reads.items():
            found = np.asarray(read(shell, angle=ANGLES))[instants].T
            error = distance(found, known[name][shell, 0, :, : instants.size])
            yield within(f"{labels[name]} in the middle, {place} wall, 0, 60 and 180°", INDEPENDENT, "the other method's", error, 1e-7)


def tube() -> System:
    """Return an evacuated tube in water."""
    source = PlaneWave(pulse=SMOOTH)
    return System(shells=[thick(0.5 * (INNER + OUTER), OUTER - INNER)], fluids=[VACUUM, WATER], source=source)


def _lame(bench: Bench) -> Iterator[Finding]:
    """Yield displacement and hoop stress of the tube under a pressure outside: u = A r + B/r in plane strain."""
    problem = dimensionless(tube())
    (wall,) = problem.shells
    assert isinstance(wall, ElasticWall)
    shear = STEEL.youngs_modulus / (2.0 * (1.0 + STEEL.poisson_ratio))
    share = OUTER**2 / (OUTER**2 - INNER**2)
    spread, twist = -(1.0 - 2.0 * STEEL.poisson_ratio) * share / (2.0 * shear), -share * INNER**2 / (2.0 * shear)
    moved, stressed = (
        wall.transfer(Modes.up_to(0), np.array([1e-6 + 0j]), [Asked(what, INNER - wall.radius)])[0, 1, 0, 0].real
        for what in ("normal", "hoop")
    )
    source, scales = "Lamé, plane strain", problem.scales
    expected = -(spread * INNER + twist / INNER)
    per_pressure = moved * scales.length / scales.pressure
    yield close("tube, displacement inward of the inner face per pressure", source, expected, per_pressure, 1e-8, unit="m/Pa")
    yield close("tube, hoop stress of the inner face per pressure", source, -2.0 * share, stressed, 1e-8)


def _backscatter(bench: Bench) -> Iterator[Finding]:
    ka = np.linspace(0.5, 12.0, bench.choose(40, 200))
    hertz = ka * WATER.sound_speed / (2.0 * np.pi * OUTER)
    found = np.abs(np.asarray(frequency_response(tube(), hertz, "form_function", angle=[0.0]))).ravel()
    expected = _series(ka)
    error = float((np.abs(found - expected) / np.maximum(expected, 0.1)).max())
    yield within(
        f"backscatter of the evacuated tube, {ka.size} frequencies to ka = 12",
        "potentials of the solid, SciPy's Bessel functions",
        f"{expected[-1]:.7g} at ka = 12",
        error,
        1e-6,
        found=f"{found[-1]:.7g}",
        measure="relative, largest",
    )


def _series(ka: FloatArray) -> FloatArray:
    """Return 2/sqrt(pi ka) |sum eps_m (-1)^m b_m|: two potentials of J_m and Y_m in the solid, H_m in the water, five faces' conditions."""
    k, terms = ka / OUTER, np.zeros(ka.size, np.complex128)
    for m in range(int(ka[-1]) + 14):
        rows = np.zeros((ka.size, 5, 5), np.complex128)
        for row, (radius, kinds) in zip((0, 3), ((OUTER, (0, 1, 2)), (INNER, (1, 2))), strict=True):
            rows[:, row : row + len(kinds), :4] = np.stack([_solid(m, k, radius)[kind] for kind in kinds], axis=1)
        rows[:, 0, :4] *= WATER.density * (k[:, None] * WATER.sound_speed) ** 2
        rows[:, 0, 4], rows[:, 1, 4] = -k * h1vp(m, ka), hankel1(m, ka)
        given = np.zeros((ka.size, 5, 1), np.complex128)
        given[:, 0, 0], given[:, 1, 0] = k * jvp(m, ka), -jv(m, ka)
        size = np.abs(rows).max(axis=2, keepdims=True)
        wide = np.abs(rows / size).max(axis=1, keepdims=True)
        terms += (1 if m == 0 else 2) * (-1.0) ** m * (np.linalg.solve(rows / size / wide, given / size)[:, 4, 0] / wide[:, 0, 4])
    return np.asarray(2.0 / np.sqrt(np.pi * ka) * np.abs(terms))


def _solid(m: int, k: FloatArray, r: float) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """Return u_r, sigma_r and tau of the four potentials at a radius, each (frequencies, 4)."""
    omega, mu = k * WATER.sound_speed, STEEL.youngs_modulus / (2.0 * (1.0 + STEEL.poisson_ratio))
    lame = 2.0 * mu * STEEL.poisson_ratio / (1.0 - 2.0 * STEEL.poisson_ratio)
    long, short = omega * np.sqrt(STEEL.density / (lame + 2.0 * mu)), omega * np.sqrt(STEEL.density / mu)
    columns = []
    for q, along in ((long, True), (short, False)):
        for value, slope in ((jv, jvp), (yv, yvp)):
            f, f1 = value(m, q * r), q * slope(m, q * r)
            f2 = -f1 / r - (q * q - m * m / r**2) * f
            if along:
                columns.append((f1, -lame * q * q * f + 2.0 * mu * f2, 2.0 * mu * m * (f / r**2 - f1 / r)))
            else:
                columns.append((m * f / r, 2.0 * mu * m * (f1 / r - f / r**2), mu * (f1 / r - f2 - m * m * f / r**2)))
    u, normal, tangential = (np.stack(one, axis=-1).astype(np.complex128) for one in zip(*columns, strict=True))
    return u, normal, tangential


def _balance(bench: Bench) -> Iterator[Finding]:
    """Yield the closure of the preset with a coat of rubber, whose walls turn work into heat."""
    response = bench.simulate(presets.load("coated"), duration=1.2, time_step=8e-3, modes=bench.choose(4, 12))
    yield _closed("two dimensions", response.energy(every=30))


def _balance_in_space(bench: Bench) -> Iterator[Finding]:
    """Yield the same under a sphere, over the whole length."""
    sphere = presets.load("coated").replace(source=SphericalShock(distance=3.0, peak_pressure=2.5e4, decay_time=1.3e-4))
    yield _closed("three dimensions", bench.simulate(sphere, duration=1.0, time_step=2e-2, modes=5, dimensions=3).energy(every=10))


def _closed(where: str, balance: xr.Dataset) -> Finding:
    residual = float(np.abs(balance["closure_relative"]).max())
    heat = float(balance["inner_dissipation"][-1] / np.abs(balance["exterior_work"]).max())
    told, what = f"{residual:.2g}; {heat:.2g} in the rubber", f"coated shell, {where}: residual over the work"
    return within(what, "first law", "0", residual, 1e-5, found=told, measure="relative, largest")


def _reciprocity(bench: Bench) -> Iterator[Finding]:
    """Yield how far two points off each other's plane are from giving each other the same pressure.

    What orders and wavenumbers leave out is all there is of it: 1e-4 at orders to 4, 2e-6 at 6, 5e-8 at 8 and 1e-10 at 10.
    """
    transit = 1.0 / WATER.sound_speed
    pulse = Gaussian(peak_pressure=2.5e4, width=0.8 * transit, centre=4.8 * transit)
    walls = System(shells=[thick(0.6, 0.04), thick(1.0, 0.04)], fluids=[VACUUM, WATER, WATER], source=PlaneWave(pulse=pulse))
    places, times, answers = ((3.0, 0.0, 0.0), (2.0, 50.0, 0.6)), np.array([7.0, 7.5]), []
    for (r, angle, z), (far, around, along) in (places, places[::-1]):
        system = walls.replace(source=SphericalWave(distance=r, angle=angle, z=z, pulse=pulse))
        start = r - walls.head_radius
        found = bench.simulate(system, duration=6.6, time_step=4e-2, modes=8, dimensions=3)
        assert isinstance(found, SpatialResponse)
        field = found.pressure(radius=[far], angle=[around], z=along, time=times - start, part="scattered", time_resolution=4e-2)
        answers.append(np.asarray(field).squeeze() / start)
    error = distance(answers[0], answers[1])
    yield within("two points, each the other's source, in three dimensions", "reciprocity", "alike", error, 2e-7)
