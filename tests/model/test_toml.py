"""TOML and back without loss, for anything that can be described."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import coaxshell.model as cx
from coaxshell.model import materials, presets

positive = st.floats(min_value=1e-12, max_value=1e12)
angles = st.floats(min_value=-360, max_value=360)
names = st.text(max_size=8)
elastic = st.builds(
    cx.Elastic, name=names, density=positive, youngs_modulus=positive, poisson_ratio=st.floats(-0.99, 0.49), reference=names
)
piezoelectric = st.sampled_from([materials.PZT4, materials.PZT4_STANDARD, materials.PZT5A, materials.PZT5H])
thickness = st.floats(min_value=1e-6, max_value=0.01)
layers = st.tuples(
    st.builds(cx.Layer, piezoelectric, thickness, st.just("sensor")),
    st.builds(cx.Layer, elastic, thickness, st.sampled_from([None, "core", "passive"])),
    st.builds(cx.Layer, piezoelectric, thickness, st.sampled_from(["actuator", "passive"])),
)
fluid = st.builds(cx.Fluid, density=positive, sound_speed=positive, name=names)
pulse = st.one_of(
    st.builds(cx.Exponential, peak_pressure=positive, decay_time=positive),
    st.builds(cx.Step, pressure=positive.map(lambda p: -p), rise_time=st.floats(0, 1)),
    st.builds(cx.Gaussian, peak_pressure=positive, width=positive),
    st.lists(st.tuples(st.floats(0, 1e6), st.floats(-1e9, 1e9)), min_size=2, max_size=5, unique_by=lambda row: row[0]).map(
        lambda rows: cx.Sampled(time=tuple(sorted(t for t, _ in rows)), pressure=tuple(p for _, p in rows))
    ),
)
delay = st.floats(0, 1)
far = st.floats(min_value=3, max_value=1e6)
along = st.floats(min_value=-1e6, max_value=1e6)
inclination = st.floats(min_value=-89.999, max_value=89.999)
source = st.one_of(
    st.builds(cx.SphericalShock, distance=far, peak_pressure=positive, decay_time=positive, angle=angles, delay=delay, z=along),
    st.builds(cx.PlaneShock, peak_pressure=positive, decay_time=positive, angle=angles, inclination=inclination),
    st.builds(cx.LineShock, distance=far, peak_pressure=positive, decay_time=positive),
    st.builds(cx.SphericalWave, distance=far, pulse=pulse, z=along),
    st.builds(cx.PlaneWave, pulse=pulse, angle=angles, delay=delay, inclination=inclination),
    st.builds(cx.LineWave, distance=far, pulse=pulse),
    st.builds(cx.UnderwaterExplosion, charge_mass=positive, stand_off=far, z=along, explosive=st.sampled_from(sorted(cx.EXPLOSIVES))),
)
law = {"mass": positive, "damping": st.floats(0, 1e8), "linear_stiffness": st.floats(0, 1e12), "cubic_stiffness": st.floats(0, 1e22)}
absorbers = st.one_of(
    st.builds(cx.AbsorberRing, count=st.integers(0, 300), offset=angles, **law),
    st.lists(st.builds(cx.Absorber, angle=angles, **law), max_size=4).map(tuple),
)


@st.composite
def systems(draw: st.DrawFn) -> cx.System:
    radii = (draw(st.floats(0.2, 0.9)), draw(st.floats(1.0, 2.0)))
    shells = [cx.Shell(radius=radius, layers=draw(layers)) for radius in radii]
    absorbed = draw(absorbers)
    return cx.System(
        name=draw(names),
        shells=shells,
        fluids=[draw(st.one_of(st.just(cx.VACUUM), fluid)), draw(fluid), draw(fluid)],
        source=draw(st.one_of(source, st.lists(source, min_size=1, max_size=3).map(tuple))),
        absorbers=absorbed,
    )


@settings(deadline=None, max_examples=60)
@given(systems())
def test_round_trip_is_lossless(system: cx.System) -> None:
    again = cx.System.from_toml_string(system.to_toml_string())
    assert again == system
    assert again.canonical() == system.canonical()


def test_sources_in_the_plane_are_written_as_before_there_were_others() -> None:
    plane = cx.PlaneWave(pulse=cx.Step(pressure=1.0))
    for source in (
        presets.load("bare").source,
        plane,
        cx.SphericalWave(distance=5, pulse=cx.Sampled(time=(0.0, 1.0), pressure=(0.0, 1.0))),
    ):
        system = presets.load("bare").replace(source=source)
        for written in (system.to_toml_string(), repr(system.canonical())):
            assert "inclination" not in written
            assert "'z'" not in written
            assert "\nz =" not in written
        moved = system.with_overrides({"source.inclination": "0.5 rad"} if source is plane else {"source.z": "-70 cm"})
        assert moved.canonical() != system.canonical()
        assert cx.System.from_toml_string(moved.to_toml_string()) == moved != system


def test_every_preset_goes_through_a_file(tmp_path: Path) -> None:
    for name in presets.names():
        system = presets.load(name)
        path = system.to_toml(tmp_path / f"{name}.toml")
        assert cx.System.from_toml(path) == system


def test_rigid_shell_control_and_limits_go_through() -> None:
    base = presets.load("active")
    system = base.replace(
        shells=[cx.RigidShell(radius=0.3), base.shells[1]],
        control=cx.PDControl(proportional=-1.5, derivative=0.1, shells="outer", saturation=True, field_limit="1 kV/mm"),
    )
    again = cx.System.from_toml_string(system.to_toml_string())
    assert again == system
    assert again.control is not None
    assert again.control.field_limit == 1e6
    assert again.controlled_shells == (1,)


def test_two_materials_of_one_name_stay_two() -> None:
    soft = materials.ALUMINIUM.replace(youngs_modulus=60e9)
    system = presets.load("bare").with_overrides({"shells[1].layers[1].material": soft})
    again = cx.System.from_toml_string(system.to_toml_string())
    assert again == system
    assert [shell.layers[1].material.youngs_modulus for shell in again.shells] == [70e9, 60e9]


def test_a_file_may_define_a_material_over_the_library() -> None:
    text = presets.text("bare") + "\n[materials.aluminium]\ndensity = '2.8 g/cm^3'\nyoungs_modulus = '70 GPa'\npoisson_ratio = 0.33\n"
    core = cx.System.from_toml_string(text).shells[0].core.material
    assert (core.name, core.density) == ("aluminium", 2800.0)


def test_a_sampled_history_is_found_beside_the_file(tmp_path: Path) -> None:
    (tmp_path / "shock.csv").write_text("time (s); pressure (Pa)\n0; 1e5\n1e-3; 5e4\n2e-3; 0\n")
    head, _, _ = presets.text("iakovlev-evacuated").partition("[source]")
    (tmp_path / "case.toml").write_text(head + '[source]\ntype = "plane-wave"\npulse = { type = "sampled", file = "shock.csv" }\n')
    pulse = cx.System.from_toml(tmp_path / "case.toml").sources[0].pulse
    assert pulse == cx.Sampled(time=(0.0, 1e-3, 2e-3), pressure=(1e5, 5e4, 0.0))


def test_canonical_is_the_physics_and_nothing_else() -> None:
    hybrid = presets.load("hybrid")
    renamed = hybrid.replace(name="other", fluids=[cx.Fluid(density=1000, sound_speed=1400)] * 3)
    assert renamed != hybrid
    assert renamed.canonical() == hybrid.canonical()
    assert hybrid.replace(absorbers=hybrid.absorber_list).canonical() == hybrid.canonical()
    assert hybrid.replace_path("absorbers.offset", 1e-9).canonical() != hybrid.canonical()
    assert json.loads(json.dumps(hybrid.canonical())) == hybrid.canonical()


@pytest.mark.parametrize("name", presets.names())
def test_written_toml_is_short_enough_to_read(name: str) -> None:
    assert len(presets.load(name).to_toml_string().splitlines()) < 80
