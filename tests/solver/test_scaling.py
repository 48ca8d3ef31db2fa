"""The same dimensionless problem in other units has the same dimensionless answer."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.numerics.modes import Modes
from coaxshell.solver.scaling import dimensionless

LAYUP = [
    cx.Layer(cx.materials.ALUMINIUM, 5e-3),
    cx.Layer(cx.materials.STRUCTURAL_STEEL, 2e-3),
]
FLUIDS = [cx.Fluid(density=900, sound_speed=1300), cx.Fluid(density=1100, sound_speed=1600), cx.Fluid(density=1000, sound_speed=1400)]


def system(length: float = 1.0, density: float = 1.0, speed: float = 1.0, kind: str = "spherical") -> cx.System:
    """Return two unlike shells in unlike fluids with every length, density and speed multiplied (pressures: density speed^2)."""
    pressure = density * speed**2

    def scaled(layer: cx.Layer) -> cx.Layer:
        material = layer.material.replace(density=layer.material.density * density, youngs_modulus=layer.material.youngs_modulus * pressure)
        return layer.replace(material=material, thickness=layer.thickness * length)

    pulse = {"peak_pressure": 2e4 * pressure, "decay_time": 1.5e-4 * length / speed}
    source = (
        cx.PlaneShock(**pulse)
        if kind == "plane"
        else {"spherical": cx.SphericalShock, "line": cx.LineShock}[kind](distance=3 * length, **pulse)
    )
    return cx.System(
        shells=[cx.Shell(radius=r * length, layers=[scaled(layer) for layer in LAYUP]) for r in (0.4, 0.9)],
        fluids=[fluid.replace(density=fluid.density * density, sound_speed=fluid.sound_speed * speed) for fluid in FLUIDS],
        source=source,
    )


@pytest.mark.parametrize("kind", ["spherical", "plane", "line"])
@pytest.mark.parametrize(("length", "density", "speed"), [(1e-3, 1.0, 1.0), (1.0, 7.3, 1.0), (1.0, 1.0, 3.281), (25.4, 0.1, 1e-2)])
def test_units_do_not_matter(kind: str, length: float, density: float, speed: float) -> None:
    settings = {"duration": 1.0, "time_step": 5e-3, "modes": 20}
    here = cx.simulate(system(kind=kind), **settings)
    there = cx.simulate(system(length, density, speed, kind), **settings)
    for name in ("normal", "tangential"):
        expected = getattr(here.solution, name)
        np.testing.assert_allclose(getattr(there.solution, name), expected, rtol=0, atol=1e-11 * abs(expected).max())
    scale = density * speed**2
    stress = np.asarray(here.stress("inner")) * scale
    np.testing.assert_allclose(np.asarray(there.stress("inner")), stress, rtol=0, atol=1e-11 * abs(stress).max())
    np.testing.assert_allclose(there.time_seconds, here.time_seconds * length / speed, rtol=1e-13)


def test_the_paper_in_its_own_units() -> None:
    problem = dimensionless(cx.presets.load("bare"))
    np.testing.assert_allclose(problem.scales.time, 1 / 1400, rtol=1e-14)
    np.testing.assert_allclose(problem.scales.pressure, 1.96e9, rtol=1e-14)
    assert [shell.radius for shell in problem.shells] == [0.5, 1.0]
    np.testing.assert_allclose([shell.mass for shell in problem.shells], 0.0612, rtol=1e-12)
    stiffness = problem.shells[1].stiffness(Modes(np.array([0.0])))
    np.testing.assert_allclose(stiffness.ww, 9.852e8 / 1.96e9, rtol=1e-4)


def test_fluids_and_thicknesses_by_hand() -> None:
    problem = dimensionless(system())
    assert [fluid.slowness for fluid in problem.fluids] == [1400 / 1300, 1400 / 1600, 1.0]
    assert [fluid.density for fluid in problem.fluids] == [0.9, 1.1, 1.0]
    aluminium, steel = (layer.material.density for layer in LAYUP)
    np.testing.assert_allclose([shell.mass for shell in problem.shells], (5e-3 * aluminium + 2e-3 * steel) / (1000 * 0.9), rtol=1e-14)
    np.testing.assert_allclose(problem.scales.time, 0.9 / 1400, rtol=1e-14)
