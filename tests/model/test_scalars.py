"""NumPy's scalars, arrays without dimensions, fractions and decimals wherever a number is; booleans nowhere."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.numerics.scalars import plain
from coaxshell.solver.settings import Settings

EIGHT = [np.int64(8), np.uint8(8), np.array(8), np.float64(8.0), np.float32(8), np.float16(8), Fraction(8), Decimal(8), np.longdouble(8)]


@pytest.mark.parametrize("eight", EIGHT, ids=lambda value: type(value).__name__)
def test_numbers_of_a_description(eight: Any) -> None:
    fluid = cx.Fluid(density=eight, sound_speed=1500)
    assert fluid == cx.Fluid(density=8.0, sound_speed=1500)
    ring = cx.absorber_ring(plain(eight) if isinstance(plain(eight), int) else 8, mass=eight, linear_stiffness=eight)
    assert ring == cx.absorber_ring(8, mass=8, linear_stiffness=8)
    changed = cx.presets.load("bare").with_overrides({"source.peak_pressure": eight})
    assert changed == cx.presets.load("bare").with_overrides({"source.peak_pressure": 8.0})
    assert cx.System.from_toml_string(changed.to_toml_string()) == changed


@pytest.mark.parametrize("eight", [np.int64(8), np.uint8(8), np.array(8), Fraction(8), Decimal(8)], ids=lambda value: type(value).__name__)
def test_settings_and_arguments(eight: Any) -> None:
    assert Settings(duration=eight, time_step=np.float32(0.5), modes=eight, refinement=eight) == Settings(8, 0.5, 8, refinement=8)
    assert Settings(duration=eight, modes=eight) == Settings(duration=8.0, modes=8)


def test_a_run_and_its_answers() -> None:
    two, half = np.int64(2), np.float32(0.5)
    response = cx.simulate(cx.presets.load("bare"), duration=two, time_step=np.float32(0.03125), modes=np.int16(8))
    same = cx.simulate(cx.presets.load("bare"), duration=2.0, time_step=0.03125, modes=8)
    assert np.array_equal(response.solution.normal, same.solution.normal)
    assert type(response.settings.modes) is int
    for shell in (np.int64(1), np.array(1), Fraction(1)):
        assert response.stress(shell, angle=np.float32(90)).equals(same.stress(1, angle=90.0))
    assert response.pressure(x=half, y=np.array(0.25), time=np.float32(1)).shape == (1, 1)
    assert response.energy(every=np.int64(8)).sizes["time"] == same.energy(every=8).sizes["time"]
    assert response.summary(window=(np.float32(0), np.int8(1))).window == same.summary(window=(0, 1)).window


def test_studies() -> None:
    quick = {"duration": np.int64(1), "time_step": np.float64(0.03125), "modes": np.int32(6)}
    found = cx.sweep(
        cx.presets.load("bare"),
        {"source.peak_pressure": (np.float32(1000), np.int64(2000))},
        points="latin-hypercube",
        samples=np.int64(2),
        seed=np.uint8(1),
        workers=np.int64(1),
        **quick,
    )
    assert found.sizes["case"] == 2


@pytest.mark.parametrize("wrong", [True, np.True_, np.array(True), np.array([8, 8]), 8j, None, np.datetime64("2020")])
def test_what_is_no_number(wrong: Any) -> None:
    with pytest.raises(InputError):
        Settings(modes=wrong)
    with pytest.raises(InputError):
        Settings(duration=wrong)
    with pytest.raises(InputError):
        cx.Fluid(density=wrong, sound_speed=1500)
    with pytest.raises(InputError):
        cx.presets.load("bare").shell_index(wrong)
