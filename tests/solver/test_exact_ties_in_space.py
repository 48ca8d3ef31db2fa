"""Segments and matrices of feedback in three dimensions on walls of elastic solids: dense solutions, two dimensions, thin walls, poles."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from electrode_pairs import BOTH, pairs
from scipy import special

import coaxshell as cx
from coaxshell.numerics.modes import Modes
from coaxshell.response import load_response
from coaxshell.solver.axial.faced import FacedWave
from coaxshell.solver.axial.tied_faces import TiedFaces
from coaxshell.solver.contour import along_alone
from coaxshell.solver.faced_voltages import readings_per_volt
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.tied_stability import determinants, fastest_growth, growing
from coaxshell.structure.axial import ENTRIES, U, V, W
from coaxshell.structure.elastic_wall import ElasticWall

PLANE = cx.PlaneShock(peak_pressure=25e3, decay_time=1.314e-4)
SMALL: dict[str, Any] = {"duration": 0.4, "time_step": 2e-2, "modes": 3, "dimensions": 3, "axial_modes": 2.0, "axial_period": 12.0}
MIXED = [[1.0, 0.5], [0.3, 0.8]]
CUT: dict[str, Any] = {"segments": 3, "segment_gap": 0.02, "dead": [1]}
BESIDE_THIN = ("thin", "elastic")


@cache
def broken() -> cx.SpatialResponse:
    return cx.simulate(pairs(BESIDE_THIN, matrix=MIXED, **CUT), stations=[0.0, 0.4], **SMALL)


def pressures(s: complex, k: float, order: int, radii: tuple[float, ...], kinds: list[Any]) -> np.ndarray:
    """Return the pressures of a fluid (rho = c = 1) on its faces per inward displacement of these, at sqrt(s^2 + k^2)."""
    kappa = np.sqrt(s * s + k * k)
    slopes = np.array([[kappa * slope(order, kappa * r) for _, slope in kinds] for r in radii])
    values = np.array([[value(order, kappa * r) for value, _ in kinds] for r in radii])
    return np.asarray(s * s * values @ np.linalg.inv(slopes))


class Dense:
    """All orders -top to top of a wave of a thin wall in an elastic one, three segments each of which the middle one is dead.

    Unknowns are U, V, W of the thin wall, the faces of the elastic one and the voltages of the live segments, wall by wall.
    """

    def __init__(self, problem: Any, modes: Modes, s: complex, outside: np.ndarray) -> None:
        self.thin, self.solid = problem.shells
        self.modes, self.s, self.outside, self.orders = modes, s, outside, np.arange(-modes.max_order, modes.max_order + 1)
        self.at, self.volts = np.arange(5 * self.orders.size).reshape(5, -1), 5 * self.orders.size + np.arange(4).reshape(2, 2)
        self.matrix, self.right = np.eye(self.volts.max() + 1, dtype=complex), np.zeros(self.volts.max() + 1, complex)
        self.read, self.heard = np.zeros((2, 2, self.right.size), complex), np.zeros((2, 2), complex)
        nodes, bare = np.array([s]), self.solid.with_gains(None)
        self.faced, self.given = bare.receptance(modes, nodes), bare.under_voltage(modes, nodes, bare.asked_of_stations)
        self.sigma = self.solid.station_port(modes, nodes)[1][-2]
        for place in range(self.orders.size):
            self._add_order(place)
        law = [complex(np.ravel(wall.gains.at(nodes, Modes(np.zeros(1))))[0]) for wall in problem.shells]
        for i, n, j in np.ndindex(2, 2, 2):
            self.matrix[self.volts[i, n]] -= law[i] * MIXED[i][j] * self.read[j, n]
            self.right[self.volts[i, n]] += law[i] * MIXED[i][j] * self.heard[j, n]
        self.answer = np.linalg.solve(self.matrix, self.right)

    def _add_order(self, place: int) -> None:
        signed, m = self.orders[place], abs(int(self.orders[place]))
        mine, faces, loads = self.at[:3, place], self.at[3:, place], self._loads(m)
        outside = (self.outside[0, m] - 1j * np.sign(signed) * self.outside[1, m]) * (1.0 if m == 0 else 0.5)
        block = self.thin.mass * self.s**2 * np.eye(3, dtype=complex)
        for value, (a, b) in zip(self.thin.dynamic_axial_stiffness(self.modes, np.array([self.s])), ENTRIES, strict=True):
            block[a, b] += value[m, 0]
            block[b, a] += value[m, 0] * (a != b)
        self.matrix[np.ix_(mine, mine)] = block
        entries = np.array([[self.faced.inner, self.faced.across], [self.faced.back, self.faced.outer]])[..., m, 0]
        both, sigma = entries * np.array(self.solid.wetted), self.sigma[:, m, 0]
        unknowns = np.array([mine[W], *faces])
        self.matrix[mine[W], unknowns] -= np.array(self.thin.wetted) @ loads[:2] / self.thin.radius
        self.matrix[np.ix_(faces, unknowns)] -= both @ loads[2:]
        self.right[faces] += both[:, 1] * outside
        push, gain = ([one.u[m], one.v[m], one.w[m]] for one in (self.thin.drive(self.modes), self.thin.sensor_gain(self.modes)))
        (thin_means, thin_pushed), (means, pushed) = (self._segments(wall, signed) for wall in (self.thin, self.solid))
        self.matrix[np.ix_(mine, self.volts[0])] -= np.outer(push, thin_pushed)
        self.matrix[np.ix_(faces, self.volts[1])] -= np.outer(self.given.faces[:, m, 0], pushed)
        self.read[0][:, mine] += np.outer(thin_means, gain)
        self.read[1][:, unknowns] += np.outer(means, sigma @ loads[2:])
        self.read[1][:, self.volts[1]] += np.outer(means, self.given.heard[m, 0] * pushed)
        self.heard[1] += means * sigma[1] * outside

    def _loads(self, m: int) -> np.ndarray:
        """Return inward loads on all four faces per W of the thin wall and the faces of the elastic one."""
        (r_0, r_1), (r_2, r_3), k = self.thin.wetted, self.solid.wetted, float(self.modes.wavenumber)
        inside, beyond, found = (special.iv, special.ivp), (special.kv, special.kvp), np.zeros((4, 3), complex)
        gap = pressures(self.s, k, m, (r_1, r_2), [inside, beyond])
        found[0, 0] = -pressures(self.s, k, m, (r_0,), [inside])[0, 0]
        found[1, :2], found[2, :2] = gap[0], -gap[1]
        found[3, 2] = pressures(self.s, k, m, (r_3,), [beyond])[0, 0]
        return found

    @staticmethod
    def _segments(wall: Any, signed: int) -> tuple[np.ndarray, np.ndarray]:
        """Return what live segments read of an order, means over each, and what a volt on each pushes on it."""
        x, weights = np.polynomial.legendre.leggauss(40)
        covered = wall.electrode_segments.covered
        means = np.array([0.5 * weights @ np.exp(1j * signed * (2 * np.pi / 3 * n + np.pi / 3 * covered * x)) for n in (0, 2)])
        return means, means.conj() * covered / 3


def test_a_wave_is_all_its_orders_at_once() -> None:
    """A thin wall by U, V and W, an elastic one by its faces, fluids by Bessel functions, live segments one by one, all in one matrix."""
    problem, top, s = dimensionless(pairs(BESIDE_THIN, matrix=MIXED, **CUT), 3), 3, np.array([0.7 + 6.0j])
    modes, outside = Modes.up_to(top, 2.3), np.random.default_rng(3).normal(size=(2, top + 1))
    outside[1, 0] = 0.0
    dense, wave = Dense(problem, modes, complex(s[0]), outside), FacedWave(problem, s, modes)
    faces, voltage = TiedFaces(wave, 2).closed([wave.cascade.solve_outside(each[:, None].astype(complex)) for each in outside])
    shown = np.stack([wave.read(one, 4, voltage[:, parity]) for parity, one in enumerate(faces)], axis=2)[..., 0]
    ahead, behind = dense.answer[dense.at][:, top:], dense.answer[dense.at][:, top::-1]
    waves = np.stack([ahead + behind, 1j * (ahead - behind)], axis=1) * np.where(np.arange(top + 1) == 0, 0.5, 1.0)
    moved = np.stack([np.stack([one[1].inner, one[1].outer]) for one in faces], axis=1)[..., 0]
    np.testing.assert_allclose(moved, waves[3:], rtol=0, atol=1e-8 * np.abs(waves[3:]).max())
    for row, unknown in ((0, W), (1, V), (2, U)):
        np.testing.assert_allclose(shown[row, 0], waves[unknown], rtol=0, atol=1e-8 * np.abs(waves[unknown]).max())
    for i, wall in enumerate(problem.shells):
        assert wall.electrode_segments is not None
        found, volts = wall.electrode_segments.values(voltage[i, ..., 0])[[0, 2]], dense.answer[dense.volts]
        np.testing.assert_allclose(found, volts[i], rtol=0, atol=1e-8 * np.abs(volts).max())
        units = wave.under_voltage(i)
        heard = np.stack([wave.sensed(j, units[j], float(i == j)) for j in (0, 1)])
        np.testing.assert_allclose(readings_per_volt(problem.open_loop, (0, 1), modes, s)[:, i], heard, rtol=1e-9)  # that poles know


def test_what_an_elastic_wall_shows_is_its_motion_by_loads_and_volts() -> None:
    for theories, loss_factor in ((BOTH, 0.0), (BOTH, 0.05)):
        problem, s = dimensionless(pairs(theories, loss_factor, matrix=MIXED), 3), np.array([0.7 + 6.0j, 2.0 + 40.0j])
        modes, wall = Modes.up_to(2, 1.5), problem.shells[1]
        assert isinstance(wall, ElasticWall)
        wave = FacedWave(problem, s, modes)
        ((faces,), voltage) = TiedFaces(wave, 1).closed([wave.cascade.solve_outside(np.ones((3, 2), complex))])
        asked, moving = wall.asked_of_stations, faces[1]
        by_loads, by_volts = wall.transfer(modes, s, asked, fed_back=False), wall.under_voltage(modes, s, asked).shown
        expected = wall.signs_of(asked)[..., 0] * (
            by_loads[:, 0] * moving.load_inner + by_loads[:, 1] * moving.load_outer + by_volts * voltage[1, 0]
        )
        shown = wave.read(faces, len(wall.piezoelectric) + 2, voltage[:, 0])[:, 1]
        for one, other in zip(shown, expected, strict=False):
            np.testing.assert_allclose(one, other, rtol=0, atol=1e-9 * np.abs(other).max())
        np.testing.assert_array_equal(shown[-1], voltage[1, 0])


@pytest.mark.parametrize(
    ("theories", "loss_factor", "law"),
    [(BOTH, 0.0, {**CUT, "matrix": MIXED}), (("elastic", "thin"), 0.05, {"segments": 3, "dead": [1]})],
    ids=["both", "lossy beside thin"],
)
def test_uniform_waves_are_two_dimensions(theories: tuple[str, str], loss_factor: float, law: dict[str, Any]) -> None:
    described = pairs(theories, loss_factor, **law).replace(source=PLANE)
    flat = cx.simulate(described, **{name: SMALL[name] for name in ("duration", "time_step", "modes")})
    space = cx.simulate(described, stations=[0.3], **SMALL)
    for read, where in (("sensor_voltage", {}), ("actuator_voltage", {}), ("stress", {}), ("stress", {"depth": "inner"})):
        one, other = (np.squeeze(np.asarray(getattr(each, read)("outer", [0.0, 70.0], **where))) for each in (flat, space))
        np.testing.assert_allclose(other, one, rtol=0, atol=1e-9 * np.abs(one).max())


def test_shells_that_read_themselves_many_segments_and_thin_walls() -> None:
    def moved(described: cx.System, modes: int = 3) -> np.ndarray:
        few = {**SMALL, "modes": modes, "axial_modes": 0.6, "time_step": 4e-2}
        return np.asarray(cx.simulate(described, stations=[0.0], **few).spatial.fields["w"][0, 1])

    own, unit = (moved(pairs(BESIDE_THIN, matrix=matrix)) for matrix in (None, [[1, 0], [0, 1]]))
    np.testing.assert_allclose(unit, own, rtol=0, atol=1e-12 * np.abs(own).max())
    whole = moved(pairs(BESIDE_THIN), 8)
    errors = [np.abs(moved(pairs(BESIDE_THIN, segments=count), 8) - whole).max() / np.abs(whole).max() for count in (4, 8)]
    assert errors[0] < 1e-2
    assert errors[0] / errors[1] > 2.5
    errors = []
    for scale in (1.0, 0.25):
        exact, thin = (moved(pairs(each, scale=scale, matrix=MIXED, **CUT)) for each in (BOTH, ("thin", "thin")))
        errors.append(np.linalg.norm(exact - thin) / np.linalg.norm(thin))
    assert errors[1] < 8e-4
    assert errors[1] < 0.27 * errors[0]


def test_balances_close_files_know_voltages_and_depths_are_read(tmp_path: Any) -> None:
    response = broken()
    energy = response.energy(every=5)
    assert float(np.abs(energy.closure_relative).max()) < 1e-4
    electrical = energy.amplifier_work - (energy.actuator_field - energy.actuator_work)
    assert float(np.abs(electrical).max()) < 1e-9 * float(np.abs(energy.actuator_work).max())
    voltage = response.spatial.at(1).segment_voltage
    assert voltage.shape == (2, 3, 21)
    assert np.abs(voltage[1, 0]).max() > 1.0
    assert not voltage[:, 1].any()
    kept = load_response(response.save(tmp_path / "run.nc"))
    np.testing.assert_allclose(kept.spatial.at(1).segment_voltage, voltage, rtol=0)
    effort = response.control_effort().at(0.4)["outer"]
    assert effort.voltage == pytest.approx(np.abs(voltage[1]).max())
    assert effort.charge is None  # that no station keeps of solids
    peak = response.peak_stress("outer", component="hoop")
    there = response.stress("outer", [peak.angle], depth=peak.depth, station=peak.station)
    assert peak.value == pytest.approx(float(np.abs(there).max()), rel=1e-3)


def test_poles_are_those_of_waves() -> None:
    late: dict[str, Any] = {"numerator": [1.4e-3, 0], "amplifier_corner": 5e3, "delay": "14 us", "segments": 5}
    rates = []
    for theories in (BESIDE_THIN, ("thin", "thin")):
        problem = dimensionless(pairs(theories, scale=0.5, **late), 3)
        found = growing(problem, 4, 1.0, 3.0)
        assert found is not None
        rates.append(fastest_growth(problem, 4, found, 1.0, 3.0))
    assert rates[0].pattern == rates[1].pattern
    assert rates[0].rate == pytest.approx(rates[1].rate, rel=0.05)
    problem = dimensionless(pairs(BESIDE_THIN, scale=0.5, **late), 3)
    s = np.array([rates[0].rate + 1j * rates[0].frequency])
    modes = Modes.up_to(4, 3.0)
    along = along_alone(problem, modes)
    here, near = (np.abs(determinants(along, along.open_loop, modes, x)[rates[0].pattern, 0]) for x in (s, s * (1 + 1e-4)))
    assert here < 1e-5 * near
    with pytest.raises(cx.InputError, match=r"control\.matrix: .* makes the closed loop unstable.* of all shells together grow"):
        cx.simulate(pairs(BOTH, matrix=[[0.0, 1.0], [1.0, 0.0]]), stations=[0.0], **SMALL)
