"""Feedback on walls of elastic solids in three dimensions: loads and readings by another quadrature, dense solutions, limits, energy."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.linalg import eigh

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.response import load_response
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.stability import unstable_poles
from coaxshell.structure.elastic_basis import strain_rows
from coaxshell.structure.elastic_wall import ElasticWall

TIME = cx.presets.load("bare").transit_time
PRESETS = {"paper": "active", "electrodes": "electrodes", "apart": "electrodes", "charged": "electrodes"}
GAINS: dict[str, Any] = {
    "paper": cx.PDControl(proportional=-2e4, derivative=-150),
    "electrodes": cx.PDControl(proportional=0, derivative=2, transducers="electrodes"),
    "charged": cx.PDControl(proportional=0, derivative=2, transducers="electrodes"),
    "apart": cx.Feedback(numerator=[TIME, 3.0], amplifier_corner="50 kHz", transducers="electrodes"),
}
SMALL: dict[str, Any] = {"duration": 0.5, "time_step": 2e-2, "modes": 2, "axial_modes": 1.5, "dimensions": 3}

FLAT = {name: value for name, value in SMALL.items() if name not in ("axial_modes", "dimensions")}


def system(kind: str, theory: str = "elastic", scale: float = 1.0, **changes: Any) -> cx.System:
    """Return a preset with walls of a theory, layers *scale* times as thick; a sensor beside a self-sensing layer "apart" or "charged"."""
    base, shells = cx.presets.load(PRESETS[kind]), []
    for shell in base.shells:
        layers = []
        for place, layer in enumerate(shell.layers):
            material = layer.material
            if isinstance(material, cx.Piezoelectric):
                material = material.replace(permittivity_reduction="standard")
            sensor = {"apart": "sensor", "charged": "charge-sensor"}.get(kind)
            role = {"role": (sensor, None, "self-sensing")[place]} if sensor and place != 1 else {}
            layers.append(layer.replace(thickness=scale * layer.thickness, material=material, **role))
        shells.append(shell.replace(layers=layers, theory=theory, **({"wetted": "faces"} if theory == "thin" else {})))
    return base.replace(**{"shells": shells, "control": GAINS[kind], **changes})


@cache
def run(kind: str, theory: str = "elastic", scale: float = 1.0, controlled: bool = True) -> cx.SpatialResponse:
    described = system(kind, theory, scale) if controlled else system(kind, theory, scale, control=None)
    return cx.simulate(described, stations=[0.2], axial_period=12.0, **SMALL)  # the same waves whatever the theory


def wall(kind: str) -> ElasticWall:
    found = dimensionless(system(kind), 3).shells[0]
    assert isinstance(found, ElasticWall)
    return found


def by_quadrature(one: ElasticWall, number: int, m: float, k: float, displacements: Any) -> tuple[float, float]:
    """Return d'x of a layer and its charge of the strain along it, by Gauss's rule and a potential that is found by a fine mesh.

    ``displacements`` gives (u_r, u_theta, u_z) and their derivatives at radii, each (3, radii).
    """
    layer = one.layers[number]
    e, mu = np.array(layer.coupling), np.array(layer.permittivity)
    cells = 200
    edges = np.linspace(layer.inner, layer.outer, cells + 1)
    width, middle = np.diff(edges), 0.5 * (edges[1:] + edges[:-1])
    along = mu[1] * (m / middle) ** 2 + mu[2] * k**2  # (r mu33 psi')' = r along psi by finite volumes
    flux, mass = mu[0] * middle / width, along * middle * width / 4.0
    matrix = np.zeros((cells + 1, cells + 1))
    for cell in range(cells):
        matrix[cell : cell + 2, cell : cell + 2] += flux[cell] * np.array([[1.0, -1.0], [-1.0, 1.0]]) + mass[cell]
    psi = np.zeros(cells + 1)
    psi[0], psi[-1] = 0.5, -0.5
    psi[1:-1] = np.linalg.solve(matrix[1:-1, 1:-1], -matrix[1:-1, [0, -1]] @ psi[[0, -1]])
    slope, value, r = np.diff(psi) / width, 0.5 * (psi[1:] + psi[:-1]), middle
    (u, v, w), (du, dv, dw) = displacements(r)
    radial = e[0, 0] * du + e[0, 1] * (u + m * v) / r + e[0, 2] * k * w
    sheared = (m / r) * e[1, 5] * (dv - v / r - m * u / r) + k * e[2, 4] * (dw - k * u)
    c = np.array(layer.stiffness)
    reduced = [e[0, place] - e[0, 0] * c[0, place] / c[0, 0] for place in (1, 2)]
    stretched = reduced[0] * (u + m * v) / r + reduced[1] * k * w
    return -float(((slope * radial - value * sheared) * r * width).sum()), -float((slope * stretched * r * width).sum())


@pytest.mark.parametrize("kind", ["electrodes", "apart", "charged"])
def test_loads_and_readings_by_quadrature(kind: str) -> None:
    one, k = wall(kind), 20.0
    modes = Modes.up_to(3, k)
    (part,), (driven,) = one.basis(modes), one.driven(modes)
    assert one.transducers is not None
    for m in (0, 3):
        for j, number in enumerate(one.transducers.driven):
            mesh = part.mesh.layers[number]
            coupling, permittivity = np.array(mesh.layer.coupling)[0, 0], np.array(mesh.layer.permittivity)[0]
            free = driven.capacitance[m, j] * (1.0 + coupling**2 / (mesh.layer.stiffness[0][0] * permittivity))
            for n in range(6):  # those through the thickness shear it
                shape = part.shapes[m, n][:, mesh.nodes]
                fitted = np.polynomial.Polynomial.fit
                curves = [fitted(mesh.radius, row, mesh.degree) for row in shape]
                load, along = by_quadrature(
                    one, number, float(m), k, lambda r, curves=curves: ([c(r) for c in curves], [c.deriv()(r) for c in curves])
                )
                assert driven.loads[m, j, n] == pytest.approx(load, rel=1e-5, abs=1e-6 * np.abs(driven.loads[m, j, :6]).max())
                expected = -along / free if number in one.transducers.actuators else -load / driven.capacitance[m, j]
                if number in one.transducers.shorted:
                    expected = -load / free
                size = np.abs(driven.readings[m, j, :6]).max()
                assert driven.readings[m, j, n] == pytest.approx(expected, rel=1e-5, abs=1e-6 * size)


@pytest.mark.parametrize("kind", ["paper", "electrodes"])
def test_the_closed_wall_against_the_equations_of_its_points(kind: str) -> None:
    """Stiffness, mass, d and p of all points on (u_r, u_theta, u_z), as in two dimensions; what stations read closes the same loop."""
    one, k, s = wall(kind), 1.7, np.array([0.7 + 2.3j])
    modes = Modes.up_to(3, k)
    (part,), (driven,), transducers = one.basis(modes), one.driven(modes), one.transducers
    assert transducers is not None
    assert one.gains is not None
    found, law, mass = one.receptance(modes, s), one.gains.at(s, modes)[0], np.tile(part.mesh.mass, 3)
    places = [0, part.mesh.radius.size - 1]
    station, shown = one.station_port(modes, s)
    for name in ("inner", "across", "outer", "other"):
        np.testing.assert_allclose(getattr(station, name), getattr(found, name), rtol=1e-10)
    for m in (0, 2, 3):
        rows = strain_rows(part.mesh, part.orders[m : m + 1], k)[0]
        stiffness = rows.reshape(len(rows), -1).T @ rows.reshape(len(rows), -1)
        shapes = part.shapes[m].reshape(part.shapes.shape[1], -1)
        d, p = (each[m] @ (shapes * mass) for each in (driven.loads, driven.readings))  # back to the points, by completeness
        push, read = transducers.acting @ d, transducers.sensing @ p
        dynamic, loads = stiffness + np.diag(mass * s[0] ** 2), np.zeros((mass.size, 2))
        loads[places, [0, 1]] = -1.0  # each r_a q_a = 1
        free = np.linalg.solve(dynamic, loads)
        squares, vectors = eigh(stiffness, np.diag(mass))
        slow, along, through = part.squares[m, :3], shapes[:3].T, vectors[:, 3:]  # the low ones of K are lost to rounding
        pushed = along @ ((along.T @ push) / (slow + s[0] ** 2))
        heard = (read @ along) @ ((along.T @ loads) / (slow + s[0] ** 2)[:, None])
        volts = law * heard / (1.0 - law * (read @ pushed))
        pushed = pushed + through @ ((through.T @ push) / squares[3:])
        moved = -(free + np.outer(pushed, volts))[places]
        here = [[found.inner[m, 0], found.across[m, 0]], [found.back[m, 0], found.outer[m, 0]]]
        np.testing.assert_allclose(here, moved, rtol=0, atol=1e-6 * np.abs(moved).max())
        given = shown[-1, :, m, 0] / np.array(one.wetted)  # per unit of r_a q_a
        np.testing.assert_allclose(given, volts, rtol=1e-6)
        whole = (free + np.outer(pushed, volts)).reshape(3, -1, 2)
        for row, component in ((1, 1), (2, 2)):  # V and U where the middle of the wall is a point of no layer: at the faces by symmetry
            assert np.abs(whole[component]).max() > 0.0
            assert np.all(np.isfinite(shown[row]))
        if kind == "electrodes":
            exact = -np.linalg.solve(dynamic - law * np.outer(push, read), loads)[places]
            np.testing.assert_allclose(here, exact, rtol=0, atol=2e-3 * np.abs(exact).max())
        assert np.abs(here + free[places]).max() > 1e-3 * np.abs(moved).max()


@pytest.mark.parametrize("kind", ["paper", "electrodes", "apart", "charged"])
def test_a_vanishing_wavenumber_is_the_plane_problem(kind: str) -> None:
    one, s = wall(kind), np.array([0.7 + 2.3j, 3.0 + 20.0j])
    near, plane = (one.receptance(Modes.up_to(3, k), s) for k in (1e-6, 0.0))
    for name in ("inner", "across", "outer", "back", "characteristic"):
        there = getattr(plane, name)
        np.testing.assert_allclose(getattr(near, name), there, rtol=0, atol=1e-9 * np.abs(there).max(axis=1, keepdims=True).max())


@pytest.mark.parametrize("kind", [pytest.param("paper", marks=pytest.mark.slow), "electrodes"])
def test_uniform_waves_are_two_dimensions(kind: str) -> None:
    source = cx.presets.load("bare").source
    plane = cx.PlaneShock(peak_pressure=source.peak_pressure, decay_time=source.decay_time)
    flat = cx.simulate(system(kind, source=plane), **FLAT)
    space = cx.simulate(system(kind, source=plane), stations=[0.3], **SMALL)
    for read, where in (("sensor_voltage", {}), ("actuator_voltage", {}), ("stress", {}), ("stress", {"depth": "inner"})):
        one, other = (np.squeeze(np.asarray(getattr(each, read)("outer", [0.0, 70.0], **where))) for each in (flat, space))
        np.testing.assert_allclose(other, one, rtol=0, atol=1e-9 * np.abs(one).max())


@pytest.mark.slow
def test_exact_walls_under_electrodes_tend_to_thin_ones() -> None:
    errors = []
    for scale in (1.0, 0.25):
        exact, thin = (np.asarray(run("electrodes", theory, scale).displacement("outer", [0, 50])) for theory in ("elastic", "thin"))
        errors.append(np.linalg.norm(exact - thin) / np.linalg.norm(exact))
    bare = np.asarray(run("electrodes", "elastic", 1.0, False).displacement("outer", [0, 50]))
    controlled = np.asarray(run("electrodes").displacement("outer", [0, 50]))
    assert errors[1] < 3e-3
    assert errors[0] / errors[1] > 2.0
    assert np.linalg.norm(bare - controlled) > 10.0 * errors[0] * np.linalg.norm(bare)


@pytest.mark.parametrize("kind", [*(pytest.param(kind, marks=pytest.mark.slow) for kind in ("paper", "electrodes")), "apart"])
def test_the_energy_closes_over_the_whole_length(kind: str, tmp_path: Any) -> None:
    response = run(kind)
    energy = response.energy(every=6)
    assert float(np.abs(energy.closure_relative).max()) < 1e-4
    if kind != "paper":
        left = energy.amplifier_work - energy.actuator_field + energy.actuator_work
        assert float(np.abs(left).max()) < 1e-3 * float(np.abs(energy.amplifier_work).max())
    response.save(tmp_path / "run.nc")
    again = load_response(tmp_path / "run.nc")
    given = np.asarray(response.actuator_voltage("outer", [0.0, 70.0]))
    assert np.abs(given).max() > 1.0
    np.testing.assert_array_equal(np.asarray(again.actuator_voltage("outer", [0.0, 70.0])), given)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_unstable_waves_are_those_of_thin_walls(sign: float) -> None:
    control = GAINS["electrodes"].replace(derivative=sign * 2.0)
    problems = (dimensionless(system("electrodes", theory, 0.5, control=control), 3) for theory in ("elastic", "thin"))
    found = [unstable_poles(problem, 2, 1.0, wavenumber=1.5).orders for problem in problems]
    np.testing.assert_array_equal(*found)
    assert (found[0].size > 0) == (sign < 0)
