"""What the guide shows to whoever extends the package works: a source, a law and a study, against answers of what there is."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.acoustics.sources.line import LineGeometry
from coaxshell.acoustics.sources.source import FreeField, incident_of_regular
from coaxshell.response import PreparedSystem
from coaxshell.solver.links import described
from coaxshell.solver.links.law import LawSlopes, StepForce
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.settings import Settings
from house import PROJECT

SETTINGS = {"duration": 1.0, "time_step": 1e-2, "modes": 5}
KNOWN = {
    "np": np,
    "cx": cx,
    "dataclass": dataclass,
    "LineGeometry": LineGeometry,
    "FreeField": FreeField,
    "incident_of_regular": incident_of_regular,
    "StepForce": StepForce,
    "LawSlopes": LawSlopes,
}


@pytest.fixture(scope="module")
def shown() -> dict[str, object]:
    """Return the names that the guide's examples define."""
    names: dict[str, object] = {"__name__": __name__, **KNOWN}
    for block in re.findall(r"```python\n(.*?)```", (PROJECT / "docs" / "extending.md").read_text(encoding="utf-8"), re.DOTALL):
        exec(block, names)
    return names


@pytest.fixture(scope="module")
def near() -> cx.LineShock:
    return cx.LineShock(peak_pressure=250e3, decay_time=1.314e-4, distance=4.0)


def test_a_source_of_two_lines_is_a_run_of_two_sources(shown, double, near):
    bare = double.replace(source=near)
    problem = dimensionless(bare)
    (one,) = problem.sources
    doublet = shown["LineDoublet"](one, replace(one, distance=one.distance + 1.5))
    own = PreparedSystem(replace(problem, sources=(doublet,)), Settings(**SETTINGS)).simulate(())
    farther = near.replace(distance=5.5, peak_pressure=-near.peak_pressure)
    two = cx.simulate(bare.replace(source=[near, farther]), **SETTINGS)
    assert_allclose(own.solution.normal, two.solution.normal, rtol=0, atol=1e-12 * np.abs(two.solution.normal).max())
    fields = [np.asarray(response.pressure([1.1, 0.4], [0.3, 0.2], time=[0.4, 0.8])) for response in (own, two)]
    assert_allclose(*fields, rtol=0, atol=1e-6 * near.peak_pressure)


def test_a_softening_spring_is_its_table(shown, double, near, monkeypatch):
    limit, stretch = 2e3, 2e-6
    points = np.linspace(-8, 8, 801)
    table = cx.laws.Table(stretch=tuple(stretch * points), force=tuple(limit * np.tanh(points) + 1e-9 * points))
    absorbers = [cx.Absorber(angle=0, mass=8.0, damping=2e4, linear_stiffness=1e8, cubic_stiffness=0.0, law=table)]
    system = double.replace(source=near, absorbers=absorbers)
    tabulated = cx.simulate(system, **SETTINGS)

    def elements(law, scales):
        return [described.Element("softening", (limit / scales.force, stretch / scales.length))]

    def made(links, found, step):
        return shown["SofteningSprings"](links, *np.array([one.numbers for one in found]).T)

    monkeypatch.setattr(described, "_elements", elements)
    monkeypatch.setattr(described, "_MADE", {**described._MADE, "softening": made})
    own = cx.simulate(system, **SETTINGS)
    assert np.ptp(tabulated.absorber_stroke().to_numpy()) > 2 * stretch  # far from linear
    assert_allclose(own.solution.normal, tabulated.solution.normal, rtol=0, atol=1e-5 * np.abs(own.solution.normal).max())
    assert float(abs(own.energy(every=25).closure_relative).max()) < 1e-3


def test_a_study_finds_the_stand_off_of_a_limit(shown, double):
    charge = cx.UnderwaterExplosion(charge_mass=10, stand_off=20)
    system, asked = double.replace(source=charge), {"metric": "outer.peak_stress", "workers": 1, **SETTINGS}

    def peak(distance: float) -> float:
        return cx.simulate(system.replace(source=charge.replace(stand_off=distance)), **SETTINGS).summary().shells[1].stress.value

    limit = 0.5 * (peak(14.0) + peak(40.0))
    found = shown["least_stand_off"](system, limit=limit, nearest=14.0, farthest=40.0, **asked)
    assert peak(found) <= limit < peak(found / 1.02)
    with pytest.raises(cx.InputError, match="begin farther away"):
        shown["least_stand_off"](system, limit=0.1 * limit, nearest=14.0, farthest=40.0, **asked)
