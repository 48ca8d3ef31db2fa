"""Tension on wetted surfaces, and charges outside the range of their similitude: told, with both numbers."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.response import PreparedSystem
from coaxshell.solver.cavitation import AMBIENT
from coaxshell.solver.tension import HARMLESS, spectra_of_motion, tensions, wall_pressures

QUICK = {"duration": 3.0, "time_step": 0.01, "modes": 24}
LOUD = {"source": cx.PlaneWave(pulse=cx.Gaussian(peak_pressure="2 MPa", width="0.15 ms"))}  # smooth: what 24 orders resolve


def prepared(name: str, changes: dict[str, object]) -> PreparedSystem:
    return cx.prepare(cx.presets.load(name).with_overrides(changes), **QUICK)


@pytest.mark.parametrize("name", ["iakovlev-evacuated", "bare"])
def test_pressures_on_the_walls_are_those_of_the_field(name: str) -> None:
    found = prepared(name, LOUD)
    grid, structure = found.structure.grid, found.structure
    response = cx.simulate(found.problem.system, **QUICK)
    window = np.exp(-20.0 * np.linspace(0.0, 1.0, grid.nodes.size) ** 4)
    angles = np.array([0.0, 70.0, 180.0])
    cosines = np.cos(np.radians(angles)[:, None] * np.arange(25.0))
    time = response.time[::5]
    for region, shell, spectra in wall_pressures(found.problem, grid, structure.normal):
        radius = found.problem.shells[shell].radius * (1 + 1e-9 * (1 if region > shell else -1))
        ours = found.problem.scales.pressure * cosines @ grid.invert(spectra, window)[0][:, ::5]
        theirs = response.pressure(radius=radius, angle=angles, time=time, front="matched").values.reshape(len(time), -1).T
        assert abs(ours - theirs).max() < 0.01 * abs(theirs).max()


def test_a_loud_shock_tears_the_water_and_says_so() -> None:
    response = cx.simulate(cx.presets.load("iakovlev-evacuated").with_overrides(LOUD), **QUICK)
    (text,) = [text for text in response.warnings if "cavitate" in text]
    pressure = response.pressure(radius=1.0 + 1e-9, angle=np.arange(0.0, 181.0, 3.0), time=response.time)
    lowest = float(pressure.min())
    assert lowest < -1.2 * AMBIENT
    value, unit = text.split("falls to ")[1].split()[:2]
    assert float(value) * {"kPa": 1e3, "MPa": 1e6}[unit] == pytest.approx(lowest, rel=0.02)
    for words in ("shell: ", "-100.0 kPa", "degrees at once", "lower the source's pressure", "t = "):
        assert words in text
    quiet = cx.simulate(cx.presets.load("iakovlev-evacuated").with_overrides({"source.peak_pressure": "25 kPa"}), **QUICK)
    assert not [text for text in quiet.warnings if "cavitate" in text]


def test_nothing_is_computed_for_faint_shocks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("coaxshell.solver.tension.wall_pressures", lambda *_: pytest.fail("pressures were computed"))
    faint = prepared("iakovlev-evacuated", {"source.peak_pressure": f"{HARMLESS * AMBIENT} Pa"})
    assert tensions(faint.problem, faint.structure.grid, faint.structure.normal) == []


def test_tension_scales_with_the_shock_and_lies_where_it_is_told() -> None:
    loud, louder = (prepared("bare", {"source.peak_pressure": p}) for p in ("5 MPa", "10 MPa"))
    first, second = (tensions(each.problem, each.structure.grid, each.structure.normal) for each in (loud, louder))
    assert {(low.region, low.shell) for low in first} <= {(low.region, low.shell) for low in second}
    for low in first:
        same = next(other for other in second if (other.region, other.shell) == (low.region, low.shell))
        assert same.pressure == pytest.approx(2 * low.pressure)
        assert (same.time, same.angle) == (low.time, low.angle)
        assert same.width >= low.width > 0
        assert same.lasting >= low.lasting > 0
        assert 0 <= low.time <= QUICK["duration"]


def test_rigid_and_evacuated_systems_are_looked_at_too() -> None:
    source = cx.PlaneWave(pulse=cx.Gaussian(peak_pressure=-3e5, width="0.1 ms"))
    rigid = cx.System(shells=[cx.RigidShell(radius=1.0)], fluids=["vacuum", "freshwater"], source=source)
    found = cx.prepare(rigid, duration=3.0, time_step=0.01, modes=12)
    (low,) = tensions(found.problem, found.structure.grid, found.structure.normal)
    assert low.angle < 15
    assert -6.6e5 < low.pressure < -4e5  # nearly doubled where it falls in squarely


@pytest.mark.parametrize(("charge", "words"), [("1 g", "lessen"), ("900 kg", "increase")])
def test_charges_outside_the_fit(charge: str, words: str) -> None:
    stand_off = "30 m" if words == "lessen" else "0.5 m"
    source = cx.UnderwaterExplosion(charge_mass=charge, stand_off=stand_off)
    assert not source.within_fit
    system = cx.presets.load("iakovlev-evacuated").replace(source=source)
    texts = [text for text in cx.simulate(system, **QUICK).warnings if "similitude" in text]
    assert len(texts) == 1
    assert words in texts[0]
    assert "3.400 MPa" in texts[0]
    assert "138.0 MPa" in texts[0]


def test_a_charge_within_the_fit_is_no_matter() -> None:
    source = cx.UnderwaterExplosion(charge_mass="10 kg", stand_off="10 m")
    assert source.within_fit
    response = cx.simulate(cx.presets.load("iakovlev-evacuated").replace(source=source), **QUICK)
    assert not [text for text in response.warnings if "similitude" in text]


@pytest.mark.parametrize("name", ["iakovlev-evacuated", "bare", "hybrid"])
@pytest.mark.filterwarnings("ignore::coaxshell.PhysicsWarning")
def test_the_direct_engine_finds_what_the_spectral_one_finds(name: str) -> None:
    system = cx.presets.load(name).with_overrides(LOUD)
    told = {}
    for engine in ("spectral", "direct"):
        response = cx.simulate(system, **QUICK, engine=engine)
        told[engine] = [text.split(" at t = ") for text in response.warnings if "cavitate" in text]
    assert told["spectral"]
    assert len(told["spectral"]) == len(told["direct"])
    for ours, theirs in zip(told["direct"], told["spectral"], strict=True):
        assert ours[0].split("falls to")[0] == theirs[0].split("falls to")[0]
        number, wanted = (float(text.split("falls to ")[1].split()[0]) for text in (ours[0], theirs[0]))
        assert number == pytest.approx(wanted, rel=0.03)
        assert float(ours[1].split()[0]) == pytest.approx(float(theirs[1].split()[0]), abs=0.03)


def test_a_motion_that_is_cut_off_ends_in_no_pressure_of_its_own() -> None:
    found = prepared("bare", LOUD)
    grid, normal = found.structure.grid, found.structure.normal
    window = np.exp(-20.0 * np.linspace(0.0, 1.0, grid.nodes.size) ** 4)
    again = spectra_of_motion(grid, grid.invert(normal))
    pressures = zip(wall_pressures(found.problem, grid, again), wall_pressures(found.problem, grid, normal), strict=True)
    for (_, _, ours), (_, _, theirs) in pressures:
        wanted = grid.invert(theirs, window)
        assert abs(grid.invert(ours, window) - wanted).max() < 0.02 * abs(wanted).max()
