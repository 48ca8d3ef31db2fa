"""Control by electrodes: the numbers of an independent derivation, stability before any inversion, and what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.model import presets
from coaxshell.numerics.modes import Modes
from coaxshell.response.voltages import demanded_voltage
from coaxshell.solver.delay_margin import delay_margin
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.solver.solution import ModalSolution
from coaxshell.solver.solve import prepare, solve_prepared
from coaxshell.solver.stability import fastest_growth, poles_beyond, unstable_poles

BARE = presets.load("bare")
PLANE = BARE.replace(source=cx.PlaneShock(peak_pressure=BARE.source.peak_pressure, decay_time=BARE.source.decay_time))
FACES = (-3e-3, 0.0, 3e-3)


def electrodes(proportional, derivative, sensor="passive", actuator="self-sensing", **changes) -> cx.System:
    """Return the paper's double shell under a plane wave with its layers in other roles and control by electrodes."""
    roles = {f"shells[{i}].layers[{j}].role": role for i in (0, 1) for j, role in ((0, sensor), (2, actuator))}
    control = cx.PDControl(proportional=proportional, derivative=derivative, transducers="electrodes", **changes)
    return PLANE.with_overrides({**roles, "control": control})


def dry(system: cx.System, radius: float) -> cx.System:
    """Return the outer shell by itself, of another radius, beside a fluid too light to matter."""
    light = cx.Fluid(density=1e-6, sound_speed=1400)
    return system.replace(shells=[system.shells[1].replace(radius=radius)], fluids=["vacuum", light])


def collocated(proportional: float, derivative: float, *, membrane: bool = False) -> Problem:
    """Return a problem whose open-circuit sensors lie where the actuators are, or both as if in the middle of the wall."""
    problem = dimensionless(electrodes(proportional, derivative, "sensor", "actuator"))
    walls = []
    for wall in problem.shells:
        sensor, actuator = wall.section.piezoelectric
        where = 0.0 if membrane else actuator.centre
        layers = replace(sensor, centre=where), replace(actuator, centre=where)
        walls.append(replace(wall, section=replace(wall.section, piezoelectric=layers)))
    return replace(problem, shells=tuple(walls))


def solved(problem: Problem, modes: int, duration: float, time_step: float = 4e-3) -> ModalSolution:
    settings = Settings(duration=duration, time_step=time_step, modes=modes)
    return solve_prepared(prepare(problem, settings), problem, settings)


def largest(solution: ModalSolution, shell: int) -> tuple[float, float, float]:
    """Return the largest stress of the core at the mid-surface and at its faces (MPa), by hand, and the largest voltage."""
    wall, m = solution.problem.shells[shell], np.arange(solution.normal.shape[2])
    angles = np.cos(np.outer(m, np.radians(np.arange(0.0, 180.25, 0.5))))
    scales, stresses = solution.problem.scales, []
    for z in FACES:
        strain_v = m / wall.radius * (1.0 + z / wall.radius)
        strain_w = -1.0 / wall.radius - z * m**2 / wall.radius**2
        modal = strain_v[:, None] * solution.tangential[shell, 0] + strain_w[:, None] * solution.normal[shell, 0]
        stresses.append(wall.section.core_modulus * scales.pressure * float(np.abs(modal.T @ angles).max()) / 1e6)
    volts = float(np.abs(demanded_voltage(solution, shell)[0].T @ angles).max())
    return stresses[1], max(stresses), volts


# gains, membrane strain alone: mid-surface and face of the inner and of the outer core (MPa), voltages, from the independent derivation
TABLE = [
    ((0, 2), False, (0.091, 0.108), (0.113, 0.146), (98, 61)),
    ((0, 10), False, (0.062, 0.079), (0.092, 0.127), (158, 161)),
    ((100, 10), False, (0.044, 0.061), (0.077, 0.112), (187, 218)),
    ((0, 10), True, (0.045, 0.057), (0.050, 0.075), (154, 159)),
    ((100, 10), True, (0.019, 0.036), (0.031, 0.057), (184, 218)),
]


@pytest.mark.slow
@pytest.mark.parametrize(("gains", "membrane", "inner", "outer", "volts"), TABLE, ids=str)
def test_the_whole_table(gains, membrane, inner, outer, volts):
    solution = solved(collocated(*gains, membrane=membrane), modes=100, duration=4.0)
    for shell, wanted in enumerate((inner, outer)):
        mid, face, voltage = largest(solution, shell)
        assert mid == pytest.approx(wanted[0], abs=6e-4)
        assert face == pytest.approx(wanted[1], abs=6e-4)
        assert voltage == pytest.approx(volts[shell], abs=0.7)


def test_a_row_of_the_table():
    # Strain of the mid-surface has few orders: the row of M = 100, but for the faces, at M = 24.
    solution = solved(collocated(0, 10, membrane=True), modes=24, duration=1.4, time_step=8e-3)
    (inner, _, inner_volts), (outer, _, outer_volts) = largest(solution, 0), largest(solution, 1)
    assert (inner, outer) == pytest.approx((0.045, 0.050), abs=6e-4)
    assert (inner_volts, outer_volts) == pytest.approx((154, 159), abs=0.7)


def test_open_sensors_without_feedback():
    response = cx.simulate(electrodes(0, 0, "sensor", "actuator"), duration=1.6, time_step=8e-3, modes=24)
    none = cx.simulate(PLANE, duration=1.6, time_step=8e-3, modes=24)
    assert response.summary().shells[0].stress.value / 1e6 == pytest.approx(0.196, abs=6e-4)
    assert none.summary().shells[0].stress.value / 1e6 == pytest.approx(0.204, abs=6e-4)
    ceramic = response.layer_peaks("inner", component="hoop")[0]
    free = none.layer_peaks("inner", component="hoop")[0]
    assert ceramic.value > 1.15 * free.value  # its own field stiffens it


def test_a_bridge_lacks_the_stiffness_of_an_open_circuit():
    # An open sensor in the driven layer adds one to k_p, and nothing else.
    bridge, modes, s = dimensionless(electrodes(3.0, 5.0)), Modes(np.arange(9.0)), np.array([2.0 + 30.0j])
    beside = collocated(2.0, 5.0)
    for one, other in zip(bridge.shells, beside.shells, strict=True):
        np.testing.assert_allclose(one.operator(modes, s).impedance, other.operator(modes, s).impedance, rtol=1e-12)


def test_a_charge_sensor_reads_as_an_open_one_and_stiffens_nothing():
    # In the driven layer's place it is the bridge; an open sensor there adds one to k_p.
    modes, s = Modes(np.arange(9.0)), np.array([2.0 + 30.0j])
    bridge, charged = dimensionless(electrodes(3.0, 5.0)), dimensionless(electrodes(3.0, 5.0, "charge-sensor", "actuator"))
    for wall, other in zip(charged.shells, bridge.shells, strict=True):
        sensor, actuator = wall.section.piezoelectric
        layers = replace(sensor, centre=actuator.centre), actuator
        moved = replace(wall, section=replace(wall.section, piezoelectric=layers))
        np.testing.assert_allclose(moved.operator(modes, s).impedance, other.operator(modes, s).impedance, rtol=1e-12)
    open_ones = dimensionless(electrodes(3.0, 5.0, "sensor", "actuator"))
    for wall, other in zip(charged.shells, open_ones.shells, strict=True):
        np.testing.assert_array_equal(wall.sensor_gain(modes).v, other.sensor_gain(modes).v)
        assert (wall.stiffness(modes).vv[1:] < other.stiffness(modes).vv[1:]).all()


def test_charge_sensors_are_refused_where_they_are_not_known():
    charged = electrodes(0.0, 0.0, "charge-sensor", "self-sensing")
    with pytest.raises(InputError, match="paper's law"):
        charged.with_overrides({"control.transducers": "paper"})


class TestEnergy:
    @pytest.mark.parametrize("loss_factor", [0.0, 0.05])
    def test_amplifiers_give_what_walls_and_fields_get(self, loss_factor):
        system = electrodes([5.0, -2.0], [0.5, 1.0], sensor="sensor").with_overrides({"materials.aluminium.loss_factor": loss_factor})
        energy = cx.simulate(system, duration=0.6, time_step=5e-3, modes=4).energy()
        work = float(np.abs(energy["exterior_work"]).max())
        assert float(np.abs(energy["closure_relative"]).max()) < 1e-6
        supply = energy["amplifier_work"] + energy["actuator_work"] - energy["actuator_field"]
        size = float(np.abs(energy["amplifier_work"]).max())
        assert size > 0.0
        assert float(np.abs(supply).max()) < 1e-6 * max(size, work)

    def test_collocated_pairs_are_passive(self):
        energy = cx.simulate(electrodes(0.0, 5.0), duration=1.5, time_step=0.01, modes=4).energy()
        taken = np.asarray(energy["actuator_work"])
        assert np.all(np.diff(taken) >= -1e-9 * taken.max())
        assert taken[-1] > 0.05 * float(energy["exterior_work"].max())


class TestStability:
    """Roots of dry walls with sensor and actuator on opposite faces, beside a fluid too light to matter."""

    @pytest.mark.parametrize(
        ("radius", "derivative", "order", "root"),
        [(1.0, 10.0, 10, (0.3185843166, 0.8242846815)), (0.5, 20.0, 30, (27.36622028 / 2, 0.0))],
    )
    def test_opposite_faces(self, radius, derivative, order, root):
        # A transit of a shell of half the radius is half as long: twice k_d is the same law, half the rate the same growth.
        problem = dimensionless(dry(electrodes(0.0, derivative, "sensor", "actuator"), radius))
        found = unstable_poles(problem, order, 20.0)
        assert order in found.orders
        np.testing.assert_array_equal(found.counts[found.orders == order], 2.0)
        growth = fastest_growth(problem, np.array([float(order)]), 0.05)
        assert (growth.order, growth.rate, growth.frequency) == pytest.approx((order, *root), rel=2e-8)

    def test_refused_with_orders_growth_frequency_and_what_to_change(self):
        with pytest.raises(InputError, match=r"control\.derivative: 10 makes the closed loop unstable: orders 7, 8, ") as caught:
            cx.simulate(electrodes(0, 10, "sensor", "actuator"), duration=4, modes=12)
        for part in ("fastest order 12 by e^(", "in transits, at ", "Hz", 'role = "self-sensing"', "positive gains stiffen and damp"):
            assert part in str(caught.value)

    def test_water_lets_softened_bending_grow(self):
        # k_p < 10 leaves every dry root on the axis, but the membrane's left and right eigenvectors then move w against each other, and
        # the water's resistance pushes instead of braking: l_w r_w/(l r) < 0.
        problem = dimensionless(electrodes(9.0, 0.0, "sensor", "actuator"))
        assert unstable_poles(problem, 40, 4.0).orders.size > 0
        wall, modes = problem.shells[0], Modes(np.array([26.0]))
        k, push, read = wall.stiffness(modes), wall.drive(modes), wall.sensor_gain(modes)
        matrix = np.array([[k.vv[0], k.vw[0]], [k.vw[0], k.ww[0]]]) - 9.0 * np.outer([push.v[0], push.w[0]], [read.v[0], read.w[0]])
        values, right = np.linalg.eig(matrix)
        left = np.linalg.inv(right).T
        assert np.all(values > 0)
        assert (left[1] * right[1])[values.argmax()] < 0

    def test_the_least_feedback_counts_where_a_membrane_resonates(self):
        # s^2 + omega^2 - c s = 0 grows by c/2 however small c is against omega: here 0.8 against 34.
        problem = dimensionless(dry(electrodes(0.0, -0.02), 1.0))
        wall, modes = problem.shells[0], Modes(np.array([12.0]))
        damping = float((wall.drive(modes).v * wall.sensor_gain(modes).v)[0]) * -0.02 / wall.mass
        growth = fastest_growth(problem, np.array([12.0]), 0.05)
        assert growth.frequency == pytest.approx(float(wall.highest_frequency(modes)[0]), rel=0.02)
        assert growth.rate == pytest.approx(damping / 2, rel=0.05)

    def test_one_layer_is_stable_at_any_positive_gain(self):
        assert unstable_poles(dimensionless(electrodes(1e3, 300.0)), 16, 4.0).orders.size == 0
        pairs = electrodes(1e3, 300.0, "self-sensing", "self-sensing")
        assert unstable_poles(dimensionless(pairs), 16, 4.0).orders.size == 0
        assert unstable_poles(dimensionless(electrodes(-2.0, -1.0)), 16, 4.0).orders.size > 0


def test_gains_of_each_shell():
    both = electrodes([0.0, 7.0], [4.0, 2.0])
    first, second = (wall.gains for wall in dimensionless(both).shells)
    assert (first.derivative, second.proportional) == (4.0, 7.0)
    turned = electrodes([7.0, 0.0], [2.0, 4.0], shells=["outer", "inner"])
    assert dimensionless(turned).shells[1].gains == second
    assert both.canonical() == turned.canonical()
    assert cx.System.from_toml_string(both.to_toml_string()) == both
    assert both.with_overrides({"control.derivative[0]": 2.0}).control.derivative == (2.0, 2.0)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"engine": "direct"}, ("control.transducers", "pressure alone", 'engine="spectral"')),
    ],
)
def test_refused_in_words(changes, words):
    system = electrodes(0.0, 1.0)
    with pytest.raises(InputError) as caught:
        cx.simulate(system, duration=1, time_step=0.02, modes=4, **changes)
    for word in words:
        assert word in str(caught.value)


class TestDelay:
    def test_weak_feedback_stands_a_quarter_of_a_period(self):
        # s^2 + c s e^{-s tau} + omega^2 = 0 grows where cos(omega tau) < 0, for small c: tau = pi/(2 omega) of the membrane.
        problem = dimensionless(dry(electrodes(0.0, 0.02), 1.0))
        omega = float(problem.shells[0].highest_frequency(Modes(np.array([12.0])))[0])
        margin = delay_margin(problem, 12, 400.0)
        assert margin.order == 12
        assert margin.delay / problem.scales.time == pytest.approx(0.5 * np.pi / omega, rel=0.2)

    def test_two_microseconds_make_nearly_all_orders_grow(self):
        problem = dimensionless(electrodes(0.0, 10.0))
        late = 2e-6 / problem.scales.time
        walls = tuple(wall.with_gains(replace(wall.gains, delay=late)) for wall in problem.shells)
        assert poles_beyond(replace(problem, shells=walls), Modes.up_to(100), 0.25).orders.size >= 92

    def test_told_with_both_numbers(self):
        (told,) = [text for text in cx.simulate(electrodes(0, 2), duration=1, time_step=0.02, modes=6).warnings if "ideal" in text]
        assert told.startswith("control: the loop is ideal, without delay: ")
        assert "order 6 grow, and electronics take about 10.00 µs; read the run as the limit" in told
        assert delay_margin(dimensionless(electrodes(0, 0)), 6, 1.0) is None
