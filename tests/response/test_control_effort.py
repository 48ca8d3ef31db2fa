"""What control costs: charge, current and power of driven layers, against the energy balance and the charge of a plate condenser."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import cumulative_trapezoid

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.numerics.modes import Modes
from coaxshell.response.effort import control_effort, electrical_power
from coaxshell.response.electrical import electrical, of_segments
from coaxshell.response.energy.electrodes import electrical_energy
from coaxshell.response.energy.motion import Motion
from coaxshell.studies.metrics import metrics_of
from coaxshell.studies.reading import MetricSource

STEP = 1e-2
M = Modes.up_to(8)


@pytest.fixture(scope="module")
def run():
    return cx.simulate("electrodes", duration=1.6, time_step=STEP, modes=8)


def test_power_is_that_of_the_energy_balance(run):
    found = electrical_power(run.motion)
    work = electrical_energy(Motion.of(run.solution, 1))[0] * run.solution.problem.scales.line_energy
    seconds = STEP * run.system.transit_time
    so_far = cumulative_trapezoid(found["real_power"].sum("shell").to_numpy(), dx=seconds, initial=0.0)
    assert_allclose(so_far[3:], work[3:], rtol=0, atol=0.01 * float(abs(work).max()))
    assert (found["apparent_power"] >= abs(found["real_power"]) * (1 - 1e-12)).all()
    assert float(found["apparent_power"].max()) > 0


def test_energy_is_that_of_the_balance_where_voltage_and_charge_jump():
    """A front passes within a few steps, in which power times the step is off by a fifth of all that is given."""
    short = cx.simulate("electrodes", duration=0.4, time_step=2e-2, modes=12)
    given = float(electrical_energy(Motion.of(short.solution, 1))[0][-1]) * short.solution.problem.scales.line_energy
    assert sum(one.energy for one in short.control_effort().shells) == pytest.approx(given, rel=0.01)


def test_charge_is_that_of_strain_and_of_a_condenser(run):
    shell = run.system.shells[0]
    pair = [layer for layer in shell.layers if layer.role == "self-sensing"]
    material, t = pair[0].material, pair[0].thickness
    e32 = material.e32 - material.e33 * material.c23 / material.c33
    mu = material.permittivity_33 + material.e33**2 / material.c33
    assert mu / t == pytest.approx(2.523e-6, rel=1e-3)  # F/m^2, of an independent derivation
    m, a = np.arange(9.0), run.system.reference_radius
    strain = (m[:, None] * run.solution.tangential[0, 0] - run.solution.normal[0, 0]) * a / shell.radius  # of the mid-surface
    found = electrical(run.motion, 0)
    expected = np.zeros_like(strain)
    for z in (-6e-3, 6e-3):
        bent = z * (m[:, None] * run.solution.tangential[0, 0] - m[:, None] ** 2 * run.solution.normal[0, 0]) * a / shell.radius**2
        expected += e32 * (strain + bent) + mu / t * found.voltage[0]
    assert_allclose(found.charge[0], expected, rtol=0, atol=2e-9 * np.abs(expected).max())
    flowed = cumulative_trapezoid(found.current[0], dx=STEP * run.system.transit_time, initial=0.0)
    assert_allclose(flowed, found.charge[0], rtol=0, atol=0.01 * np.abs(expected).max())


def test_effort_beside_its_limits(run):
    effort = run.control_effort(voltage=10.0, current=1e3)
    inner = effort["inner"]
    assert inner.field == pytest.approx(inner.voltage / 3e-3)
    assert inner.voltage == pytest.approx(run.summary().shells[0].actuator_voltage.value)
    assert inner.limits["field"] == pytest.approx(590e3)
    assert inner.shares["voltage"] == pytest.approx(inner.voltage / 10.0)
    assert not effort.within
    assert "590.0 kV/m" in str(effort)
    assert effort.to_dict()["shells"][1]["shell"] == "outer"
    (metric,) = metrics_of(["inner.peak_actuator_current"], run.system)
    assert metric(MetricSource(run)) >= inner.current > 0  # at points, above the mean over a segment
    history = run.history("inner", 0, "actuator_charge")
    assert history.attrs["units"] == "C/m^2"
    assert_allclose(history, run.modal("inner", "actuator_charge")[0].sum("mode"), rtol=0, atol=1e-12)


@pytest.fixture(scope="module")
def cut():
    changes = {"control.segments": 5, "control.segment_gap": "20 mm", "control.dead": [3]}
    return cx.simulate(cx.presets.load("electrodes").with_overrides(changes), duration=0.6, time_step=STEP, modes=8)


def test_charge_of_a_segment_is_that_under_it(cut):
    wall, shell, m = cut.solution.problem.shells[1], cut.system.shells[1], np.arange(9.0)
    half = np.pi / 5 - 10e-3 / shell.radius
    found = of_segments(cut.motion, 1)
    assert_allclose(found.voltage, cut.solution.segment_voltage[1], rtol=0, atol=1e-9)
    modal = sum(gain.v[:, None] * cut.solution.tangential[1] + gain.w[:, None] * cut.solution.normal[1] for gain, _ in wall.charges(M))
    plate = sum(capacitance for _, capacitance in wall.charges(M))
    scales = cut.solution.problem.scales
    for segment in (0, 1, 3):
        theta = 2 * np.pi * segment / 5 + half * (2 * (np.arange(2000) + 0.5) / 2000 - 1)
        mean = np.stack([np.cos(np.outer(m, theta)).mean(axis=1), np.sin(np.outer(m, theta)).mean(axis=1)])
        expected = np.einsum("hm,hmt->t", mean, modal) + plate * found.voltage[segment]
        assert_allclose(found.charge[segment], expected * scales.pressure * scales.length, rtol=0, atol=1e-6 * np.abs(found.charge).max())
    assert not found.voltage[3].any()
    assert found.charge[3].any()
    assert found.width == pytest.approx(2 * half * shell.radius)


def test_power_of_segments_is_that_of_the_energy_balance(cut):
    found = electrical_power(cut.motion)
    assert_allclose(found["segment_power"].sum("segment"), found["real_power"], rtol=1e-12, atol=1e-12)
    supplied, held = (one * cut.solution.problem.scales.line_energy for one in electrical_energy(Motion.of(cut.solution, 1)))
    seconds = STEP * cut.system.transit_time
    so_far = cumulative_trapezoid(found["real_power"].sum("shell").to_numpy(), dx=seconds, initial=0.0)
    assert_allclose(so_far[3:], supplied[3:], rtol=0, atol=0.01 * float(abs(supplied).max()))
    mu = cut.system.shells[0].serving("actuator")[0]
    plate = 2 * (mu.material.permittivity_33 + mu.material.e33**2 / mu.material.c33) / mu.thickness
    expected = sum(0.5 * plate * one.width * (one.voltage**2).sum(axis=0) for one in (of_segments(cut.motion, i) for i in (0, 1)))
    assert_allclose(held, expected, rtol=1e-9, atol=1e-9 * held.max())  # of condensers, whatever the orders


def test_effort_names_the_segment_that_is_asked_for_most(cut):
    effort = cut.control_effort(apparent_power=1.0, voltage=30.0)
    outer = effort["outer"]
    assert [one.segment for one in outer.segments] == [0, 1, 2, 3, 4]
    assert outer.voltage == outer.worst("voltage").voltage == pytest.approx(np.abs(cut.solution.segment_voltage[1]).max())
    assert outer.worst("voltage").segment == 0  # at the head
    assert outer.segments[3].voltage == outer.segments[3].current == 0.0
    assert outer.segments[4].angle == pytest.approx(-72.0)
    assert sum(one.energy for one in outer.segments) == pytest.approx(outer.energy)
    assert outer.shares["apparent_power"] == pytest.approx(outer.worst("apparent_power").apparent_power)
    assert "largest real power, one segment" in str(effort)
    assert len(effort.to_dict()["shells"][1]["segments"]) == 5
    with pytest.raises(InputError, match="told of no segment"):
        outer.worst("mass")


def test_the_paper_knows_no_charge():
    paper = cx.presets.load("bare").replace(control=cx.PDControl(proportional=-1, derivative=-0.1))
    run = cx.simulate(paper, duration=0.5, time_step=2e-2, modes=3)
    assert run.control_effort()["inner"].charge is None
    assert run.summary().shells[0].actuator_charge is None
    with pytest.raises(InputError, match="driven by electrodes"):
        electrical_power(run.motion)


@pytest.mark.parametrize(("limits", "words"), [({"watts": 3.0}, "no limit"), ({"voltage": -1.0}, "positive")])
def test_what_is_refused(run, limits, words):
    with pytest.raises(InputError, match=words):
        control_effort(run.motion, **limits)
    with pytest.raises(InputError, match="are whole"):
        run.control_effort()["inner"].worst("voltage")


def test_elastic_walls_tend_to_thin_ones():
    found = []
    for theory in ("thin", "elastic"):
        system = cx.presets.load("electrodes").with_overrides(
            {
                f"shells[{i}].{name}": x
                for i in (0, 1)
                for name, x in (("theory", theory), ("wetted", "faces"))
                if theory == "thin" or name == "theory"
            }
        )
        found.append(cx.simulate(system, duration=0.8, time_step=2e-2, modes=3).control_effort(segment="point")["inner"])
    assert found[1].charge == pytest.approx(found[0].charge, rel=0.1)
    assert found[1].apparent_power == pytest.approx(found[0].apparent_power, rel=0.2)
