"""Frequencies at which feedback takes energy alone: no pole can be near there, and the determinants need not be followed.

Where every wall pushes with what it reads, of the same layers, by -c times its reading, C = -P W/s, what voltages are read as without
feedback: W = diag(c A), A the circumferences, and P symmetric with a positive Hermitian part wherever Re s > 0, since walls and fluids give
no energy. With the law H on all walls and the matrix K between them D/D0 = det(1 + (H/s) W K P). At an s at which

    |arg H/s| < pi/2 - beta,      tan beta = the largest |eigenvalue| of S^-1 (W K - (W K)')/2,  S = (W K + (W K)')/2 > 0,

it is not 0, nor with any share t in (0, 1] of the gain: (1 + t (H/s) W K P) x = 0 has y = P x, y* x = -t (H/s) y* W K y, of which the
right side would have a negative real part and the left has a positive one. So its argument, followed as t grows from 0, is one continuous
function of s there; all that it turns by between two nodes is the difference of its values at them, however often it turns in between. Of
one wall that is the principal argument; of several the sum of those of the walls closed one after the other, each a loop of that kind, or
of 1 + lambda, lambda the eigenvalues. Without a matrix each wall may have a law of its own, all within a right angle.

Of walls of elastic solids, which push with what they read but for parts of h/R, the shapes along them are asked instead, as in
:mod:`coaxshell.solver.passivity` but frequency by frequency: where the Hermitian part of (omega^2 + s^2 - t H d p')/s is positive definite
without feedback (t = 0, always) and with all of it, it is in between, each wall takes energy, and the same holds.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.solver.contour import NOWHERE, SPACING, Bands, Contour
from coaxshell.solver.electrode_loops import shares_of
from coaxshell.solver.scaling import FluidRegion, Problem
from coaxshell.solver.voltage_response import controlled
from coaxshell.structure.control_law import ControlLaw
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.electroded_wall import ElectrodedWall
from coaxshell.structure.shell_model import Gain

_TURN = 0.25
"""Radians by which a delay turns between frequencies at which a law is looked at."""
_ROUNDING = 1e-9
_DECADE = 24
"""Frequencies to a decade at which solid walls are asked."""
_SURE = 0.25
"""Share of a shape's own damping, sigma_0, that has to be left."""
_STEPS = 3
"""Even steps of a contour that a band is long at least."""


def taking_bands(problem: Problem, modes: Modes, contour: Contour) -> Bands:
    """Return where on a contour the feedback of all walls takes energy alone, in all orders of modes."""
    walls = [problem.shells[i] for i in controlled(problem)]
    slack = asymmetry(problem, modes)
    if slack is not None:
        laws = {id(wall.gains): wall.gains for wall in walls if wall.gains is not None}
        found = [_bands(law, modes.orders, contour, 0.5 * np.pi - slack) for law in laws.values()]
    elif _alone_and_solid(problem):
        found = [_solid_bands(wall, modes, contour) for wall in walls if isinstance(wall, ElasticWall)]
    else:
        return NOWHERE
    least, *others = found
    for other in others:
        least = _both(least, other)
    long = least.highs - least.lows > _STEPS * SPACING * contour.shift
    return Bands(least.lows[long], least.highs[long])


def all_taken(problem: Problem, modes: Modes, least: float) -> bool:
    """Return whether laws take energy alone wherever poles that grow by more than a rate per transit would be looked for."""
    if asymmetry(problem, modes) is None:
        return False
    contour = Contour.of(problem, modes, least)
    return taking_bands(problem, modes, contour).hold_all(contour)


def all_taken_in_waves(problem: Problem, waves: Sequence[Modes], least: float) -> bool:
    """Return the same of waves of ascending wavenumber.

    What walls push with and read is linear in 1, k and k^2, so that the first and the last, k = 0 or little more and the highest, tell of
    all; laws are the same in all waves and are asked at twice the highest frequency of these two.
    """
    ends = [waves[0], waves[-1]]
    if any(asymmetry(problem, modes) is None for modes in ends):
        return False
    first, last = (Contour.of(problem, modes, least) for modes in ends)
    if max(first.shift, last.shift) > least:
        return all(all_taken(problem, modes, least) for modes in waves)
    farther = last._replace(fades=2.0 * float(max(first.nodes[-1].imag, last.nodes[-1].imag)))
    return taking_bands(problem, waves[-1], farther).hold_all(farther)


def asymmetry(problem: Problem, modes: Modes) -> float | None:
    """Return beta, by how much less than a right angle a law may turn and still take energy alone; None if walls push otherwise.

    0 where W K is symmetric: of walls that answer themselves alone, and of matrices that do to each other what energy asks for.
    """
    known = np.ndim(modes.wavenumber) == 0 and all(fluid is None or type(fluid) is FluidRegion for fluid in problem.fluids)
    factors = [_factor(problem.shells[i], modes) for i in controlled(problem)] if known else [None]
    weights = np.array([0.0 if one is None else one for one in factors])
    if not (weights > 0.0).all():
        return None
    shares = shares_of(problem, controlled(problem))
    laws = {problem.shells[i].gains for i in controlled(problem)}
    if len(laws) > 1 and not np.array_equal(shares, np.diag(np.diag(shares))):
        return None
    tied = weights[:, None] * shares
    even, odd, size = 0.5 * (tied + tied.T), 0.5 * (tied - tied.T), np.abs(tied).max()
    lowest = float(np.linalg.eigvalsh(even)[0])
    if np.abs(odd).max() <= _ROUNDING * size:
        return 0.0 if lowest >= -1e-12 * size else None
    if lowest <= _ROUNDING * size:
        return None
    return float(np.arctan(np.abs(np.linalg.eigvals(np.linalg.solve(even, odd))).max()))


def _factor(wall: object, modes: Modes) -> float | None:
    """Return c A of a wall whose push is -c times what it reads in all orders; None of any other."""
    if not isinstance(wall, ElectrodedWall):
        return None  # what an elastic wall reads of the strain along it is its push but for parts of h/R
    push, read = (_parts(gain, modes) for gain in (wall.drive(modes), wall.sensor_gain(modes)))
    factor = float((push * read).sum() / max((read * read).sum(), 1e-300))
    same = np.allclose(push, factor * read, rtol=_ROUNDING, atol=_ROUNDING * np.abs(push).max())
    return -factor * wall.radius if same else None


def _parts(gain: Gain, modes: Modes) -> FloatArray:
    """Return a gain per unit V, W and U, where there is an axial wavenumber, (2 or 3, orders)."""
    axial = [] if modes.two_dimensional else [np.zeros_like(gain.w) if gain.u is None else gain.u]
    return np.stack([gain.v, gain.w, *axial])


def _bands(law: ControlLaw, orders: FloatArray, contour: Contour, most: float) -> Bands:
    """Return where |arg H/s| is less than an angle for all orders that a law weighs: where it turns by less than is left of that."""
    weights = np.broadcast_to(law.weight(orders), orders.shape)
    fed, places = np.unique(weights, return_index=True)
    weighed = orders[places[fed != 0.0]]
    last = float(contour.nodes[-1].imag)
    if not weighed.size:
        return Bands(np.zeros(1), np.array([last]))
    frequency = np.unique(np.concatenate([contour.nodes.imag, *_turning(law, contour, last)]))
    frequency = frequency[frequency <= last]
    s = contour.shift + 1j * frequency
    angle = np.angle(np.atleast_2d(law.at(s, Modes(weighed)) / s))
    left = np.minimum(most - np.abs(angle[:, 1:]), most - np.abs(angle[:, :-1]))
    taking = ((left >= 0.0) & (0.5 * np.abs(np.diff(angle, axis=1)) <= left)).all(axis=0)
    return _runs(frequency, np.asarray(taking))


def _turning(law: ControlLaw, contour: Contour, last: float) -> list[FloatArray]:
    """Return frequencies beside the law's own resonances, and as close as a delay turns it."""
    beside = np.sinh(np.linspace(-12.0, 12.0, 97))
    own = [np.abs(frequency + max(width, contour.shift) * beside) for frequency, width in law.resonances]
    return [*own, np.arange(0.0, last, _TURN / law.delay)] if law.delay else own


def _runs(frequency: FloatArray, steps: npt.NDArray[np.bool_]) -> Bands:
    """Return the runs of steps between ascending frequencies that are so."""
    turns = np.flatnonzero(np.diff(np.concatenate([[False], steps, [False]]).astype(int)))
    return Bands(frequency[turns[::2]], frequency[turns[1::2]])


def _alone_and_solid(problem: Problem) -> bool:
    """Return whether all walls under control are solid and answer themselves alone, in fluids that give no energy."""
    known = all(fluid is None or type(fluid) is FluidRegion for fluid in problem.fluids)
    return known and not problem.tied and all(isinstance(problem.shells[i], ElasticWall) for i in controlled(problem))


def held_in(problem: Problem, modes: Modes, contour: Contour) -> npt.NDArray[np.bool_]:
    """Return which orders solid walls take energy in with their feedback as far as any resonates; True of all where walls are others."""
    if not _alone_and_solid(problem):
        return np.ones(modes.count, dtype=np.bool_)
    walls = [wall for i in controlled(problem) if isinstance(wall := problem.shells[i], ElasticWall)]
    each = [_resistance(wall, modes, contour) for wall in walls]
    return np.asarray(np.all([(taken | (frequency > contour.even[-1])).all(axis=1) for frequency, taken in each], axis=0))


def _resistance(wall: ElasticWall, modes: Modes, contour: Contour) -> tuple[FloatArray, npt.NDArray[np.bool_]]:
    """Return frequencies, and at which of them the shapes along a wall take energy in each order, (orders, frequencies).

    omega^2 + s^2 - H d p' over s turns as H/s does and is smooth in s otherwise: no resonance of the wall is in its Hermitian part.
    """
    law, last = wall.gains, float(contour.nodes[-1].imag)
    if law is None or wall.closed_by_solver:
        return np.array([0.0, last]), np.full((modes.count, 2), wall.gains is None)
    smooth = np.geomspace(1e-2, last, int(_DECADE * np.log10(last / 1e-2)))
    frequency = np.unique(np.concatenate([[0.0, last], smooth, *_turning(law, contour, last)]))
    frequency = frequency[frequency <= last]
    return frequency, wall.along_resistance(modes, contour.shift + 1j * frequency) > _SURE * contour.shift


def _solid_bands(wall: ElasticWall, modes: Modes, contour: Contour) -> Bands:
    """Return where on a contour a solid wall takes energy with its feedback, in all orders of modes."""
    frequency, taken = _resistance(wall, modes, contour)
    return _runs(frequency, np.asarray((taken[:, 1:] & taken[:, :-1]).all(axis=0)))


def _both(one: Bands, other: Bands) -> Bands:
    """Return what two sets of bands share."""
    lows, highs = np.maximum.outer(one.lows, other.lows).ravel(), np.minimum.outer(one.highs, other.highs).ravel()
    shared = highs > lows
    ascending = np.argsort(lows[shared])
    return Bands(lows[shared][ascending], highs[shared][ascending])
