"""Fields changed by dotted path."""

from __future__ import annotations

from typing import Any

import pytest

import coaxshell.model as cx
from coaxshell.model import presets

HYBRID = presets.load("hybrid")


def at(system: cx.System, path: str) -> Any:
    return eval(f"system.{path}", {"system": system})


@pytest.mark.parametrize(
    ("path", "value", "where", "expected"),
    [
        ("source.peak_pressure", "30 kPa", "source.peak_pressure", 3e4),
        ("source.z", "-70 cm", "source.z", -0.7),
        ("shells[0].radius", 0.4, "shells[0].radius", 0.4),
        ("shells.0.radius", "40 cm", "shells[0].radius", 0.4),
        ("shells.inner.radius", "400 mm", "shells[0].radius", 0.4),
        ("shells.outer.layers[1].thickness", "7 mm", "shells[1].layers[1].thickness", 0.007),
        ("shells[0].layers[0].material", "pzt-5a", "shells[0].layers[0].material", cx.materials.PZT5A),
        ("shells[0].layers[1].material.density", 2800, "shells[0].layers[1].material.density", 2800.0),
        ("fluids.exterior.density", 1025, "fluids[2].density", 1025.0),
        ("fluids[0]", "vacuum", "fluids[0]", cx.VACUUM),
        ("absorbers.count", "30", "absorbers.count", 30),
        ("absorbers.mass", 0, "absorbers.mass", 0.0),
        ("absorbers", "none", "absorbers", ()),
        ("control", "none", "control", None),
        ("control.shells", "inner", "controlled_shells", (0,)),
        ("control.saturation", "true", "control.saturation", True),
        ("name", "mine", "name", "mine"),
    ],
)
def test_one_path(path: str, value: Any, where: str, expected: Any) -> None:
    changed = HYBRID.replace_path(path, value)
    assert at(changed, where) == expected
    assert at(HYBRID, where) != expected  # the original stays


def test_a_material_changes_in_every_layer_made_of_it() -> None:
    changed = HYBRID.with_overrides({"materials.aluminium.density": "2.8 g/cm^3", "materials.PZT4.e32": -5})
    for shell in changed.shells:
        assert isinstance(shell, cx.Shell)
        assert [layer.material.density for layer in shell.layers] == [7500.0, 2800.0, 7500.0]
        assert shell.sensor is not None
        assert isinstance(shell.sensor.material, cx.Piezoelectric)
        assert shell.sensor.material.e32 == -5.0


def test_only_the_result_need_be_consistent() -> None:
    changed = HYBRID.with_overrides({"shells[0].radius": 2, "shells[1].radius": 3})  # the first alone would overlap
    assert changed.reference_radius == 3.0


def test_several_sources_and_single_absorbers_by_number() -> None:
    system = HYBRID.replace(source=[HYBRID.source, cx.PlaneShock(peak_pressure=1, decay_time=1)], absorbers=HYBRID.absorber_list)
    changed = system.with_overrides({"source[1].angle": 30, "absorbers[24].mass": 3})
    assert changed.sources[1].angle == 30.0
    assert [absorber.mass for absorber in changed.absorber_list] == [10.0] * 24 + [3.0]


def test_a_derived_default_follows() -> None:
    system = HYBRID.replace(source=cx.PlaneWave(pulse=cx.Gaussian(peak_pressure=1, width=1e-4)))
    changed = system.replace_path("source.pulse.width", 2e-4)
    assert at(changed, "source.pulse.centre") == pytest.approx(1.2e-3, rel=1e-15)
