"""Magnitudes that no material has are remarked with what was probably meant; what exists is not."""

from __future__ import annotations

import pytest

import coaxshell.model as cx
from coaxshell.model import fluids, materials, presets
from coaxshell.model.plausibility import remarks


@pytest.mark.parametrize(
    ("path", "value", "told"),
    [
        ("materials.aluminium.youngs_modulus", 210, "is 210 GPa meant?"),
        ("materials.aluminium.density", 7.85, "is 7.85 g/cm^3 meant?"),
        ("materials.aluminium.youngs_modulus", "70 kPa", "is 70000 MPa meant?"),
        ("fluids[2].sound_speed", 1.5, "is 1.5 km/s meant?"),
        ("fluids[2].sound_speed", 1.5e6, "is 1.5e+06 mm/s meant?"),
        ("shells[0].layers[0].material.density", 7.5, "shells[0].layers[0].material.density = 7.5"),
        ("source", cx.PlaneWave(pulse=cx.Sampled(time=[0, 1e-4], pressure=[0.025, 0.0])), "source.pulse: the peak is 0.025 Pa"),
        ("source.peak_pressure", "0.025 mPa", "source: the peak = 2.5e-05 Pa (below 0.01 Pa)"),
        ("source.peak_pressure", "-0.025 mPa", "source: the peak = 2.5e-05 Pa"),
        ("source.peak_pressure", "250 GPa", "(above 1e+10 Pa)"),
        ("source.decay_time", "2 h", "source: decay_time = 7200 s (above 60 s)"),
        ("source.decay_time", "1 ns", "source: decay_time = 1e-09 s (below 1e-08 s)"),
        ("source.delay", "3 h", "source.delay = 10800 s"),
        ("source.distance", "500 km", "source.distance = 500000 m"),
        ("source", cx.PlaneWave(pulse=cx.Step(pressure=1e5, rise_time=3600.0)), "rise_time = 3600 s"),
        ("source", cx.PlaneWave(pulse=cx.Gaussian(peak_pressure=1e5, width=100.0)), "width = 100 s"),
        ("shells[0].layers[1].thickness", "0.3 m", "of its radius"),
    ],
)
def test_what_no_material_has_is_remarked(path, value, told):
    found = remarks(presets.load("bare").replace_path(path, value))
    assert found
    assert told in found[0]


def test_a_shell_of_kilometres_is_remarked():
    plane = presets.load("bare").replace(source=cx.PlaneShock(peak_pressure=1e5, decay_time=1e-4))
    (told,) = remarks(plane.replace_path("shells[1].radius", "5 km"))
    assert told.startswith("shells[1].radius = 5000 m (above 1000 m) is outside any shell that is built")


def test_what_exists_is_not():
    for name in presets.names():
        assert remarks(presets.load(name)) == []
    bare = presets.load("bare")
    for name in materials.names():
        material = materials.get(name)
        if isinstance(material, cx.Elastic):
            assert remarks(bare.replace_path("shells[0].layers[1].material", material)) == []
    ghost = cx.Elastic(name="ghost", density=1e-9, youngs_modulus=1e-3, poisson_ratio=0.3)  # a wall of next to nothing, on purpose
    assert remarks(bare.replace_path("shells[0].layers[1].material", ghost)) == []
    plain = bare.replace(source=cx.PlaneWave(pulse=cx.Step(pressure=1.0)))  # units of the reader's own, and a sharp front
    assert remarks(plain) == remarks(bare.replace_path("source", cx.PlaneShock(peak_pressure=1.0, decay_time=1.0))) == []
    for name in fluids.names():
        assert remarks(bare.replace_path("fluids[1]", name)) == []


@pytest.mark.parametrize(
    ("ceramic", "s55", "s66", "d15"), [(cx.materials.PZT5A, 47.5, 44.3, 584.0), (cx.materials.PZT5H, 43.5, 42.6, 741.0)], ids=["5A", "5H"]
)
def test_shear_constants_of_ceramics_are_those_of_a_table_of_compliances(ceramic, s55, s66, d15):
    # Erturk and Inman, Piezoelectric Energy Harvesting, Wiley 2011, Table E.1: s in pm^2/N, d15 in pm/V
    assert ceramic.c44 == pytest.approx(1e12 / s55, rel=4e-3)
    assert ceramic.c66 == pytest.approx(1e12 / s66, rel=4e-3)
    assert ceramic.e15 == pytest.approx(d15 / s55, rel=4e-3)
