"""The energy balance: it closes, it notices every broken factor, and it is labelled."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.response import Response
from coaxshell.response.energy import energy
from coaxshell.solver.recompute import spectra_of
from coaxshell.solver.scaling import Problem

WATER, AIR = cx.Fluid(density=1000, sound_speed=1400), cx.Fluid(density=400, sound_speed=900)
ALUMINIUM = cx.materials.ALUMINIUM
LINK = {"mass": 10, "damping": 1e5, "linear_stiffness": 1e9}
SMALL = {"duration": 3.0, "time_step": 1e-2, "modes": 20}


def plain(radius: float, thickness: float = 6e-3) -> cx.Shell:
    return cx.Shell(radius=radius, layers=[cx.Layer(ALUMINIUM, thickness)])


def lopsided(radius: float) -> cx.Shell:
    layers = [
        cx.Layer(cx.materials.PZT4, 2e-3, role="sensor"),
        cx.Layer(ALUMINIUM, 8e-3),
        cx.Layer(cx.materials.PZT4, 3e-3, role="actuator"),
    ]
    return cx.Shell(radius=radius, layers=layers)


SHOCK = {"peak_pressure": 2.5e4, "decay_time": 1.314e-4}
SYSTEMS: dict[str, tuple[cx.System, float]] = {
    "bare preset": (cx.presets.load("bare"), 1e-5),
    "hybrid preset": (cx.presets.load("hybrid"), 1e-3),
    "saturated control": (
        cx.presets.load("active").replace(control=cx.PDControl(proportional=-2e4, derivative=-150, saturation=True)),
        1e-4,
    ),
    "linear absorbers off the axis": (
        cx.presets.load("bare").replace(absorbers=[cx.Absorber(angle=25.0, **LINK), cx.Absorber(angle=-80.0, **LINK)]),
        1e-4,
    ),
    "three shells, two sources, sine half": (
        cx.System(
            shells=[plain(0.3), lopsided(0.6), plain(1.0)],
            fluids=[AIR, WATER, AIR, WATER],
            source=[cx.SphericalShock(distance=4.0, angle=30.0, **SHOCK), cx.LineShock(distance=3.0, angle=-100.0, **SHOCK)],
            control=cx.PDControl(proportional=-2e4, derivative=-150, shells=[1]),
        ),
        1e-5,
    ),
    "vacuum inside, plane wave": (
        cx.System(shells=[plain(0.5), plain(1.0)], fluids=[cx.VACUUM, WATER, WATER], source=cx.PlaneShock(**SHOCK)),
        1e-5,
    ),
    "rigid core": (
        cx.System(shells=[cx.RigidShell(radius=0.3), plain(1.0)], fluids=[cx.VACUUM, WATER, WATER], source=cx.PlaneShock(**SHOCK)),
        1e-5,
    ),
    "one thick shell of two layers": (
        cx.System(
            shells=[cx.Shell(radius=1.0, layers=[cx.Layer(cx.materials.STRUCTURAL_STEEL, 2e-2), cx.Layer(ALUMINIUM, 6e-2)])],
            fluids=[cx.VACUUM, WATER],
            source=cx.PlaneShock(**SHOCK),
        ),
        1e-6,
    ),
    "one shell": (cx.System(shells=[plain(1.0)], fluids=[WATER, WATER], source=cx.PlaneShock(**SHOCK)), 1e-5),
}


@pytest.fixture(scope="module")
def solved() -> Callable[[str], Response]:
    known: dict[str, Response] = {}

    def solve(name: str) -> Response:
        if name not in known:
            known[name] = cx.simulate(SYSTEMS[name][0], **SMALL)
        return known[name]

    return solve


@pytest.fixture(scope="module")
def balanced(solved: Callable[[str], Response]) -> Callable[[str], xr.Dataset]:
    known: dict[str, xr.Dataset] = {}

    def balance(name: str) -> xr.Dataset:
        if name not in known:
            known[name] = solved(name).energy()
        return known[name]

    return balance


def worst(balance: xr.Dataset) -> float:
    return float(np.abs(balance["closure_relative"]).max())


@pytest.mark.slow_for("three shells, two sources, sine half", "saturated control")
@pytest.mark.filterwarnings("ignore::coaxshell.PhysicsWarning")
@pytest.mark.parametrize("name", SYSTEMS)
def test_it_closes_at_every_time(balanced: Callable[[str], xr.Dataset], name: str) -> None:
    assert worst(balanced(name)) < SYSTEMS[name][1]


def scaled_shell(problem: Problem, index: int, **factors: float) -> Problem:
    """Return the problem with attributes of one shell, or of its section, multiplied."""
    shell = problem.shells[index]
    own = {name: factor * getattr(shell, name) for name, factor in factors.items() if name == "mass"}
    inside = {name: factor * getattr(shell.section, name) for name, factor in factors.items() if name != "mass"}
    shells = list(problem.shells)
    shells[index] = replace(shell, **own, section=replace(shell.section, **inside))
    return replace(problem, shells=tuple(shells))


def scaled_fluid(problem: Problem, index: int, **factors: float) -> Problem:
    fluids = list(problem.fluids)
    fluids[index] = replace(fluids[index], **{name: factor * getattr(fluids[index], name) for name, factor in factors.items()})
    return replace(problem, fluids=tuple(fluids))


BROKEN: dict[str, tuple[str, Callable[[Problem], Problem]]] = {
    "mass of the inner shell": ("bare preset", lambda p: scaled_shell(p, 0, mass=1.01)),
    "mass of the outer shell": ("bare preset", lambda p: scaled_shell(p, 1, mass=1.01)),
    "membrane stiffness": ("bare preset", lambda p: scaled_shell(p, 0, membrane=1.01)),
    "bending stiffness": ("bare preset", lambda p: scaled_shell(p, 1, bending=1.5)),
    "interior density": ("bare preset", lambda p: scaled_fluid(p, 0, density=1.01)),
    "interior slowness": ("bare preset", lambda p: scaled_fluid(p, 0, slowness=1.01)),
    "gap density": ("bare preset", lambda p: scaled_fluid(p, 1, density=1.01)),
    "cross stiffness": ("one thick shell of two layers", lambda p: scaled_shell(p, 0, cross=1.1)),
    "feedback": (
        "three shells, two sources, sine half",
        lambda p: replace(p, shells=(p.shells[0], replace(p.shells[1], gains=replace(p.shells[1].gains, derivative=-160.0)), p.shells[2])),
    ),
}


@pytest.mark.slow_except("feedback", "cross stiffness", "bending stiffness")
@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_factor_shows(solved: Callable[[str], Response], name: str) -> None:
    system, broken = BROKEN[name]
    solution = solved(system).solution
    assert worst(energy(replace(solution, problem=broken(solution.problem)), spectra=spectra_of(solution))) > 2 * SYSTEMS[system][1]


@pytest.mark.slow_except("change0")
@pytest.mark.parametrize("change", [{"mass": 12}, {"linear_stiffness": 1.2e9}, {"damping": 1.2e5}])
def test_a_broken_absorber_shows(
    solved: Callable[[str], Response], balanced: Callable[[str], xr.Dataset], change: dict[str, float]
) -> None:
    name = "linear absorbers off the axis"
    solution = solved(name).solution
    wrong = [a.replace(**change) for a in SYSTEMS[name][0].absorber_list]
    problem = replace(solution.problem, system=solution.problem.system.replace(absorbers=wrong))
    found = energy(replace(solution, problem=problem), spectra=spectra_of(solution))
    assert worst(found) > 10 * worst(balanced(name))


def test_the_parts_are_labelled_and_add_up(solved: Callable[[str], Response]) -> None:
    balance = solved("bare preset").energy(every=7)
    assert set(balance.dims) == {"time"}
    np.testing.assert_allclose(balance["time"], solved("bare preset").time[::7], rtol=1e-15)
    assert balance["time_seconds"].attrs["units"] == "s"
    for variable in balance.data_vars.values():
        assert variable.dims == ("time",)
        assert {"units", "long_name", "role", "group"} <= set(variable.attrs)
    shells = {f"{shell}_{part}" for shell in ("inner", "outer") for part in ("kinetic", "strain", "piezoelectric")}
    fluids = {f"{fluid}_{part}" for fluid in ("interior", "gap") for part in ("kinetic", "compression")}
    assert shells | fluids <= {str(name) for name, variable in balance.data_vars.items() if variable.attrs["role"] == "store"}
    parts = balance["incident_work"] + balance["scattered_work"] + balance["radiated_work"]
    np.testing.assert_allclose(parts, balance["exterior_work"], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(balance["radiated_energy"], -balance["radiated_work"], rtol=1e-15)
    stored = sum(v for v in balance.data_vars.values() if v.attrs["role"] in ("store", "loss"))
    np.testing.assert_allclose(balance["exterior_work"] - stored, balance["closure_residual"], rtol=1e-9, atol=1e-12)
    for name in shells | fluids:
        assert float(balance[name].min()) > -1e-9 * float(balance["exterior_work"].max())


def test_what_is_not_there_is_left_out(balanced: Callable[[str], xr.Dataset]) -> None:
    rigid = balanced("rigid core")
    assert not [name for name in rigid.data_vars if str(name).startswith(("inner_", "interior_"))]
    assert float(np.abs(rigid["actuator_work"]).max()) == 0.0
    assert {"gap_1_kinetic", "gap_2_kinetic", "shell_1_strain"} <= set(balanced("three shells, two sources, sine half").data_vars)
    assert {"shell_kinetic", "interior_kinetic"} <= set(balanced("one shell").data_vars)


@pytest.mark.slow
def test_it_does_not_depend_on_how_often_it_is_taken(solved: Callable[[str], Response], balanced: Callable[[str], xr.Dataset]) -> None:
    often, seldom = balanced("bare preset"), solved("bare preset").energy(every=50)
    for name in ("gap_kinetic", "interior_compression", "outer_strain", "exterior_work"):
        np.testing.assert_allclose(often[name][::5], seldom[name], rtol=1e-9, atol=1e-14)


@pytest.mark.slow
def test_a_loaded_response_gives_the_same(solved: Callable[[str], Response], balanced: Callable[[str], xr.Dataset], tmp_path) -> None:
    response = solved("linear absorbers off the axis")
    loaded = cx.load_response(response.save(tmp_path / "run.nc"))
    xr.testing.assert_allclose(loaded.energy(), balanced("linear absorbers off the axis"), rtol=1e-12)


def test_progress_is_told(solved: Callable[[str], Response]) -> None:
    told: list[tuple[float, str]] = []
    solved("one shell").energy(progress=lambda fraction, stage: told.append((fraction, stage)))
    fractions = [fraction for fraction, _ in told]
    assert fractions == sorted(fractions)
    assert fractions[-1] == pytest.approx(1.0)
    assert told[-1][1] == "fluids"


@pytest.mark.parametrize("every", [0, -3, 2.5, True, 10**6])
def test_a_bad_every_is_refused(solved: Callable[[str], Response], every: object) -> None:
    with pytest.raises(InputError, match="every"):
        solved("one shell").energy(every=every)  # type: ignore[arg-type]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::coaxshell.PhysicsWarning")
@pytest.mark.parametrize(("name", "limit"), [("bare", 1e-6), ("absorbers", 1e-5), ("active", 1e-6), ("hybrid", 3e-5)])
def test_presets_close_at_the_papers_resolution(name: str, limit: float) -> None:
    # Measured 5.1e-7, 6.2e-6, 5.5e-7, 1.7e-5: with dampers the error of the march in the rates is what is left.
    assert worst(cx.simulate(cx.presets.load(name)).energy()) < limit
