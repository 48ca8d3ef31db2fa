"""The presets hold the paper's numbers."""

from __future__ import annotations

import math

import pytest

import coaxshell.model as cx
from coaxshell.model import presets


def total_mass(system: cx.System) -> float:
    """Mass of the shells per metre of length, sum of rho t 2 pi R."""
    shells = [shell for shell in system.shells if isinstance(shell, cx.Shell)]
    return sum(2 * math.pi * shell.radius * layer.thickness * layer.material.density for shell in shells for layer in shell.layers)


def test_names() -> None:
    assert presets.names() == (
        "bare",
        "absorbers",
        "active",
        "hybrid",
        "electrodes",
        "electrodes-hybrid",
        "iakovlev-evacuated",
        "iakovlev-filled",
        "iakovlev-double",
        "steel-tube",
        "coated",
    )


@pytest.mark.parametrize("name", ["bare", "absorbers", "active", "hybrid"])
def test_table_1(name: str) -> None:
    system = presets.load(name)
    assert system.name == name
    assert total_mass(system) == pytest.approx(576.8, abs=0.05)  # theory.md, section 2
    assert [shell.radius for shell in system.shells] == [0.5, 1.0]
    assert [[layer.role for layer in shell.layers] for shell in system.shells if isinstance(shell, cx.Shell)] == [
        ["sensor", "core", "actuator"]
    ] * 2
    assert (system.exterior.density, system.exterior.sound_speed) == (1000.0, 1400.0)
    (source,) = system.sources
    assert isinstance(source, cx.SphericalShock)
    assert (source.distance, source.peak_pressure, source.decay_time) == (5.0, 2.5e4, 1.314e-4)
    assert (len(system.absorber_list) == 25) is (name in ("absorbers", "hybrid"))
    assert (system.control is not None) is (name in ("active", "hybrid"))


def test_control_by_electrodes_is_on_both_faces_of_the_same_shells() -> None:
    for name, plain in (("electrodes", "bare"), ("electrodes-hybrid", "absorbers")):
        system = presets.load(name)
        assert system.control == cx.PDControl(proportional=0, derivative=2, transducers="electrodes")
        roles = {f"shells[{i}].layers[{j}].role": role for i in (0, 1) for j, role in ((0, "sensor"), (2, "actuator"))}
        other = system.with_overrides({**roles, "control": None})
        assert other.canonical() == presets.load(plain).canonical()


def test_coated_is_the_bare_shells_with_rubber_on_the_inner_one() -> None:
    coated, bare = presets.load("coated"), presets.load("bare")
    for number, (shell, plain) in enumerate(zip(coated.shells, bare.shells, strict=True)):
        assert isinstance(shell, cx.Shell)
        assert isinstance(plain, cx.Shell)
        assert shell.theory == "elastic"
        assert shell.inner_radius == pytest.approx(plain.inner_radius)
        layers = [(layer.thickness, layer.role, layer.material.density) for layer in shell.layers]
        assert layers[:3] == [(layer.thickness, layer.role, layer.material.density) for layer in plain.layers]
        assert layers[3:] == ([(0.03, "passive", 1240.0)] if number == 0 else [])
    assert coated.replace(shells=bare.shells, name="bare").canonical() == bare.canonical()
    rubber = coated.shells[0].layers[3].material  # type: ignore[union-attr]
    assert isinstance(rubber, cx.Viscoelastic)
    assert rubber.long_term_modulus / (3.0 * (1.0 - 2.0 * rubber.poisson_ratio)) == pytest.approx(2e9, rel=0.05)
    low, high = cx.materials.RUBBERS["neoprene"].youngs_modulus
    assert low <= rubber.long_term_modulus <= high


def test_hybrid_is_the_example_of_the_interface() -> None:
    aluminium = cx.Elastic(name="aluminium", density=2700, youngs_modulus=70e9, poisson_ratio=0.33)
    pzt4 = cx.materials.PZT4
    water = cx.Fluid(density=1000, sound_speed=1400)
    layers = [cx.Layer(pzt4, 3e-3, role="sensor"), cx.Layer(aluminium, 6e-3), cx.Layer(pzt4, 3e-3, role="actuator")]
    system = cx.System(
        shells=[cx.Shell(radius=0.5, layers=layers), cx.Shell(radius=1.0, layers=layers)],  # type: ignore[arg-type]
        fluids=[water, water, water],
        source=cx.SphericalShock(distance=5.0, peak_pressure=2.5e4, decay_time=1.314e-4),
        absorbers=cx.absorber_ring(25, mass=10, damping=1e6, linear_stiffness=1e9, cubic_stiffness=1e20),
        control=cx.PDControl(proportional=-2e4, derivative=-150),
    )
    assert system.canonical() == presets.load("hybrid").canonical()


def test_presets_differ_only_where_they_say() -> None:
    hybrid = presets.load("hybrid")
    assert hybrid.replace(control=None).canonical() == presets.load("absorbers").canonical()
    assert hybrid.replace(absorbers=None).canonical() == presets.load("active").canonical()
    assert hybrid.replace(absorbers=None, control=None).canonical() == presets.load("bare").canonical()


@pytest.mark.parametrize(
    ("name", "density", "modulus", "speed", "peak", "decay", "geometry"),
    [
        ("iakovlev-evacuated", 7800.0, 177.45e9, 1400.0, 250e3, 1.314e-4, "plane"),
        ("iakovlev-filled", 7900.0, 241e9, 1470.0, 25e3, 3.76e-3, "spherical"),
        ("iakovlev-double", 7800.0, 177.45e9, 1400.0, 250e3, 1.314e-4, "plane"),
    ],
)
def test_verification_cases(name: str, density: float, modulus: float, speed: float, peak: float, decay: float, geometry: str) -> None:
    system = presets.load(name)
    for shell in system.shells:
        assert isinstance(shell, cx.Shell)
        steel = shell.core.material
        assert isinstance(steel, cx.Elastic)
        assert (steel.density, steel.youngs_modulus, steel.poisson_ratio, shell.thickness) == (density, modulus, 0.3, 0.01)
    assert system.exterior.sound_speed == speed
    assert (system.fluids[0] == cx.VACUUM) is (name != "iakovlev-filled")
    (source,) = system.sources
    assert source.geometry == geometry
    assert source.pulse == cx.Exponential(peak_pressure=peak, decay_time=decay)


def test_case_and_punctuation_of_a_name_do_not_matter() -> None:
    assert presets.load("Iakovlev Double") == presets.load("iakovlev-double")
