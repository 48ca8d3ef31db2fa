"""Gradients of what a run computes, against differences of runs: transposes, the march backwards, nodes, walls and sources."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.studies.gradients.sensitivity import MetricSensitivity
from coaxshell.studies.metrics import metrics_of
from coaxshell.studies.varied_fields import field_of, varied

SETTINGS = {"duration": 1.0, "time_step": 0.02, "modes": 8}
NAMES = ("angle", "mass", "damping", "linear_stiffness", "cubic_stiffness")
BASE = cx.presets.load("hybrid").replace(absorbers=())


def layout(*, cubic=1e22, mass=12.0):
    """Three unequal absorbers without symmetry, whose springs bend."""
    rows = [(10.0, 8.0, 5e5, 1e9, cubic), (130.0, mass, 2e6, 5e8, 2 * cubic), (245.0, 5.0, 1e6, 2e9, 0.5 * cubic)]
    return tuple(cx.Absorber(**dict(zip(NAMES, row, strict=True))) for row in rows)


def sensitivity(system, metric="inner.rms_stress", power=16.0, **settings):
    return MetricSensitivity(system, metrics_of([metric], system)[0], power, cx.simulate(system, **{**SETTINGS, **settings}))


def difference(system, changes, metric="inner.rms_stress", power=16.0, **settings):
    """Return the derivative along a change of some fields, by central differences extrapolated to sixth order."""

    def slope(part):
        ends = [varied(system, {path: at + sign * part * step for path, (at, step) in changes.items()}) for sign in (1, -1)]
        values = [sensitivity(end, metric, power, **settings).value for end in ends]
        return (values[0] - values[1]) / (2 * part)

    first, second, third = (slope(part) for part in (1.0, 0.5, 0.25))
    once, twice = (4 * second - first) / 3, (4 * third - second) / 3
    return (16 * twice - once) / 15


def fields(system, name, step):
    return {f"absorbers[{i}].{name}": (getattr(one, name), step(one)) for i, one in enumerate(system.absorbers)}


def along(found, changes):
    return sum(step * found.of(path) for path, (_, step) in changes.items())


@pytest.mark.parametrize("steps", [60, 61])
def test_transposed_transforms(steps):
    grid = LaplaceGrid(0.05, steps)
    rng = np.random.default_rng(0)
    spectrum = rng.normal(size=grid.nodes.size) + 1j * rng.normal(size=grid.nodes.size)
    history, other = rng.normal(size=(2, grid.time.size))
    assert_allclose((grid.invert_transposed(history) @ spectrum).real, history @ grid.invert(spectrum), rtol=1e-12)
    assert_allclose(grid.transform_linear_transposed(spectrum) @ other, (spectrum @ grid.transform_linear(other)).real, rtol=1e-12)


@pytest.mark.parametrize("name", NAMES)
def test_absorbers_that_are_marched(name):
    system = BASE.replace(absorbers=layout())
    changes = fields(system, name, lambda one: 0.2 if name == "angle" else 0.02 * getattr(one, name))
    assert_allclose(along(sensitivity(system), changes), difference(system, changes), rtol=1e-7)


def test_each_absorber_has_its_own_gradient():
    system = BASE.replace(absorbers=layout())
    changes = {"absorbers[1].mass": (12.0, 0.2)}
    assert_allclose(along(sensitivity(system), changes), difference(system, changes), rtol=1e-7)


def test_massless_absorbers_and_refinement():
    system = BASE.replace(absorbers=layout(mass=0.0))
    changes = fields(system, "linear_stiffness", lambda one: 0.02 * one.linear_stiffness) | {"absorbers[0].mass": (8.0, 0.2)}
    assert_allclose(along(sensitivity(system, refinement=2), changes), difference(system, changes, refinement=2), rtol=1e-7)


def test_absorbers_that_are_solved_at_each_node():
    system = BASE.replace(absorbers=layout(cubic=0.0))
    found = sensitivity(system)
    steps = {"angle": lambda one: 0.1, "mass": lambda one: 0.1, "damping": lambda one: 1e4, "linear_stiffness": lambda one: 1e7}
    changes = {path: pair for name, step in steps.items() for path, pair in fields(system, name, step).items()}
    assert_allclose(along(found, changes), difference(system, changes), rtol=1e-7)
    with pytest.raises(cx.InputError, match=r"absorbers\[0\].cubic_stiffness: .*linear"):
        found.of("absorbers[0].cubic_stiffness")


@pytest.mark.parametrize("cubic", [0.0, 1e22])
def test_mirror_images_that_are_carried_once(cubic):
    ring = [cx.Absorber(angle=a, mass=8, damping=1e6, linear_stiffness=1e9, cubic_stiffness=cubic) for a in (0, 120, 240)]
    system = BASE.replace(absorbers=ring)
    found = sensitivity(system)
    assert found.of("absorbers[0].angle") == 0.0
    changes = {"absorbers[1].angle": (120.0, 0.2), "absorbers[2].angle": (240.0, -0.1), "absorbers[2].mass": (8.0, 0.1)}
    assert_allclose(along(found, changes), difference(system, changes), rtol=1e-6)


LAWS = (
    cx.laws.Polynomial(coefficients=(1e9, 1e16, 1e23)),
    cx.laws.Parallel(
        laws=(cx.laws.Gap(clearance=1e-7, stiffness=5e9, restitution=0.6), cx.laws.Maxwell(stiffness=2e9, relaxation_time=1e-4))
    ),
    cx.laws.Sides(
        inner=cx.laws.Friction(force=500.0, speed=0.02), outer=cx.laws.Table(stretch=(-1.0, 0.0, 2e-7, 1.0), force=(-1e9, 0.0, 50.0, 2e9))
    ),
    cx.laws.Parallel(laws=(cx.laws.Friction(force=50.0, stiffness=1e9), cx.laws.Bistable(k1=-1e8, k3=1e20, rest="outwards"))),
)
OF_LAWS = {
    "absorbers[0].law.coefficients[1]": 0.01,
    "absorbers[1].law.laws[0].stiffness": 0.001,
    "absorbers[1].law.laws[0].clearance": 1e-4,
    "absorbers[1].law.laws[0].restitution": 0.001,
    "absorbers[1].law.laws[1].relaxation_time": 0.01,
    "absorbers[2].law.inner.speed": 0.01,
    "absorbers[2].law.outer.force[2]": 0.001,
    "absorbers[3].law.laws[0].force": 1e-4,
    "absorbers[3].law.laws[1].k3": 0.01,
    "absorbers[0].inertance": 0.01,
    "absorbers[1].damping": 0.01,
    "absorbers[2].footprint": 0.01,
    "absorbers[3].mass": 0.01,
    "absorbers[1].angle": 0.001,
    "shells[0].radius": 1e-5,
}


def of_laws(laws=LAWS):
    """Absorbers of unlike laws at unlike angles, one on a shell alone."""
    common = {"mass": 8.0, "damping": 1e6, "linear_stiffness": 1e9, "footprint": 0.05, "inertance": 1.0}
    sides = ("both", "both", "both", "outer")
    return BASE.replace(
        absorbers=[cx.Absorber(angle=a, law=law, links=on, **common) for a, law, on in zip((10, 130, 200, 245), laws, sides, strict=True)]
    )


def relative(system, names):
    found = {path: field_of(system, path).present for path in names}
    return {path: (at, names[path] * abs(at)) for path, at in found.items()}


def test_laws_of_absorbers_that_are_marched():
    system, settings = of_laws(), {"duration": 0.7, "modes": 6}
    changes = relative(system, OF_LAWS)
    assert_allclose(along(sensitivity(system, **settings), changes), difference(system, changes, **settings), rtol=1e-6)
    sticking = of_laws((cx.laws.Friction(force=500.0), *LAWS[1:]))
    with pytest.raises(cx.InputError, match=r"absorbers.law: exact dry friction .* no gradient; give it a speed"):
        sensitivity(sticking, **settings).of("absorbers[0].mass")


def test_laws_of_absorbers_that_are_solved_at_each_node():
    maxwell = cx.laws.Maxwell(stiffness=2e9, relaxation_time=1e-4)
    system = of_laws((maxwell, cx.laws.Linear(stiffness=1e9, damping=1e5), cx.laws.Sides(outer=maxwell), None))
    wanted = ("[0].law.relaxation_time", "[1].law.damping", "[2].law.outer.stiffness", "[0].inertance", "[3].mass", "[2].footprint")
    changes = relative(system, {f"absorbers{path}": 0.01 for path in wanted})
    assert_allclose(along(sensitivity(system), changes), difference(system, changes), rtol=1e-7)


def test_stresses_of_walls_with_losses():
    """The stress is g(s) of the motion: backwards g is its conjugate, and g itself moves with the loss factor."""
    lossy = {f"shells[0].layers[1].material.{name}": value for name, value in (("loss_factor", 0.03), ("reference_frequency", 1000.0))}
    system = BASE.replace(absorbers=layout()).with_overrides(lossy)
    wanted = {"shells[0].layers[1].material.loss_factor": 0.01, "absorbers[0].mass": 0.01, "shells[0].layers[1].thickness": 1e-3}
    changes, settings = relative(system, wanted), {"duration": 0.8, "modes": 6}
    assert_allclose(along(sensitivity(system, **settings), changes), difference(system, changes, **settings), rtol=1e-7)


@pytest.mark.parametrize("cubic", [None, 0.0, 1e22])
def test_walls_fluids_gains_and_sources(cubic):
    system = BASE if cubic is None else BASE.replace(absorbers=layout(cubic=cubic))
    thickness = system.shells[0].layers[1].thickness
    changes = {
        "control.derivative": (system.control.derivative, 0.02 * system.control.derivative),
        "control.proportional": (system.control.proportional, 0.02 * system.control.proportional),
        "shells[0].layers[1].thickness": (thickness, 0.002 * thickness),
        "shells[1].radius": (system.shells[1].radius, 1e-4),
        "fluids[1].sound_speed": (system.fluids[1].sound_speed, 0.5),
        "source.distance": (system.sources[0].distance, 0.02),
    }
    assert_allclose(along(sensitivity(system), changes), difference(system, changes), rtol=1e-7)


@pytest.mark.slow_for("1e+22")
@pytest.mark.parametrize("cubic", [0.0, 1e22])
def test_reflections_of_surface_and_bottom(cubic):
    """Images that are turned over and images of images that are not, up to three rounds; the sines take part."""
    system = BASE.replace(absorbers=layout(cubic=cubic), control=None, sea=cx.Sea(depth=1.3, bottom=2.9))
    steps = {
        "sea.depth": 1e-3,
        "shells[1].radius": 1e-4,
        "source.distance": 1e-3,
        "fluids[2].sound_speed": 1e-4,
        "absorbers[0].angle": 0.01,
    }
    changes, settings = relative(system, steps | {"absorbers[1].damping": 0.01}), {"duration": 1.4, "time_step": 0.035, "modes": 3}
    assert_allclose(along(sensitivity(system, **settings), changes), difference(system, changes, **settings), rtol=1e-7)


def test_orders_that_the_step_does_not_resolve():
    system = BASE.replace(absorbers=layout())
    wall = system.shells[0]
    changes = {"shells[0].radius": (wall.radius, 1e-4), "shells[0].layers[0].thickness": (wall.layers[0].thickness, 1e-6)}
    settings = {"modes": 20, "time_step": 0.05}
    assert_allclose(along(sensitivity(system, **settings), changes), difference(system, changes, **settings), rtol=1e-6)


@pytest.mark.parametrize(
    "metric", ["inner.peak_stress", "outer.peak_displacement_tail", "outer.actuator_field_ratio", "inner.segment_actuator_field"]
)
def test_peaks_and_voltages(metric):
    system = BASE.replace(absorbers=layout())
    changes = fields(system, "mass", lambda one: 0.2) | {"control.derivative": (system.control.derivative, 0.1)}
    changes["shells[0].layers[1].thickness"] = (system.shells[0].layers[1].thickness, 1e-6)
    assert_allclose(along(sensitivity(system, metric), changes), difference(system, changes, metric), rtol=1e-6)
