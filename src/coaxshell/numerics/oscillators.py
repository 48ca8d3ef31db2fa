r"""Damped oscillators on a moving base: their exact answers to a motion that is linear between its samples.

An oscillator of natural circular frequency omega and damping ratio zeta = 1/(2 Q), at rest before the first sample, is held by a base whose
acceleration is a(t); its displacement z relative to the base obeys

    z'' + 2 zeta omega z' + omega^2 z = -a(t).

Between samples a is linear, so that the state x = (z, z') steps without error (Nigam and Jennings, Bull. Seism. Soc. Am. 59, 1969),

    x_{n+1} = A x_n + B_0 a_n + B_1 a_{n+1},    A = exp(F dt).

An oscillator that is slow beside the samples need not be looked at after each: over r steps x_{n+r} = A^r x_n + sum_j g_j a_{n+j}, and a
component y = C x obeys the recursion of A^r's own trace t and determinant d with what both blocks before it have been given,

    y_{n+2} = t y_{n+1} - d y_n + C u_{n+1} + C (A^r - t) u_n,    u_n = sum_j g_j a_{nr+j}.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, NamedTuple, get_args

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import signal

Kind = Literal["pseudo-velocity", "absolute-acceleration", "relative-displacement"]
KINDS: tuple[Kind, ...] = get_args(Kind)
"""omega z; the acceleration of the mass itself, z'' + a = -omega^2 z - 2 zeta omega z'; z."""

IntArray = npt.NDArray[np.int64]
_BYTES = 2**26
"""Of the sums over blocks of steps that are held at a time."""
_BENT, _FEWEST = 0.06, 1.0 / 16.0
"""Second difference of looks, to the largest, up to which parabolas join them: 26 looks a cycle; share of a record between two at most."""
_TERMS = 48
"""Of the series of an exponential, to rounding for up to 3 radians a step."""
_BLOCK = 64
"""Steps between which no oscillator is looked at on the way to the end."""


class Extremes(NamedTuple):
    """Largest and smallest values, each of shape (frequencies, series); at least and at most 0, where the oscillator begins."""

    largest: FloatArray
    smallest: FloatArray

    def take(self, number: int, values: FloatArray) -> None:
        """Fill in those of one oscillator from its values, (series, looks): of the parabola through the looks around each."""
        self.largest[number], self.smallest[number] = _crest(values), -_crest(-values)

    def joined(self, other: Extremes) -> Extremes:
        """Return the extremes of both."""
        return Extremes(np.maximum(self.largest, other.largest), np.minimum(self.smallest, other.smallest))


@dataclass(frozen=True)
class Oscillators:
    """Oscillators of one damping at several frequencies, on bases sampled at one step.

    Parameters
    ----------
    frequency : ndarray, shape (F,)
        Natural frequencies without damping, Hz.
    quality_factor : float
        Q = 1/(2 zeta), above 1/2.
    step : float
        Of the samples, s.
    """

    frequency: FloatArray
    quality_factor: float
    step: float

    @cached_property
    def omega(self) -> FloatArray:
        """Natural circular frequencies times the step, (F,): time is counted in steps, and displacements in accelerations times step^2."""
        return np.asarray(2.0 * np.pi * self.step * self.frequency)

    @property
    def damping(self) -> float:
        """zeta."""
        return 0.5 / self.quality_factor

    @cached_property
    def _stepped(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """A, (F, 2, 2), and B_0, B_1, (F, 2): from the exponential of a matrix that knows of a and its slope too, by its series."""
        rates = np.zeros((self.omega.size, 4, 4))
        rates[:, 0, 1] = rates[:, 2, 3] = 1.0
        rates[:, 1, 0], rates[:, 1, 1], rates[:, 1, 2] = -(self.omega**2), -2.0 * self.damping * self.omega, -1.0
        found = term = np.broadcast_to(np.eye(4), rates.shape)
        for k in range(1, _TERMS):
            term = term @ rates / k
            found = found + term
        return found[:, :2, :2], found[:, :2, 2] - found[:, :2, 3], found[:, :2, 3]

    def powers(self, count: int, which: slice | IntArray = slice(None)) -> FloatArray:
        """Return A^0, ..., A^count of some of them, (F, count + 1, 2, 2), in closed form."""
        n, omega = np.arange(count + 1.0), self.omega[which][:, None]
        decay, turned = self.damping * omega, omega * np.sqrt(1.0 - self.damping**2)
        cosine, sine = np.cos(turned * n), np.sin(turned * n) / turned
        rows = [[cosine + decay * sine, sine], [-(omega**2) * sine, cosine - decay * sine]]
        return np.asarray(np.exp(-decay * n)[..., None, None] * np.moveaxis(np.array(rows), (0, 1), (-2, -1)))

    def weights(self, steps: int, which: slice | IntArray = slice(None)) -> FloatArray:
        """Return what unit samples 0, ..., steps do to the state after so many steps from rest, g_j: (F, 2, steps + 1)."""
        _, before, after = self._stepped
        passed = self.powers(steps, which)[:, ::-1]  # A^{steps - j} at j
        found = np.zeros((passed.shape[0], 2, steps + 1))
        found[..., :-1] += np.einsum("fjab,fb->faj", passed[:, 1:], before[which])
        found[..., 1:] += np.einsum("fjab,fb->faj", passed[:, 1:], after[which])
        return found

    def stride(self, per_cycle: float) -> IntArray:
        """Return after how many steps each is looked at so that a cycle has at least so many looks: a power of two, 1 for the fastest."""
        looks = np.log2(2.0 * np.pi / (self.omega * per_cycle))
        return np.asarray(1 << np.maximum(0, np.floor(looks)).astype(np.int64))

    def reads(self, kind: Kind) -> FloatArray:
        """Return C, (F, 2), of a quantity y = C x, SI, by its name in :data:`KINDS`."""
        rows, omega = np.zeros((self.omega.size, 2)), self.omega
        if kind == "absolute-acceleration":
            rows[:, 0], rows[:, 1] = -(omega**2), -2.0 * self.damping * omega
        else:
            rows[:, 0] = self.step**2 if kind == "relative-displacement" else self.step * omega
        return rows

    def during(self, acceleration: FloatArray, end: FloatArray, kind: Kind, per_cycle: float = 32.0) -> Extremes:
        """Return the extremes of a quantity while the base moves.

        Parameters
        ----------
        acceleration : ndarray, shape (series, N + 1)
            Of the bases, m/s^2.
        end : ndarray, shape (F, 2, series)
            States at the last sample (:meth:`at_the_end`), where not all oscillators are looked at otherwise.
        kind : str
            One of :data:`KINDS`.
        per_cycle : float
            Looks a cycle, as far as there are samples. Between looks a peak is that of a parabola: of a cosine of 10 looks a cycle
            it is missed by 1e-3 of itself at most, of 32 by 1e-5. A slow oscillator sees the displacement of its base: it is
            looked at as often as that needs.
        """
        rows, stride = self.reads(kind), 1 << max(0, int(np.log2(_FEWEST * acceleration.shape[1])))
        last = np.einsum("fa,fas->fs", rows, end)
        found, wanted = Extremes(*(np.zeros_like(last) for _ in range(2))), self.stride(per_cycle)
        while stride > 1:
            count = max(1, _BYTES * stride // (16 * acceleration.size))
            here = np.flatnonzero(wanted >= stride)
            for some in (here[first : first + count] for first in range(0, here.size, count)):
                for number, values in zip(some, self._at_strides(acceleration, rows, some, stride), strict=True):
                    if _resolved(values):
                        found.take(number, values)
                        wanted[number] = 0
            stride //= 2
        for number in np.flatnonzero(wanted):
            found.take(int(number), self.history(acceleration, rows[number], int(number)))
        return found.joined(Extremes(last, last))

    def history(self, acceleration: FloatArray, row: FloatArray, number: int) -> FloatArray:
        """Return a quantity y = C x of one oscillator, C its ``row``, at all samples, (series, N + 1)."""
        power, before, after = (x[number] for x in self._stepped)
        trace, determinant = np.trace(power), np.linalg.det(power)
        back = row @ (power - trace * np.eye(2))
        taps = [row @ after, row @ before + back @ after, back @ before]
        first = acceleration[:, :1] * [-taps[0], row @ before - taps[1]]  # at rest at the first sample, whatever the base does there
        values, _ = signal.lfilter(taps, [1.0, -trace, determinant], acceleration, axis=-1, zi=first)
        return np.asarray(values)

    def _at_strides(self, acceleration: FloatArray, rows: FloatArray, some: IntArray, stride: int) -> Iterator[FloatArray]:
        """Yield a quantity of each of some oscillators after every so many steps, (series, looks)."""
        blocks = np.lib.stride_tricks.sliding_window_view(acceleration, stride + 1, axis=-1)[:, ::stride]
        weights, power = self.weights(stride, some), self.powers(stride, some)[:, stride]
        trace, determinant = np.trace(power, axis1=1, axis2=2), np.linalg.det(power)
        back = np.einsum("fa,fab->fb", rows[some], power - trace[:, None, None] * np.eye(2))
        taps = np.einsum("xfa,faj->xfj", np.array([rows[some], back]), weights)
        given = np.tensordot(taps, blocks, axes=(2, 2))  # (2, F, series, blocks)
        given[0, ..., 1:] += given[1, ..., :-1]
        for load, t, d in zip(given[0], trace, determinant, strict=True):
            yield np.asarray(signal.lfilter([1.0], [1.0, -t, d], load, axis=-1))

    def at_the_end(self, acceleration: FloatArray) -> FloatArray:
        """Return the state x at the last sample, (F, 2, series), from blocks of steps in turn."""
        steps, odd = acceleration.shape[1] - 1, (acceleration.shape[1] - 1) % _BLOCK
        state = np.einsum("faj,sj->fas", self.weights(odd), acceleration[:, : odd + 1])
        weights, power = self.weights(_BLOCK), self.powers(_BLOCK)[:, _BLOCK]
        for first in range(odd, steps, _BLOCK):
            state = power @ state + weights @ acceleration[:, first : first + _BLOCK + 1].T
        return np.asarray(state)

    def after(self, end: FloatArray, kind: Kind) -> Extremes:
        """Return the extremes of a quantity in the free vibration that follows, from states at the end, when the base accelerates no more.

        Those of y at the end of the motion and at its next two turning points, in closed form.
        """
        rows, omega, zeta = self.reads(kind), self.omega[:, None], self.damping
        rate = np.stack([end[:, 1], -(omega**2) * end[:, 0] - 2.0 * zeta * omega * end[:, 1]], axis=1)
        y, dy = (np.einsum("fa,fas->fs", rows, x) for x in (end, rate))
        decay, turned = zeta * omega, omega * np.sqrt(1.0 - zeta**2)
        sine = (dy + decay * y) / turned  # y = e^{-decay t} (y cos + sine sin), dy/dt ~ dy cos - (decay dy + omega^2 y)/turned sin
        phase = np.arctan2(dy * turned, decay * dy + omega**2 * y) % np.pi
        turning = np.exp(-decay / turned * phase) * (y * np.cos(phase) + sine * np.sin(phase))
        values = np.stack([y, turning, -np.exp(-decay / turned * np.pi) * turning])
        return Extremes(values.max(axis=0, initial=0.0), values.min(axis=0, initial=0.0))


def _crest(values: FloatArray) -> FloatArray:
    """Return the largest value of each series, (series,), at least 0; between samples that of the parabola through three."""
    series, last = np.arange(values.shape[0]), values.shape[1] - 1
    when = values.argmax(axis=-1)
    highest = values[series, when]
    inside = (when > 0) & (when < last)
    before, after = values[series, np.maximum(when - 1, 0)], values[series, np.minimum(when + 1, last)]
    bend = np.where(inside, 2.0 * highest - before - after, 0.0)
    raised = (after - before) ** 2 / (8.0 * np.where(bend > 0.0, bend, np.inf))
    return np.asarray(np.maximum(highest + raised, 0.0))


def _resolved(values: FloatArray) -> bool:
    """Return whether looks, (series, looks), lie on smooth curves."""
    return bool(np.abs(np.diff(values, 2, axis=-1)).max(initial=0.0) <= _BENT * np.abs(values).max(initial=0.0))
