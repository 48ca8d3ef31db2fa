"""What stresses in a thin wall cannot exceed at an instant, for all its depths at once, and stresses made only where they may be largest.

By its membrane strain e_m = m V - W and its deflection an order of a stress at a depth is p_m V + q_m W = (p_m/m) e_m + (q_m + p_m/m) W, of
which the first part is what stretches the wall and the second what bends it. With |.| the norm that the stress is,

    |sum over orders| <= sum_m |p_m/m| |e_m| + |q_m + p_m/m| |W_m|,

and |e_m| and |W_m| are the same for all depths; what a voltage asked for adds counts with the sum of its orders. V and W themselves would
nearly cancel. With their changes from instant to instant it
bounds those of the stress: beside an instant that has been summed around the circle no other can be larger by more.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.depth_stress import DepthStress
from coaxshell.solver.solution import ModalSolution
from coaxshell.structure.shell_model import Gain

_CACHED = 256 * 1024
"""Bytes of amplitudes that stay in the processor's cache."""
_ROUNDING = 1e-9
_APART = 8
"""Instants of which one is summed first."""
_FIRST, _MANY = 16, 128
"""Instants summed together: at first, and when more is known."""

Instants = npt.NDArray[np.int64]
Stresses = Callable[[Any], Mapping[str, FloatArray]]
"""From instants to the modal amplitudes (parities, M + 1, instants) of the components of a stress, Pa."""


class Bounds(NamedTuple):
    """What stresses, and their changes since the instant before, cannot exceed: shape (depths, T) each, Pa."""

    reach: FloatArray
    change: FloatArray


class DepthStressWhereLarge(DepthStress):
    """A stress at one depth whose amplitudes are made at the instants that are asked for.

    Parameters
    ----------
    stresses : callable
    reach, change : ndarray, shape (T,)
        As :class:`Bounds`, at this depth.
    """

    def __init__(self, stresses: Stresses, reach: FloatArray, change: FloatArray) -> None:
        super().__init__({})
        self._stresses, self._reach, self._way = stresses, reach, np.cumsum(change)

    def most(self, window: slice) -> float:
        """Return what the magnitude cannot exceed at any instant of a window."""
        return float(self._reach[window].max(initial=0.0))

    def largest(self, window: slice, above: float) -> tuple[float, int, int]:
        """Return the largest magnitude with its instant and its place on the circle; -1 if none exceeds *above*.

        One instant in a few is summed first, those that promise most before the others; then those that can still be larger.
        """
        upper = self._reach.copy()
        best = (above, -1, 0)
        centres = np.arange(window.start, window.stop, _APART)
        beside = np.arange(_APART) - _APART // 2
        near = np.clip(centres[:, None] + beside, window.start, window.stop - 1)
        order = np.argsort(-upper[near].max(axis=1), kind="stable")
        start, count = 0, _FIRST
        while start < order.size:
            some = order[start : start + count]
            some = some[upper[near[some]].max(axis=1) > best[0]]
            if not some.size:
                break
            best, tops = self._summed(centres[some], best)
            far = np.abs(self._way[near[some]] - self._way[centres[some], None])
            upper[near[some]] = np.minimum(upper[near[some]], tops[:, None] * (1.0 + _ROUNDING) + far)
            start, count = start + count, _MANY
        left = np.arange(window.start, window.stop)
        while (left := left[upper[left] > best[0]]).size:
            left = left[np.argsort(-upper[left], kind="stable")]
            best, _ = self._summed(left[:_FIRST], best)
            upper[left[:_FIRST]] = -1.0
        return best if best[1] >= 0 else (-1.0, window.start, 0)

    def _summed(self, instants: Instants, best: tuple[float, int, int]) -> tuple[tuple[float, int, int], FloatArray]:
        """Return the largest magnitude at some instants, or the best before, and the largest at each."""
        field = DepthStress(self._stresses(instants)).on_circle(slice(None))
        tops = field.max(axis=0)
        k = int(tops.argmax())
        if tops[k] > best[0]:
            best = (float(tops[k]), int(instants[k]), int(field[:, k].argmax()))
        return best, tops

    def at_angles(self, theta: FloatArray, window: Any) -> FloatArray:
        """Return the magnitude at angles (degrees), (T, A)."""
        return DepthStress(self._stresses(window)).at_angles(theta, slice(None))


class Driven(NamedTuple):
    """The voltage that a control law asks for, (parities, M + 1, T), V, and what a volt adds to each component at every depth, Pa."""

    voltage: FloatArray
    per_volt: Sequence[Mapping[str, float]]


def bounds(solution: ModalSolution, shell: int, gains: Sequence[Mapping[str, Gain]], driven: Driven | None = None) -> Bounds:
    """Return what stresses cannot exceed at each instant of a run in two dimensions, and from one instant to the next.

    Parameters
    ----------
    solution : ModalSolution
    shell : int
    gains : sequence of mapping
        Of every depth: one component, or the hoop and the axial stress of which von Mises' is made.
    driven : Driven, optional
    """
    normal, tangential = solution.normal[shell], solution.tangential[shell]
    m = np.arange(normal.shape[1], dtype=np.float64)
    each = np.where(m == 0, 1.0, m)
    stretched, bent = (np.empty((len(gains), m.size)) for _ in range(2))
    for row, of_depth in enumerate(gains):
        along = {name: np.where(m == 0, -gain.w, gain.v / each) for name, gain in of_depth.items()}
        stretched[row] = _norm(along)
        bent[row] = _norm({name: along[name] + gain.w for name, gain in of_depth.items()})
    found = Bounds(*np.zeros((2, len(gains), normal.shape[2])))
    width = max(16, _CACHED // (8 * normal.shape[0] * m.size))
    for start in range(0, normal.shape[2], width):
        first = max(start - 1, 0)  # changes need the instant before
        some, new = slice(first, start + width), slice(start - first, None)
        w = np.ascontiguousarray(normal[..., some])
        strain = m[:, None] * tangential[..., some]
        strain -= w
        found.reach[:, start : start + width] = stretched @ _size(strain[..., new]) + bent @ _size(w[..., new])
        found.change[:, first + 1 : start + width] = stretched @ _size(np.diff(strain)) + bent @ _size(np.diff(w))
    if driven is not None:
        volts = np.array([_norm({name: np.array([one]) for name, one in of_depth.items()}) for of_depth in driven.per_volt])
        found.reach[:] += volts * _size(driven.voltage).sum(axis=0)
        found.change[:, 1:] += volts * _size(np.diff(driven.voltage)).sum(axis=0)
    found.reach[:] *= 1.0 + _ROUNDING
    found.change[:] *= 1.0 + _ROUNDING
    return found


def _norm(components: Mapping[str, FloatArray]) -> FloatArray:
    """Return von Mises' norm of a hoop and an axial stress, or the magnitude of one component."""
    if len(components) == 1:
        return np.asarray(np.abs(next(iter(components.values()))))
    hoop, axial = components["hoop"], components["axial"]
    return np.asarray(np.sqrt(np.maximum(hoop**2 + (axial - hoop) * axial, 0.0)))


def _size(amplitudes: FloatArray) -> FloatArray:
    """Return the magnitude of each order, (M + 1, T), of amplitudes of one or two parities."""
    return np.asarray(np.abs(amplitudes[0]) if len(amplitudes) == 1 else np.hypot(amplitudes[0], amplitudes[1]))
