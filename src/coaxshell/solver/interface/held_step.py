"""One step of saturating actuators beside absorbers, by the few unknowns that are not linear.

With all that the voltages ask for given, the step is linear but for what is lacking where they are held at a limit,
l = clip(u) - u at the held points H of the circle, and for the cubic springs, n(D):

    u = u_0 + G B l + U (n - t V B l),        D = D_0 + X n - (dt/2 + X t) V B l,        l_H = s_H - u_H,        n = n(D),

B l the modes of l, s_H = +-1; G, one number a mode (and pair of walls), what voltages answer to voltages, V B l the velocities of the
points of the links, t = c + k dt/2 their tangents, X and U what stretches and voltages answer to inputs of the links. Newton's method
for n and l on H together, with the points beyond the limit as the next H, ends when it finds H again: a few unknowns for each link and
each point held instead of all modes. Both begin where the steps before lead; 1.1 to 1.4 iterations a step are then enough.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.interface.laws import CubicSprings
from coaxshell.solver.interface.saturation import CircleSums

_TOLERANCE = 1e-11
"""Of the springs' forces, relative to all that drives the links."""
_MOST_ITERATIONS = 40
_NOTHING = 1e-9
"""Of what voltages of a wall answer to its own, at most, what they answer to another's within a step is rounding."""
_NEAR = 0.85
"""Of the limit, beyond which points are near."""


class NotSettledError(Exception):
    """Raised where points are not found again, or too many are held for this to pay."""


class Linear(NamedTuple):
    """What one step answers, all actuators giving what is asked for; modes of both parities are in a row, K of them.

    Attributes
    ----------
    own : ndarray, shape (controlled, controlled, K)
        G.
    felt : ndarray, shape (2N, controlled * K)
        V.
    tangent : ndarray, shape (2N,)
        t.
    half : float
        dt/2.
    stretch : ndarray, shape (2N, 2N)
        X.
    asked : ndarray, shape (controlled * K, 2N)
        U.
    """

    own: FloatArray
    felt: FloatArray
    tangent: FloatArray
    half: float
    stretch: FloatArray
    asked: FloatArray


class Patch(NamedTuple):
    """Points near the limit, some of which are held, and what the lack at them answers.

    Attributes
    ----------
    at : ndarray of int, shape (P,)
        The points, in all of (controlled, points) one after the other.
    place : ndarray of int, shape (controlled * points,)
        Where each of all points is among them, -1 where it is not.
    around, back : list of ndarray, shapes (K, points there) and (points there, K)
        Of every wall, to its points and back.
    system : ndarray, shape (P, P)
        1 + G - U t V between the points.
    answered : ndarray, shape (P, 2N)
        U at the points.
    shortened : ndarray, shape (2N, P)
        (dt/2 + X t) V B.
    """

    at: npt.NDArray[np.intp]
    place: npt.NDArray[np.intp]
    around: list[FloatArray]
    back: list[FloatArray]
    system: FloatArray
    answered: FloatArray
    shortened: FloatArray


class Held(NamedTuple):
    """The end of a step, and where the next one begins.

    Attributes
    ----------
    asked, lack : ndarray, shape (controlled, K)
        u and B l.
    volts, before : ndarray, shape (controlled, points)
        u around the circle, and that of the step before.
    sides : ndarray, shape (controlled, points)
        +-1 where a voltage is held, 0 elsewhere.
    patch : Patch
        With all points held.
    stretches : tuple of ndarray, each of shape (2N,)
        D, and those of the two steps before.
    nonlinear : ndarray, shape (2N,)
        n(D).
    iterations : int
    """

    asked: FloatArray
    lack: FloatArray
    volts: FloatArray
    before: FloatArray
    sides: FloatArray
    patch: Patch
    stretches: tuple[FloatArray, FloatArray, FloatArray]
    nonlinear: FloatArray
    iterations: int


class HeldStep:
    """Newton's method for one step; constants only.

    Parameters
    ----------
    linear : Linear
    springs : CubicSprings
    circle : CircleSums
    shape : tuple of int
        Controlled walls, parities, M + 1.
    """

    def __init__(self, linear: Linear, springs: CubicSprings, circle: CircleSums, shape: tuple[int, int, int]) -> None:
        self._linear, self._springs, self._circle, self._shape = linear, springs, circle, shape
        self._walls, self._width = shape[0], shape[1] * shape[2]
        self._felt = linear.tangent[:, None] * linear.felt
        self._shortened = linear.half * linear.felt + linear.stretch @ self._felt
        largest = np.abs(linear.own).max(axis=-1)
        self._coupled = largest > _NOTHING * largest.max()
        self._most = self._walls * circle.points // 2

    def at_rest(self) -> Held:
        """Return what stands before the first step."""
        none, links = np.zeros((self._walls, self._width)), np.zeros(self._linear.stretch.shape[0])
        volts = np.zeros((self._walls, self._circle.points))
        return Held(none, none, volts, volts, volts, self._patch(volts), (links, links, links), links, 0)

    def _of_wall(self, wall: int) -> slice:
        return slice(wall * self._width, (wall + 1) * self._width)

    def _patch(self, volts: FloatArray) -> Patch:
        """Return the patch of all points near the limit."""
        linear, walls = self._linear, range(self._walls)
        near = np.abs(volts) > _NEAR
        at = [np.flatnonzero(one) for one in near]
        ends = np.cumsum([0, *(one.size for one in at)])
        if ends[-1] > self._most:
            raise NotSettledError
        parts = [slice(a, b) for a, b in pairwise(ends)]
        maps = [self._circle.some(one) for one in at]
        around, back = [one for one, _ in maps], [one for _, one in maps]
        answered = np.concatenate([around[i].T @ linear.asked[self._of_wall(i)] for i in walls])
        felt, shortened = (
            np.concatenate([one[:, self._of_wall(j)] @ back[j].T for j in walls], axis=1) for one in (self._felt, self._shortened)
        )
        system = np.eye(ends[-1]) - answered @ felt
        for i in walls:
            for j in walls:
                if self._coupled[i, j]:
                    system[parts[i], parts[j]] += (around[i].T * linear.own[i, j]) @ back[j].T
        every = np.flatnonzero(near)
        place = np.full(near.size, -1)
        place[every] = np.arange(every.size)
        return Patch(every, place, around, back, system, answered, shortened)

    def solve(self, asked: FloatArray, stretch: FloatArray, drive: float, before: Held) -> Held:
        """Return the end of a step.

        Parameters
        ----------
        asked, stretch : ndarray, shapes (controlled, K) and (2N,)
            u_0 and D_0.
        drive : float
            The largest input of a link.
        before : Held
            Of the step before, where it begins.

        Raises
        ------
        NotSettledError
        """
        springs, linear = self._springs, self._linear
        last, older, oldest = before.stretches
        z = 3.0 * (last - older) + oldest
        nonlinear = springs.nonlinear_part(z)
        patch = before.patch
        sides, patch = self._held(patch, 2.0 * before.volts - before.before)
        for iteration in range(1, _MOST_ITERATIONS + 1):
            slope = springs.linearise(z).slope
            lack, predicted, missing = self._newton(patch, sides, asked, stretch, nonlinear - slope * z, slope)
            z = stretch + linear.stretch @ predicted - missing
            nonlinear = springs.nonlinear_part(z)
            inputs = predicted - self._felt @ lack.ravel()
            reached = asked + (linear.asked @ inputs).reshape(asked.shape) + (linear.own * lack).sum(axis=1)
            volts = self._circle.at_points(reached.reshape(self._shape))
            scale = max(drive, float(np.abs(nonlinear).max(initial=0.0)))
            found, patch = self._held(patch, volts)
            if np.array_equal(found, sides) and float(np.abs(nonlinear - predicted).max(initial=0.0)) <= _TOLERANCE * scale:
                return Held(reached, lack, volts, before.volts, sides, patch, (z, last, older), nonlinear, iteration)
            sides = found
        raise NotSettledError

    def _held(self, patch: Patch, volts: FloatArray) -> tuple[FloatArray, Patch]:
        """Return the sides of the points beyond the limit, and a patch with all of them: the same if it has."""
        sides = np.trunc(np.clip(volts, -1.5, 1.5))
        if patch.place[np.flatnonzero(sides)].min(initial=0) < 0:
            patch = self._patch(volts)
        return sides, patch

    def _newton(
        self, patch: Patch, sides: FloatArray, asked: FloatArray, stretch: FloatArray, offset: FloatArray, slope: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return B l, n, and what l takes off the stretches, where n = offset + slope D and the points of ``sides`` are held."""
        at = np.flatnonzero(sides)
        held, links = patch.place[at], stretch.size
        count = held.size
        system, target = np.empty((count + links, count + links)), np.empty(count + links)
        system[:count, :count] = patch.system[held[:, None], held]
        system[:count, count:] = patch.answered[held]
        system[count:, :count] = slope[:, None] * patch.shortened[:, held]
        system[count:, count:] = -slope[:, None] * self._linear.stretch
        system.ravel()[count * (count + links + 1) :: count + links + 1] += 1.0
        near = np.concatenate([one @ around for one, around in zip(asked, patch.around, strict=True)])
        target[:count] = sides.ravel()[at] - near[held]
        target[count:] = offset + slope * stretch
        solution = np.asarray(np.linalg.solve(system, target), dtype=np.float64)
        beyond = np.zeros(patch.at.size)
        beyond[held] = solution[:count]
        lack, done = np.empty_like(asked), 0
        for wall, back in enumerate(patch.back):
            lack[wall] = beyond[done : done + len(back)] @ back
            done += len(back)
        return lack, solution[count:], np.asarray(patch.shortened @ beyond, dtype=np.float64)
