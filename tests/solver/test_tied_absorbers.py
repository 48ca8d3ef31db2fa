"""Absorbers beside segments and matrices of feedback: both laws at once at every node, whole electrodes, the march, energy, storage."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.model import presets
from coaxshell.numerics.modes import Modes
from coaxshell.solver.interface.absorbers import InterfacePoints, side_admittance
from coaxshell.solver.interface.linked import solve_linked
from coaxshell.solver.recompute import spectra_of
from coaxshell.structure.segments import Segments

HYBRID = presets.load("electrodes-hybrid").replace(source=cx.PlaneShock(peak_pressure=25e3, decay_time=1.314e-4))
CUBIC = HYBRID.replace(
    absorbers=tuple(one.replace(angle=angle) for one, angle in zip(HYBRID.absorber_list, (20.0, 160.0, 250.0), strict=False))
)
LINEAR = CUBIC.replace(absorbers=tuple(one.replace(cubic_stiffness=0.0) for one in CUBIC.absorber_list))
RUN = {"duration": 0.6, "time_step": 0.02, "modes": 12}


def cut(system: cx.System, **control) -> cx.System:
    return system.with_overrides({f"control.{name}": value for name, value in control.items()})


@pytest.fixture(scope="module")
def linear():
    return cx.simulate(cut(LINEAR, segments=6, segment_gap="10 mm", dead=[2]), **RUN)


def test_links_and_loops_obey_their_laws_at_once(linear):
    solved, shares = linear.solution.spectra, linear.solution.problem.shells[1].segments
    points, count = InterfacePoints(solved.problem, solved.absorbers, solved.modes), solved.absorbers.count
    assert solved.absorbers.parities == 2  # a dead segment aside, in spite of a wave from ahead
    law, w = side_admittance(solved.absorbers, solved.grid.nodes), points.evaluate(solved.normal)
    force, _ = solved.exact
    assert_allclose(force[:count], -(law.inner.T * w[:count] + law.other.T * w[count:]), rtol=1e-9, atol=1e-12 * np.abs(force).max())
    assert_allclose(force[count:], -(law.other.T * w[:count] + law.outer.T * w[count:]), rtol=1e-9, atol=1e-12 * np.abs(force).max())
    wall, m = solved.problem.shells[1], np.arange(13.0)
    gain = wall.sensor_gain(solved.modes).columns
    phi = gain.v * solved.tangential[1] + gain.w * solved.normal[1]
    volts = shares.values(solved.voltage[1])
    asked = np.ravel(wall.gains.at(solved.grid.nodes, Modes(np.zeros(1))))
    for segment in (0, 3):
        theta = shares.centres[segment] + 2 * np.pi / 6 * shares.covered * ((np.arange(3000) + 0.5) / 3000 - 0.5)
        mean = np.stack([np.cos(np.outer(m, theta)).mean(axis=1), np.sin(np.outer(m, theta)).mean(axis=1)])
        read = np.einsum("hm,hmk->k", mean, phi)
        assert_allclose(volts[segment], asked * read, rtol=1e-5, atol=1e-6 * np.abs(volts).max())
    assert np.abs(volts[2]).max() < 1e-9 * np.abs(volts).max()


def test_the_march_tends_to_the_exact_answer_of_linear_absorbers(linear):
    errors = []
    for step in (0.02, 0.01):
        solved = linear.solution.spectra if step == 0.02 else cx.simulate(linear.system, **RUN | {"time_step": step}).solution.spectra
        marched = solve_linked(solved.structure, solved.absorbers, exact=False)
        exact, other = (solved.grid.invert(one.normal) for one in (solved, marched))
        errors.append(np.abs(other - exact).max() / np.abs(exact).max())
        assert marched.iterations > 0
    assert errors[0] < 1e-3
    assert errors[0] / errors[1] > 3.0


def test_segments_beside_absorbers_tend_to_whole_electrodes():
    whole, errors = cx.simulate(LINEAR, **RUN).solution, []
    for count in (6, 12):
        run = cx.simulate(cut(LINEAR, segments=count), **RUN).solution
        errors.append(np.abs(run.normal - whole.normal).max() / np.abs(whole.normal).max())
    assert errors[0] < 1e-2
    assert errors[0] / errors[1] > 2.5


@pytest.mark.parametrize("system", [LINEAR, CUBIC], ids=["linear", "cubic"])
def test_a_diagonal_matrix_beside_absorbers_is_each_walls_own_law(system):
    law = cx.Feedback(numerator=[2 * system.transit_time, 0], transducers="electrodes")
    own, tied = (cx.simulate(system.replace(control=one), **RUN).solution for one in (law, law.replace(matrix=[[1, 0], [0, 1]])))
    away = np.abs(own.normal - tied.normal).max() / np.abs(own.normal).max()
    assert away < (1e-12 if system is LINEAR else 2e-3)  # marched by kernels of orders here, of points there


@pytest.mark.slow_for("cubic")
@pytest.mark.parametrize("law", [None, cx.laws.Friction(force=2e3)], ids=["cubic", "friction"])
def test_energy_closes_and_a_stored_run_knows_its_voltages(law, tmp_path):
    absorbers = tuple(one.replace(law=law, cubic_stiffness=1e20 if law is None else 0.0) for one in CUBIC.absorber_list)
    run = cx.simulate(cut(CUBIC.replace(absorbers=absorbers), segments=6, dead=[2]), **RUN)
    energy = run.energy()
    assert np.abs(energy.closure_relative).max() < 3e-3
    electrical = energy.amplifier_work - (energy.actuator_field - energy.actuator_work)
    assert np.abs(electrical).max() < 1e-9 * np.abs(energy.actuator_work).max()
    assert 0.0 < run.solution.estimates.march.max() < (0.1 if law is None else 0.2)
    kept = cx.load_response(run.save(tmp_path / "run.nc"))
    again = spectra_of(kept.solution)
    assert_allclose(again.voltage, run.solution.spectra.voltage, rtol=1e-9, atol=1e-9 * np.abs(again.voltage).max())
    assert_allclose(again.segments, run.solution.segment_voltage, rtol=1e-9, atol=1e-9 * np.abs(again.segments).max())
    assert isinstance(run.solution.problem.shells[0].segments, Segments)
