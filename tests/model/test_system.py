"""What a description tells of itself."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import coaxshell.model as cx
from coaxshell.model import fluids, materials, presets
from coaxshell.model.absorbers import gaps_of


def test_radii_and_core_of_a_wall() -> None:
    shell = presets.load("bare").shells[1]
    assert isinstance(shell, cx.Shell)
    assert shell.thickness == pytest.approx(0.012, rel=1e-15)
    assert (shell.inner_radius, shell.outer_radius) == pytest.approx((0.994, 1.006), rel=1e-15)
    assert shell.core.material == materials.ALUMINIUM
    assert shell.sensor is shell.layers[0]
    assert shell.actuator is shell.layers[2]


def test_core_without_a_core_layer() -> None:
    thin, thick = cx.Layer("brass", 0.001, "passive"), cx.Layer("copper", 0.002, "passive")
    ceramic = cx.Layer(materials.PZT5A, 0.01, "passive")
    assert cx.Shell(radius=1, layers=(thin, thick, ceramic)).core is thick
    assert cx.Shell(radius=1, layers=(ceramic,)).core is ceramic


def test_library_names_lead_to_their_materials_and_each_has_a_source() -> None:
    for name in materials.names():
        material = materials.get(name.upper().replace("-", " "))
        assert material.name.lower() == name
        assert len(material.reference) > 10
    for name in fluids.names():
        assert fluids.get(name) is fluids.get(name.upper())
        assert fluids.REFERENCES[name]


def test_paper_pzt4_against_the_standard_one() -> None:
    printed, standard = materials.PZT4, materials.PZT4_STANDARD
    assert (printed.permittivity_reduction, printed.actuator_coupling) == ("printed", "printed")
    assert (standard.permittivity_reduction, standard.actuator_coupling) == ("standard", "plane-stress")
    same = {"name", "reference", "permittivity_reduction", "actuator_coupling"}
    assert printed.model_dump(exclude=same) == standard.model_dump(exclude=same)


@given(st.integers(1, 300), st.floats(-360, 360))
def test_a_ring_is_evenly_spaced(count: int, offset: float) -> None:
    ring = cx.absorber_ring(count, mass=1.0, damping=2.0, offset=offset, inner_shell=3)
    assert len(ring) == len(ring.absorbers) == count
    assert ring.absorbers[0].angle == pytest.approx(offset % 360 if offset == 360 else offset, abs=1e-9)
    for k, absorber in enumerate(ring.absorbers):
        turn = (absorber.angle - offset - 360.0 * k / count) / 360.0
        assert turn == pytest.approx(round(turn), abs=1e-9)
        assert (absorber.mass, absorber.damping, absorber.inner_shell) == (1.0, 2.0, 3)


def test_a_changed_copy_of_a_ring_writes_its_own_absorbers_out() -> None:
    ring = cx.absorber_ring(3, mass=1.0)
    assert [absorber.mass for absorber in ring.absorbers] == [1.0] * 3
    for changed in (ring.replace(mass=9.0), ring.model_copy(update={"mass": 9.0})):
        assert [absorber.mass for absorber in changed.absorbers] == [9.0] * 3


def test_rings_of_several_gaps_are_written_out() -> None:
    base = presets.load("bare")
    middle = base.shells[0].replace(radius=0.75)
    rings = [cx.absorber_ring(3, mass=1.0, damping=1.0), cx.absorber_ring(2, mass=2.0, damping=1.0, inner_shell=1)]
    system = cx.System(
        shells=[base.shells[0], middle, base.shells[1]],
        fluids=["water-1400"] * 4,
        source=base.source,
        absorbers=rings,  # type: ignore[arg-type]
    )
    assert [absorber.inner_shell for absorber in system.absorber_list] == [0, 0, 0, 1, 1]


def test_gaps_of_an_absorber_are_those_that_it_is_in() -> None:
    made = {"mass": 1.0, "linear_stiffness": 1.0, "inner_shell": 1, "outer_shell": 4}
    gaps = [
        gaps_of(cx.Absorber(**made, **more)) for more in ({}, {"links": "inner"}, {"links": "outer"}, {"links": "outer", "grounded": True})
    ]
    assert [list(one) for one in gaps] == [[1, 2, 3], [1], [3], [1, 2, 3]]
    assert list(gaps_of(cx.absorber_ring(2, mass=1.0, damping=1.0, inner_shell=2))) == [2]


def test_an_empty_ring_fits_any_system() -> None:
    ring = cx.absorber_ring(0, mass=1.0)
    assert presets.load("iakovlev-filled").replace(absorbers=ring).absorber_list == ()


@pytest.mark.parametrize(("shell", "number"), [("inner", 0), ("outer", 1), (0, 0), (1, 1), ("1", 1)])
def test_shell_index(shell: int | str, number: int) -> None:
    assert presets.load("bare").shell_index(shell) == number


def test_distance_of_every_kind_of_source() -> None:
    step = cx.Step(pressure=1.0)
    system = presets.load("bare").replace(
        source=[
            cx.SphericalWave(distance=5, pulse=step),
            cx.PlaneWave(pulse=step),
            cx.LineWave(distance=4, pulse=step),
            cx.UnderwaterExplosion(charge_mass=1, stand_off=3),
        ]
    )
    assert system.source_distances == (5.0, None, 4.0, 4.0)
    assert [source.geometry for source in system.sources] == ["spherical", "plane", "line", "spherical"]


def test_similitude_of_tnt_agrees_with_the_imperial_form_of_cole() -> None:
    """Cole: 21600 psi (W^(1/3)/S)^1.13 and 0.058 ms W^(1/3) (W^(1/3)/S)^-0.22, W in lb and S in ft."""
    mass, stand_off = 12.0, 9.0
    scale = (mass / 0.45359237) ** (1 / 3)
    ratio = scale / (stand_off / 0.3048)
    charge = cx.UnderwaterExplosion(charge_mass=mass, stand_off=stand_off, explosive="TNT-Cole")
    assert charge.peak_pressure == pytest.approx(21600 * 6894.757 * ratio**1.13, rel=2e-3)
    assert charge.decay_time == pytest.approx(0.058e-3 * scale * ratio**-0.22, rel=2e-3)
    assert charge.pulse == cx.Exponential(peak_pressure=charge.peak_pressure, decay_time=charge.decay_time)


def test_similitude_scales_with_the_cube_root_of_mass() -> None:
    for explosive in cx.EXPLOSIVES:
        small = cx.UnderwaterExplosion(charge_mass=1, stand_off=2, explosive=explosive)
        large = cx.UnderwaterExplosion(charge_mass=8, stand_off=4, explosive=explosive)
        assert large.peak_pressure == pytest.approx(small.peak_pressure, rel=1e-14)
        assert large.decay_time == pytest.approx(2 * small.decay_time, rel=1e-14)
    assert cx.UnderwaterExplosion(charge_mass=1, stand_off=2).within_fit
    assert not cx.UnderwaterExplosion(charge_mass=1, stand_off=200).within_fit


def test_shock_factors_of_a_charge() -> None:
    """One pound at one foot is a hull shock factor of 1 lb^(1/2)/ft; straight below the keel feels all of it, abeam half, above none."""
    pound = cx.UnderwaterExplosion(charge_mass=0.45359237, stand_off=0.3048)
    assert 0.4526 * pound.hull_shock_factor == pytest.approx(1.0, rel=1e-4)
    shares = {90.0: 0.0, 0.0: 0.5, 180.0: 0.5, -90.0: 1.0, -30.0: 0.75}
    for angle, share in shares.items():
        assert pound.replace(angle=angle).keel_shock_factor() == pytest.approx(share * pound.hull_shock_factor, abs=1e-15)
    assert pound.keel_shock_factor(up=180.0) == pound.hull_shock_factor


def test_sampled_history_reads_what_people_write(tmp_path: Path) -> None:
    expected = cx.Sampled(time=(0.0, 1e-3), pressure=(1.0, -2.0))
    for number, text in enumerate(
        ["t,p\n0,1\n1e-3,-2", "\ufeff0;1\n0.001;-2\n", "# s Pa\n0 1\n\n1e-3\t-2\n", '"time","pressure"\r\n"0","1"\r\n"1e-3","-2"\r\n']
    ):
        path = tmp_path / f"{number}.csv"
        path.write_text(text, encoding="utf-8")
        assert cx.Sampled.from_csv(path) == expected


def test_a_system_can_be_copied_hashed_and_sent_to_a_process() -> None:
    system = presets.load("hybrid")
    assert pickle.loads(pickle.dumps(system)) == system
    assert copy.deepcopy(system) == system
    assert hash(cx.System.from_toml_string(system.to_toml_string())) == hash(system)


def test_the_schema_tells_units_limits_and_examples() -> None:
    schema = cx.System.model_json_schema()
    thickness = schema["$defs"]["Layer"]["properties"]["thickness"]
    assert (thickness["unit"], thickness["exclusiveMinimum"], thickness["examples"]) == ("m", 0, ["6 mm"])
    assert thickness["description"].startswith("Thickness")
