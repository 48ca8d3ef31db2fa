"""How far the histories of a run are from measured ones: samples at the times of each record's own clock, in units of its noise."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.studies.fitting.measurement import Measurement
from coaxshell.studies.fitting.places import Shown, shown_at
from coaxshell.studies.fitting.predicting import Predicted

_GUESSES = 401
"""Offsets that are tried to begin with."""


class Matching:
    """The samples of some records that a run can answer to.

    Parameters
    ----------
    records : sequence of Measurement
    reach : ndarray, shape (records,)
        How far each clock may be from where its search begins, s; 0 of those known.
    begin : ndarray, shape (records,)
        Where each clock begins, s.
    end : float
        Last instant of the run, s.

    Raises
    ------
    InputError
        If a record has too few samples within the run.
    """

    def __init__(self, records: Sequence[Measurement], begin: FloatArray, reach: FloatArray, end: float) -> None:
        self.records = tuple(records)
        self.time: list[FloatArray] = []
        self.values: list[FloatArray] = []
        for one, at, around in zip(records, begin, reach, strict=True):
            time, values = np.asarray(one.time)[one.used], np.asarray(one.values)[one.used]
            inside = time - at + around <= end
            if inside.sum() < 3:
                problem = f"{int(inside.sum())} of its samples lie within the run, which ends at {end:g} s"
                raise InputError(f"measured.{one.name}", problem, "give a longer duration, or clock_guess and clock_range")
            self.time.append(time[inside])
            self.values.append(values[inside])
        sizes = [0, *np.cumsum([time.size for time in self.time])]
        self.rows = [slice(int(a), int(b)) for a, b in pairwise(sizes)]
        self.count = int(sizes[-1])

    @property
    def noise_to_begin_with(self) -> FloatArray:
        """The noise of each record where it is told, else the RMS of the record: all then weigh alike."""
        return np.array(
            [one.noise or float(np.sqrt(np.mean(y**2))) or 1.0 for one, y in zip(self.records, self.values, strict=True)], dtype=np.float64
        )

    def shown(self, found: Predicted, number: int, offset: float) -> Shown:
        """Return what a run shows at the samples of a record whose clock shows *offset* (s) as the run begins.

        Between the instants of the run by cubic splines, of pressures, whose fronts jump, by straight lines. Nothing before it begins.
        """
        return shown_at(self.records[number].quantity, found.time, found.values[number], self.time[number] - offset)

    def missing(self, found: Predicted, offsets: FloatArray, noise: FloatArray) -> FloatArray:
        """Return (run - record)/noise of all samples, (samples,)."""
        parts = [(self.shown(found, k, float(offset)).values - self.values[k]) / noise[k] for k, offset in enumerate(offsets)]
        return np.concatenate(parts)

    def offset(self, found: Predicted, members: Sequence[int], low: float, high: float, noise: FloatArray) -> float:
        """Return the clock within limits at which a run comes closest to some records that share it, each as large as it fits best."""

        def left(offset: float) -> float:
            total = 0.0
            for k in members:
                shown, y = self.shown(found, k, offset).values, self.values[k]
                square = float(shown @ shown)
                along = max(0.0, float(shown @ y))
                total += (float(y @ y) - (along**2 / square if square > 0.0 else 0.0)) / noise[k] ** 2
            return total

        grid = np.linspace(low, high, _GUESSES)
        costs = np.array([left(float(one)) for one in grid])
        best = np.flatnonzero(costs <= costs.min() + 1e-12 * costs.max())
        return float(grid[best[np.argmin(np.abs(grid[best] - 0.5 * (low + high)))]])
