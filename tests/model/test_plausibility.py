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
    ],
)
def test_what_no_material_has_is_remarked(path, value, told):
    found = remarks(presets.load("bare").replace_path(path, value))
    assert found
    assert told in found[0]


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
    for name in fluids.names():
        assert remarks(bare.replace_path("fluids[1]", name)) == []
