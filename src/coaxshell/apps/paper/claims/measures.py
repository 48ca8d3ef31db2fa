"""Measures that several claims share."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.apps.paper.observed import SIDES, Observed
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.texts import rounded

POINTS = tuple((shell, side) for shell in ("inner", "outer") for side in SIDES)
RAPID = 4.0
"""Cycles in a transit above which an oscillation is called rapid: periods below a quarter of the outer radius in water."""


def change(found: npt.ArrayLike, reference: npt.ArrayLike) -> float:
    """Return the relative L2 distance of a history from a reference; 0 if both are nothing."""
    reference = np.asarray(reference, dtype=np.float64)
    norm = float(np.linalg.norm(reference))
    away = float(np.linalg.norm(np.asarray(found, dtype=np.float64) - reference))
    return away / norm if norm else (0.0 if away == 0.0 else np.inf)


def stress_changes(found: Observed, reference: Observed, shells: tuple[str, ...] = ("inner",)) -> dict[tuple[str, str], float]:
    """Return the relative L2 change of the stress at head and tail of shells."""
    return {(shell, side): change(found.stress(shell, side), reference.stress(shell, side)) for shell in shells for side in SIDES}


def onset(time: FloatArray, values: FloatArray, share: float = 0.01) -> float:
    """Return the first instant at which a magnitude passes a share of its peak."""
    magnitude = np.abs(values)
    return float(time[int(np.argmax(magnitude > share * magnitude.max()))])


def peak(values: npt.ArrayLike) -> float:
    """Return the largest magnitude."""
    return float(np.abs(np.asarray(values)).max())


def reduction(found: float, reference: float) -> float:
    """Return by how many per cent a value lies below a reference."""
    return 100.0 * (1.0 - found / reference)


def variation(values: FloatArray) -> float:
    """Return the total variation over the range: 1 for a monotone history, 2 for one swing to and fro, and so on."""
    return float(np.abs(np.diff(values)).sum() / np.ptp(values))


def rapid_part(time: FloatArray, values: FloatArray, above: float = RAPID) -> FloatArray:
    """Return the part of a history that oscillates faster than *above* cycles in a transit.

    A Gaussian-smoothed copy, half-power at that frequency, is taken off; ends are held.
    """
    from scipy.ndimage import gaussian_filter1d

    step = float(time[1] - time[0])
    width = np.sqrt(np.log(2.0)) / (2.0 * np.pi * above) / step
    return np.asarray(values - gaussian_filter1d(values, width, mode="nearest"), dtype=np.float64)


def rms(values: npt.ArrayLike) -> float:
    """Return the root mean square."""
    return float(np.sqrt(np.mean(np.square(np.asarray(values, dtype=np.float64)))))


def extremum_near(time: FloatArray, values: FloatArray, instant: float) -> tuple[float, float]:
    """Return (instant, magnitude relative to the peak) of the local extremum of a magnitude that lies nearest to an instant.

    Only extrema of at least half the peak count; without one the instant of the peak is returned.
    """
    magnitude = np.abs(values)
    inside = magnitude[1:-1]
    at = 1 + np.flatnonzero((inside >= magnitude[:-2]) & (inside > magnitude[2:]) & (inside >= 0.5 * magnitude.max()))
    k = int(at[np.argmin(np.abs(time[at] - instant))]) if at.size else int(magnitude.argmax())
    return float(time[k]), float(magnitude[k] / magnitude.max())


def sentence(items: dict[tuple[str, str], float], form: str = "{} %", factor: float = 100.0) -> str:
    """Return values at points as text, "1 % at the inner head, 2 % at the inner tail"; to two digits unless the form tells."""
    shown = [rounded(factor * value, 2) if form == "{} %" else factor * value for value in items.values()]
    return ", ".join(f"{form.format(value)} at the {shell} {side}" for (shell, side), value in zip(items, shown, strict=True))


def named(items: dict[tuple[str, str], float], what: str, factor: float = 100.0) -> dict[str, float]:
    """Return values at points by names such as "inner head, change of the stress (%)"."""
    return {f"{shell} {side}, {what}": factor * value for (shell, side), value in items.items()}


def sentence_case(text: str) -> str:
    """Return a text as a sentence: a capital letter first, a full stop last."""
    first = text[0] if text[1:2] == " " else text[0].upper()  # a symbol keeps its case
    return f"{first}{text[1:].rstrip('.')}."
