"""Displacement relative to the section's translation: what is left when the shell moves as a whole is nothing."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.response import Response
from coaxshell.response.run_comparison import comparison_rows
from coaxshell.response.translation import still_grows
from coaxshell.solver.solution import ModalSolution

AROUND = np.arange(0.0, 360.0, 2.0)


@pytest.mark.parametrize("parities", [1, 2])
def test_translation_is_the_mean_motion_of_the_section(make: Callable[..., ModalSolution], parities: int) -> None:
    response = Response(make(parities=parities))
    inward, along = (response.displacement(1, AROUND, component).values for component in ("normal", "tangential"))
    cosine, sine = np.cos(np.radians(AROUND)), np.sin(np.radians(AROUND))
    expected = np.stack([(-inward * cosine - along * sine).mean(axis=1), (-inward * sine + along * cosine).mean(axis=1)], axis=1)
    found = response.translation("outer")
    assert found.dims == ("time", "direction")
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-13 * abs(expected).max())


@pytest.mark.parametrize("component", ["normal", "tangential"])
def test_relative_and_translation_make_up_the_absolute(response: Response, component: str) -> None:
    angles = np.array([0.0, 33.0, 180.0, 275.0])
    x, y = response.translation(0).values.T[..., None]
    cosine, sine = np.cos(np.radians(angles)), np.sin(np.radians(angles))
    rigid = -x * cosine - y * sine if component == "normal" else -x * sine + y * cosine
    absolute, relative = (response.displacement(0, angles, component, relative=each) for each in (False, True))
    np.testing.assert_allclose(relative + rigid, absolute, rtol=0, atol=1e-12 * float(abs(absolute).max()))
    assert relative.name == f"relative_{component}_displacement"
    assert float(abs(relative).max()) > 0.1 * float(abs(absolute).max())


def test_a_shell_that_only_translates_is_not_deformed(make: Callable[..., ModalSolution]) -> None:
    solution = make()
    for part in (solution.normal, solution.tangential):
        part[:, :, [0, *range(2, part.shape[2])]] = 0.0
    solution.tangential[:] = solution.normal
    response = Response(solution)
    for component in ("normal", "tangential"):
        absolute = float(abs(response.displacement(0, AROUND, component)).max())
        assert float(abs(response.displacement(0, AROUND, component, relative=True)).max()) < 1e-14 * absolute
    assert response.summary().shells[0].relative_displacement.value < 1e-14 * absolute


def test_breathing_and_the_rest_of_order_1_are_left(make: Callable[..., ModalSolution]) -> None:
    solution = make(parities=1)
    solution.normal[:, :, 2:] = 0.0
    solution.tangential[:] = 0.0
    w = solution.problem.scales.length * solution.normal[0, 0]
    found = Response(solution).displacement(0, [0, 90], relative=True)
    np.testing.assert_allclose(found, np.stack([w[0] + w[1] / 2, w[0]], axis=1), rtol=0, atol=1e-14 * abs(w).max())


@pytest.mark.parametrize(
    ("history", "grows"),
    [
        (lambda t: t, True),  # a drift
        (lambda t: t + 0.02 * np.sin(40 * t), True),  # with ringing on it
        (lambda t: -(t**2), True),
        (lambda t: 1 - np.exp(-8 * t), False),  # settled
        (lambda t: np.sin(6 * t), False),  # to and fro
        (lambda t: 0 * t, False),
    ],
    ids=["drift", "ringing", "faster", "settled", "back", "none"],
)
def test_what_still_grows(make: Callable[..., ModalSolution], history: Callable[[np.ndarray], np.ndarray], grows: bool) -> None:
    solution = make(parities=1)
    solution.normal[:, :, 1] = solution.tangential[:, :, 1] = history(solution.time / solution.time[-1])
    assert still_grows(solution, 0, slice(0, len(solution.time))) is grows
    assert Response(solution).summary().shells[0].displacement_head.growing >= grows


def test_a_longer_run_changes_the_absolute_displacement_alone() -> None:
    short, long = (cx.simulate(cx.presets.load("bare"), modes=12, time_step=0.02, duration=duration).summary() for duration in (5.0, 10.0))
    for name in ("relative_displacement_head", "relative_displacement_tail", "relative_displacement"):
        first, second = (getattr(summary.shells[0], name) for summary in (short, long))
        assert second.value == pytest.approx(first.value, rel=1e-5)  # the contours of the two inversions differ
        assert not first.growing
    drift = [summary.shells[0].displacement_head for summary in (short, long)]
    assert drift[1].value > 1.4 * drift[0].value
    assert all(peak.growing for peak in drift)
    text = [line for line in str(short).splitlines() if line.startswith("inner  absolute displacement at head")]
    assert "still growing" in text[0]
    rows = {(row[0], row[1]): row[-1] for row in comparison_rows(short, long)}
    assert rows["inner", "absolute displacement at head"] == "still growing"
    assert rows["inner", "relative displacement at head"] == "the same"
    assert short.to_dict()["shells"][0]["displacement_head"]["growing"] is True
