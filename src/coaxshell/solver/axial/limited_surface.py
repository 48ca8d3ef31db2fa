"""One step of voltages that stop at a limit at every point of a wall: a = b + K_0 delta(a), delta = clip(a) - a, around and along it.

As in two dimensions (:mod:`coaxshell.solver.limited_step`), with h the points that are held on the side sigma, E the values there of all
waves, P the waves of values there, and d = E_h a - sigma V what is cut off,

    a = b + kappa P_h d,      (1 - E_h kappa P_h) d = E_h b - sigma V,      kappa = -K_0.

P is the adjoint of E, but for the mean squares of the waves, in the product that weighs each point by its share of the wall: the matrix is
symmetric there, its eigenvalues lie between 1 - max kappa > 0 and 1, and conjugate gradients solve for d without it, by transforms along
the axis and products around. The points held are corrected until they reproduce themselves.

Where they turn in circles the step is solved by an iteration that always converges, with y(a) = P of what exceeds the limit,

    a <- (1 - kappa/2)^-1 [b + kappa (y(a) - a/2)],

which shortens the way left by |kappa/(2 - kappa)| < 1 at each turn: y(a) - a/2 is of slope 1/2 or -1/2 at every point.

Points are those of two dimensions around, and more than four to the shortest wave along the axis: what clipping makes of higher waves
folds back from three times the highest on alone.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.axial.lack import Channels
from coaxshell.solver.axial.series import AxialSeries
from coaxshell.solver.electrode_patterns import Patterns

_MAX_SETS, _WHOLE = 60, 12
"""Sets of points in a step at most, and those after which a set that differs by what is next to the limit alone will do."""
_MOST, _MOST_TURNS = 2_000, 2_000
"""Iterations of conjugate gradients, and of those that always converge."""
_TOLERANCE = 1e-10
"""Of the voltages, in units of the limit."""
_ROUNDS = 30

Sides = npt.NDArray[np.int8]


class WallSurface:
    """Sums of all waves and patterns at the points of a wall, and back.

    Parameters
    ----------
    patterns : Patterns
        Of the first wave, which has all.
    channels : Channels
    parities : int
        Along the axis.
    """

    def __init__(self, patterns: Patterns, channels: Channels, parities: int) -> None:
        self.evaluate, self.project = np.ascontiguousarray(patterns.evaluate.T), np.ascontiguousarray(patterns.project.T)
        self.series = AxialSeries(len(channels.counts), parities)
        self._places = channels.places()

    def gridded(self, amplitudes: FloatArray) -> FloatArray:
        """Return amplitudes (parities, channels) as (waves, patterns, parities), 0 where a wave lacks a pattern."""
        found = np.zeros((self.series.waves * len(self.evaluate), self.series.parities))
        found[self._places] = amplitudes.T
        return found.reshape(self.series.waves, len(self.evaluate), self.series.parities)

    def along(self, amplitudes: FloatArray) -> FloatArray:
        """Return patterns at the points of the axis, (points along, patterns), of amplitudes as :meth:`gridded` returns them."""
        return self.series.values(amplitudes)

    def amplitudes(self, at_points: FloatArray, rows: npt.NDArray[np.intp]) -> FloatArray:
        """Return amplitudes (parities, channels) of values at some rows of points, (rows, points around), 0 at all others."""
        patterns = np.zeros((self.series.points, len(self.evaluate)))
        patterns[rows] = at_points @ self.project
        return np.asarray(self.series.coefficients(patterns).reshape(-1, self.series.parities)[self._places].T)

    def beyond(self, along: FloatArray, limits: FloatArray) -> npt.NDArray[np.intp]:
        """Return the rows at which patterns might sum up to more than the least limit."""
        return np.flatnonzero(np.abs(along).sum(axis=1) > float(limits.min()))


class SurfaceStep:
    """The steps of a march, one after another; it remembers which points were held, and by how much.

    Parameters
    ----------
    surface : WallSurface
    limits : ndarray, shape (walls, points around)
        V.
    present : ndarray, shape (walls, walls, channels)
        K_0.
    """

    def __init__(self, surface: WallSurface, limits: FloatArray, present: FloatArray) -> None:
        self._surface, self._limits = surface, limits
        self._size = float(limits.max())
        walls, shape = len(limits), (surface.series.points, limits.shape[1])
        self._kappa = [-present[i, i] for i in range(walls)]
        others = present.copy()
        others[np.arange(walls), np.arange(walls)] = 0.0
        self._others = others if np.abs(others).max(initial=0.0) > _TOLERANCE else None
        self._sides = [np.zeros(shape, np.int8) for _ in range(walls)]
        self._cut = [np.zeros(shape) for _ in range(walls)]
        self._weights = surface.series.weights

    def solve(self, known: FloatArray) -> tuple[FloatArray, int]:
        """Return delta, (walls, parities, channels), from b, and the iterations it took; 0 where no limit is reached.

        Raises
        ------
        InputError
            If no iteration comes to an end, or walls answer each other within a step too strongly.
        """
        delta, taken = np.zeros_like(known), 0
        for _ in range(_ROUNDS):
            before = delta.copy()
            beside = known if self._others is None else known + np.einsum("ijc,jpc->ipc", self._others, delta)
            for wall, b in enumerate(beside):
                delta[wall], more = self._of_wall(wall, b)
                taken += more
            if self._others is None or np.abs(delta - before).max() <= _TOLERANCE * max(self._size, float(np.abs(known).max())):
                return delta, taken
        raise _too_long()

    def _of_wall(self, wall: int, b: FloatArray) -> tuple[FloatArray, int]:
        """Return delta of one wall and the iterations it took."""
        surface, limit = self._surface, self._limits[wall]
        free = surface.along(surface.gridded(b))
        if not (rows := surface.beyond(free, limit)).size:
            self._sides[wall][:] = 0
            return np.zeros_like(b), 0
        sides, cut, taken, seen = self._sides[wall], self._cut[wall], 0, set[bytes]()
        for turn in range(_MAX_SETS):
            held = sides.any()
            y, cut, more = self._excess(wall, free, sides, cut) if held else (np.zeros_like(b), cut, 0)
            asked = b + self._kappa[wall] * y
            along = surface.along(surface.gridded(asked)) if held else free
            rows = surface.beyond(along, limit)
            volts = along[rows] @ surface.evaluate
            over = np.abs(volts) - limit
            found = np.zeros_like(sides)
            found[rows] = np.where(over > 0.0, np.sign(volts), 0.0)
            taken += more + 1
            near = np.full(sides.shape, np.inf)
            near[rows] = np.abs(over)
            doubtful = found != sides
            circles = found.tobytes() in seen
            if not doubtful.any() or ((circles or turn >= _WHOLE) and near[doubtful].max() <= 1e-7 * self._size):
                self._sides[wall], self._cut[wall] = sides, cut
                return -y, taken
            if circles:
                break
            seen.add(sides.tobytes())
            sides = found
        y, more = self._safely(wall, b, asked)
        return -y, taken + more

    def _safely(self, wall: int, b: FloatArray, asked: FloatArray) -> tuple[FloatArray, int]:
        """Return y by the iteration that always converges, from a guess of a, and how often it turned."""
        surface, limit, kappa = self._surface, self._limits[wall], self._kappa[wall]
        rate = float(np.abs(kappa / (2.0 - kappa)).max())
        enough = _TOLERANCE * self._size * (1.0 - rate) / max(rate, _TOLERANCE)
        for taken in range(1, _MOST_TURNS):
            along = surface.along(surface.gridded(asked))
            rows = surface.beyond(along, limit)
            volts, cut = along[rows] @ surface.evaluate, np.zeros(self._cut[wall].shape)
            cut[rows] = volts - np.clip(volts, -limit, limit)
            y = surface.amplitudes(cut[rows], rows)
            after = (b + kappa * (y - 0.5 * asked)) / (1.0 - 0.5 * kappa)
            change, asked = float(np.linalg.norm(after - asked)), after
            if change <= enough:
                self._sides[wall], self._cut[wall] = np.sign(cut).astype(np.int8), cut
                return y, taken
        raise _too_long()

    def _excess(self, wall: int, free: FloatArray, sides: Sides, start: FloatArray) -> tuple[FloatArray, FloatArray, int]:
        """Return y = P_h d, d at all points and the iterations, where some points are held; ``free`` is b along the axis."""
        surface, kappa = self._surface, self._kappa[wall]
        rows = np.flatnonzero(sides.any(axis=1))
        held, weight = sides[rows] != 0, self._weights[rows, None]

        def times(d: FloatArray) -> FloatArray:
            moved = surface.along(surface.gridded(kappa * surface.amplitudes(d, rows)))
            return np.asarray(np.where(held, d - moved[rows] @ surface.evaluate, 0.0))

        right = np.where(held, free[rows] @ surface.evaluate - sides[rows] * self._limits[wall], 0.0)
        d = np.where(held, start[rows], 0.0)
        left = right - times(d) if d.any() else right.copy()
        enough = (_TOLERANCE * self._size) ** 2 * float((weight * held).sum())
        way, square, taken = left.copy(), float((weight * left * left).sum()), 1
        while square > enough and taken < _MOST:
            turned = times(way)
            part = square / float((weight * way * turned).sum())
            d += part * way
            left -= part * turned
            before, square = square, float((weight * left * left).sum())
            way = left + (square / before) * way
            taken += 1
        if not square <= enough:
            raise _too_long()
        cut = np.zeros(sides.shape)
        cut[rows] = d
        return surface.amplitudes(d, rows), cut, taken


def _too_long() -> InputError:
    return InputError(
        "time_step",
        "is too long for amplifiers that stop at their limit: their voltages do not settle within a step",
        "use a quarter of it, or four times the refinement, or lower gains",
    )
