"""Feedback across shells: against each its own, all walls at once by hand, poles, margins, energy, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.model import presets
from coaxshell.numerics.modes import Modes
from coaxshell.solver import tied_stability
from coaxshell.solver.contour import NOWHERE, Contour, fed_orders
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.electrode_loops import ElectrodeLoops
from coaxshell.solver.electrode_patterns import OrderPatterns
from coaxshell.solver.recompute import spectra_of
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.taking_bands import asymmetry
from coaxshell.solver.tied_stability import Tied, _counted, growing, growing_of
from coaxshell.solver.voltage_response import VoltageResponse

PLANE = presets.load("electrodes").replace(source=cx.PlaneShock(peak_pressure=25e3, decay_time=1.314e-4))
TIME = PLANE.transit_time
RUN = {"duration": 0.6, "time_step": 0.02, "modes": 6}
MIXED = [[1.0, 0.5], [0.3, 0.8]]


def under(matrix=None, gain: float = 1.0, **others) -> cx.System:
    """Return the pairs under a lead of some gain, whose shells read each other by a matrix."""
    law = cx.Feedback(numerator=[2 * gain * TIME, 3 * gain], transducers="electrodes", matrix=matrix, **others)
    return PLANE.replace(control=law)


@pytest.fixture(scope="module")
def mixed():
    return cx.simulate(under(MIXED), **RUN)


def test_shells_that_read_themselves_are_those_without_a_matrix():
    own, unit = (cx.simulate(under(matrix), **RUN) for matrix in (None, [[1, 0], [0, 1]]))
    for name in ("normal", "tangential", "control_voltage"):
        one, other = getattr(own.solution, name), getattr(unit.solution, name)
        assert_allclose(other, one, rtol=0, atol=1e-13 * np.abs(one).max())
    one, other = (cx.stability_margins(under(matrix), duration=0.6, modes=3) for matrix in (None, [[1, 0], [0, 1]]))
    assert_allclose(other["delay_margin"], one["delay_margin"], rtol=1e-10)


def test_all_walls_at_once_by_hand():
    problem = dimensionless(under(MIXED))
    modes, s = Modes.up_to(5), np.array([3.0 + 0.0j, 3.0 + 40.0j, 0.5 + 12.0j])
    response = VoltageResponse.at(problem.open_loop, problem, modes, s)
    loops = ElectrodeLoops.of(problem, response, OrderPatterns(modes.orders, 1), s)
    bare = ModalSystem(problem.open_loop, s, modes)
    compliance = np.stack([np.stack(bare.solve(j, 1.0)) for j in range(2)], axis=1)
    walls, law = problem.open_loop.shells, problem.shells[0].gains
    for m in range(1, 6):
        for k, node in enumerate(s):
            dense = np.zeros((4, 4), np.complex128)
            fluid = np.linalg.inv(compliance[:, :, m, k])  # what the fluids add to the walls' own impedance
            push, read = np.zeros((4, 2), np.complex128), np.zeros((2, 4), np.complex128)
            for i, wall in enumerate(walls):
                stiff, at = wall.stiffness(modes), slice(2 * i, 2 * i + 2)
                dense[at, at] = [[stiff.vv[m], stiff.vw[m]], [stiff.vw[m], stiff.ww[m]]] + wall.mass * node**2 * np.eye(2)
                fluid[i, i] -= bare.shells[i].impedance[m, k]
                push[at, i] = [x[m] for x in wall.drive(modes)[:2]]
                read[i, at] = [x[m] for x in wall.sensor_gain(modes)[:2]]
            dense[1::2, 1::2] += fluid
            closed = dense - push @ (law.at(np.array([node]), modes)[0] * np.array(MIXED)) @ read
            assert_allclose(np.linalg.det(loops.matrix[m, k]), np.linalg.det(closed) / np.linalg.det(dense), rtol=1e-10)
            load = np.array([0.0, 0.0, 0.0, 1.0])
            volts = law.at(np.array([node]), modes)[0] * np.array(MIXED) @ read @ np.linalg.solve(closed, load)
            without = (read @ np.linalg.solve(dense, load))[:, None, None] * np.ones((2, 6, 3))
            assert_allclose(loops.voltages(without)[:, m, k], volts, rtol=1e-10)


def test_energy_closes_across_shells(mixed):
    energy = mixed.energy()
    assert np.abs(energy.closure_relative).max() < 2e-5
    electrical = energy.amplifier_work - (energy.actuator_field - energy.actuator_work)
    assert np.abs(electrical).max() < 1e-6 * np.abs(energy.actuator_work).max()
    assert mixed.control_effort()["inner"].energy != 0.0


def test_stored_runs_and_files_know_their_matrix(mixed, tmp_path):
    kept = cx.load_response(mixed.save(tmp_path / "run.nc"))
    assert_allclose(spectra_of(kept.solution).voltage, mixed.solution.spectra.voltage, rtol=1e-9, atol=1e-12)
    system = mixed.system
    assert cx.System.from_toml_string(system.to_toml_string()) == system
    turned = under([[0.8, 0.3], [0.5, 1.0]], shells=["outer", "inner"])
    assert turned.canonical() == system.canonical()
    assert dimensionless(turned).shells == dimensionless(system).shells


def test_passive_matrices_need_no_count():
    # c A differs between the walls, whose radii are 0.5 and 1 m: what is symmetric in energy is not in numbers.
    modes = Modes.up_to(2)
    inner, outer = (-(w.drive(modes).w / w.sensor_gain(modes).w)[0] * w.radius for w in dimensionless(under()).shells)
    ratio = np.sqrt(outer / inner)
    assert ratio == pytest.approx(np.sqrt(2.0))
    for x, passive in ((0.9, True), (-0.9, True), (1.1, False)):
        found = asymmetry(dimensionless(under([[1.0, x * ratio], [x / ratio, 1.0]])), Modes.up_to(6))
        assert found == (0.0 if passive else None)
    assert asymmetry(dimensionless(under(MIXED)), Modes.up_to(6)) != 0.0
    assert growing(dimensionless(under([[1.0, 0.9 * ratio], [0.9 / ratio, 1.0]])), 6, 0.5) is None


def test_orders_that_nothing_is_fed_back_to_are_not_counted(monkeypatch):
    """Of those that are, every one as far as it resonates: turns and the nearest ratio are those of the whole contour of all orders."""
    monkeypatch.setattr(tied_stability, "taking_bands", lambda *_: NOWHERE)
    for delay, grows in (("1 us", False), ("20 us", True)):
        problem = dimensionless(under([[1.0, 0.4], [0.2, 1.0]], 3.0, delay=delay, weights=[0, 0, 1.0, 0.5]))
        modes, orders = Modes.up_to(6), np.array([2.0, 3.0])
        assert_allclose(fed_orders(problem, modes), orders)
        whole, nearest = _counted(problem, Tied(modes), Contour.of(problem, modes, 0.5))
        found, near = growing_of(problem, Tied(modes), 0.5)
        assert (found is not None) == (whole is not None) == grows
        assert near == pytest.approx(nearest, rel=1e-3)
        assert fed_orders(dimensionless(under([[1.0, 0.4], [0.2, 1.0]])), modes).size == 7


def test_poles_are_where_gains_say():
    matrix = [[1.0, 0.4], [0.6, 1.0]]
    system = under(matrix, delay="1 us")
    margins = cx.stability_margins(system, duration=0.6, modes=3)
    factor = 0.0
    for row, shell in enumerate(margins["shell"].values):
        gain = float(margins["gain_margin"].sel(shell=shell).min())
        assert np.isfinite(gain)
        for beyond, grows in ((0.98, False), (1.02, True)):
            scaled = [list(one) for one in matrix]
            scaled[row] = [beyond * gain * one for one in scaled[row]]
            assert (growing(dimensionless(under(scaled, delay="1 us")), 3, 1.0 / 0.6) is not None) == grows
        factor = max(factor, gain)
    with pytest.raises(InputError, match=r"control\.delay: 1\.000 µs makes .* of all shells together grows? .* fastest order"):
        cx.simulate(under(matrix, gain=1.2 * factor, delay="1 us"), **RUN)
    with pytest.raises(InputError, match=r"control\.matrix: \[\[0\.0, 1\.0\], \[1\.0, 0\.0\]\] makes"):
        cx.simulate(under([[0, 1], [1, 0]]), **RUN)


def test_one_shell_senses_and_the_other_acts():
    roles = {"shells[0].layers[0].role": "actuator", "shells[0].layers[2].role": "actuator"}
    roles |= {"shells[1].layers[0].role": "sensor", "shells[1].layers[2].role": "sensor"}
    system = under([[0, 0.2], [0, 0]]).with_overrides(roles)
    response = cx.simulate(system, **RUN)
    assert np.abs(response.actuator_voltage("inner", 0).to_numpy()).max() > 0.1
    assert [one.shell for one in response.control_effort().shells] == ["inner"]
    assert np.abs(response.energy().closure_relative).max() < 2e-5
    with pytest.raises(InputError, match=r"shells\[0\] has no sensor layer"):
        system.with_overrides({"control.matrix": [[0, 0.2], [0.1, 0]]})


def test_limits_and_segments_know_matrices():
    cut = cx.simulate(under(MIXED, segments=4, saturation=True, field_limit=5e3), **RUN)
    assert np.abs(cut.actuator_voltage("inner", [0, 90]).to_numpy()).max() == pytest.approx(15.0)
    assert np.abs(cut.energy().closure_relative).max() < 2e-5
    with pytest.raises(InputError, match=r"time_step: is too long for limits of shells that answer each other so strongly"):
        cx.simulate(under([[0.2, 0.9], [-0.9, 0.2]], gain=10.0, segments=4, saturation=True, field_limit=1e3), **RUN)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"control.matrix": [[1, 0]]}, r"control\.matrix\[0\]: has 2 numbers, and there are 1 rows"),
        ({"control.matrix": [[1]]}, r"control\.matrix: the matrix has 1 rows for 2 shell"),
        ({"control.matrix": [[0, 0], [0, 0]]}, r"control\.matrix: holds nothing but 0"),
        ({"control.matrix": "all"}, r"control\.matrix: 'all' is not allowed"),
        ({"control.matrix": [[1, 0], [0, "x"]]}, r"control\.matrix\[1\]"),
        ({"control.matrix": MIXED, "control.transducers": "paper"}, r"control\.matrix: is not known to the paper's law"),
    ],
)
def test_matrices_that_cannot_be(change, told):
    with pytest.raises(InputError, match=told):
        under().with_overrides(change)


def test_what_does_not_know_matrices_refuses_them():
    with pytest.raises(InputError, match=r"control\.matrix: .* an answer at a frequency"):
        cx.frequency_response(under(MIXED), frequency=[1e3], quantity="stress", shell="inner", angle=0)
