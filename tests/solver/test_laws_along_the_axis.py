"""Line absorbers of any law in three dimensions, on thin and exact walls: two dimensions, rows of points, exact ones, balances, corners."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.solver.axial import solve as axial_solve
from coaxshell.solver.axial.line_laws import means_of, of_means
from coaxshell.solver.axial.sampling import AxialSampling

STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=210e9, poisson_ratio=0.3)
WATER = cx.Fluid(density=1000, sound_speed=1400)
SPHERE = cx.SphericalShock(distance=3.0, peak_pressure=25e3, decay_time=0.13e-3)
LINE = cx.LineShock(distance=3.0, peak_pressure=25e3, decay_time=0.13e-3, angle=20.0)
COMMON = {"mass": 20.0, "damping": 1e4, "linear_stiffness": 1e8}
MIXED = ("elastic", "thin")
STOP = cx.laws.Gap(clearance=2e-6, stiffness=1e9, restitution=0.6)
HELD = 1e9
SLIDER = cx.laws.Friction(force=300.0, stiffness=HELD)
BRANCH = cx.laws.Maxwell(stiffness=2e8, relaxation_time=1e-4)
DRY = cx.laws.Friction(force=300.0, static_force=400.0)
LAWS: list[dict[str, Any]] = [
    {"law": BRANCH, "links": "inner"},
    {"inertance": 5.0, "cubic_stiffness": 1e20},
    {"law": cx.laws.Sides(inner=STOP, outer=DRY)},
    {"law": cx.laws.Parallel(laws=(SLIDER, cx.laws.Bistable(k1=-1e8, k3=1e20, rest="outwards")))},
]


def system(theories: tuple[str, str], absorbers: Any, source: Any = SPHERE) -> cx.System:
    shells = [cx.Shell(radius=r, layers=[cx.Layer(STEEL, 0.02)], theory=t) for r, t in zip((0.9, 1.0), theories, strict=True)]
    return cx.System(shells=shells, fluids=[WATER] * 3, source=source, absorbers=absorbers)


def run(described: cx.System, **settings: Any) -> Any:
    return cx.simulate(described, **{"duration": 0.4, "time_step": 2e-2, "modes": 4, "dimensions": 3, **settings})


def off(found: Any, true: Any) -> float:
    found, true = np.asarray(found), np.asarray(true)
    return float(np.linalg.norm(found - true) / np.linalg.norm(true))


def every_law(**more: Any) -> list[cx.Absorber]:
    return [cx.Absorber(angle=5.0 + 15.0 * n, **COMMON, **one, **more) for n, one in enumerate(LAWS)]


@pytest.mark.parametrize(("theories", "count"), [(MIXED, 4), (("thin", "thin"), 1)], ids=["marched", "linear"])
def test_what_is_uniform_along_the_axis_is_two_dimensional(theories: tuple[str, str], count: int) -> None:
    described = system(theories, every_law(footprint=0.1)[:count], LINE)
    flat, space = run(described, dimensions=2), run(described, stations=[0.7])
    assert off(space.absorber_force(0.7), flat.absorber_force()) < 1e-10
    assert off(space.absorber_displacement(0.7), flat.absorber_displacement()) < 1e-10
    assert off(space.stress("inner", station=0.7), flat.stress("inner")) < 1e-10


@pytest.mark.parametrize("links", ["inner", "outer"])
def test_on_one_shell_and_between_a_shell_and_a_core(links: str) -> None:
    hung = cx.Absorber(angle=40.0, links=links, law=SLIDER, **COMMON)
    alone = cx.System(shells=[cx.Shell(radius=1.0, layers=[cx.Layer(STEEL, 0.02)])], fluids=[WATER] * 2, source=LINE, absorbers=[hung])
    core = cx.System(
        shells=[cx.RigidShell(radius=0.9), *alone.shells],
        fluids=[WATER] * 3,
        source=LINE,
        absorbers=[hung.model_copy(update={"links": "both"})],
    )
    for described in (alone, core):
        flat, space = run(described, dimensions=2), run(described)
        assert off(space.absorber_force(0.0), flat.absorber_force()) < 1e-10
        assert off(space.displacement("outer", 40, station=0.0), flat.displacement("outer", 40)) < 1e-10


def law_of(share: float) -> cx.laws.Sides:
    """Return a law of a line on so many metres of it."""
    stop = STOP.model_copy(update={"stiffness": share * STOP.stiffness})
    slider = SLIDER.model_copy(update={"force": share * SLIDER.force, "stiffness": share * HELD})
    branch = BRANCH.model_copy(update={"stiffness": share * BRANCH.stiffness})
    table = cx.laws.Table(stretch=(-1e-3, 0.0, 1e-3), force=(-5e4 * share, 0.0, 2e5 * share))
    return cx.laws.Sides(inner=cx.laws.Parallel(laws=(stop, slider)), outer=cx.laws.Parallel(laws=(branch, table)))


def test_a_row_of_points_where_forces_are_taken_is_a_line(monkeypatch: pytest.MonkeyPatch) -> None:
    # the law of a line is asked at 14 places of a period where 3 waves count: as many points there, whose masses rest, do the same
    period, waves, narrow = 2.4, 3, 1e-9
    sampling, spacing = AxialSampling(period, 4, 2 * np.pi * waves / period), period / 14
    monkeypatch.setattr(axial_solve, "require_room", lambda *_, **__: None)
    monkeypatch.setattr(axial_solve, "resolved_sampling", lambda *_: (sampling, []))
    links = {"mass": 1e9, "damping": 1e4, "linear_stiffness": 1e8}
    each = {name: value * spacing for name, value in links.items()}
    lines = [cx.Absorber(angle=10, law=law_of(1.0), footprint=narrow, **links)]
    points = [cx.PointAbsorber(angle=10, z=n * spacing, footprint=narrow, law=law_of(spacing), **each) for n in range(-6, 8)]
    line, row, bare = (run(system(MIXED, absorbers), stations=[0.0, 0.3]) for absorbers in (lines, points, ()))
    for shell in ("inner", "outer"):
        assert off(row.stress(shell), line.stress(shell)) < 1e-8
    assert off(bare.stress("inner"), line.stress("inner")) > 1e-3


def test_a_law_that_is_linear_tends_to_the_exact_answer_at_second_order() -> None:
    errors = []
    for step in (2e-2, 1e-2):
        exact, marched = (
            run(system(MIXED, [cx.Absorber(angle=10, law=law, **COMMON)]), duration=0.3, time_step=step, stations=[0.0, 0.5], modes=2)
            for law in (cx.laws.Linear(stiffness=1e9), cx.laws.Polynomial(coefficients=(1e9,)))
        )
        errors.append(off(marched.absorber_displacement(), exact.absorber_displacement()))
        told = marched.errors().sel(cause="march", quantity="stress").to_numpy()
        assert off(marched.stress("inner"), exact.stress("inner")) < 5 * told.max()
    assert errors[0] < 2e-2
    assert errors[1] < errors[0] / 3


def test_the_energy_closes_and_a_loaded_run_knows_the_forces(tmp_path: Any) -> None:
    found = run(system(MIXED, every_law()[2:]), stations=[0.0, 0.4], modes=2)
    balance = found.energy(every=5)
    assert float(np.abs(balance.closure_relative).max()) < 2e-4  # half of it at half the step
    assert float(balance.law_dissipation[-1]) > 1e-3 * float(balance.exterior_work.max())
    again = cx.load_response(found.save(tmp_path / "run.nc"))
    there, here = (one.pressure(x=[0.95], y=[0.0], z=0.1, time=[0.3]) for one in (again, found))
    np.testing.assert_allclose(there, here, rtol=1e-9)


def test_the_energy_of_linear_links_that_differ_closes() -> None:
    balance = run(system(("thin", "thin"), every_law()[:1]), modes=3).energy(every=5)
    assert float(np.abs(balance.closure_relative).max()) < 1e-4
    assert float(balance.law_dissipation[-1]) > 0.0


def test_steps_too_long_for_a_law_are_told() -> None:
    stiff = cx.Absorber(angle=0, law=cx.laws.Gap(clearance=0.0, stiffness=1e12), **COMMON)
    found = run(system(("thin", "thin"), [stiff]), modes=2)
    assert any("on the stiffest law of a link something swings by" in told for told in found.warnings)


def test_means_over_steps_have_one_way_back() -> None:
    moved = np.concatenate([[0.0], np.random.default_rng(1).normal(size=9)])
    means, velocity = means_of(moved, 0.1)
    np.testing.assert_allclose(of_means(means), moved, atol=1e-14)
    np.testing.assert_allclose(np.cumsum(velocity) * 0.1, moved, atol=1e-14)
