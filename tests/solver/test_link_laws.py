"""Laws of links by themselves: on a mass stepped as the march steps it, against closed forms and their own energy."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import pytest
from numpy.testing import assert_allclose

from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.links.branches import Inerters, MaxwellBranches, SpringDampers
from coaxshell.solver.links.friction import DryFriction, HystereticFriction, SmoothedFriction
from coaxshell.solver.links.law import LinkLaw
from coaxshell.solver.links.laws import LinkLaws
from coaxshell.solver.links.springs import BrokenLines, Polynomials
from coaxshell.solver.links.step import LawSolver
from coaxshell.solver.links.stops import Stops, damping_number

ONE = np.array([0])


def row(*values: float) -> FloatArray:
    return np.array(values)[:, None]


class Motion(NamedTuple):
    stretch: FloatArray
    velocity: FloatArray
    stored: FloatArray
    force: FloatArray

    @property
    def work(self) -> FloatArray:
        """What the link took up to every instant."""
        return np.concatenate([[0.0], np.cumsum(self.force * np.diff(self.stretch))])


def swing(
    laws: Sequence[LinkLaw],
    time_step: float,
    steps: int,
    *,
    stretch: float = 0.0,
    velocity: float = 0.0,
    push: Callable[[float], float] = lambda time: 0.0,
    drift: float = 0.0,
) -> Motion:
    """Step m = 1 on one link by the midpoint rule; the link's other end moves at the speed *drift*."""
    known = LinkLaws(1, laws)
    solver = LawSolver(np.array([[-(time_step**2) / 4.0]]), known, np.zeros(1))
    state = known.at_rest()._replace(stretch=np.array([stretch]))
    added, found, forces = np.zeros(1), [(stretch, velocity, float(known.stored(state)[0]))], []
    for n in range(steps):
        outer = push((n + 0.5) * time_step)
        mean = state.stretch + 0.5 * time_step * (velocity - drift) + 0.25 * time_step**2 * outer
        step = solver.solve(mean, added, state)
        added, state = step.added, step.state
        velocity += time_step * (outer - float(added[0]))
        forces.append(float(added[0]))
        found.append((float(state.stretch[0]), velocity, float(known.stored(state)[0])))
    return Motion(*np.array(found).T, np.array(forces))


CONSERVATIVE: dict[str, Callable[[float], LinkLaw]] = {
    "bistable": lambda dt: Polynomials(ONE, row(-2.0, 0.0, 5.0)),
    "fifth order": lambda dt: Polynomials(ONE, row(0.0, 0.3, 0.0, 0.0, 2.0)),
    "broken line": lambda dt: BrokenLines(ONE, np.array([0.3]), row(0.5, -0.2), row(400.0, 20.0), row(1.0, -1.0)),
    "elastic stops": lambda dt: Stops(ONE, np.array([0.4]), row(900.0, 100.0), np.array([1.0]), dt),
}


@pytest.mark.parametrize("name", CONSERVATIVE)
def test_elastic_laws_keep_energy_at_any_step(name):
    for time_step in (0.02, 0.3):
        motion = swing([CONSERVATIVE[name](time_step)], time_step, 120, stretch=0.1, velocity=1.0)
        energy = 0.5 * motion.velocity**2 + motion.stored
        assert_allclose(energy, energy[0], rtol=1e-10)  # 120 steps, each solved to 1e-12
        assert np.ptp(motion.stretch) > 0.4


LOSSY: dict[str, Callable[[float], LinkLaw]] = {
    "damper": lambda dt: SpringDampers(ONE, np.array([3.0]), np.array([0.4]), dt),
    "Maxwell branch": lambda dt: MaxwellBranches(ONE, np.array([3.0]), np.array([0.2]), dt),
    "stops": lambda dt: Stops(ONE, np.array([0.1]), row(900.0, 100.0), np.array([0.6]), dt),
    "smoothed friction": lambda dt: SmoothedFriction(ONE, np.array([0.1]), np.array([0.05]), dt),
    "hysteretic friction": lambda dt: HystereticFriction(ONE, np.array([0.2]), np.array([5.0])),
    "dry friction": lambda dt: DryFriction(ONE, np.array([0.1]), np.array([0.15]), np.array([dt**2 / 4.0])),
}


@pytest.mark.parametrize("name", LOSSY)
def test_no_step_of_a_law_with_losses_gives_energy(name):
    for time_step in (0.01, 0.2):
        spring = Polynomials(ONE, row(1.0))
        motion = swing([spring, LOSSY[name](time_step)], time_step, 120, velocity=1.0)
        heat = motion.work - (motion.stored - motion.stored[0])
        assert heat[-1] > 0.03
        assert np.diff(heat).min() > -1e-13


LAWS = {**CONSERVATIVE, **LOSSY, "inerter": lambda dt: Inerters(ONE, np.array([0.7]), dt)}


@pytest.mark.parametrize("name", LAWS)
def test_the_slope_is_that_of_the_force(name):
    law = LAWS[name](0.1)
    state = np.array([[0.05], [0.02], [0.3]])[: law.variables]
    for before, after in ((0.05, 0.07), (0.3, 0.7), (0.7, 0.3), (-0.1, -0.6), (-0.6, 0.6)):
        start, end, part = np.array([before]), np.array([after]), 1e-6
        rise = law.force(end + part, start, state).value - law.force(end - part, start, state).value
        assert_allclose(law.force(end, start, state).slope, rise / (2.0 * part), rtol=1e-6, atol=1e-7)


def test_a_bistable_link_swings_in_its_well_at_the_closed_frequency():
    # f = -k D + k3 D^3 rests at D = sqrt(k/k3), where f' = 2 k
    k, k3, time_step = 2.0, 5.0, 0.02
    well = np.sqrt(k / k3)
    motion = swing([Polynomials(ONE, row(-k, 0.0, k3))], time_step, 800, stretch=well + 1e-4)
    up = np.flatnonzero((motion.stretch[:-1] < well) & (motion.stretch[1:] >= well))
    period = (up[-1] - up[0]) * time_step / (up.size - 1)
    assert_allclose(period, 2.0 * np.pi / np.sqrt(2.0 * k), rtol=2e-3)


def test_a_mass_leaves_a_stop_at_the_coefficient_of_restitution():
    for restitution in (1.0, 0.8, 0.3):
        missed = []
        for time_step in (2e-3, 1e-3):
            stop = Stops(ONE, np.array([0.1]), row(1e4, 0.0), np.array([restitution]), time_step)
            motion = swing([stop], time_step, round(0.3 / time_step), velocity=1.0)
            missed.append(abs(-motion.velocity[-1] - restitution))
        assert missed[1] < 1e-3
        assert restitution == 1.0 or missed[1] < missed[0] / 3.0  # second order


def test_a_bouncing_ball_flies_e_times_as_long_after_every_bounce():
    restitution, time_step = 0.5, 2e-3
    stop = Stops(ONE, np.zeros(1), row(2e4, 0.0), np.array([restitution]), time_step)
    motion = swing([stop], time_step, 1400, stretch=-0.5, push=lambda time: 1.0)
    before, after = motion.stretch[:-1], motion.stretch[1:]
    share = before / np.where(after == before, 1.0, before - after)
    left = (np.arange(before.size) + share)[(before > 0.0) & (after <= 0.0)] * time_step
    struck = (np.arange(before.size) + share)[(before <= 0.0) & (after > 0.0)] * time_step
    flights = struck[1:3] - left[:2]
    assert_allclose(struck[0], 1.0, rtol=2e-3)  # from the height 1/2 under g = 1
    assert_allclose(flights, 2.0 * restitution ** np.arange(1, 3), rtol=0.035)  # less by its weight on the spring of the stop


def test_the_damping_number_solves_its_equation():
    for restitution in (0.05, 0.5, 0.99, 1.0 - 1e-7, 1.0):
        u = damping_number(restitution)
        assert (u > 0.0) == (restitution < 1.0)
        if restitution < 1.0 - 1e-6:
            less, more = (1.0 - 1e-9) * u, (1.0 + 1e-9) * u
            assert less - np.log1p(less) > -restitution * less - np.log1p(-restitution * less)
            assert more - np.log1p(more) < -restitution * more - np.log1p(-restitution * more)


def friction(time_step: float, kinetic: float, static: float, share: float = 1.0) -> DryFriction:
    """Return dry friction on a mass of 1; ``share`` is what another spring leaves of its compliance."""
    return DryFriction(ONE, np.array([kinetic]), np.array([static]), np.array([share * time_step**2 / 4.0]))


def test_dry_friction_takes_4_f_over_k_from_every_swing_and_then_holds():
    time_step = 0.02
    motion = swing([Polynomials(ONE, row(1.0)), friction(time_step, 0.05, 0.05)], time_step, 1650, stretch=1.02)
    turns = motion.stretch[np.rint(np.pi * np.arange(1, 9) / time_step).astype(int)]
    assert_allclose(np.abs(turns), 1.02 - 0.1 * np.arange(1, 9), atol=3e-4)
    assert np.ptp(motion.stretch[-20:]) < 0.05 * time_step**2 / 2.0  # the creep that it may
    assert abs(motion.stretch[-1]) < 0.05


def test_a_mass_that_comes_to_stick_does_not_swing_from_step_to_step():
    time_step = 0.02
    motion = swing([friction(time_step, 0.05, 0.05)], time_step, 200, velocity=0.1, push=lambda time: 0.02)
    stop = round(0.1 / 0.03 / time_step)
    assert 0.0 < np.abs(motion.velocity[stop + 3 :]).max() < 2e-4
    assert np.abs(motion.velocity[-10:]).max() < 1e-7
    assert_allclose(motion.force[-10:], 0.02, rtol=1e-3)


def test_stick_slip_has_the_closed_period():
    # A mass on a spring k is carried by a belt at V: it sticks until the spring pulls by F_s, then swings about F_k/k until its speed is V.
    speed, static, kinetic, time_step = 0.05, 0.3, 0.2, 0.01
    stiff = 1.0 + time_step**2 / 4.0  # the spring to the ground is a second force on the mass, implicit by its own share
    known = LinkLaws(1, [friction(time_step, kinetic, static, 1.0 / stiff)])
    solver = LawSolver(np.array([[-(time_step**2) / 4.0 / stiff]]), known, np.zeros(1))
    state, place, velocity, added, slips = known.at_rest(), 0.0, speed, np.zeros(1), []
    for _ in range(4000):
        free = (place + 0.5 * time_step * velocity) / stiff
        step = solver.solve(np.array([free + state.stretch[0] - place - 0.5 * time_step * speed]), added, state)
        added, state = step.added, step.state
        half = free - time_step**2 / 4.0 / stiff * float(added[0])
        place, velocity = 2.0 * half - place, 4.0 * (half - place) / time_step - velocity
        slips.append(float(state.internal[0][1, 0]))
    starts = np.flatnonzero(np.diff(np.array(slips)) > 0.0)[1:]
    period = np.diff(starts).mean() * time_step
    drop = static - kinetic
    assert_allclose(period, 2.0 * drop / speed + 2.0 * (np.pi - np.arctan(drop / speed)), rtol=5e-3)


def left_after(amplitude: float) -> float:
    """Return the share of its energy that a mass on a spring keeps, struck to a speed, with a light mass on a cubic spring."""
    light, damping, cubic, time_step = 0.02, 0.2, 4.0 / 3.0, 0.1  # x" + x + eps f = 0, eps v" = eps f, f = 0.2 dD/dt + 4/3 D^3
    known = LinkLaws(
        1, [Polynomials(ONE, row(0.0, 0.0, light * cubic)), SpringDampers(ONE, np.zeros(1), np.array([light * damping]), time_step)]
    )
    quarter, stiff = time_step**2 / 4.0, 1.0 + time_step**2 / 4.0
    solver = LawSolver(np.array([[-quarter * (1.0 / stiff + 1.0 / light)]]), known, np.zeros(1))
    state, added = known.at_rest(), np.zeros(1)
    x, dx, v, dv = 0.0, amplitude, 0.0, 0.0
    for _ in range(1200):
        free_x, free_v = (x + 0.5 * time_step * dx) / stiff, v + 0.5 * time_step * dv
        step = solver.solve(np.array([free_x - free_v]), added, state)
        added, state = step.added, step.state
        half_x, half_v = free_x - quarter / stiff * float(added[0]), free_v + quarter / light * float(added[0])
        x, dx = 2.0 * half_x - x, 4.0 * (half_x - x) / time_step - dx
        v, dv = 2.0 * half_v - v, 4.0 * (half_v - v) / time_step - dv
    return (x * x + dx * dx) / amplitude**2


@pytest.mark.slow
def test_an_essentially_nonlinear_absorber_takes_energy_above_the_fold_of_its_slow_manifold():
    # |x|^2 = [lambda^2 + (1 - 3/4 k Z)^2] Z has its fold at Z = 4/(9 k) (2 - (1 - 3 lambda^2)^(1/2)): below it the absorber sleeps
    damping, cubic = 0.2, 4.0 / 3.0
    z = 4.0 / (9.0 * cubic) * (2.0 - np.sqrt(1.0 - 3.0 * damping**2))
    fold = np.sqrt((damping**2 + (1.0 - 0.75 * cubic * z) ** 2) * z)
    assert left_after(0.97 * fold) > 0.5
    assert left_after(1.15 * fold) < 0.06


def test_linear_laws_marched_are_those_of_the_nodes():
    # the force of a stretch (1 - cos wt)/2, against the transform's impedance at s = iw in the steady state
    time_step, omega = 5e-3, 3.0
    time = time_step * np.arange(round(12.0 / time_step) + 1)
    stretch = np.sin(omega * time)
    laws = {
        "spring and damper": SpringDampers(ONE, np.array([2.0]), np.array([0.3]), time_step),
        "Maxwell": MaxwellBranches(ONE, np.array([2.0]), np.array([0.3]), time_step),
        "inerter": Inerters(ONE, np.array([0.7]), time_step),
    }
    for name, law in laws.items():
        state = np.zeros((law.variables, 1))
        if name == "inerter":
            state[:] = omega
        force = []
        for before, after in zip(stretch[:-1, None], stretch[1:, None], strict=True):
            force.append(float(law.force(after, before, state).value[0]))
            state = law.advance(after, before, state)
        middle, tail = time[:-1] + 0.5 * time_step, slice(-round(2.0 * np.pi / omega / time_step), None)
        fitted = np.linalg.lstsq(np.stack([np.sin(omega * middle), np.cos(omega * middle)]).T[tail], np.array(force)[tail], rcond=None)[0]
        impedance = law.impedance(np.array([1j * omega]))[0, 0]
        assert_allclose(fitted, [impedance.real, impedance.imag], rtol=1e-4, atol=1e-4, err_msg=name)
