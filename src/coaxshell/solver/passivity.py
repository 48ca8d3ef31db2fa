"""Orders whose feedback cannot make a loop unstable, found without the fluids: walls that stay passive with it.

Fluids take energy from a wall and never give any: the load that they add to its normal motion, over s, has a positive real part wherever
Re s > 0. A wall whose own impedance with feedback, Z(s)/s, has one too on all of Re s = sigma_0 has it everywhere to the right (a harmonic
function is least on the boundary), and then no fluid and no other such wall can make their determinant zero there. Where feedback acts
on V as well, V alone has to be passive first, so that Z has no poles.

In waves along the axis U and V together have to be: the Hermitian part of their 2 x 2, over s, is positive definite.

Of a wall of solids the shapes along it are asked, which alone hear and answer volts: omega^2 + s^2 - H d p' on them, over s, has to have a
positive definite Hermitian part, and then its faces, too, take energy from what presses on them. Where one layer senses and acts, d and -p
are alike but for a hundredth or less.

The line is walked at nodes as far from each other as the functions bend: beside each resonance of V (of U and V) and of the law at
distances that grow from sigma_0, and by a growing step in between. A delay turns the feedback between nodes: where by more than half a
radian, its phase counts at its worst.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.solver.scaling import FluidRegion, Problem
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.shell_model import ShellModel

Orders = npt.NDArray[np.bool_]
"""Of each order, whether."""

_LOWEST, _HIGHEST = 1e-2, 1e8
_DECADE = 6
"""Nodes to a decade where nothing resonates."""
_BESIDE = 0.35
"""Nodes beside a resonance of width sigma lie at sigma sinh(0.35 k)."""
_TURNED = 0.5
"""Radians by which a delay may turn between nodes that are taken as they are."""
_LATE = 400
"""Nodes by which a delay is followed."""
_SURE = 0.25
"""Share of the wall's own damping, M sigma_0, that has to be left: what lies between the nodes is smooth to better than that."""


def passive_orders(problem: Problem, modes: Modes, least: float) -> Orders:
    """Return which orders no feedback of the problem can make grow by more than a rate per transit; True only where that is certain."""
    known = np.ndim(modes.wavenumber) == 0 and all(fluid is None or type(fluid) is FluidRegion for fluid in problem.fluids)
    found = np.full(modes.count, known)
    for wall in problem.shells:
        if wall.gains is not None and found.any() and isinstance(wall, ElasticWall):
            found &= _passive_solid(wall, modes, least)
        elif wall.gains is not None and found.any():
            found[found] = _passive(wall, Modes(modes.orders[found], modes.wavenumber, modes.sparse), least)
    return found


def _passive(wall: ShellModel, modes: Modes, least: float) -> Orders:
    """Return for which orders a wall is passive with its feedback on Re s = *least*."""
    assert wall.gains is not None
    fed: Orders = np.asarray(wall.gains.weight(modes.orders)) * np.ones(modes.count) != 0.0
    if not fed.any():
        return np.ones_like(fed)
    passive: Orders = ~fed
    if wall.gains.delay and not modes.two_dimensional:
        return passive  # a delay that no node follows would have to be bounded along the wall too
    some = Modes(modes.orders[fed], modes.wavenumber, modes.sparse)
    s = np.asarray(least + 1j * _frequencies(wall, some, least), dtype=np.complex128)
    resistance = wall.resistance(some, s)
    if wall.gains.delay:
        gaps = np.diff(s.imag, axis=1)
        turns = wall.gains.delay * np.maximum(gaps, np.roll(gaps, 1, axis=1)) > _TURNED
        worst = np.concatenate([turns[:, :1], turns], axis=1)
        whole, alone = (np.asarray(one.operator(some, s).impedance) for one in (wall, wall.with_gains(None)))
        fed_back = np.abs((whole - alone) / s)
        resistance = np.where(worst, np.minimum(resistance, wall.mass * least - fed_back), resistance)
    passive[fed] = (resistance > _SURE * wall.mass * least).all(axis=1)
    return passive


def _passive_solid(wall: ElasticWall, modes: Modes, least: float) -> Orders:
    """Return for which orders the shapes of a wall that bends and stretches along itself alone are passive with its feedback."""
    assert wall.gains is not None
    fed: Orders = np.asarray(wall.gains.weight(modes.orders)) * np.ones(modes.count) != 0.0
    if wall.gains.delay or wall.closed_by_solver:
        return ~fed
    s = np.asarray(least + 1j * np.sort(np.concatenate(_common(wall, least))), dtype=np.complex128)
    return ~fed | (wall.along_resistance(modes, s) > _SURE * least).all(axis=1)


def _frequencies(wall: ShellModel, modes: Modes, least: float) -> FloatArray:
    """Return where the line of Re s = *least* is looked at, ascending, shape (orders, nodes)."""
    assert wall.gains is not None
    common, beside = _common(wall, least), _beside(least)
    if wall.gains.delay:
        common.append(np.arange(0.0, _LATE) * (_TURNED / wall.gains.delay))
    own = {x.tobytes(): x for one in (wall.with_gains(None), wall) for x in one.along_frequencies(modes).T}
    each = [np.abs(x[:, None] + least * beside) for x in own.values()]
    rows = [np.broadcast_to(x, (modes.count, x.size)) for x in common]
    return np.sort(np.concatenate([*rows, *each], axis=1), axis=1)


def _common(wall: ShellModel, least: float) -> list[FloatArray]:
    """Return those of them that follow the resonances of the law, and all else that is smooth."""
    assert wall.gains is not None
    everywhere = np.geomspace(_LOWEST, _HIGHEST, int(_DECADE * np.log10(_HIGHEST / _LOWEST)))
    resonant = [np.asarray(np.abs(frequency + max(width, least) * _beside(least))) for frequency, width in wall.gains.resonances]
    return [np.zeros(1), everywhere, *resonant]


def _beside(least: float) -> FloatArray:
    """Return the distances of nodes from a resonance over its width."""
    far = np.arcsinh(1e4 / least)
    return np.asarray(np.sinh(np.linspace(-far, far, int(2 * far / _BESIDE))))
