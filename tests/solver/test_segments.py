"""Electrodes cut into segments: the loops of patterns against all orders at once by hand, passivity, poles, and the continuous limit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.model import presets
from coaxshell.numerics.modes import Modes
from coaxshell.solver.contour import Contour
from coaxshell.solver.electrode_loops import ElectrodeLoops
from coaxshell.solver.electrode_patterns import patterns_of
from coaxshell.solver.recompute import spectra_of
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.taking_bands import all_taken
from coaxshell.solver.tied_stability import counted, determinants, fastest_growth, growing
from coaxshell.solver.voltage_response import VoltageResponse, controlled

PAIRS = presets.load("electrodes")
PLANE = PAIRS.replace(source=cx.PlaneShock(peak_pressure=25e3, decay_time=1.314e-4))
RUN = {"duration": 1.0, "time_step": 0.01, "modes": 24}
NODES = np.array([3.0 + 0.0j, 3.0 + 40.0j, 0.5 + 12.0j])


def cut(system: cx.System = PLANE, **control) -> cx.System:
    return system.with_overrides({f"control.{name}": value for name, value in control.items()})


def by_hand(problem, orders, response, s):
    """Return the law from readings to voltages in orders, (walls, 2 orders, nodes, walls, 2 orders): integrals over each live segment."""
    control = problem.system.control
    count, walls, fine = control.segments, len(response.shells), 4000
    found = np.zeros((s.size, walls, 2 * orders.size, walls, 2 * orders.size), np.complex128)
    for a, i in enumerate(response.shells):
        radius = problem.system.shells[i].radius
        angle = 2 * np.pi / count - (control.segment_gap or 0.0) / radius
        around = angle * ((np.arange(fine) + 0.5) / fine - 0.5)
        square = np.where(orders == 0, 2.0, 1.0) * np.pi
        projection = np.zeros((2 * orders.size, 2 * orders.size))
        for k in set(range(count)) - set(control.dead or ()):
            theta = 2 * np.pi * k / count + around
            waves = np.concatenate([np.cos(np.outer(orders, theta)), np.sin(np.outer(orders, theta))])
            mean = waves.mean(axis=1)
            projection += np.outer(angle * mean / np.tile(square, 2), mean)
        law = problem.shells[i].gains.at(s, Modes(np.zeros(1)))
        found[:, a, :, a, :] = law[:, None, None] * projection
    return found


@pytest.mark.parametrize("dead", [(), (1, 4)])
def test_loops_of_patterns_are_those_of_all_orders_at_once(dead):
    problem = dimensionless(cut(proportional=3.0, segments=5, segment_gap="20 mm", dead=list(dead)))
    modes = Modes.up_to(11)
    response = VoltageResponse.at(problem.open_loop, problem, modes, NODES)
    patterns = patterns_of(problem, response.shells, modes.orders, 2)
    loops = ElectrodeLoops.of(problem, response, patterns, NODES)
    free = np.random.default_rng(3).normal(size=(2, 2, 12, 3)) + 1j
    free[:, 1, 0] = 0.0  # order 0 has no sine
    given = patterns.in_orders(loops.voltages(patterns.readings(free)))

    law, size = by_hand(problem, modes.orders, response, NODES), 2 * 2 * 12
    reads = np.zeros((3, 2, 2, 12, 2, 2, 12), np.complex128)
    for parity in range(2):
        for m in range(12):
            reads[:, :, parity, m, :, parity, m] = np.moveaxis(response.read[:, :, m], -1, 0)
    law, reads = law.reshape(3, size, size), reads.reshape(3, size, size)
    matrix = np.eye(size) - law @ reads
    by_orders = np.linalg.solve(matrix, law @ np.moveaxis(free, -1, 0).reshape(3, size, 1))
    assert_allclose(np.moveaxis(given, -1, 0).reshape(3, size), by_orders[..., 0], rtol=2e-5, atol=2e-7 * np.abs(by_orders).max())
    together = np.prod(loops.determinants(), axis=0)
    assert_allclose(together, np.linalg.det(matrix), rtol=1e-5)


def test_segments_tend_to_the_continuous_electrode():
    whole = cx.simulate(PLANE, **RUN).solution
    errors = []
    for count in (6, 12, 24):
        run = cx.simulate(cut(segments=count), **RUN).solution
        errors.append(np.abs(run.normal - whole.normal).max() / np.abs(whole.normal).max())
    assert errors[0] < 8e-3
    assert errors[0] / errors[1] > 2.5  # (pi m/N)^2/3 of the orders that move
    assert errors[1] / errors[2] > 3.5


def test_energy_closes_with_dead_segments_and_gaps():
    system = cut(segments=8, segment_gap="10 mm", dead=[3])
    run = {"duration": 0.5, "time_step": 0.01, "modes": 12}
    response = cx.simulate(system, **run)
    voltage = response.solution.segment_voltage
    assert voltage.shape == (2, 8, 51)
    assert not voltage[:, 3].any()
    assert np.abs(voltage[1, 0]).max() > 10.0
    energy = response.energy()
    assert np.abs(energy.closure_relative).max() < 2e-5
    electrical = energy.amplifier_work - (energy.actuator_field - energy.actuator_work)
    assert np.abs(electrical).max() < 1e-6 * np.abs(energy.actuator_work).max()
    assert float(energy.actuator_work[-1]) > 0.0
    at = response.actuator_voltage("outer", [0.0, 22.4, 22.5, 135.0, -135.0]).to_numpy()
    assert_allclose(at[:, 0], voltage[1, 0])
    assert not at[:, 2].any()  # between two segments
    assert not at[:, 3].any()
    assert_allclose(at[:, 4], voltage[1, 5])
    mirror = cx.simulate(cut(segments=8, segment_gap="10 mm", dead=[5]), **run).solution
    assert_allclose(mirror.segment_voltage[:, 3], voltage[:, 5], rtol=1e-9, atol=1e-9)
    assert_allclose(mirror.normal[:, 1], -response.solution.normal[:, 1], rtol=1e-9, atol=1e-16)


def test_stress_of_driven_ceramics_has_the_voltage_of_each_segment():
    response = cx.simulate(cut(segments=8), **RUN)
    angles = np.array([10.0, 22.4, 22.6, 30.0])
    at = response.stress("outer", angles, depth=5e-3)
    volts = response.actuator_voltage("outer", angles).to_numpy()
    wall = response.solution.problem.shells[1]
    per_volt = wall.control_stress(5e-3) * response.solution.problem.scales.pressure
    motion = at.to_numpy() - per_volt * volts
    assert np.abs(np.diff(volts[:, 1:3])).max() > 1.0
    assert np.abs(np.diff(motion[:, 1:3])).max() < 0.05 * np.abs(motion).max()  # what strains make goes on across the cut


def test_stored_runs_know_their_segments(tmp_path):
    response = cx.simulate(cut(segments=6, dead=[2]), **RUN)
    kept = cx.load_response(response.save(tmp_path / "run.nc"))
    assert_allclose(kept.solution.segment_voltage, response.solution.segment_voltage, rtol=0)
    assert_allclose(spectra_of(kept.solution).voltage, response.solution.spectra.voltage, rtol=1e-9, atol=1e-12)


def test_collocated_segments_are_passive():
    problem = dimensionless(cut(proportional=50.0, derivative=10.0, segments=7, dead=[0]))
    assert growing(problem, 16, 0.5) is None
    contour = Contour.of(problem, Modes.up_to(16), 0.5)
    assert all_taken(problem, Modes.up_to(16), 0.5)
    assert counted(problem, Modes.up_to(16), contour) is None  # counted nevertheless: no pole


@pytest.mark.slow_for("dead0")
@pytest.mark.parametrize("dead", [(), (2,)])
def test_poles_of_late_loops_are_found(dead):
    law = cx.Feedback(numerator=[1.4e-3, 0], amplifier_corner=5e3, delay="20 us", transducers="electrodes", segments=8, dead=list(dead))
    system = PLANE.replace(control=law)
    problem, modes = dimensionless(system), Modes.up_to(12)
    found = growing(problem, 12, 1.0)
    assert found is not None
    fastest = fastest_growth(problem, 12, found, 1.0)
    if not dead:
        s = np.array([fastest.rate + 1j * fastest.frequency])
        beside = s * (1 + 1e-4)
        here, near = (np.abs(determinants(problem, problem.open_loop, modes, x)[fastest.pattern, 0]) for x in (s, beside))
        assert here < 1e-6 * near
    assert growing(problem, 12, 1.3 * fastest.rate) is None or dead
    with pytest.raises(InputError, match=r"control\.delay.*20\.00 µs makes the closed loop unstable.*(8 segments|all orders together)"):
        cx.simulate(system, duration=1.0, time_step=0.02, modes=12)


def test_both_walls_need_the_same_law_to_be_passive():
    problem = dimensionless(cut(derivative=[2.0, -1.0], segments=6))
    assert growing(problem, 12, 1.0) is not None
    with pytest.raises(InputError, match=r"control\.derivative"):
        cx.simulate(problem.system, duration=1.0, time_step=0.02, modes=12)


@pytest.mark.parametrize(
    ("control", "said"),
    [
        ({"segments": 30}, "control.segments: 30 segments push on order 30 as well, and the run ends at 24"),
        ({"segments": 0}, "control.segments"),
        ({"segments": 2.5}, "control.segments"),
        ({"dead": [1]}, "control.dead: is said of electrodes that are not cut"),
        ({"segment_gap": "1 mm"}, "control.segment_gap: is said of electrodes that are not cut"),
        ({"segments": 4, "dead": [4]}, "control.dead: 4 is no segment of 4"),
        ({"segments": 4, "dead": [1, 1]}, "control.dead"),
        ({"segments": 2, "dead": [0, 1]}, "control.dead: lists all 2 segments"),
        ({"segments": 4, "segment_gap": 1.0}, "control.segment_gap: 1 m leaves nothing of 4 segments of shells[0]"),
        ({"segments": 4, "transducers": "paper"}, "control.segments: 4 are not known to the paper's law"),
    ],
)
def test_bad_input_is_told_before_anything_is_computed(control, said):
    with pytest.raises(InputError) as told:
        cx.simulate(cut(**control), **RUN)
    assert str(told.value).startswith(said)


def test_where_segments_are_not_known_it_is_said():
    system = cut(segments=4)
    for call, said in [
        (lambda: cx.simulate(system, **RUN, engine="direct"), "direct engine"),
        (lambda: cx.frequency_response(system, 1000.0, "stress", shell=0, angle=0.0), "at a frequency"),
        (lambda: cx.gradient(system, metric="inner.rms_stress", variables=["control.derivative"], **RUN), "backwards"),
        (lambda: system.with_overrides({"shells[0].layers[0].role": "sensor"}), "reads or pushes alone"),
    ]:
        with pytest.raises(InputError) as told:
            call()
        assert said in str(told.value)


def test_a_modal_filter_of_segments_weighs_their_patterns():
    law = cx.Feedback(numerator=[1.4e-3, 0], transducers="electrodes", segments=8, weights=2)
    problem = dimensionless(PLANE.replace(control=law))
    response = VoltageResponse.at(problem.open_loop, problem, Modes.up_to(8), NODES)
    patterns = patterns_of(problem, controlled(problem), Modes.up_to(8).orders, 1)
    loops = ElectrodeLoops.of(problem, response, patterns, NODES)
    assert loops.law.shape == (2, 5, 3)
    assert not loops.law[:, 3:].any()
    assert loops.law[:, 2].all()
    with pytest.raises(InputError, match="modal filter"):
        law.replace(dead=[1])
    assert replace(patterns, parities=2).numbers.count == 8


@pytest.mark.parametrize("dead", [(), (1,)])
def test_ideal_loops_of_segments_are_warned_of(dead):
    system = cut(segments=6, dead=list(dead))
    (told,) = [text for text in cx.simulate(system, duration=1.0, time_step=0.02, modes=12).warnings if "the loop is ideal" in text]
    least = 1e6 * float(cx.stability_margins(cut(segments=6), duration=1.0, modes=12)["delay_margin"].min())
    assert float(told.split("delay: ")[1].split(" µs")[0]) == pytest.approx(least, rel=0.01)
    assert "order 3 with 9, ..., which 6 segments tie to it, grow" in told
