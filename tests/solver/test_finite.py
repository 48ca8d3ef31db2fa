"""No result with NaN or infinity leaves a run: the error says at which stage, shell, order and instant it began."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.model import presets
from coaxshell.numerics.finite import first_bad, require_finite
from coaxshell.response import Response
from coaxshell.solver.interface import linked
from coaxshell.solver.structure_spectra import StructureSpectra

COARSE: dict[str, Any] = {"duration": 2.0, "time_step": 1e-2, "modes": 12}


@pytest.fixture(scope="module")
def response() -> Response:
    return cx.simulate(presets.load("hybrid"), **COARSE)


def test_first_bad_is_the_earliest_along_the_last_axis() -> None:
    array = np.zeros((2, 3, 10))
    assert first_bad(array) is None
    assert first_bad(np.full(4, 1e308)) is None  # their sum overflows, no number does
    array[0, 0, 7], array[1, 2, 4] = np.nan, -np.inf
    assert first_bad(array) == (1, 2, 4)
    assert first_bad(array.astype(np.complex128)) == (1, 2, 4)
    assert first_bad(np.arange(3)) is None
    assert first_bad(np.array([1, np.nan], dtype=np.float16)) == (1,)
    assert first_bad(np.zeros((0, 3))) is None


def test_values_name_their_place() -> None:
    with pytest.raises(InputError, match=r"pressure: is nan at time = 0.5, x = 2, and 1 of 6 of its values are no numbers; go finer"):
        require_finite([[0.0, 1, 2], [0, 1, np.nan]], "pressure", [("time", np.array([0.0, 0.5])), ("x", np.arange(3.0))], "go finer")


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize(
    ("name", "place"),
    [
        ("normal", r"the normal displacement is -?(nan|inf) first at shell 1, half 0, order 3, t = 0.5 transits"),
        ("tangential", r"the tangential displacement is -?(nan|inf) first at shell 1, half 0, order 3, t = 0.5"),
        ("normal_rate", "the normal velocity"),
        ("tangential_rate", "the tangential velocity"),
        ("absorber_displacement", "displacement of the absorbers .* first at absorber 1, t = 0.5"),
        ("absorber_force", "force of the absorbers .* first at absorber 1, side 0, t = 0.5"),
        ("time", "time is"),
    ],
)
def test_no_array_of_a_solution_passes(response: Response, name: str, place: str, bad: float) -> None:
    values = np.array(getattr(response.solution, name))
    values[(*(1, 0, 3)[: values.ndim - 1], 50)] = bad
    with pytest.raises(InputError, match=place):
        Response(replace(response.solution, **{name: values}))


@pytest.mark.parametrize(
    ("name", "index", "told"),
    [
        (
            "normal",
            (1, 0, 4, 9),
            "source: the answer of shells and fluids to the source is nan.* shell 1, half 0, order 4, freq",
        ),
        (
            "compliance",
            (0, 1, 2, 9),
            "shells: the answer of .* to forces is nan.* answering shell 0, loaded shell 1, order 2",
        ),
    ],
)
def test_the_stage_is_named(name: str, index: tuple[int, ...], told: str, monkeypatch: pytest.MonkeyPatch) -> None:
    made = getattr(StructureSpectra, name)

    def poisoned(structure: StructureSpectra) -> np.ndarray:
        found = made.fget(structure)
        found[index] = np.nan
        return found

    monkeypatch.setattr(StructureSpectra, name, property(poisoned))
    with pytest.raises(InputError, match=told):
        cx.simulate(presets.load("hybrid"), **COARSE)


def test_a_march_that_fails_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    march = linked.march_interface

    def poisoned(*given: Any, **options: Any) -> Any:
        found = march(*given, **options)
        found.force[3, 77] = np.nan
        return found

    monkeypatch.setattr(linked, "march_interface", poisoned)
    with pytest.raises(InputError, match=r"absorbers: the force of the absorbers is nan first at absorber \d+, side \d, t = 0.77"):
        cx.simulate(presets.load("hybrid"), **COARSE)


def test_a_failed_linear_solve_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*given: Any, **options: Any) -> Any:
        raise np.linalg.LinAlgError("Singular matrix")

    monkeypatch.setattr(linked, "march_interface", fails)
    with pytest.raises(InputError, match=r"leave the range of the computer \(Singular matrix\)"):
        cx.simulate(presets.load("hybrid"), **COARSE)


def test_fields_and_energies_are_numbers(response: Response, monkeypatch: pytest.MonkeyPatch) -> None:
    spectra = response.motion.spectra
    spoilt = np.array(spectra.normal)
    spoilt[1, 0, 2, 5] = np.nan
    broken = Response(response.solution)
    broken.motion.spectra = replace(spectra, normal=spoilt)
    with pytest.raises(InputError, match=r"pressure: is nan at time = 1, y = 0, x = 1.5"):
        broken.pressure(x=[1.5], y=[0.0], time=1.0, part="radiated")
    with pytest.raises(InputError, match="energy"):
        broken.energy()
