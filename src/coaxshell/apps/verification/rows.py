"""What a check returns: rows of the report, and sheets of plots."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import FloatArray

Verdict = Literal["pass", "FAIL", "noted", "skipped"]


@dataclass(frozen=True)
class Row:
    """One comparison.

    Attributes
    ----------
    what, source : str
        What is compared, and where the expected value comes from.
    expected, found : str
        Both as text, with units.
    error, tolerance : float
        It passes if the error is at most the tolerance; a NaN never does. An infinite tolerance judges nothing: "noted".
    measure : str
        How the error is measured: "relative", "absolute", "relative L2", "order", ...
    skipped : str
        Why it was not carried out; "" if it was.
    """

    what: str
    source: str
    expected: str
    found: str
    error: float
    tolerance: float
    measure: str = "relative"
    skipped: str = ""

    @property
    def verdict(self) -> Verdict:
        """Return "pass", "FAIL", "noted" or "skipped"."""
        if self.skipped:
            return "skipped"
        if math.isinf(self.tolerance):
            return "noted"
        return "pass" if self.error <= self.tolerance else "FAIL"

    @property
    def cells(self) -> tuple[str, ...]:
        """The row as texts: what, source, expected, found, error, tolerance, measure, verdict."""
        if self.skipped:
            return self.what, self.source, self.expected, self.skipped, "", "", "", self.verdict
        errors = (f"{self.error:.2g}", "" if self.verdict == "noted" else f"{self.tolerance:.2g}")
        if self.measure == ORDER:
            errors = ("0" if self.error == 0 else f"{self.error:.2f}", "0")
        return self.what, self.source, self.expected, self.found, *errors, self.measure, self.verdict


ORDER = "order"
HEADINGS = ("what", "source", "expected", "found", "error", "tolerance", "measure", "verdict")
"""Headings of :attr:`Row.cells`."""


@dataclass(frozen=True)
class Curve:
    """One curve of a plot; ``style`` is "line", "dashed" or "points"."""

    label: str
    x: FloatArray
    y: FloatArray
    style: Literal["line", "dashed", "points"] = "line"
    colour: str | None = None


@dataclass(frozen=True)
class Panel:
    """One pair of axes."""

    title: str
    x_label: str
    y_label: str
    curves: Sequence[Curve]
    logarithmic: bool = False


@dataclass(frozen=True)
class Sheet:
    """A figure of a check: panels side by side, and what they show."""

    title: str
    caption: str
    panels: Sequence[Panel] = field(default_factory=tuple)


Finding = Row | Sheet


def value(number: float, unit: str = "") -> str:
    """Return a number as text with up to seven digits."""
    return f"{number:.7g} {unit}".rstrip()


def close(
    what: str,
    source: str,
    expected: float,
    found: float,
    tolerance: float,
    *,
    unit: str = "",
    measure: str = "relative",
    scale: float | None = None,
) -> Row:
    """Return the row of a number: the error is absolute if ``measure`` says so, else relative to ``scale`` or the expected value."""
    error = abs(found - expected)
    if measure != "absolute":
        error /= abs(expected if scale is None else scale) or math.nan
    return Row(what, source, value(expected, unit), value(found, unit), error, tolerance, measure)


def within(what: str, source: str, expected: str, error: float, tolerance: float, *, found: str = "", measure: str = "relative L2") -> Row:
    """Return the row of an error already measured, such as the distance between two histories."""
    return Row(what, source, expected, found or f"differs by {error:.2g}", error, tolerance, measure)


def at_least(what: str, source: str, least: float, found: float) -> Row:
    """Return the row of an observed order of convergence."""
    lacking = max(0.0, least - found) if math.isfinite(found) else math.nan
    return Row(what, source, f"≥ {least:g}", f"{found:.2f}", lacking, 0.0, ORDER)


def skipped(what: str, source: str, why: str) -> Row:
    """Return the row of something that could not be carried out here."""
    return Row(what, source, "", "", math.nan, 0.0, skipped=why)


def distance(found: npt.ArrayLike, expected: npt.ArrayLike) -> float:
    """Return the relative L2 distance |found - expected|/|expected|; NaN if nothing is expected."""
    reference = np.asarray(expected)
    norm = float(np.linalg.norm(reference))
    return float(np.linalg.norm(np.asarray(found) - reference)) / norm if norm else math.nan


def orders(errors: Sequence[float] | FloatArray, ratio: float = 2.0) -> FloatArray:
    """Return the observed orders between successive errors at steps that shrink by a ratio."""
    e = np.asarray(errors, dtype=np.float64)
    result: FloatArray = np.log(e[:-1] / e[1:]) / np.log(ratio)
    return result
