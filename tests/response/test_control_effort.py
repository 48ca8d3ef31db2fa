"""What control costs: charge, current and power of driven layers, against the energy balance and the charge of a plate condenser."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.response.effort import control_effort, electrical_power
from coaxshell.response.electrical import electrical
from coaxshell.response.energy.electrodes import electrical_energy
from coaxshell.response.energy.motion import Motion
from coaxshell.studies.metrics import metrics_of
from coaxshell.studies.reading import MetricSource

STEP = 1e-2


@pytest.fixture(scope="module")
def run():
    return cx.simulate("electrodes", duration=1.6, time_step=STEP, modes=8)


def test_power_is_that_of_the_energy_balance(run):
    found = electrical_power(run.motion)
    work = electrical_energy(Motion.of(run.solution, 1))[0] * run.solution.problem.scales.line_energy
    seconds = STEP * run.system.transit_time
    so_far = cumulative_trapezoid(found["real_power"].sum("shell").to_numpy(), dx=seconds, initial=0.0)
    np.testing.assert_allclose(so_far[3:], work[3:], rtol=0, atol=0.01 * float(abs(work).max()))
    assert (found["apparent_power"] >= abs(found["real_power"]) * (1 - 1e-12)).all()
    assert float(found["apparent_power"].max()) > 0


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
    np.testing.assert_allclose(found.charge[0], expected, rtol=0, atol=2e-9 * np.abs(expected).max())
    flowed = cumulative_trapezoid(found.current[0], dx=STEP * run.system.transit_time, initial=0.0)
    np.testing.assert_allclose(flowed, found.charge[0], rtol=0, atol=0.01 * np.abs(expected).max())


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
    np.testing.assert_allclose(history, run.modal("inner", "actuator_charge")[0].sum("mode"), rtol=0, atol=1e-12)


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
