"""Feedback on walls of elastic solids with losses: against walls without, a dense solution, receptances, thin walls; balances."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.solver.scaling import dimensionless
from coaxshell.structure.elastic_basis import OrdersBasis, PotentialOfLayer, involved, layer_strains
from coaxshell.structure.elastic_wall import Asked, ElasticWall
from coaxshell.structure.losses import Prony
from coaxshell.structure.lossy_solid import LossySolidWall

PRESETS = {"paper": "active", "electrodes": "electrodes", "apart": "electrodes", "open": "electrodes"}
GAINS: dict[str, Any] = {
    "paper": cx.PDControl(proportional=-2e4, derivative=-150),
    "electrodes": cx.PDControl(proportional=0, derivative=2, transducers="electrodes"),
}
GAINS["apart"] = GAINS["open"] = cx.Feedback(numerator=[3e-4, 3.0], amplifier_corner="20 kHz", transducers="electrodes")
FACTORS = Prony(0.9, (0.2,), (0.3,)), Prony(1.0, (0.05,), (0.1,)), Prony(0.95, (0.1,), (0.2,))
SMALL: dict[str, Any] = {"duration": 0.8, "time_step": 1e-2, "modes": 3}


def system(
    kind: str, theory: str = "elastic", scale: float = 1.0, losses: tuple[float, ...] = (0.02, 0.01, 0.03), **changes: Any
) -> cx.System:
    """Return a preset with walls of a theory, each layer with a loss factor; a sensor, by its charge ("apart") or "open"."""
    base, shells = cx.presets.load(PRESETS[kind]), []
    for shell in base.shells:
        layers = []
        for place, (layer, factor) in enumerate(zip(shell.layers, losses, strict=True)):
            standard = {"permittivity_reduction": "standard"} if isinstance(layer.material, cx.Piezoelectric) else {}
            sensor = {"apart": "charge-sensor", "open": "sensor"}.get(kind)
            role = {"role": (sensor, None, "self-sensing")[place]} if sensor and place != 1 else {}
            material = layer.material.replace(loss_factor=factor, **standard)
            layers.append(layer.replace(thickness=scale * layer.thickness, material=material, **role))
        shells.append(shell.replace(layers=layers, theory=theory, **({"wetted": "faces"} if theory == "thin" else {})))
    return base.replace(**{"shells": shells, "control": GAINS[kind], **changes})


@cache
def run(kind: str, theory: str = "elastic", scale: float = 1.0) -> cx.Response:
    return cx.simulate(system(kind, theory, scale), **SMALL)


def walls(kind: str, factors: tuple[Prony | None, ...], dimensions: int = 2) -> tuple[ElasticWall, LossySolidWall]:
    """Return a wall without losses and the same in pieces under other factors."""
    plain = dimensionless(system(kind, losses=(0.0, 0.0, 0.0)), dimensions).shells[0]
    assert isinstance(plain, ElasticWall)
    layers = tuple(replace(layer, factor=factor) for layer, factor in zip(plain.layers, factors, strict=True))
    return plain, replace(LossySolidWall.of(layers, plain.core), gains=plain.gains, transducers=plain.transducers)


def close(found: Any, expected: Any, within: float) -> None:
    np.testing.assert_allclose(found, expected, rtol=0, atol=within * float(np.abs(expected).max()))


@pytest.mark.parametrize("kind", ["paper", "electrodes", "apart", "open"])
@pytest.mark.parametrize("wavenumber", [0.0, 1.7])
def test_pieces_that_lose_nothing_are_the_wall_without_losses(kind: str, wavenumber: float) -> None:
    """Three pieces with factors 1 each, joined: voltages find the same inertia, also above the first resonance of the thickness."""
    idle = tuple(Prony(1.0, (0.0,), (float(time),)) for time in (1, 2, 3))
    plain, pieces = walls(kind, idle, 3 if wavenumber else 2)
    assert len(pieces.pieces) == 3
    modes, s = Modes.up_to(3, wavenumber), np.array([0.7 + 2.3j, 1.0 + 60.0j, 1.0 + 600.0j])
    for name in ("inner", "across", "back", "outer", "characteristic"):
        close(getattr(pieces.receptance(modes, s), name), getattr(plain.receptance(modes, s), name), 1e-6)
    asked = [Asked("hoop", 0.9 * plain.faces[1]), Asked("radial", 0.9 * plain.faces[0]), *plain._asked_potentials]
    found, expected = (one.under_voltage(modes, s, asked) for one in (pieces, plain))
    close(found.faces, expected.faces, 1e-7)
    close(found.heard, expected.heard, 1e-8)
    for a, b in zip(found.shown, expected.shown, strict=True):
        close(a, b, 1e-7)
    ports = [(one.station_port if wavenumber else one.two_port)(modes, s)[1] for one in (pieces, plain)]
    for a, b in zip(*ports, strict=True):
        close(a, b, 1e-6)
    for a, b in zip(pieces.transfer(modes, s, asked), plain.transfer(modes, s, asked), strict=True):
        close(a, b, 1e-6)


def dense(part: OrdersBasis, m: int, factors: tuple[Prony, ...], s: complex) -> np.ndarray:
    """Return K_g of all points of a wall at one order: the strains' stiffness under the factors, the potentials' without."""
    size, found = part.mesh.radius.size, np.zeros((2 * part.mesh.radius.size,) * 2, np.complex128)
    for mesh, factor in zip(part.mesh.layers, factors, strict=True):
        taking, order = list(involved(0.0)), np.array([float(m)])
        local, root = layer_strains(mesh, order, 0.0)[0], np.linalg.cholesky(mesh.layer.matrix[np.ix_(taking, taking)]).T
        rows = np.einsum("ij,jqcp->iqcp", root, local[taking]) * np.sqrt(mesh.weights)[:, None, None]
        blocks = [(factor.at(np.array([s]))[0], rows.reshape(-1, *rows.shape[2:]))]
        if mesh.layer.coupling is not None:
            blocks.append((1.0, PotentialOfLayer(mesh, order, 0.0).rows[0]))
        for scale, each in blocks:
            wide = np.zeros((len(each), 2, size))
            wide[..., mesh.nodes] = each
            flat = wide.reshape(len(each), -1)
            found += scale * flat.T @ flat
    return found


@pytest.mark.parametrize("kind", ["electrodes", "apart", "open"])
def test_the_closed_wall_against_the_equations_of_its_points(kind: str) -> None:
    """(K_g + s^2 B B') x = d u, (K_g + s^2 M) x = loads, u = O p'x + a H h: every layer loses otherwise; h is of X X'M x alone."""
    plain, lossy = walls(kind, FACTORS)
    modes, s = Modes.up_to(3), np.array([0.7 + 2.3j])
    part, driven, transducers = plain.basis(modes)[0], plain.driven(modes)[0], plain.transducers
    assert transducers is not None
    assert plain.gains is not None
    found, given = lossy.receptance(modes, s), lossy.under_voltage(modes, s, [])
    mass, places, circuits = np.tile(part.mesh.mass, 2), [0, part.mesh.radius.size - 1], transducers.circuits
    opened, law = np.diag(circuits.opened), plain.gains.at(s, modes)[0]
    for m in (1, 2, 3):
        stiffness, shapes = dense(part, m, FACTORS, s[0]), part.shapes[m].reshape(part.shapes.shape[1], -1)
        d, p = (each[m] @ (shapes * mass) for each in (driven.loads, driven.readings))  # back to the points, by completeness
        inert, loads = (shapes[:2] * mass).T, np.zeros((mass.size, 2))
        loads[places, [0, 1]] = -1.0
        free = np.linalg.solve(stiffness + np.diag(mass * s[0] ** 2), loads)
        pushed = np.linalg.solve(stiffness + s[0] ** 2 * inert @ inert.T, d.T @ circuits.shares)
        read = circuits.reading @ p
        along = (read @ shapes[:2].T) @ (inert.T @ pushed)
        own = np.linalg.inv(np.eye(len(read)) - opened @ (read @ pushed - along) @ opened)  # of what moves at once
        hears = law * np.outer(circuits.acting, circuits.sensing @ own)
        loop = np.eye(len(read)) - opened @ read @ pushed - hears @ along
        volts = np.linalg.solve(loop, opened @ read @ free + hears @ (read @ shapes[:2].T) @ (inert.T @ free))
        here = np.array([[found.inner[m, 0], found.across[m, 0]], [found.back[m, 0], found.outer[m, 0]]])
        close(here, -(free + pushed @ volts)[places], 1e-7)
        asked = np.linalg.solve(np.eye(len(read)) - opened @ read @ pushed, circuits.acting)
        close(given.faces[:, m, 0], -(pushed @ asked)[places], 1e-6)
        assert np.abs(here + free[places]).max() > 1e-4 * np.abs(here).max()


@pytest.mark.parametrize("kind", ["paper", "electrodes", "apart"])
def test_the_loop_within_is_the_loop_closed_from_outside(kind: str) -> None:
    """By what a volt does, what is read of loads without feedback, and the law: H + D (1 - H heard)^-1 H read."""
    _, lossy = walls(kind, FACTORS)
    modes, s = Modes.up_to(4), np.array([0.7 + 2.3j, 1.0 + 30.0j])
    assert lossy.gains is not None
    opened, closed, law = lossy.with_gains(None), lossy.receptance(modes, s), lossy.gains.at(s, modes)
    given, (bare, shown) = opened.under_voltage(modes, s, []), opened.two_port(modes, s)
    volts = law * shown[-2] / (1.0 - law * given.heard)
    for name, face, load in (("inner", 0, 0), ("across", 0, 1), ("back", 1, 0), ("outer", 1, 1)):
        close(getattr(closed, name), getattr(bare, name) + given.faces[face] * volts[load] / lossy.wetted[load], 1e-8)


def test_they_tend_to_thin_walls_with_losses() -> None:
    errors = []
    for scale in (1.0, 0.25):
        exact, thin = (np.asarray(run("electrodes", theory, scale).displacement("inner", [0, 50, 180])) for theory in ("elastic", "thin"))
        errors.append(np.linalg.norm(exact - thin) / np.linalg.norm(exact))
    assert errors[1] < 2e-3
    assert errors[0] / errors[1] > 2.0
    exact, thin = (
        cx.stability_margins(system("electrodes", theory), duration=1.0, time_step=1e-2, modes=4) for theory in ("elastic", "thin")
    )
    np.testing.assert_allclose(exact.phase_margin.values, thin.phase_margin.values, atol=1.0)


@pytest.mark.parametrize("kind", ["electrodes", "apart"])
def test_the_energy_closes_with_the_heat(kind: str) -> None:
    response = run(kind)
    energy = response.energy()
    assert float(np.abs(energy.closure_relative).max()) < 1e-5
    assert float(energy.inner_dissipation[-1] + energy.outer_dissipation[-1]) > 1e-3 * float(energy.exterior_work.max())
    assert float(energy.actuator_work[-1]) > 0.01 * float(energy.exterior_work.max())
    left = energy.amplifier_work - energy.actuator_field + energy.actuator_work
    assert float(np.abs(left).max()) < 1e-9 * float(energy.actuator_work.max())


@pytest.mark.parametrize("place", [1, 3])
def test_a_rubber_beside_electrodes(place: int) -> None:
    """Within the wall, where it divides the stack, or on its face; it loses by its potentials."""
    base = system("electrodes", losses=(0.0, 0.0, 0.0))
    coat = next(
        layer for shell in cx.presets.load("coated").shells for layer in shell.layers if isinstance(layer.material, cx.Viscoelastic)
    )
    layers = list(base.shells[1].layers)
    layers.insert(place, coat.replace(thickness="3 mm", role="passive"))
    energy = cx.simulate(base.replace(shells=[base.shells[0], base.shells[1].replace(layers=layers)]), **SMALL).energy()
    assert float(np.abs(energy.closure_relative).max()) < 1e-5
    assert float(energy.outer_dissipation[-1]) > 1e-4 * float(energy.exterior_work.max())


def test_segments_and_limits_know_losses() -> None:
    base = system("electrodes")
    law = base.control.replace(segments=3, dead=(2,), saturation=True)
    layers = [[layer.replace(**weaker(layer)) for layer in shell.layers] for shell in base.shells]
    shells = [shell.replace(layers=each) for shell, each in zip(base.shells, layers, strict=True)]
    response = cx.simulate(base.replace(control=law, shells=shells), **SMALL)
    assert float(np.abs(response.energy().closure_relative).max()) < 1e-4  # 4.7e-5; without losses 3.3e-5
    assert any("was held at" in warning for warning in response.warnings)


def weaker(layer: cx.Layer) -> dict[str, Any]:
    """Return the material of a ceramic that stands 10 kV/m."""
    return {"material": layer.material.replace(field_limit=1e4)} if isinstance(layer.material, cx.Piezoelectric) else {}


def test_three_dimensions() -> None:
    small = {"duration": 0.4, "time_step": 2e-2, "modes": 2, "axial_modes": 1.5, "dimensions": 3, "stations": [0.0]}
    response = cx.simulate(system("electrodes"), **small)
    assert float(np.abs(response.energy().closure_relative).max()) < 2e-5


def test_voltages_at_frequencies_are_those_of_the_law() -> None:
    """What the law reads and gives, with losses and without, near thin walls."""
    asked: dict[str, Any] = {"modes": 4, "shell": "inner", "angle": 0.0}
    found = []
    for described in (system("electrodes"), system("electrodes", losses=(0.0,) * 3), system("electrodes", "thin")):
        with pytest.warns(cx.PhysicsWarning):
            read, given = (
                complex(cx.frequency_response(described, 700.0, name, **asked).values.ravel()[0])
                for name in ("sensor_voltage", "actuator_voltage")
            )
        law = 2.0 * 2j * np.pi * 700.0 * described.transit_time
        assert abs(given / (law * read) - 1.0) < 0.1  # the contour has a small real part
        found.append(read)
    assert abs(found[0] / found[2] - 1.0) < 0.05
    assert 1e-4 < abs(found[1] / found[0] - 1.0) < 0.05
