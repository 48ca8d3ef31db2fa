"""Segments and feedback across shells in three dimensions: two dimensions, all orders of a wave at once, balances, files, poles."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.model import presets
from coaxshell.numerics.modes import Modes
from coaxshell.response import load_response
from coaxshell.solver.axial.tied_wave import TiedWave
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.taking_bands import asymmetry
from coaxshell.solver.tied_stability import determinants, fastest_growth, growing
from coaxshell.structure.axial import ENTRIES, U, V, W

PAIRS = presets.load("electrodes")
PLANE = cx.PlaneShock(peak_pressure=25e3, decay_time=1.314e-4)
TIME = PAIRS.transit_time
SMALL: dict[str, Any] = {"duration": 0.5, "time_step": 2e-2, "modes": 5, "dimensions": 3, "stations": [0.0, 0.4]}
EIGHT = {**SMALL, "modes": 8, "stations": [0.0]}
MIXED = [[1.0, 0.5], [0.3, 0.8]]


def cut(system: cx.System = PAIRS, **control: Any) -> cx.System:
    return system.with_overrides({f"control.{name}": value for name, value in control.items()})


def under(matrix: Any, **others: Any) -> cx.System:
    return PAIRS.replace(control=cx.Feedback(numerator=[2 * TIME, 3.0], transducers="electrodes", matrix=matrix, **others))


@cache
def broken() -> cx.SpatialResponse:
    return cx.simulate(under(MIXED, segments=5, segment_gap="10 mm", dead=[1]), **SMALL)


@pytest.mark.parametrize("described", [cut(segments=5, dead=[1], segment_gap="10 mm"), under(MIXED)], ids=["segments", "matrix"])
def test_uniform_waves_are_two_dimensions(described):
    described = described.replace(source=PLANE)
    flat = cx.simulate(described, duration=0.5, time_step=2e-2, modes=5)
    space = cx.simulate(described, **{**SMALL, "stations": [0.3]})
    for read, where in (("sensor_voltage", {}), ("actuator_voltage", {}), ("stress", {}), ("stress", {"depth": "inner"})):
        one, other = (np.squeeze(np.asarray(getattr(each, read)("inner", [0.0, 80.0], **where))) for each in (flat, space))
        assert_allclose(other, one, rtol=0, atol=1e-10 * np.abs(one).max())
    if described.control.segments:
        efforts = [each.control_effort() for each in (flat, space)]
        plane, along = (one.shells[1].worst("real_power") for one in (efforts[0], efforts[1].each[0]))
        assert along.segment == plane.segment
        assert along.charge == pytest.approx(plane.charge, rel=1e-9)
        assert along.real_power == pytest.approx(plane.real_power, rel=0.1)  # the current by differences
        assert "largest voltage times current, one segment" in str(efforts[1])


def test_long_waves_tend_to_two_dimensions():
    problem, s = dimensionless(cut(segments=5, dead=[2]), 3), np.array([3.0 + 0.0j, 3.0 + 40.0j, 0.5 + 12.0j])
    normal = np.random.default_rng(5).normal(size=(2, 2, 8, 3)) + 1j
    normal[:, 1, 0] = 0.0
    flat, long = (TiedWave(problem, s, Modes.up_to(7, k)).driven(normal) for k in (0.0, 1e-6))
    for name in ("normal", "tangential", "voltage"):
        one, other = getattr(flat, name), getattr(long, name)
        assert_allclose(other, one, rtol=0, atol=1e-9 * np.abs(one).max())


@pytest.mark.parametrize(
    "described", [cut(segments=3, dead=[1], segment_gap="20 mm", proportional=3.0), under(MIXED)], ids=["cut", "matrix"]
)
def test_a_wave_is_all_its_orders_at_once(described):
    """All U, V and W of both walls, with integrals over each live segment taken numerically, in one matrix."""
    problem, modes, s, top = dimensionless(described, 3), Modes.up_to(4, 2.3), np.array([0.7 + 6.0j]), 5
    bare, wave = ModalSystem(problem.open_loop, s, modes), TiedWave(problem, s, modes)
    control, walls, size = problem.system.control, problem.shells, 2 * 2 * top * 3
    fluid = np.moveaxis(np.linalg.inv(np.moveaxis(bare.compliance(), (0, 1), (-2, -1))), (-2, -1), (0, 1))[..., 0]
    dense, place = np.zeros((size, size), np.complex128), np.arange(size).reshape(2, 2, top, 3)  # walls, parities, orders, (U, V, W)
    push, read = np.zeros((size, 4 * top), np.complex128), np.zeros((4 * top, size), np.complex128)
    for i, wall in enumerate(problem.open_loop.shells):
        k = wall.dynamic_axial_stiffness(modes, s)
        for parity, m in np.ndindex(2, top):
            at = place[i, parity, m]
            for value, (a, b) in zip(k, ENTRIES, strict=True):
                dense[at[a], at[b]] = dense[at[b], at[a]] = value[m, 0]
            dense[at, at] += wall.mass * s[0] ** 2
            for j in range(2):
                dense[at[W], place[j, parity, m, W]] += fluid[i, j, m] - (bare.shells[i].impedance[m, 0] if i == j else 0.0)
            row = (2 * i + parity) * top + m
            for gain, matrix in ((walls[i].drive(modes), push.T), (walls[i].sensor_gain(modes), read)):
                matrix[row, at] = [gain.u[m], gain.v[m], gain.w[m]]
    law = np.zeros((4 * top, 4 * top), np.complex128)
    for i, j in np.ndindex(2, 2):
        share = np.eye(2)[i, j] if control.model_dump().get("matrix") is None else control.matrix[i][j]
        factor = share * walls[i].gains.at(s, Modes(np.zeros(1))).ravel()[0]
        law[2 * i * top : 2 * (i + 1) * top, 2 * j * top : 2 * (j + 1) * top] = factor * projection(
            control, problem.system.shells[i].radius, top
        )
    loads = np.random.default_rng(7).normal(size=(2, 2, top))
    loads[:, 1, 0] = 0.0  # order 0 has no sine
    right = np.zeros(size, np.complex128)
    right[place[..., W]] = loads
    answer = np.linalg.solve(dense - push @ law @ read, right)[place]
    free = np.einsum("ijm,jhm->ihm", bare.compliance()[..., 0], loads)[..., None]
    parities = 2 if control.dead else 1  # which whole electrodes answer alike
    found = wave.driven(free[:, :parities])
    for moved, which in ((found.axial, U), (found.tangential, V), (found.normal, W)):
        assert_allclose(moved[..., 0], answer[:, :parities, :, which], rtol=0, atol=2e-7 * np.abs(answer[..., which]).max())
    ratio = np.linalg.det(np.eye(4 * top) - law @ read @ np.linalg.solve(dense, push))
    if control.dead:
        assert_allclose(determinants(problem, problem.open_loop, modes, s)[0, 0], ratio, rtol=1e-6)


def projection(control: Any, radius: float, top: int) -> np.ndarray:
    """Return from readings to voltages in orders, (cosines, then sines): integrals over each live segment."""
    if control.segments is None:
        return np.eye(2 * top)
    count, m = control.segments, np.arange(top)
    angle = 2 * np.pi / count - (control.segment_gap or 0.0) / radius
    around, found = angle * ((np.arange(4000) + 0.5) / 4000 - 0.5), np.zeros((2 * top, 2 * top))
    for k in set(range(count)) - set(control.dead or ()):
        theta = 2 * np.pi * k / count + around
        mean = np.concatenate([np.cos(np.outer(m, theta)), np.sin(np.outer(m, theta))]).mean(axis=1)
        found += np.outer(angle * mean / np.tile(np.where(m == 0, 2.0, 1.0) * np.pi, 2), mean)
    return found


def test_balances_close_with_the_electrical_row():
    energy = broken().energy(every=25)
    assert np.abs(energy.closure_relative).max() < 2e-5
    electrical = energy.amplifier_work - (energy.actuator_field - energy.actuator_work)
    assert np.abs(electrical).max() < 1e-6 * np.abs(energy.actuator_work).max()
    given = sum(one.energy for one in broken().control_effort(whole_length=True).over_length)
    assert given == pytest.approx(float(energy.amplifier_work[-1]), rel=0.1)  # by its values at steps of 0.02


def test_segments_have_one_voltage_each_and_files_know_them(tmp_path):
    response = broken()
    voltage = response.spatial.at(1).segment_voltage
    assert voltage.shape == (2, 5, 26)
    assert not voltage[:, 1].any()
    assert np.abs(voltage[1, 0]).max() > 1.0
    given = np.asarray(response.actuator_voltage("outer", [0.0, 20.0, 36.0, 72.0], station=0.4))
    assert_allclose(given[:, 0], voltage[1, 0])
    assert_allclose(given[:, 1], given[:, 0], rtol=1e-12, atol=0)
    assert not given[:, 2:].any()  # a strip, and the dead one
    kept = load_response(response.save(tmp_path / "run.nc"))
    assert_allclose(kept.spatial.at(1).segment_voltage, voltage, rtol=0)
    mirror = cx.simulate(under(MIXED, segments=5, segment_gap="10 mm", dead=[4]), **SMALL)
    assert_allclose(mirror.spatial.at(1).segment_voltage[:, 1:], voltage[:, :0:-1], rtol=0, atol=1e-9 * np.abs(voltage).max())


def test_many_segments_are_a_whole_electrode_and_own_rows_the_own_law():
    whole = cx.simulate(PAIRS, **EIGHT).spatial.fields["w"]
    errors = []
    for count in (4, 8):
        run = cx.simulate(cut(segments=count), **EIGHT).spatial.fields["w"]
        errors.append(np.abs(run - whole).max() / np.abs(whole).max())
    assert errors[0] < 1e-2
    assert errors[0] / errors[1] > 2.5
    own, unit = (cx.simulate(under(matrix), **SMALL).spatial.fields for matrix in (None, [[1, 0], [0, 1]]))
    for name, values in own.items():
        assert_allclose(unit[name], values, rtol=0, atol=1e-12 * np.abs(values).max())


def test_poles_are_those_of_waves():
    late = cx.Feedback(numerator=[1.4e-3, 0], amplifier_corner=5e3, delay="14 us", transducers="electrodes", segments=5)
    problem = dimensionless(PAIRS.replace(control=late), 3)
    assert growing(problem, 6, 1.0) is None
    found = growing(problem, 6, 1.0, 4.0)
    assert found is not None
    fastest = fastest_growth(problem, 6, found, 1.0, 4.0)
    s = np.array([fastest.rate + 1j * fastest.frequency])
    here, near = (np.abs(determinants(problem, problem.open_loop, Modes.up_to(6, 4.0), x)[fastest.pattern, 0]) for x in (s, s * (1 + 1e-4)))
    assert here < 1e-6 * near
    with pytest.raises(InputError, match=r"control\.delay: 14\.00 µs makes the closed loop unstable at the axial wavenumber .*5 segments"):
        cx.simulate(problem.system, **{**SMALL, "duration": 1.0})
    assert all(asymmetry(dimensionless(cut(segments=5, dead=[0]), 3), Modes.up_to(6, k)) == 0.0 for k in (0.0, 3.0))


def test_margins_of_waves_are_where_poles_cross():
    law = cx.Feedback(numerator=[20 * TIME, 0], transducers="electrodes", segments=5, dead=[2])
    told: list[float] = []
    system = PAIRS.replace(control=law)
    margins = cx.stability_margins(system, duration=0.5, modes=6, dimensions=3, progress=lambda share, _: told.append(share))
    assert told == sorted(told)
    assert told[-1] == 1.0
    assert dict(margins.sizes) == {"shell": 2, "wavenumber": 6, "order": 3}
    assert margins.attrs["segments"] == 5
    gain = margins["gain_margin"].to_numpy()
    assert not np.any(np.isfinite(gain) & (gain > 1e3))  # rounding of patterns without orders is no loop
    assert np.isnan(gain[:, -1, 1:]).all()
    k = float(margins["wavenumber"][3]) * system.reference_radius
    delay = float(margins["delay_margin"][:, 3].min())
    top = int(6 * np.sqrt(1 - (k / 6) ** 2) + 1e-9)
    for factor, grows in ((0.9, False), (1.1, True)):
        later = dimensionless(system.with_overrides({"control.delay": factor * delay}), 3)
        assert (growing(later, top, 2.0, k) is not None) == grows
    crossed = cx.stability_margins(under(MIXED), duration=0.5, modes=3, dimensions=3)
    assert np.isfinite(crossed["delay_margin"].min(("wavenumber", "order"))).all()


def test_what_is_not_solved_is_refused_with_a_remedy():
    rings = presets.load("electrodes-hybrid").absorbers
    for system, said in (
        (
            cut(segments=4).replace(absorbers=rings),
            r"control\.segments: 4 segments .* march of line absorbers .*use linear springs, point absorbers",
        ),
        (cut(segments=30), r"control\.segments: 30 segments push on order 30 as well, and the run ends at 5"),
    ):
        with pytest.raises(InputError, match=said):
            cx.simulate(system, **SMALL)
