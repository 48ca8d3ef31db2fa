"""A prepared structure retuned: bitwise what a fresh preparation gives, and only what changed is made anew."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.response import PreparedSystem
from coaxshell.solver import coupling, excitation
from coaxshell.solver.settings import Settings
from coaxshell.solver.shared_parts import shared_parts
from coaxshell.solver.solve import solve

SETTINGS = Settings(duration=1.0, time_step=5e-3, modes=15)
RING = cx.absorber_ring(5, mass=10, damping=2e5, linear_stiffness=1e9, cubic_stiffness=1e21)
ACTIVE = cx.presets.load("active").replace(absorbers=RING)
ARRAYS = ("normal", "tangential", "normal_rate", "tangential_rate", "absorber_displacement", "absorber_force", "control_correction")


def shock(**changes: float) -> cx.SphericalShock:
    return cx.SphericalShock(**{"distance": 5.0, "peak_pressure": 2.5e4, "decay_time": 1.314e-4, **changes})


def thicker(system: cx.System) -> cx.System:
    inner, outer = system.shells
    layers = (*outer.layers[:-1], outer.layers[-1].model_copy(update={"thickness": 4e-3}))
    return system.replace(shells=[inner, outer.model_copy(update={"layers": layers})])


def smaller(system: cx.System) -> cx.System:
    inner, outer = system.shells
    return system.replace(shells=[inner.model_copy(update={"radius": 0.45}), outer])


CHANGES: dict[str, Callable[[cx.System], cx.System]] = {
    "absorbers": lambda s: s.replace(absorbers=cx.absorber_ring(3, mass=5, linear_stiffness=1e8)),
    "no absorbers": lambda s: s.replace(absorbers=()),
    "gains": lambda s: s.replace(control=cx.PDControl(proportional=-1e4, derivative=-170)),
    "no control": lambda s: s.replace(control=None),
    "saturation": lambda s: s.replace(control=cx.PDControl(proportional=-2e4, derivative=-150, saturation=True)),
    "lower limit": lambda s: s.replace(control=cx.PDControl(proportional=-2e4, derivative=-150, saturation=True, field_limit=1e5)),
    "pulse": lambda s: s.replace(source=shock(peak_pressure=1e5, decay_time=3e-4)),
    "distance": lambda s: s.replace(source=shock(distance=4.0)),
    "angle": lambda s: s.replace(source=shock(angle=40.0)),
    "two sources": lambda s: s.replace(source=[shock(), cx.PlaneShock(peak_pressure=1e4, decay_time=1e-4, angle=90.0)]),
    "thickness": thicker,
    "radius": smaller,
    "fluid": lambda s: s.replace(fluids=[cx.VACUUM, *s.fluids[1:]]),
}


def assert_the_same(found: PreparedSystem, system: cx.System, settings: Settings = SETTINGS) -> None:
    reused, fresh = found.simulate().solution, solve(system, settings=settings)
    assert reused.problem == fresh.problem
    assert reused.settings == fresh.settings
    for array in ARRAYS:
        kept, expected = getattr(reused, array), getattr(fresh, array)
        assert (kept is None) == (expected is None), array
        if expected is not None:
            np.testing.assert_array_equal(kept, expected, err_msg=array)
    assert reused.warnings == fresh.warnings
    np.testing.assert_array_equal(reused.estimates.modal_stress, fresh.estimates.modal_stress)
    assert reused.estimates.time_window == fresh.estimates.time_window


@pytest.mark.slow_for("two sources", "distance", "angle", "no absorbers")
@pytest.mark.parametrize("name", CHANGES)
def test_equals_a_fresh_run_exactly(name: str) -> None:
    prepared = cx.prepare(ACTIVE, settings=SETTINGS)
    prepared.simulate()
    changed = CHANGES[name](ACTIVE)
    once = prepared.retuned(changed)
    assert_the_same(once, changed)
    assert_the_same(once.retuned(ACTIVE), ACTIVE)
    assert_the_same(prepared, ACTIVE)


@pytest.mark.slow
def test_a_chain_of_changes() -> None:
    prepared, system = cx.prepare(ACTIVE, settings=SETTINGS), ACTIVE
    for change in CHANGES.values():
        system = change(system) if system.control is not None else change(ACTIVE)
        prepared = prepared.retuned(system)
        assert_the_same(prepared, system)


def test_the_number_of_modes_is_chosen_anew() -> None:
    automatic = Settings(duration=0.5, time_step=1e-2, modes="auto", tolerance=0.05)
    prepared = cx.prepare(ACTIVE, settings=automatic)
    changed = ACTIVE.replace(source=shock(decay_time=2e-3))
    assert_the_same(prepared.retuned(changed), changed, automatic)


@pytest.fixture
def counted(monkeypatch: pytest.MonkeyPatch) -> dict[str, int]:
    """Count the fluid matrices made, and the loads."""
    counts = {"fluids": 0, "loads": 0}
    fluid_matrix, made = coupling.fluid_matrix, excitation.UnitLoad._made

    def fluids(*arguments: object) -> object:
        counts["fluids"] += 1
        return fluid_matrix(*arguments)

    def loads(*arguments: object) -> object:
        counts["loads"] += 1
        return made(*arguments)

    monkeypatch.setattr(coupling, "fluid_matrix", fluids)
    monkeypatch.setattr(excitation.UnitLoad, "_made", loads)
    return counts


@pytest.mark.parametrize("name", ["absorbers", "gains", "pulse", "angle", "saturation"])
def test_fluids_and_loads_are_made_once(name: str, counted: dict[str, int]) -> None:
    prepared = cx.prepare(ACTIVE, settings=SETTINGS).retuned(CHANGES["gains"](ACTIVE.replace(source=shock(peak_pressure=1.0))))
    prepared.simulate()
    before = dict(counted)
    assert before["fluids"] > 0
    prepared.retuned(CHANGES[name](ACTIVE)).simulate()
    assert counted == before


def test_sources_share_the_answers_to_forces() -> None:
    prepared = cx.prepare(ACTIVE, settings=SETTINGS)
    other = prepared.retuned(CHANGES["two sources"](ACTIVE))
    assert other.structure.compliance is prepared.structure.compliance
    assert other.structure.kernels is prepared.structure.kernels
    assert prepared.retuned(CHANGES["gains"](ACTIVE)).structure.units is not prepared.structure.units


def test_unstable_gains_are_refused_and_do_no_harm() -> None:
    prepared = cx.prepare(ACTIVE, settings=SETTINGS)
    with pytest.raises(InputError, match=r"control\.proportional"):
        prepared.retuned(ACTIVE.replace(control=cx.PDControl(proportional=2e5, derivative=0.0)))
    assert_the_same(prepared, ACTIVE)


def test_public_form() -> None:
    settings = {"duration": 1.0, "time_step": 5e-3, "modes": 15}
    changed = CHANGES["gains"](ACTIVE)
    ready = cx.prepare(ACTIVE, **settings).retuned(changed)
    assert ready.system == changed
    np.testing.assert_array_equal(ready.simulate().stress("inner"), cx.simulate(changed, **settings).stress("inner"))


def test_retunable_shares_from_its_first_retuning_on(counted: dict[str, int]) -> None:
    settings = {"duration": 1.0, "time_step": 5e-3, "modes": 15}
    prepared = cx.prepare(ACTIVE, **settings, retunable=True)
    response = prepared.simulate()
    before = dict(counted)
    assert before["fluids"] > 0
    changed = CHANGES["gains"](ACTIVE)
    retuned = prepared.retuned(changed).simulate()
    assert counted == before
    np.testing.assert_array_equal(retuned.stress("inner"), cx.simulate(changed, **settings).stress("inner"))
    np.testing.assert_array_equal(response.stress("inner"), cx.simulate(ACTIVE, **settings).stress("inner"))


class TestSharedParts:
    def test_it_keeps_and_lets_go_of_the_longest_unused(self) -> None:
        shared, made = shared_parts(room=3 * 80), []

        def part(name: str) -> np.ndarray:
            return shared.get_or_make(name, lambda: made.append(name) or np.zeros(10))

        first = part("a")
        part("b")
        part("c")
        assert part("a") is first
        assert shared.bytes == 240
        part("d")  # b goes
        assert shared.bytes == 240
        for name in "acd":
            part(name)
        assert made == list("abcd")
        part("b")
        assert made == list("abcdb")

    def test_what_is_larger_than_the_room_is_not_kept(self) -> None:
        shared = shared_parts(room=79)
        shared.get_or_make("a", lambda: np.zeros(10))
        assert shared.bytes == 0
