"""Whether feedback that ties walls or orders is stable: poles counted as :mod:`coaxshell.solver.stability` does, of all that is tied.

The determinant of a pattern q (an order, where electrodes are whole) over that without feedback is that of 1 - H K C_q, of as many rows as
walls; of all patterns together, and with dead segments of that between these,

    D/D0 = product over patterns of |1 - H K C_q|, times |[(1 - H K C)^-1] on the dead segments|,

the complementary minor: what is left of the loops of the live ones. Where laws take energy alone (:mod:`coaxshell.solver.taking_bands`) any
number of segments does, dead ones or not: nothing is counted where that is all of the contour, and without dead ones nothing there.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.control import PDControl
from coaxshell.model.feedback import Feedback
from coaxshell.model.gains import segments_of
from coaxshell.model.parts import laws_of
from coaxshell.model.prefixes import engineering
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.texts import rounded
from coaxshell.solver.contour import NOWHERE, Bands, Contour, along_alone, fed_orders, few_of, turned, turned_outside
from coaxshell.solver.electrode_loops import ElectrodeLoops
from coaxshell.solver.electrode_patterns import Patterns, patterns_of
from coaxshell.solver.scaling import Problem
from coaxshell.solver.stability import listed, remedy
from coaxshell.solver.taking_bands import taking_bands
from coaxshell.solver.tied import require_resolved
from coaxshell.solver.voltage_response import VoltageResponse, controlled

_BLOCK = 513  # a block of a contour shares a node with the next one
_SPACING = 0.8
_HALVINGS = 8
_STARTS, _ITERATIONS = 12, 40
_ROUGHLY = 1.2
"""How far apart rates may be between which the fastest growth is, before Newton's method takes over."""


@dataclass(frozen=True)
class Tied:
    """What feedback ties: the orders and walls of one wave.

    Attributes
    ----------
    modes : Modes
        Orders, and the axial wavenumber at which walls are stiffest of all that is tied.
    """

    modes: Modes

    @property
    def alone(self) -> bool:
        """Whether it is one wave, whose orders are those of its modes."""
        return True

    def response(self, passive: Problem, controls: Problem, s: ComplexArray) -> VoltageResponse:
        """Return what voltages are read as at some nodes; ``passive`` is the problem ``controls`` without its feedback."""
        return VoltageResponse.at(passive, controls, self.modes, s)

    @property
    def whole(self) -> bool:
        """Whether all patterns are one determinant, dead segments of all or not."""
        return False

    def factors(self, passive: Problem, controls: Problem, patterns: Patterns, s: ComplexArray) -> ComplexArray:
        """Return the factors of the determinants over those without feedback, (rows, nodes): see :meth:`ElectrodeLoops.factors`."""
        return ElectrodeLoops.of(controls, self.response(passive, controls, s), patterns, s).factors()

    @property
    def place(self) -> str:
        """Where along the axis, for a message; nothing in two dimensions."""
        k = float(self.modes.wavenumber)
        return f" at the axial wavenumber {k:.3g}/a" if k else ""


class PatternPoles(NamedTuple):
    """Patterns with poles that grow, how many each has, and the ratio of the determinants at the nodes of the contour."""

    patterns: FloatArray
    counts: FloatArray
    nodes: ComplexArray
    ratio: ComplexArray


def determinants(problem: Problem, passive: Problem, modes: Modes, nodes: ComplexArray) -> ComplexArray:
    """Return D/D0 of each pattern, shape (patterns, nodes), or, where dead segments tie them, of all together, (1, nodes)."""
    return _determinants(problem, passive, Tied(modes), nodes)


def _determinants(problem: Problem, passive: Problem, tied: Tied, nodes: ComplexArray) -> ComplexArray:
    each, one = _factors(problem, passive, tied, nodes)
    return each.prod(axis=0, keepdims=True) if one else each


def _factors(problem: Problem, passive: Problem, tied: Tied, nodes: ComplexArray) -> tuple[ComplexArray, bool]:
    """Return factors of D/D0, shape (rows, nodes), and whether they are those of one determinant, or of one pattern each."""
    found = []
    patterns = patterns_of(problem, controlled(problem), tied.modes.orders, 1)
    for start in range(0, nodes.size, _BLOCK):
        s = nodes[start : start + _BLOCK]
        found.append(tied.factors(passive, problem, patterns, s))
    return np.concatenate(found, axis=1), tied.whole or bool(patterns.dead)


def growing(problem: Problem, max_order: int, least: float, wavenumber: float = 0.0) -> PatternPoles | None:
    """Return the patterns with poles that grow, at an axial wavenumber, by more than a rate per transit; None if there can be none."""
    return growing_of(problem, Tied(Modes.up_to(max_order, wavenumber)), least)[0]


def growing_of(problem: Problem, tied: Tied, least: float) -> tuple[PatternPoles | None, float]:
    """Return them of what is tied, and the least ratio of determinants on the contour, infinite where nothing had to be counted."""
    modes = tied.modes
    contour = Contour.of(problem, modes, least)
    slow = along_alone(problem, modes)
    bands = taking_bands(slow, modes, contour)
    if bands.hold_all(contour):
        return None, np.inf
    if tied.alone and segments_of(problem.system) is None:  # orders stand alone: those that are fed back, each as far as it resonates
        some = few_of(modes, fed_orders(problem, modes))
        if not some.count:
            return None, np.inf
        turns, nearest = _alone(problem, some, least)
        if not (np.rint(-turns / np.pi) > 0.0).any():
            return None, nearest
    elif bands.lows.size and not _in_one(slow, tied):
        found, nearest = _counted(slow, tied, contour, bands)
        if found is None:
            return None, nearest
    return _counted(slow, tied, contour)


def _alone(problem: Problem, modes: Modes, least: float) -> tuple[FloatArray, float]:
    """Return how far the determinants of orders that stand alone turn, and the least of them."""
    slow, contour = along_alone(problem, modes), Contour.of(problem, modes, least)
    passive, bands = slow.open_loop, taking_bands(slow, modes, contour)
    return turned(slow, modes, contour, partial(_ratio, slow, passive), bands, partial(_angle, slow, passive, Tied(modes)))


def _ratio(problem: Problem, passive: Problem, nodes: ComplexArray, modes: Modes) -> ComplexArray:
    return determinants(problem, passive, modes, nodes)


def _angle(problem: Problem, passive: Problem, tied: Tied, nodes: ComplexArray, modes: Modes | None = None) -> FloatArray:
    """Return the argument of D/D0 of each pattern as it is followed from no feedback, where laws take energy alone: of 1 + lambda each."""
    own = tied if modes is None else Tied(modes)
    patterns = patterns_of(problem, controlled(problem), own.modes.orders, 1)
    loops = ElectrodeLoops.of(problem, own.response(passive, problem, nodes), patterns, nodes)
    return np.asarray(np.angle(np.linalg.eigvals(loops.matrix)).sum(axis=-1))


def _in_one(problem: Problem, tied: Tied) -> bool:
    """Return whether all patterns are one determinant."""
    return tied.whole or bool(patterns_of(problem, controlled(problem), tied.modes.orders, 1).dead)


def counted(problem: Problem, modes: Modes, contour: Contour) -> PatternPoles | None:
    """Return the patterns with poles right of a contour; where the determinant turns fast between nodes there are more of them."""
    return _counted(problem, Tied(modes), contour)[0]


def _counted(problem: Problem, tied: Tied, contour: Contour, bands: Bands = NOWHERE) -> tuple[PatternPoles | None, float]:
    """Return them, and the least ratio of determinants on the contour, followed outside of bands where laws take energy alone."""
    passive, runs = problem.open_loop, bands.left(contour.nodes.imag)
    if not runs:
        return None, np.inf
    nodes = np.asarray(contour.shift + 1j * np.unique(np.concatenate(runs)), dtype=np.complex128)
    ratio, one = _factors(problem, passive, tied, nodes)
    for _ in range(_HALVINGS):
        quick = (np.abs(np.angle(ratio[:, 1:] / ratio[:, :-1])).max(axis=0) > _SPACING) & ~bands.between(nodes)
        if not quick.any():
            break
        between = 0.5 * (nodes[1:] + nodes[:-1])[quick]
        nodes = np.append(nodes, between)
        ratio = np.append(ratio, _factors(problem, passive, tied, between)[0], axis=1)
        ascending = np.argsort(nodes.imag)
        nodes, ratio = nodes[ascending], ratio[:, ascending]
    turned, nearest = turned_outside(nodes, ratio, bands, partial(_angle, problem, passive, tied)), float(np.abs(ratio).min())
    if one:  # the product of many turns too far between nodes
        turned, ratio = turned.sum(keepdims=True), ratio.prod(axis=0, keepdims=True)
    counts = np.rint(-turned / np.pi)
    bad = np.flatnonzero(counts > 0)
    return (PatternPoles(bad.astype(np.float64), counts[bad], nodes, ratio[bad]) if bad.size else None), nearest


class PatternGrowth(NamedTuple):
    """The fastest growing motion found: e^{(rate + i frequency) t} in a pattern, t in transits; NaN where only its rate is known."""

    pattern: int
    rate: float
    frequency: float


def fastest_growth(problem: Problem, max_order: int, found: PatternPoles, least: float, wavenumber: float = 0.0) -> PatternGrowth:
    """Return the fastest growth: its rate is enclosed by contours, from the last of which Newton's method finds the pole beside it."""
    return fastest_growth_of(problem, Tied(Modes.up_to(max_order, wavenumber)), found, least)


def fastest_growth_of(problem: Problem, tied: Tied, found: PatternPoles, least: float) -> PatternGrowth:
    """Return the fastest growth of what is tied."""
    modes, low, high = tied.modes, least, 4.0 * least
    problem = along_alone(problem, modes)
    while (beyond := _counted(problem, tied, Contour.of(problem, modes, high))[0]) is not None:
        found, low, high = beyond, high, 4.0 * high
    while high > _ROUGHLY * low:
        middle = float(np.sqrt(low * high))
        beyond = _counted(problem, tied, Contour.of(problem, modes, middle))[0]
        found, low, high = (found, low, middle) if beyond is None else (beyond, middle, high)
    best = PatternGrowth(int(found.patterns[0]), low, np.nan)
    for row, ratio in zip(found.patterns, found.ratio, strict=True):
        slope = np.gradient(ratio, found.nodes)
        way = np.abs(ratio / np.where(slope == 0.0, 1e-300, slope))
        lowest = np.flatnonzero((way <= np.append(way[1:], np.inf)) & (way <= np.append(np.inf, way[:-1])))
        nearest = [np.argsort(way)[:_STARTS], lowest[np.argsort(way[lowest])[:_STARTS]]]
        starts = found.nodes[np.unique(np.concatenate(nearest))]
        s = _newton(problem, tied, int(row), starts, 0.5 * low)
        if s.size and s.real.max() > best.rate:
            fastest = s[s.real.argmax()]
            best = PatternGrowth(int(row), float(fastest.real), abs(float(fastest.imag)))
    return best


def _newton(problem: Problem, tied: Tied, row: int, s: ComplexArray, slowest: float) -> ComplexArray:
    """Return the zeros of a pattern's determinant that Newton's method finds from some places, none left of a rate."""
    passive, change, farthest = problem.open_loop, s, 2.0 * np.abs(s).max(initial=0.0)
    for _ in range(_ITERATIONS):
        step = 1e-6 * np.abs(s)
        here, ahead = _determinants(problem, passive, tied, np.concatenate([s, s + step]))[row].reshape(2, -1)
        change = here * step / np.where(ahead == here, 1e-300, ahead - here)
        near = np.abs(s - change) < farthest
        s, change = (s - change)[near], change[near]
        s = np.maximum(s.real, slowest) + 1j * s.imag
        if (np.abs(change) < 1e-9 * np.abs(s)).all():  # also where none is left
            break
    return np.asarray(s[np.abs(change) < 1e-6 * np.abs(s)])


def nearest_ratio_of_tie(problem: Problem, tied: Tied, least: float) -> float:
    """Return the least ratio of determinants, infinite where nothing had to be counted; 0 where a pattern grows by more than a rate."""
    found, nearest = growing_of(problem, tied, least)
    return nearest if found is None else 0.0


def growth_of_tie_beyond(problem: Problem, tied: Tied, rate: float) -> float:
    """Return the rate of the fastest growth of what is tied, or the rate given where nothing grows faster."""
    found, _ = growing_of(problem, tied, rate)
    return rate if found is None else fastest_growth_of(problem, tied, found, rate).rate


def require_stable_ties(problem: Problem, max_order: int, duration: float, wavenumber: float = 0.0) -> float:
    """Raise InputError if loops that are tied would grow by a factor e within the duration, or if a plane run does not resolve segments.

    At an axial *wavenumber* above 0 patterns have the orders that the wave has, which may be none. What is returned of a stable loop is how
    near it is: the least ratio of determinants on the contour, infinite where nothing had to be counted.
    """
    if wavenumber == 0.0:
        require_resolved(problem, max_order)
    return require_stable_tie(problem, Tied(Modes.up_to(max_order, wavenumber)), duration)


def require_stable_tie(problem: Problem, tied: Tied, duration: float) -> float:
    """Raise InputError, and return how near it is to growing, as :func:`require_stable_ties` of what is tied."""
    found, nearest = growing_of(problem, tied, 1.0 / duration)
    if found is None:
        return nearest
    cut, laws = segments_of(problem.system), laws_of(problem.system)
    fastest = fastest_growth_of(problem, tied, found, 1.0 / duration)
    turns = fastest.frequency if not fastest.frequency < 1e-9 * fastest.rate else 0.0  # rounding of a real pole
    hertz = turns / (2.0 * np.pi * problem.scales.time)
    if laws[0].dead or tied.whole:
        where = f"{found.counts[0]:.0f} motions, of all orders together, grow without bound, the fastest"
    else:
        orders, grow = listed(found.patterns)
        where = f"{orders} of all shells together {grow} without bound, fastest order {fastest.pattern}"
        if cut is not None:
            others = ", ".join(map(str, sorted({cut - fastest.pattern, cut + fastest.pattern} - {fastest.pattern})))
            them = "it" if found.patterns.size == 1 else "them"
            where = f"{orders}, with those that {cut} segments tie to {them}, {grow} without bound, fastest order "
            where += f"{fastest.pattern} with {others}, ..."
    entries, value = _guilty(laws[0]) if len(laws) == 1 else ("control", "these laws together")
    told = f"by e^({rounded(fastest.rate, 3)} t), t in transits" + (f", at {engineering(hertz, 'Hz')}" if np.isfinite(hertz) else "")
    raise InputError(entries, f"{value} makes the closed loop unstable{tied.place}: {where} {told}", remedy(problem))


def _guilty(control: PDControl | Feedback) -> tuple[str, str]:
    """Return what of the control is to be changed, and its value."""
    if isinstance(control, Feedback):
        if control.delay:
            return "control.delay", engineering(control.delay, "s")
        if control.matrix is not None:
            return "control.matrix", str([list(row) for row in control.matrix])
        return "control.numerator", str(list(control.numerator))
    gains = {name: getattr(control, name) for name in ("proportional", "derivative")}
    negative = [name for name, gain in gains.items() if np.any(np.asarray(gain) < 0.0)] or list(gains)
    return " and ".join(f"control.{name}" for name in negative), " and ".join(str(gains[name]) for name in negative)
