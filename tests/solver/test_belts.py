"""Electrodes cut along the axis: every belt by itself in one matrix, limits, balances, poles, and what is refused."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.model import presets
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.response import load_response
from coaxshell.solver.axial.belt_ties import TiedClass, tie_of_broken, ties_of_belts
from coaxshell.solver.axial.belts import classes_of, driven_sets
from coaxshell.solver.axial.sampling import FAR, AxialSampling
from coaxshell.solver.axial.stability import require_stable_waves
from coaxshell.solver.contour import Contour, highest_frequency
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.electrode_patterns import patterns_of
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.segmented_margins import segmented_loops
from coaxshell.solver.tied_stability import fastest_growth_of, growing_of
from coaxshell.solver.voltage_response import VoltageResponse
from coaxshell.structure.axial import ENTRIES, U, V, W
from coaxshell.structure.belts import BeltClasses, Belts

PAIRS = presets.load("electrodes")
PLANE = cx.PlaneShock(peak_pressure=25e3, decay_time=1.314e-4)
TIME, A = PAIRS.transit_time, PAIRS.reference_radius
SMALL: dict[str, Any] = {"duration": 0.5, "time_step": 2e-2, "modes": 5, "dimensions": 3, "stations": [0.0, 0.4, 0.75]}
FEW = SMALL | {"duration": 0.3, "modes": 4, "axial_modes": 5}
MIXED = [[1.0, 0.5], [0.3, 0.8]]


def cut(**control: Any) -> cx.System:
    return PAIRS.with_overrides({f"control.{name}": value for name, value in control.items()})


def late(**others: Any) -> cx.System:
    law = {"numerator": [1.4e-3, 0], "amplifier_corner": 5e3, "delay": "14 us", "transducers": "electrodes"}
    return PAIRS.replace(control=cx.Feedback(**law | {"segment_pitch": 0.6} | others))


@cache
def broken() -> cx.SpatialResponse:
    return cx.simulate(
        cut(segment_pitch=0.8, segment_length=0.7, segments=4, segment_gap="20 mm", dead=[2]).with_overrides({"source.z": 0.3}), **SMALL
    )


def dense(problem: Problem, modes: Modes, s: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return (U, V, W) of all walls and orders per load on each, and the matrices of pushes and readings: nothing eliminated."""
    top = modes.count
    bare = ModalSystem(problem.open_loop, s, modes)
    fluid = np.moveaxis(np.linalg.inv(np.moveaxis(bare.compliance(), (0, 1), (-2, -1))), (-2, -1), (0, 1))[..., 0]
    size = 2 * top * 3
    matrix, place = np.zeros((size, size), np.complex128), np.arange(size).reshape(2, top, 3)
    push, read = np.zeros((size, 2 * top)), np.zeros((2 * top, size))
    for i, m in np.ndindex(2, top):
        at, wall = place[i, m], problem.open_loop.shells[i]
        for value, (a, b) in zip(wall.dynamic_axial_stiffness(modes, s), ENTRIES, strict=True):
            matrix[at[a], at[b]] = matrix[at[b], at[a]] = value[m, 0]
        if modes.two_dimensional or m == 0:  # U or V, which couple to nothing
            matrix[at[U if modes.two_dimensional else V], :] = matrix[:, at[U if modes.two_dimensional else V]] = 0.0
            matrix[at[V], at[V]] += 1.0 if m == 0 else 0.0
        matrix[at, at] += wall.mass * s[0] ** 2
        for j in range(2):
            matrix[at[W], place[j, m, W]] += fluid[i, j, m] - (bare.shells[i].impedance[m, 0] if i == j else 0.0)
        for gain, rows in ((problem.shells[i].drive(modes), push.T), (problem.shells[i].sensor_gain(modes), read)):
            rows[i * top + m, at] = [0.0 if gain.u is None else gain.u[m], gain.v[m], gain.w[m]]
    return np.linalg.inv(matrix), push, read


@pytest.mark.parametrize(
    ("others", "count", "z0"),
    [
        ({}, 3, 0.3),
        ({"segments": 3, "segment_gap": "20 mm"}, 3, 0.3),
        ({"segments": 3, "segment_gap": "20 mm", "dead": [0]}, 3, 0.3),
        ({"dead_belts": [1]}, 4, 0.0),
        ({"segments": 3, "segment_gap": "20 mm", "dead_belts": [0, -1]}, 3, 0.3),
        ({"segments": 4, "segment_gap": "20 mm", "dead": [2], "dead_belts": [1], "dead_electrodes": [[0, 0], [-1, 1], [-1, 3]]}, 3, 0.3),
    ],
    ids=["whole around", "segments", "dead", "dead belt", "dead belts of segments", "dead electrodes"],
)
def test_belts_are_all_waves_and_all_belts_at_once(others, count, z0):
    """Some belts of a period, both parities along the axis, means over each belt and segment taken numerically."""
    law = cx.Feedback(numerator=[2 * TIME, 3.0], transducers="electrodes", matrix=MIXED, segment_pitch=1.0, segment_length=0.7, **others)
    system = PAIRS.replace(control=law).with_overrides({"source.z": z0})
    problem, sampling, grid = dimensionless(system, 3), AxialSampling(count / A, 4, 5.5), LaplaceGrid(0.02, 25)
    belts, block, top = problem.belts, slice(3, 4), 5
    assert belts is not None
    (waves,) = driven_sets(problem, sampling, np.zeros(1), grid, block)
    s, numbers = grid.nodes[block], np.arange(1 - len(sampling.modes), len(sampling.modes))
    z = belts.length * ((np.arange(4000) + 0.5) / 4000 - 0.5)
    law_at = problem.shells[0].gains.at(s, Modes(np.zeros(1))).ravel()[0]
    fed = np.zeros((count * 2 * top, count * 2 * top), np.complex128)
    for n in range(count):
        around = projection(law, problem.system.shells, top, n - count if n == count - 1 else n)
        part = slice(n * 2 * top, (n + 1) * 2 * top)
        fed[part, part] = np.kron(np.array(MIXED) * law_at, np.ones((top, top))) * around
    loops, right = np.eye(count * 2 * top, dtype=np.complex128), np.zeros(count * 2 * top, np.complex128)
    kept = np.zeros((count * top, count * top))
    middles, found = belts.pitch * np.arange(count), {}
    for q in numbers:
        k, orders = sampling.spacing * q, sampling.modes[abs(q)].count
        found[q] = dense(problem, sampling.modes[abs(q)], s)
        inverse, push, read = found[q]
        seen = np.exp(1j * k * np.add.outer(middles, z)).mean(axis=1)  # of e^{ikz}, by each belt
        held = np.real(np.multiply.outer(seen, seen.conj())) * belts.length / sampling.period
        pad = np.arange(2 * top).reshape(2, top)[:, :orders].ravel()
        whole = np.zeros((2 * top, 2 * top), np.complex128)
        whole[np.ix_(pad, pad)] = read @ inverse @ push
        loops -= fed @ np.kron(np.multiply.outer(seen, seen.conj()) * belts.length / sampling.period, whole)
        kept += np.kron(held, np.diag(np.arange(top) < orders))
        free = waves.belts.amplitudes(abs(q))[0][:3, :, 0, :, 0]  # of the source alone, half of cos k(z - z0) each way
        phi = np.zeros(2 * top, np.complex128)
        phi[pad] = read @ free[[2, 1, 0]].transpose(1, 2, 0).ravel()
        share = (1.0 if q == 0 else 0.5) * sampling.weights[abs(q)] * np.exp(-1j * k * z0 / A)
        right += fed @ np.kron(seen * share, phi)
    inverse, push, read = dense(problem, Modes.up_to(4, FAR * 5.5), s)
    missing = (np.eye(count * top) - kept).reshape(count, top, count, top)
    full = np.einsum("amcm,imjn->aimcjn", missing, (read @ inverse @ push).reshape(2, top, 2, top)).reshape(loops.shape)
    loops -= fed @ full
    volts = np.linalg.solve(loops, right).reshape(count, 2, top)
    classes = classes_of(belts, sampling)
    patterns, told = classes.patterns(np.arange(float(count))), np.zeros((count, 2, top), np.complex128)
    for number in range(classes.classes):
        told += np.einsum("an,awm->nwm", patterns[..., number], waves.belts.voltages(number)[:, :, 0, :, 0])
    assert np.abs(volts).max() > 0.0
    assert_allclose(told, volts, rtol=0, atol=1e-7 * np.abs(volts).max())
    wave, parts = 2, waves.belts.amplitudes(2)
    given = sum(belts.length / sampling.period * np.exp(-1j * sampling.spacing * wave * middles[n]) * volts[n] for n in range(count))
    given = given * np.exp(1j * sampling.spacing * wave * z).mean()
    inverse, push, _ = found[wave]
    orders = sampling.modes[wave].count
    moved = (inverse @ push @ given[:, :orders].ravel()).reshape(2, orders, 3)[..., [W, V, U]].transpose(2, 0, 1)
    both = 0.5 * (parts[1][:3, :, 0, :, 0] - 1j * parts[2][:3, :, 0, :, 0])
    assert_allclose(both, moved, rtol=0, atol=1e-6 * np.abs(moved[0]).max())


def projection(law: Any, shells: Any, top: int, belt: int) -> np.ndarray:
    """Return from readings of both walls to their voltages in orders, cosines alone: means over each segment of one, loads of the other."""
    if belt in (law.dead_belts or ()):
        return np.zeros((2 * top, 2 * top))
    m, weight = np.arange(top), np.where(np.arange(top) == 0, 2.0, 1.0) * np.pi
    if law.segments is None:
        return np.kron(np.ones((2, 2)), np.eye(top))
    angles = [2 * np.pi / law.segments - law.segment_gap / shells[wall].radius for wall in range(2)]
    found = np.zeros((2, top, 2, top))
    for k in set(range(law.segments)) - set(law.dead or ()) - {segment for n, segment in law.dead_electrodes or () if n == belt}:
        theta = 2 * np.pi * k / law.segments + np.multiply.outer(angles, (np.arange(4000) + 0.5) / 4000 - 0.5)
        means = [np.cos(np.outer(m, one)).mean(axis=1) for one in theta]
        for i, j in np.ndindex(2, 2):
            found[i, :, j] += np.outer(angles[i] * means[i] / weight, means[j])
    return found.reshape(2 * top, 2 * top)


@pytest.mark.parametrize("covered", [1.0, 0.7])
def test_waves_of_a_class_read_all_that_they_are_given(covered):
    for count in (1, 4, 5):
        classes = BeltClasses(Belts(0.5, 0.5 * covered), count, np.arange(40_000.0) * (2 * np.pi / (0.5 * count)))
        assert_allclose(classes.kept(np.full(40_000, 9.0), np.zeros(1))[:, 0], 1.0, rtol=0, atol=2e-4)
        assert sorted(wave for number in range(classes.classes) for wave in classes.waves_of(number)) == list(range(40_000))


def test_a_voltage_on_one_wall_is_heard_on_another_as_there():
    problem, s = dimensionless(cut(segment_pitch=0.8), 3), np.array([0.7 + 6.0j])
    for tie in ties_of_belts(problem, AxialSampling(4 * 0.8 / A, 4, 6.0)):
        read = tie.response(problem.open_loop, problem, s).read
        radius = np.array([wall.radius for wall in problem.shells])[:, None, None]
        assert_allclose(radius[0] * read[0, 1], radius[1] * read[1, 0], rtol=1e-9)


def test_short_belts_without_gaps_are_a_whole_electrode():
    problem, sampling, s, errors = dimensionless(cut(segment_pitch=0.8), 3), AxialSampling(8.0, 2, 60.0), np.array([3.0 + 4.0j]), []
    waves = [VoltageResponse.at(problem.open_loop, problem, modes, s).read[:, :, :1, 0] for modes in sampling.modes]
    law = problem.shells[0].gains.at(s, Modes(np.zeros(1))).ravel()[0]
    for count in (5, 10, 20):
        classes = BeltClasses(Belts(8.0 / count, 8.0 / count), count, sampling.wavenumbers)
        worst = 0.0
        for wave in range(3):
            read = sum((classes.loop_shares[q] * waves[q] for q in classes.waves_of(wave)), np.zeros_like(waves[0]))
            given, whole = (np.linalg.inv(np.eye(2) - law * one[:, :, 0]) for one in (read, waves[wave]))
            worst = max(worst, np.abs(classes.read[0, wave] ** 2 * given - whole).max() / np.abs(whole).max())
        errors.append(worst)
    assert errors[0] / errors[1] > 3.0
    assert errors[1] / errors[2] > 3.0


def test_uniform_sources_move_all_belts_alike():
    run = cx.simulate(cut(segment_pitch=0.8).replace(source=PLANE), **{**SMALL, "axial_modes": 16})
    flat = cx.simulate(PAIRS.replace(source=PLANE), duration=0.5, time_step=2e-2, modes=5).solution.normal
    for w in run.spatial.fields["w"]:  # with no gap between them they are one electrode
        assert_allclose(w, flat, rtol=0, atol=1e-9 * np.abs(flat).max())
    gaps = cx.simulate(
        cut(segment_pitch=0.8, segment_length=0.5).replace(source=PLANE), **{**SMALL, "stations": [0.1, 0.9], "axial_modes": 16}
    )
    assert_allclose(gaps.spatial.fields["w"][1], gaps.spatial.fields["w"][0], rtol=0, atol=1e-12)  # 0.1 m from the middle each
    energy = gaps.energy(every=25)
    assert energy.attrs["extent"] == "per metre of length"
    assert np.abs(energy.closure_relative).max() < 2e-5
    problem, volts = gaps.spatial.problem, gaps.spatial.at(0).control_voltage[:, 0, :, -1]
    around = np.pi * np.where(np.arange(volts.shape[1]) == 0, 2.0, 1.0) @ volts.T**2
    held = sum(0.5 * wall.capacitance * wall.radius * each for wall, each in zip(problem.shells, around, strict=True))
    assert float(energy.actuator_field[-1]) == pytest.approx(problem.scales.line_energy * 0.5 / 0.8 * held, rel=1e-6)


def test_balances_close_and_amplifiers_are_told_at_stations():
    energy = broken().energy(every=25)
    assert np.abs(energy.closure_relative).max() < 2e-5
    electrical = energy.amplifier_work - (energy.actuator_field - energy.actuator_work)
    assert np.abs(electrical).max() < 1e-6 * np.abs(energy.actuator_work).max()
    effort = broken().control_effort(whole_length=True)
    given = sum(one.energy for one in effort.over_length)
    assert given == pytest.approx(float(energy.amplifier_work[-1]), rel=0.1)  # by its values at steps of 0.02
    over, between = effort.at(0.0).shells[1], effort.at(0.4).shells[1]
    assert over.worst("voltage").segment == 0
    assert over.charge > 0.0
    assert between.voltage == between.charge == between.real_power == 0.0


def test_a_belt_has_one_voltage_and_files_know_it(tmp_path):
    response = broken()
    voltage = response.spatial.at(0).segment_voltage
    assert voltage.shape == (2, 4, 26)
    assert not response.spatial.at(1).segment_voltage.any()  # between belts
    assert not voltage[:, 2].any()  # dead ones of all belts
    assert voltage[:, [0, 1, 3]].any(axis=(0, 2)).all()
    ends = cx.simulate(response.system, **{**SMALL, "stations": [0.3, 0.34, 0.36], "axial_period": response.spatial.settings.axial_period})
    assert_allclose(ends.spatial.at(1).segment_voltage, ends.spatial.at(0).segment_voltage, rtol=1e-12)
    assert_allclose(ends.spatial.at(1).segment_voltage, voltage, rtol=0, atol=1e-12 * np.abs(voltage).max())
    assert not ends.spatial.at(2).segment_voltage.any()
    kept = load_response(response.save(tmp_path / "run.nc"))
    assert_allclose(kept.spatial.at(0).segment_voltage, voltage, rtol=0)


@cache
def failed() -> cx.SpatialResponse:
    """Both kinds of dead ones, on one side of z = 0 alone."""
    single = {"dead_belts": [-1], "dead_electrodes": [[0, 2], [1, 0]]}
    return cx.simulate(cut(segment_pitch=0.8, segment_length=0.7, segments=4, segment_gap="20 mm", **single), **FEW)


def test_single_dead_electrodes_are_at_ground_and_the_others_are_not():
    run = cx.simulate(failed().system, **{**FEW, "stations": [0.0, 0.8, -0.8, 1.6]})
    here, beside, gone, far = (run.spatial.at(number).segment_voltage for number in range(4))
    largest = np.abs(here).max()
    assert not gone.any()
    assert not here[:, 2].any()
    assert not beside[:, 0].any()
    assert np.abs(here[:, [0, 1, 3]]).max(axis=(0, 2)).min() > 1e-3 * largest
    assert np.abs(beside[:, 1:]).max(axis=(0, 2)).min() > 1e-3 * largest
    assert np.abs(far).max() > 1e-3 * largest
    volts = run.spatial.fields["potential 3"]
    assert np.abs(volts[2]).max() == 0.0
    effort = run.control_effort().at(0.0)["inner"].segments
    assert effort[2].voltage == effort[2].current == effort[2].real_power == 0.0
    assert effort[0].current > 0.0


def test_balances_close_with_single_dead_electrodes():
    energy = failed().energy(every=15)
    assert np.abs(energy.closure_relative).max() < 2e-5
    electrical = energy.amplifier_work - (energy.actuator_field - energy.actuator_work)
    assert np.abs(electrical).max() < 1e-6 * np.abs(energy.actuator_work).max()


def test_belts_that_are_all_dead_leave_the_walls_alone():
    settings = {**FEW, "duration": 0.2, "axial_period": 8 * 0.8, "stations": [0.3]}
    dead = cx.simulate(cut(segment_pitch=0.8, dead_belts=list(range(-3, 5))), **settings)
    free = cx.simulate(PAIRS.replace(control=None), **settings)
    assert_allclose(dead.spatial.fields["w"], free.spatial.fields["w"], rtol=0, atol=1e-6 * np.abs(free.spatial.fields["w"]).max())
    assert not dead.spatial.at(0).control_voltage.any()


def test_poles_with_single_dead_belts_are_those_of_one_matrix_of_the_live_ones():
    problem = dimensionless(late(segment_length=0.5, dead_belts=[-1, 2]), 3)
    count, s, order = 5, np.array([1.0 + 7.0j, 0.8 + 30.0j]), 2
    sampling = AxialSampling(count * 0.6 / A, 4, 7.0)
    tie, belts = tie_of_broken(problem, sampling), problem.belts
    assert belts is not None
    told = tie.factors(problem.open_loop, problem, patterns_of(problem, (0, 1), tie.modes.orders, 1), s).reshape(-1, 5, s.size)[:, order]
    z = np.add.outer(belts.pitch * np.arange(count), belts.length * ((np.arange(2000) + 0.5) / 2000 - 0.5))
    whole, left = np.zeros((s.size, count, 2, count, 2), np.complex128), np.eye(count, dtype=np.complex128)
    law = np.stack([wall.gains.at(s, Modes(np.zeros(1))).ravel() for wall in problem.shells])
    for modes in sampling.modes:
        if order < modes.count:
            seen = np.exp(1j * float(modes.wavenumber) * z).mean(axis=1)
            held = np.multiply.outer(seen, seen.conj()).real * (2.0 if float(modes.wavenumber) else 1.0) * belts.length / sampling.period
            left -= held
            whole += np.einsum("nm,ijs->snimj", held, VoltageResponse.at(problem.open_loop, problem, modes, s).read[:, :, order])
    whole += np.einsum("nm,ijs->snimj", left, VoltageResponse.at(problem.open_loop, problem, sampling.far, s).read[:, :, order])
    live = [0, 1, 3]  # -1 is 4 of 5
    loops = np.eye(6) - np.einsum("is,snimj->snimj", law, whole)[:, live][:, :, :, live].reshape(s.size, 6, 6)
    assert_allclose(told.prod(axis=0), np.linalg.det(loops), rtol=1e-6)
    with pytest.raises(
        InputError, match=r"control\.delay: 14\.00 µs makes the closed loop unstable with its dead belts: .* motions, of all"
    ):
        require_stable_waves(problem, AxialSampling(3 * 0.6 / A, 1, 7.0), 1.0)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"dead_belts": [0]}, r"control\.dead_belts: is said of electrodes that are not cut along the axis; give segment_pitch"),
        ({"segment_pitch": 0.8, "dead_belts": [0, 0]}, r"control\.dead_belts: \[0, 0\] names a belt twice"),
        ({"segment_pitch": 0.8, "dead_belts": [10**400]}, r"control\.dead_belts: .* give a list of belts by number"),
        ({"segment_pitch": 0.8, "dead_belts": ["one"]}, r"control\.dead_belts: .* give a list of belts by number"),
        ({"segment_pitch": 0.8, "dead_electrodes": [[0, 1]]}, r"control\.dead_electrodes: names segments .* not cut around the wall"),
        ({"segment_pitch": 0.8, "segments": 4, "dead_electrodes": [[0, 4]]}, r"control\.dead_electrodes: \[0, 4\]: 4 is no segment of 4"),
        ({"segment_pitch": 0.8, "segments": 4, "dead_electrodes": [0, 4]}, r"control\.dead_electrodes: .* give pairs of a belt"),
        ({"segment_pitch": 0.8, "dead_belts": [40]}, r"control\.dead_belts: belt 40 is outside the axial period of .*axial_period=64\.8"),
    ],
)
def test_dead_ones_that_are_not_there_are_refused(changes, said):
    with pytest.raises(InputError, match=said):
        cx.simulate(cut(**changes), **SMALL)


def test_margins_do_not_know_single_dead_belts():
    with pytest.raises(InputError, match=r"control\.dead_belts: leaves no two belts alike"):
        cx.stability_margins(cut(segment_pitch=0.8, dead_belts=[1]), duration=0.5, modes=3, axial_modes=5.0, dimensions=3)


def test_poles_are_those_of_classes_of_waves():
    problem = dimensionless(late(segment_length=0.5), 3)
    ties = ties_of_belts(problem, AxialSampling(4 * 0.6 / A, 5, 7.0))
    assert len(ties) == 3
    found, _ = growing_of(problem, ties[1], 1.0)
    assert found is not None
    fastest = fastest_growth_of(problem, ties[1], found, 1.0)
    s = np.array([fastest.rate + 1j * fastest.frequency])
    laws = [wall.gains.at(s, Modes(np.zeros(1))).ravel()[0] for wall in problem.shells]
    read = ties[1].response(problem.open_loop, problem, s).read[:, :, fastest.pattern, 0]
    assert np.abs(np.linalg.det(np.eye(2) - np.array(laws)[:, None] * read)) < 1e-6
    with pytest.raises(InputError, match=r"control\.delay: 14\.00 µs makes the closed loop unstable at .* and those that the electrodes"):
        cx.simulate(problem.system, **{**SMALL, "duration": 1.0, "axial_modes": 7.0})
    assert growing_of(dimensionless(cut(segment_pitch=0.8, segments=4), 3), ties[0], 1.0)[1] == np.inf  # pairs take energy alone


def turns_of_all(problem: Problem, ties: list[TiedClass], order: int, shell: int, factor: float, delay: float) -> Any:
    """Return what gives the sign of the determinant of ten belts together at nodes, one wall's law times a factor and later.

    Of all that is even about the middle of one: what is odd grows alike, and two zeros at once are easily passed over.
    """
    belts, count = problem.belts, 10
    assert belts is not None
    z = np.add.outer(belts.pitch * np.arange(count), belts.length * ((np.arange(2000) + 0.5) / 2000 - 0.5))
    waves = [modes for tie in ties for modes in tie.waves if order < modes.count]
    seen = [np.exp(1j * float(modes.wavenumber) * z).mean(axis=1) for modes in waves]
    held = [np.real(np.multiply.outer(one, one.conj())) * belts.length / (count * belts.pitch) for one in seen]
    even = (np.eye(count) + np.eye(count)[-np.arange(count)])[:, : count // 2 + 1]
    even = even / np.linalg.norm(even, axis=0)
    held = [even.T @ one @ even * (2.0 if float(modes.wavenumber) else 1.0) for one, modes in zip(held, waves, strict=True)]

    def sign(s: np.ndarray) -> np.ndarray:
        parts = [*zip(held, waves, strict=True), (np.eye(len(held[0])) - np.sum(held, axis=0), ties[0].modes)]
        read = [VoltageResponse.at(problem.open_loop, problem, modes, s).read[:, :, order] for _, modes in parts]
        law = np.stack([wall.gains.at(s, Modes(np.zeros(1))).ravel() for wall in problem.shells])
        law[shell] *= factor * np.exp(-delay * s)
        whole = sum(np.einsum("nm,is,ijs->snimj", one, law, each) for (one, _), each in zip(parts, read, strict=True))
        size = 2 * len(held[0])
        return np.linalg.slogdet(np.eye(size) - whole.reshape(s.size, size, size))[0]

    return sign


def grows(sign: Any, s: np.ndarray) -> bool:
    """Return whether a determinant, 1 far away, turns on its way there as one with zeros beyond does; nodes are added until it tells."""
    found = sign(s)
    while (quick := np.abs(np.angle(found[1:] / found[:-1])) > 1.0).any():
        between = 0.5 * (s[1:] + s[:-1])[quick]
        place = np.flatnonzero(quick) + 1
        s, found = np.insert(s, place, between), np.insert(found, place, sign(between))
    turned = np.angle(found[1:] / found[:-1]).sum() + np.angle(1.0 / found[-1])
    return bool(np.rint(-turned / np.pi) > 0)


def test_margins_part_stable_belts_from_growing_ones():
    system = late(numerator=[0.2 * TIME, 1.0], amplifier_corner="20 kHz", weights=1, delay="4 us")
    margins = cx.stability_margins(system, duration=1.0, modes=2, axial_modes=8.0, dimensions=3)
    assert margins["wavenumber"].values == pytest.approx(np.linspace(0.0, np.pi / 0.6, 6))
    assert "cannot tell" in margins["wavenumber"].attrs["long_name"]
    problem = dimensionless(system, 3)
    ties = ties_of_belts(problem, AxialSampling(10 * 0.6 / A, 2, 8.0))
    nodes = Contour.of(problem, ties[0].modes, 1.0)._replace(fades=10.0 * highest_frequency(problem, 2, 8.0 * FAR)).nodes
    for name, shell, change in (
        ("gain_margin", "inner", lambda by, told: (1.0 + by * (told - 1.0), 0.0)),
        ("delay_margin", "outer", lambda by, told: (1.0, by * told / problem.scales.time)),
    ):
        each = margins[name].sel(shell=shell)
        told, order = float(each.min()), int(each.values.min(axis=0).argmin())
        assert np.isfinite(told)
        place = ["inner", "outer"].index(shell)
        found = [grows(turns_of_all(problem, ties, order, place, *change(by, told)), nodes) for by in (0.98, 1.02)]
        assert found == [False, True], name


def test_margins_of_belts_in_segments_are_told_by_pattern():
    margins = cx.stability_margins(
        late(segments=4, delay="1 us", numerator=[0.2 * TIME, 1.0]), duration=0.5, modes=4, axial_modes=6.0, dimensions=3
    )
    assert margins.attrs["segments"] == 4
    assert margins["delay_margin"].shape == (2, 6, 3)
    assert np.isfinite(margins["delay_margin"].min())
    with pytest.raises(InputError, match=r"control\.segment_length: .*axial_modes=6 or more"):
        cx.stability_margins(late(), duration=0.5, modes=3, dimensions=3)


def test_delay_margins_of_belts_with_dead_segments_part_stable_from_growing_ones():
    problem = dimensionless(late(segments=2, dead=[1], numerator=[0.2 * TIME, 1.0], delay="0.2 us"), 3)
    tie, place = ties_of_belts(problem, AxialSampling(4 * 0.6 / A, 2, 6.0))[1], 1
    least = segmented_loops(problem, tie, 1.0)[place].margins.delay.min()
    for factor, many in ((0.97, False), (1.03, True)):
        walls = list(problem.shells)
        walls[place] = walls[place].with_gains(walls[place].gains.late(factor * least))
        found, _ = growing_of(replace(problem, shells=tuple(walls)), tie, 1.0)
        assert (found is not None) == many


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"control.segment_length": 0.5}, r"control\.segment_length: is said of electrodes that are not cut along the axis"),
        ({"control.segment_pitch": 0.5, "control.segment_length": 0.6}, r"control\.segment_length: 0\.6 m is more than the 0\.5 m"),
        ({"control.segment_pitch": 0.5, "control.dead": [1]}, r"control\.dead: is said of electrodes that are not cut; give the number"),
        ({"control.segment_pitch": 0.5, "control.transducers": "paper"}, r"control\.segment_pitch: 0\.5 m: .* the paper's law"),
        ({"control.segment_pitch": 0.1}, r"control\.segment_length: 0\.1 m are less than half of the shortest wave .*axial_modes=32"),
        ({"control.segment_pitch": 0.8, "control.saturation": True}, r"control\.saturation: "),
    ],
)
def test_what_is_not_solved_is_refused_with_a_remedy(changes, said):
    with pytest.raises(InputError, match=said):
        cx.simulate(PAIRS.with_overrides(changes), **SMALL)


def test_runs_that_know_no_belts_refuse_them():
    rings, belts = presets.load("electrodes-hybrid").absorbers, cut(segment_pitch=0.8)
    for system, keywords, said in (
        (belts, {"modes": 5}, r"control\.segment_pitch: .*a plane run is alike all along it; use dimensions=3"),
        (belts.replace(absorbers=rings), SMALL, r"control\.segment_pitch: .*beside absorbers"),
        (belts.replace(source=PLANE.replace(inclination=20.0)), SMALL, r"control\.segment_pitch: .*a wave that runs along it"),
        (belts, {**SMALL, "axial_period": 10.0}, r"axial_period: 10 m is no whole number of electrodes 0\.8 m apart; give 10\.4 m"),
    ):
        with pytest.raises(InputError, match=said):
            cx.simulate(system, **keywords)
