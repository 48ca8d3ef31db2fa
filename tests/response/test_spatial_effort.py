"""What control costs in three dimensions: two dimensions under uniform sources, stations added up, and the energy balance."""

from __future__ import annotations

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.response.electrical import power
from coaxshell.response.energy.length_power import length_power
from coaxshell.solver.axial.sampling import whole_length_sampling

PAIRS = cx.presets.load("electrodes")
RUN = {"duration": 0.4, "time_step": 0.01, "modes": 4}


@pytest.fixture(scope="module")
def spatial():
    first = cx.simulate(PAIRS, **RUN, dimensions=3, stations=[0.0]).spatial
    period = whole_length_sampling(first.problem, first.settings).period  # the same waves at stations as over the length
    return cx.simulate(PAIRS, **RUN, dimensions=3, stations=list(period * np.arange(6) / 11.0), axial_period=period)


def test_uniform_sources_cost_what_they_do_in_two_dimensions():
    plane = PAIRS.replace(source=cx.PlaneShock(peak_pressure=25e3, decay_time=1.314e-4))
    flat = cx.simulate(plane, **RUN).control_effort()["outer"]
    effort = cx.simulate(plane, **RUN, dimensions=3, stations=[0.3]).control_effort(whole_length=True)
    there, whole = effort.at(0.3)["outer"], effort.over_length[1]
    for name in ("voltage", "field", "charge"):
        assert getattr(there, name) == pytest.approx(getattr(flat, name), rel=1e-9)
    assert there.current == pytest.approx(flat.current, rel=0.05)  # by differences, where it jumps
    assert (whole.real_power, whole.apparent_power) == pytest.approx((flat.real_power, flat.apparent_power), rel=1e-9)
    assert whole.energy == pytest.approx(flat.energy, rel=1e-9)
    assert effort.extent == "per metre of length"


def test_elastic_walls_cost_over_the_length_what_they_do_in_two_dimensions():
    """By the charge of their layers; one without losses in one with them."""
    layers = [one.replace(material=one.material.replace(loss_factor=0.03)) for one in PAIRS.shells[1].layers]
    system = PAIRS.replace(shells=[PAIRS.shells[0].replace(theory="elastic"), PAIRS.shells[1].replace(theory="elastic", layers=layers)])
    plane, few = system.replace(source=cx.PlaneShock(peak_pressure=25e3, decay_time=1.314e-4)), {**RUN, "modes": 2, "time_step": 0.02}
    flat = cx.simulate(plane, **few).control_effort().shells
    over_length = cx.simulate(plane, **few, dimensions=3, stations=[0.3]).control_effort(whole_length=True).over_length
    for one, whole in zip(flat, over_length, strict=True):
        assert (whole.real_power, whole.apparent_power) == pytest.approx((one.real_power, one.apparent_power), rel=1e-9)


def test_power_at_all_stations_adds_up_to_that_over_the_length(spatial):
    ((_, outer), extent), period = length_power(spatial.spatial), spatial.spatial.sampling.period * PAIRS.reference_radius
    per_metre = np.stack([power(motion, 1).real for motion in spatial.motions])  # of half a period, the other its mirror image
    total = period / 11.0 * (per_metre[0] + 2.0 * per_metre[1:].sum(axis=0))
    assert extent == "over the whole length"
    assert_allclose(total, outer.real, rtol=0, atol=0.01 * np.abs(outer.real).max())
    assert (outer.apparent >= np.abs(outer.real) * (1 - 1e-12)).all()


def test_energy_over_the_length_is_that_of_the_balance(spatial):
    effort = spatial.control_effort(whole_length=True, voltage=30.0)
    given = sum(one.energy for one in effort.over_length)
    assert given == pytest.approx(float(spatial.energy(every=40)["amplifier_work"][-1]), rel=1e-3)
    assert not effort.within
    assert effort.at(0.0)["outer"].shares["voltage"] > 1.0
    text = str(effort)
    assert "largest real power, over the whole length" in text
    assert json.loads(json.dumps(effort.to_dict()))["stations"][1]["shells"][1]["shell"] == "outer"
    assert not spatial.control_effort().over_length


def test_what_has_no_charge_is_told_without():
    paper = cx.presets.load("bare").replace(control=cx.PDControl(proportional=-1, derivative=-0.1))
    run = cx.simulate(paper, duration=0.3, time_step=2e-2, modes=2, dimensions=3, stations=[0.0])
    assert run.control_effort().each[0]["inner"].charge is None
    with pytest.raises(InputError, match="no wall is driven"):
        run.control_effort(whole_length=True)
