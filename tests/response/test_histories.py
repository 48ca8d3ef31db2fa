"""Displacement, stress and modal arrays: values against plain formulas, units, coordinates, bad input."""

from __future__ import annotations

import math

import numpy as np
import pytest

from coaxshell.errors import InputError
from coaxshell.response import Response

A = 1.25


def plain(response: Response, shell: int, theta: float, of_normal: object, of_tangential: object) -> np.ndarray:
    """Sum cosine-type orders in a plain loop: of_normal(m) a W + of_tangential(m) a V."""
    w, v = response.solution.normal[shell], response.solution.tangential[shell]
    total = np.zeros(w.shape[-1])
    for m in range(w.shape[1]):
        for half, function in enumerate((math.cos, math.sin)):
            total += A * (of_normal(m) * w[half, m] + of_tangential(m) * v[half, m]) * function(m * math.radians(theta))
    return total


def test_normal_displacement(response: Response) -> None:
    found = response.displacement("outer", angle=[0, 30])
    np.testing.assert_allclose(found.sel(angle=30), plain(response, 1, 30, lambda m: 1, lambda m: 0), rtol=1e-12, atol=1e-18)


def test_tangential_derivative_is_what_the_stress_uses(response: Response) -> None:
    h = 1e-3
    fore, aft = (response.displacement(0, angle=25 + s, component="tangential") for s in (h, -h))
    slope = (fore - aft) / math.radians(2 * h)
    np.testing.assert_allclose(slope, plain(response, 0, 25, lambda m: 0, lambda m: m), rtol=0, atol=1e-9 * A)


def test_design_stress_is_eq_22(response: Response) -> None:
    modulus = 70e9 / (1 - 0.33**2)
    expected = plain(response, 0, 75, lambda m: -modulus / 0.5, lambda m: m * modulus / 0.5)
    np.testing.assert_allclose(response.stress("inner", angle=75), expected, rtol=1e-11, atol=1e-6)


def test_inward_displacement_compresses(response: Response, make: object) -> None:
    solution = make(parities=1)
    solution.tangential[:] = 0.0
    solution.normal[:, :, 0] = 1.0
    solution.normal[:, :, 1:] = 0.0
    assert (Response(solution).stress("inner", 0) < 0).all()


def test_labels(response: Response) -> None:
    found = response.displacement("inner")
    assert found.dims == ("time", "angle")
    assert list(found.angle.values) == [0.0, 180.0]
    assert found.attrs["units"] == "m"
    assert found.attrs["sign"] == "positive inward"
    assert found.attrs["shell"] == 0
    assert found.attrs["shell_name"] == "inner"
    assert found.time_seconds.attrs["units"] == "s"
    assert found.time.attrs["units"] == "a/c_e"
    np.testing.assert_array_equal(found.time, response.time)
    np.testing.assert_allclose(found.time_seconds, response.time * A / 1400, rtol=1e-15)
    np.testing.assert_array_equal(found.time_seconds, response.time_seconds)
    stress = response.stress("outer")
    assert (stress.name, stress.attrs["units"], stress.attrs["sign"]) == ("stress", "Pa", "positive in tension")
    assert response.displacement(1, component="tangential").attrs["sign"] == "positive towards increasing angle"


def test_a_single_angle_leaves_no_dimension(response: Response) -> None:
    found = response.stress("inner", angle=30)
    assert found.dims == ("time",)
    assert float(found.angle) == 30.0
    np.testing.assert_array_equal(found, response.stress("inner", angle=[30]).isel(angle=0))


def test_one_half_equals_two_halves_with_a_zero_sine(make: object) -> None:
    two = make()
    two.normal[:, 1], two.tangential[:, 1] = 0.0, 0.0
    one = make()
    object.__setattr__(one, "normal", two.normal[:, :1])
    object.__setattr__(one, "tangential", two.tangential[:, :1])
    for component in ("normal", "tangential"):
        np.testing.assert_allclose(
            Response(one).displacement(0, [10, 200], component), Response(two).displacement(0, [10, 200], component), rtol=1e-12, atol=1e-18
        )


@pytest.mark.parametrize(
    ("quantity", "units", "angle_values"),
    [
        ("displacement", "m", lambda r: r.displacement(0, 40)),
        ("tangential", "m", lambda r: r.displacement(0, 40, "tangential")),
        ("stress", "Pa", lambda r: r.stress(0, 40)),
        ("sensor_voltage", "V", lambda r: r.sensor_voltage(0, 40)),
    ],
)
def test_modal_arrays_sum_to_the_history(response: Response, quantity: str, units: str, angle_values: object) -> None:
    found = response.modal("inner", quantity)
    assert found.dims == ("half", "mode", "time")
    assert found.attrs["units"] == units
    phase = np.radians(40 * found.mode.values)
    functions = {"cos": np.cos(phase), "sin": np.sin(phase), "-cos": -np.cos(phase)}
    total = sum(functions[str(half)] @ found.sel(half=half).values for half in found.half.values)
    expected = angle_values(response)
    np.testing.assert_allclose(total, expected, rtol=0, atol=1e-12 * float(abs(expected).max()))


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda r: r.displacement("middle"), "middle"),
        (lambda r: r.displacement(2), "2"),
        (lambda r: r.displacement(0, angle="north"), "angle: 'north'"),
        (lambda r: r.displacement(0, angle=[0, math.nan]), "angle: nan is not finite"),
        (lambda r: r.displacement(0, angle=[]), "angle"),
        (lambda r: r.displacement(0, angle=[[0, 1]]), r"angle: an array of shape \(1, 2\)"),
        (lambda r: r.displacement(0, component="radial"), "component: 'radial' is unknown; allowed: normal, tangential"),
        (lambda r: r.modal(0, "colour"), "quantity: 'colour'"),
    ],
)
def test_bad_input(response: Response, call: object, words: str) -> None:
    with pytest.raises(InputError, match=words):
        call(response)


def test_a_rigid_shell_has_displacement_but_no_stress(rigid_core: Response) -> None:
    assert rigid_core.displacement(0).dims == ("time", "angle")
    for call in (rigid_core.stress, rigid_core.sensor_voltage):
        with pytest.raises(InputError, match=r"shells\[0\]: a rigid shell"):
            call(0)
