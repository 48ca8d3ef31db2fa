"""Absorbers of any law in whole systems: against exact solutions, each other, their energy, and what they are in limits."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell import Response
from coaxshell.acoustics.basis import Modes
from coaxshell.model import presets
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.interface.absorbers import absorber_set, side_admittance
from coaxshell.solver.links.any_law import march_interface
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.structure_spectra import StructureSpectra

BARE = presets.load("bare")
LAWS = cx.laws
COMMON = {"damping": 1e4, "linear_stiffness": 1e8}


def of(*absorbers: cx.Absorber, system: System = BARE) -> System:
    return system.replace(absorbers=absorbers)


def run(system: System, time_step: float = 8e-3, modes: int = 6, duration: float = 2.0) -> Response:
    return cx.simulate(system, duration=duration, time_step=time_step, modes=modes)


def motion(response: Response) -> FloatArray:
    return np.concatenate([np.asarray(response.displacement(shell, [0.0, 70.0])) for shell in range(len(response.system.shells))], axis=1)


def apart(one: FloatArray, other: FloatArray) -> float:
    return float(np.linalg.norm(one - other) / np.linalg.norm(other))


def closure(response: Response) -> float:
    return float(abs(response.energy(every=25).closure_relative).max())


def single(**law: object) -> cx.Absorber:
    return cx.Absorber(angle=0, mass=10, **{**COMMON, **law})


@cache
def plain() -> FloatArray:
    return motion(run(of(single(linear_stiffness=5e8))))


@pytest.mark.parametrize("law", [LAWS.Linear(4e8), LAWS.Sides(LAWS.Linear(4e8), LAWS.Linear(4e8)), LAWS.Parallel([LAWS.Linear(2e8)] * 2)])
def test_a_spring_as_a_law_is_solved_exactly_as_that_of_the_absorber(law):
    assert apart(motion(run(of(single(law=law)))), plain()) < 1e-12


@pytest.mark.parametrize("law", [LAWS.Polynomial([4e8]), LAWS.Table([-1.0, 1.0], [-4e8, 4e8]), LAWS.Gap(0.0, 4e8)])
def test_a_straight_law_that_is_marched_is_the_exact_spring(law):
    assert 1e-9 < apart(motion(run(of(single(law=law)))), plain()) < 1e-4


def test_a_cubic_law_is_the_cubic_spring_by_another_march():
    spring = motion(run(of(single(cubic_stiffness=1e21)), time_step=4e-3))
    law = motion(run(of(single(law=LAWS.Cubic(k3=1e21))), time_step=4e-3))
    assert apart(spring, motion(run(of(single()), time_step=4e-3))) > 1e-2
    assert apart(law, spring) < 2e-4


def test_absorbers_with_unequal_sides_are_those_with_the_mean_where_the_mass_is_nothing_and_exact():
    # two springs in series, 1/k = 1/k0 + 1/k1
    series = 1.0 / (1.0 / 3e8 + 1.0 / 6e8)
    sides = LAWS.Sides(LAWS.Linear(3e8), LAWS.Linear(6e8))
    unequal = cx.Absorber(mass=1e-9, law=sides)
    equal = cx.Absorber(mass=1e-9, linear_stiffness=2.0 * series)
    assert apart(motion(run(of(unequal))), motion(run(of(equal)))) < 1e-9


FULL = {
    "bistable": LAWS.Bistable(-2e8, 1e20),
    "stops": LAWS.Gap("1 um", 1e9, 0.5),
    "dry friction": LAWS.Friction(3e3, 4e3),
    "smoothed friction": LAWS.Friction(3e3, speed=1e-2),
    "hysteretic friction": LAWS.Friction(5e2, stiffness=1e9),
    "table": LAWS.Table([-1e-6, 0.0, 1e-6], [-2e3, 0.0, 5e2]),
    "Maxwell": LAWS.Maxwell(1e9, "50 us"),
    "each side its own": LAWS.Sides(LAWS.Gap("0.5 um", 2e9, 0.6), LAWS.Parallel([LAWS.Friction(1e3), LAWS.Maxwell(1e9, 1e-4)])),
}


@pytest.mark.slow_for("each side its own", "smoothed friction")
@pytest.mark.parametrize("name", FULL)
def test_the_energy_of_every_law_closes(name):
    response = run(of(single(law=FULL[name], inertance=1.0 if name == "Maxwell" else 0.0)), time_step=4e-3, modes=4)
    energy = response.energy(every=25)
    assert float(abs(energy.closure_relative).max()) < 1e-4
    heat = float(energy.law_dissipation[-1] / energy.exterior_work.max())
    assert (heat > 1e-4) == (name not in ("bistable", "table"))
    assert heat > -1e-12


def test_the_march_of_friction_and_stops_converges_at_second_order():
    law = FULL["each side its own"]
    coarse, middle, fine = (motion(run(of(single(law=law)), time_step=0.016 / 2**k))[:: 2**k] for k in range(3))
    assert apart(coarse, fine) / apart(middle, fine) > 3.0
    assert apart(middle, fine) < 2e-3


def test_a_mass_on_one_shell_alone_is_a_shell_with_a_dynamic_mass():
    # links="outer" of a mass on a spring so stiff that it moves with the wall: a lump, whichever shell is inside
    lump = motion(run(of(cx.Absorber(mass=5, linear_stiffness=1e13, links="outer"))))
    between = motion(run(of(cx.Absorber(mass=5, law=LAWS.Sides(outer=LAWS.Linear(1e13))))))
    assert apart(lump, between) < 1e-10
    assert apart(lump, motion(run(BARE.replace(absorbers=[])))) > 1e-3


def test_a_core_that_is_no_shell_holds_like_a_spring_to_the_ground():
    # massless: two springs k in series to what does not move; against a rigid inner shell, whose fluid is the same
    ring = BARE.replace(shells=[cx.RigidShell(radius=BARE.shells[0].radius), BARE.shells[1]])
    to_core = motion(run(of(cx.Absorber(mass=2, linear_stiffness=2e8, links="outer", grounded=True), system=ring)))
    to_shell = motion(run(of(cx.Absorber(mass=2, linear_stiffness=2e8), system=ring)))
    assert apart(to_core, to_shell) < 1e-12
    law = cx.Absorber(mass=2, law=LAWS.Polynomial([2e8]), links="outer", grounded=True)
    assert apart(motion(run(of(law, system=ring))), to_core) < 1e-4


def test_a_tuned_mass_damper_has_den_hartogs_two_equal_peaks():
    # mass ratio mu: tuned to w/(1 + mu), zeta^2 = 3 mu/(8 (1 + mu)^3), both peaks near the fixed points, (1 + 2/mu)^(1/2)
    problem, ratio, mass = dimensionless(BARE), 0.05, 3.0
    scales, tuned = problem.scales, 1.0 / (1.0 + ratio)
    damper = 2.0 * ratio * mass * np.sqrt(3.0 * ratio / (8.0 * (1.0 + ratio) ** 3))
    absorber = cx.Absorber(
        mass=ratio * mass * scales.pressure * scales.length**2 / scales.velocity**2,
        linear_stiffness=ratio * mass * tuned**2 * scales.pressure,
        damping=damper * scales.pressure * scales.length / scales.velocity,
        links="outer",
    )
    s = 1j * np.linspace(0.7, 1.3, 6001)
    links = absorber_set(problem, (absorber,), 1)
    law = side_admittance(links, s)
    assert not law.inner.any()
    answer = np.abs(mass / (mass * (1.0 + s**2) + law.outer[:, 0]))
    peaks = answer[1:-1][(answer[1:-1] > answer[:-2]) & (answer[1:-1] > answer[2:])]
    assert peaks.size == 2
    assert_allclose(peaks, np.sqrt(1.0 + 2.0 / ratio), rtol=0.02)


def test_inertance_alone_is_a_mass_between_the_ends():
    # of a mass on one shell and no spring, q = b/(m + b) w: the wall feels m b/(m + b)
    inerter = cx.Absorber(mass=6, inertance=3, links="outer")
    lump = cx.Absorber(mass=2, linear_stiffness=1e14, links="outer")
    assert apart(motion(run(of(inerter))), motion(run(of(lump)))) < 1e-5
    marched = cx.Absorber(mass=6, inertance=3, links="outer", law=LAWS.Polynomial([1.0]))
    assert apart(motion(run(of(marched))), motion(run(of(lump)))) < 2e-4


def test_friction_that_never_slips_is_a_rigid_link_and_none_is_nothing():
    free = cx.Absorber(mass=5, law=LAWS.Friction(1e-6), links="outer")
    stuck = cx.Absorber(mass=5, law=LAWS.Friction(1e9), links="outer")
    assert apart(motion(run(of(free))), motion(run(BARE.replace(absorbers=[])))) < 1e-6
    lump = motion(run(of(cx.Absorber(mass=5, linear_stiffness=1e13, links="outer"))))
    assert apart(motion(run(of(stuck), time_step=4e-3))[::2], lump) < 2e-3


def test_one_shell_alone_bears_a_tuned_mass_damper():
    system = presets.load("iakovlev-filled")
    damper = cx.Absorber(mass=20, linear_stiffness=1e8, damping=1e4, links="outer")
    response = run(of(damper, system=system))
    assert closure(response) < 1e-4
    marched = damper.replace(linear_stiffness=0.0, law=LAWS.Polynomial([1e8]))
    assert apart(motion(run(of(marched, system=system))), motion(response)) < 1e-4


def test_a_mirrored_pair_of_any_law_is_carried_once_and_is_the_pair():
    law = LAWS.Gap("1 um", 1e9, 0.5)
    pair = of(single(law=law).replace(angle=30.0), single(law=law).replace(angle=-30.0))
    nearly = of(single(law=law).replace(angle=30.0), single(law=law, damping=1.0000001e4).replace(angle=-30.0))
    assert apart(motion(run(pair)), motion(run(nearly))) < 1e-6


def test_what_a_run_of_laws_saved_answers_as_before(tmp_path):
    response = run(of(single(law=FULL["stops"])))
    response.save(tmp_path / "run.nc")
    restored = cx.load_response(tmp_path / "run.nc")
    assert_allclose(restored.shell_velocity("inner", angle=0), response.shell_velocity("inner", angle=0), rtol=1e-12)
    assert restored.system == response.system


def test_a_step_too_long_for_a_stop_is_told_with_the_one_that_would_do():
    told = [str(one) for one in run(of(single(law=LAWS.Gap("0.1 um", 1e12)))).warnings if str(one).startswith("absorbers")]
    assert len(told) == 1
    assert "radians a step" in told[0]
    assert "time_step = " in told[0]


def test_point_absorbers_have_laws_too():
    def at_point(**law: object) -> FloatArray:
        point = cx.PointAbsorber(angle=20, z=0.1, mass=3, damping=1e4, **law)
        response = cx.simulate(BARE.replace(absorbers=[point]), duration=1.0, time_step=2e-2, modes=5, dimensions=3, stations=[0.0])
        return np.asarray(response.displacement("inner", angle=[0.0, 60.0]))

    exact = at_point(linear_stiffness=1e8)
    assert apart(at_point(law=LAWS.Polynomial([1e8])), exact) < 1e-4
    assert apart(at_point(law=LAWS.Linear(1e8)), exact) < 1e-12
    assert apart(at_point(linear_stiffness=1e8, law=LAWS.Friction(2e3)), exact) > 1e-3


def test_where_laws_are_not_solved_they_are_refused_first():
    with pytest.raises(cx.InputError) as told:
        cx.simulate(of(single(law=FULL["stops"])), duration=1.0, time_step=2e-2, modes=4, engine="direct")
    assert told.value.where == "absorbers[0].law"


def test_answers_at_frequencies_refuse_what_is_not_linear():
    with pytest.raises(cx.InputError, match="is not linear"):
        cx.frequency_response(of(single(law=FULL["stops"])), frequency=[100.0], quantity="absorber_force", modes=4)


def test_saturation_beside_laws_is_refused():
    system = of(single(law=FULL["stops"]), system=BARE.replace(control=cx.PDControl(proportional=-2e4, derivative=-150, saturation=True)))
    with pytest.raises(cx.InputError, match="saturation"):
        run(system)


def test_links_begin_at_rest_whatever_the_band_limit_leaves_of_the_motion_then():
    system = of(cx.Absorber(angle=0, mass=1e6, law=LAWS.Polynomial([1.0])))  # it yields to everything
    problem = dimensionless(system)
    structure = StructureSpectra(problem, LaplaceGrid(2e-2, 60), Modes.up_to(6))
    links = absorber_set(problem, system.absorber_list, 1)
    moved, _ = structure.motion_at(structure.points(links))
    assert abs(moved[:, 0]).max() > 1e-6 * abs(moved).max()
    found = march_interface(structure, links).laws
    assert found is not None
    assert_allclose(found.stretch[:, 1:], -moved[:, 1:], rtol=0, atol=1e-8 * abs(moved).max())
