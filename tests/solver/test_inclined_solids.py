"""Inclined plane waves on walls of elastic solids: shapes at real wavenumbers, potentials at complex ones, limits, causality, refusals."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.special import iv, ivp, kv, kvp

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.solver.scaling import dimensionless
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.lossy_solid import LossySolidWall

BARE = cx.presets.load("bare")
PULSE = cx.Gaussian(peak_pressure=2.5e4, width=0.05 * BARE.transit_time, centre=0.3 * BARE.transit_time)
RUN: dict[str, Any] = {"duration": 0.7, "time_step": 2e-2, "modes": 3, "dimensions": 3}
NODES = np.array([0.7 + 2.3j, 3.0 + 60.0j])


def system(theory: str = "elastic", scale: float = 1.0, inclination: float = 8.0) -> cx.System:
    """Return the paper's double shell, aluminium between ceramics, all layers *scale* times as thick."""
    shells = []
    for shell in BARE.shells:
        layers = [layer.replace(thickness=scale * layer.thickness) for layer in shell.layers]
        shells.append(shell.replace(layers=layers, theory=theory, **({"wetted": "faces"} if theory == "thin" else {})))
    return BARE.replace(shells=shells, source=cx.PlaneWave(pulse=PULSE, inclination=inclination))


@cache
def run(theory: str = "elastic", scale: float = 1.0, inclination: float = 8.0) -> cx.SpatialResponse:
    return cx.simulate(system(theory, scale, inclination), stations=[0.0, 0.7], **RUN)


def wall_of(described: cx.System) -> ElasticWall:
    found = dimensionless(described, 3).shells[0]
    assert isinstance(found, ElasticWall)
    return found


def test_at_a_real_wavenumber_it_is_the_sum_over_shapes() -> None:
    """Faces, motion, six stresses and the potentials of ceramics, by equations that know no shapes."""
    wall, orders = wall_of(system()), np.arange(4.0)
    for k in (0.3, 20.0):
        by_shapes, shown = wall.station_port(Modes(orders, k), NODES)
        found, also = wall.station_port(Modes(orders, np.full(NODES.size, k, np.complex128)), NODES)
        for name in ("inner", "across", "outer"):
            np.testing.assert_allclose(getattr(found, name), getattr(by_shapes, name), rtol=1e-7)
        for row, expected in zip(also, shown, strict=True):
            np.testing.assert_allclose(row, expected, rtol=0, atol=1e-6 * np.abs(expected).max())


def with_losses(inclination: float = 8.0, coated: bool = False) -> cx.System:
    """Return the shells with losses in the core of the inner one, the outer one *coated* with rubber."""
    described = system(inclination=inclination)
    inner, outer = described.shells
    core = inner.layers[1].material.replace(loss_factor=0.02)
    shells = [inner.replace(layers=[layer.replace(material=core) if layer is inner.layers[1] else layer for layer in inner.layers]), outer]
    if coated:
        coats = [
            layer for shell in cx.presets.load("coated").shells for layer in shell.layers if isinstance(layer.material, cx.Viscoelastic)
        ]
        shells[1] = outer.replace(layers=[*outer.layers, coats[0].replace(thickness="6 mm")])
    return described.replace(shells=shells)


def test_at_a_real_wavenumber_losses_are_those_of_pieces_by_shapes_and_of_rubber_by_its_potentials() -> None:
    orders = np.arange(4.0)
    for described in dimensionless(with_losses(coated=True), 3).shells:
        wall = described.resolving(100.0)
        assert isinstance(wall, LossySolidWall)
        for k in (0.3, 20.0):
            in_pieces, shown = wall.station_port(Modes(orders, k), NODES)
            found, also = wall.station_port(Modes(orders, np.full(NODES.size, k, np.complex128)), NODES)
            for name in ("inner", "across", "outer"):
                np.testing.assert_allclose(getattr(found, name), getattr(in_pieces, name), rtol=1e-7)
            for row, expected in zip(also, shown, strict=True):
                np.testing.assert_allclose(row, expected, rtol=0, atol=1e-6 * np.abs(expected).max())


def test_losses_under_an_inclined_wave_tend_to_those_of_two_dimensions() -> None:
    small = {**RUN, "duration": 0.3, "modes": 1}
    almost = cx.simulate(with_losses(1e-6), stations=[0.0], **small)
    flat = cx.simulate(with_losses(0.0), **{name: value for name, value in small.items() if name != "dimensions"})
    for read, where in (("displacement", {}), ("stress", {"depth": "inner"}), ("stress", {"depth": "outer"})):
        one, other = (np.squeeze(np.asarray(getattr(each, read)("outer", [0, 50, 180], **where))) for each in (almost, flat))
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-6 * np.abs(other).max())


def by_potentials(wall: ElasticWall, order: int, k: complex, s: complex) -> ComplexArray:
    """Return u_r of the faces per force r sigma_r on each, of one isotropic layer: six waves of phi, psi and chi, without elements."""
    (layer,) = wall.layers
    g = 1.0 if layer.factor is None else layer.factor.at(np.array([s]))[0]
    shear, density = g * layer.shear, layer.density
    pressure = (1.0 if layer.shear_alone else g) * layer.bulk + 4.0 / 3.0 * shear
    kappa = [np.sqrt(s * s * density / modulus + k * k) for modulus in (pressure, shear)]

    def rows(r: float) -> tuple[list[complex], list[list[complex]]]:
        moved, tractions = [], []
        for number in range(6):
            x, m = kappa[min(number // 2, 1)], order / r
            value, slope = ((iv, ivp), (kv, kvp))[number % 2]
            y, d = value(order, x * r), x * slope(order, x * r)
            if number < 2:
                force = density * s * s * y + 2 * shear * ((m * m + k * k) * y - d / r), 2 * shear * m * (y / r - d), -2 * k * shear * d
                moved.append(d)
            elif number < 4:
                around = -shear * ((x * x + 2 * m * m) * y - 2 * d / r)
                force = 2 * shear * m * (d - y / r), around, -k * shear * m * y
                moved.append(m * y)
            else:
                normal = 2 * k * shear * ((x * x + m * m) * y - d / r)
                force = normal, 2 * k * shear * m * (y / r - d), -shear * (x * x + k * k) * d
                moved.append(k * d)
            tractions.append(list(force))
        return moved, tractions

    (inner, force_inner), (outer, force_outer) = rows(layer.inner), rows(layer.outer)
    matrix = np.concatenate([-layer.inner * np.array(force_inner).T, layer.outer * np.array(force_outer).T])
    loads = np.zeros((6, 2))
    loads[[0, 3], [0, 1]] = 1.0
    return np.asarray(np.array([inner, outer]) @ np.linalg.solve(matrix, loads))


@pytest.mark.parametrize("loses", [False, True])
@pytest.mark.parametrize("order", [0, 1, 3])
def test_at_a_complex_wavenumber_it_agrees_with_separated_potentials(order: int, loses: bool) -> None:
    losses = {"loss_factor": 0.1, "reference_frequency": 2000.0} if loses else {}
    steel = cx.Layer(cx.Elastic(density=7800, youngs_modulus=210e9, poisson_ratio=0.3, **losses), 0.04)
    wall = wall_of(BARE.replace(shells=[cx.Shell(radius=1.0, layers=[steel], theory="elastic")], fluids=BARE.fluids[1:]))
    assert (wall.layers[0].factor is not None) == loses
    k = -1j * NODES * np.sin(np.radians(10.0))
    found = wall.receptance(Modes(np.array([float(order)]), k), NODES)
    for place, (wavenumber, s) in enumerate(zip(k, NODES, strict=True)):
        expected = by_potentials(wall, order, wavenumber, s)
        here = [[found.inner[0, place], found.across[0, place]], [found.back[0, place], found.outer[0, place]]]
        np.testing.assert_allclose(here, expected, rtol=0, atol=2e-7 * np.abs(expected).max())


def test_it_tends_to_thin_walls_and_to_the_wave_across_the_axis() -> None:
    angles = [0, 50, 180]
    errors = []
    for scale in (1.0, 0.25):
        exact, thin = (np.asarray(run(theory, scale).displacement("outer", angles)) for theory in ("elastic", "thin"))
        errors.append(np.linalg.norm(exact - thin) / np.linalg.norm(thin))
    assert errors[1] < 1e-3
    assert errors[0] / errors[1] > 3.0
    for read, where in (("displacement", {}), ("stress", {"depth": "inner"})):
        almost, across = (np.asarray(getattr(run(inclination=i), read)("outer", angles, **where)) for i in (1e-6, 0.0))
        np.testing.assert_allclose(almost, across, rtol=0, atol=1e-6 * np.abs(across).max())


def test_nothing_moves_before_the_front_and_stations_see_the_same_later() -> None:
    response = run()
    late = 0.7 * np.sin(np.radians(8.0))  # in transits of an outer shell of 1 m
    here, there = (np.asarray(response.displacement("outer", 0.0, station=z)) for z in (0.0, 0.7))
    time = np.asarray(response.displacement("outer", 0.0, station=0.0).time)
    unit = float(response.solution.problem.scales.time) if time[-1] < 0.1 else 1.0
    shifted = np.interp(time - late * unit, time, here)
    assert np.abs(there - shifted).max() < 2e-2 * np.abs(here).max()
    before = time < 0.1 * unit  # the pulse is 1e-4 of its peak 0.2 transits before its middle
    assert np.abs(there[before]).max() < 1e-3 * np.abs(there).max()


def test_what_is_not_solved_is_refused_by_name() -> None:
    with pytest.raises(cx.InputError, match=r"source\.inclination: 20 degrees: .* pressure waves in the .*shell run ahead"):
        cx.simulate(system(inclination=20.0), **RUN)
