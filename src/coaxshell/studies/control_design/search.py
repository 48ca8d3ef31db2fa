"""The search for the numbers of a law: quasi-random places first, then the simplex of Nelder and Mead from the best of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.structure.control_law import RationalLaw
from coaxshell.studies.control_design.bench import Bench, Effect, Margins
from coaxshell.studies.control_design.kinds import Kind, Polynomials, Reference, with_corner

_PLACES = {1: 8, 2: 16, 3: 48}
"""Places at which a search begins, by how many numbers there are."""
_STEPS = 40
_REFUSED = 10.0
"""Score of what keeps no limit at all; the share of the stress that is left is 1 without control."""


@dataclass(frozen=True)
class Limits:
    """What a law has to keep.

    Attributes
    ----------
    gain_margin : float
        Factor on the gain, and one over it where less gain is what makes it grow.
    phase_margin : float
        Radians.
    volts : ndarray
        Of each controlled shell.
    ceramic : float or None
        Largest hoop stress of the ceramics, Pa.
    """

    gain_margin: float
    phase_margin: float
    volts: FloatArray
    ceramic: float | None = None


class Trial(NamedTuple):
    """One law that was tried.

    Attributes
    ----------
    kind : str
    highest : int
        The highest order that is fed back.
    polynomials : tuple
        Numerator and denominator without corner, s in transits.
    score : float
        The share of the stress that is left, plus what it lacks of the limits.
    margins : Margins
    effect : Effect or None
        None of a law whose loop lacks the margins.
    """

    kind: str
    highest: int
    polynomials: Polynomials
    score: float
    margins: Margins
    effect: Effect | None

    @property
    def kept(self) -> bool:
        """Whether it keeps all limits."""
        return self.score < _REFUSED and self.effect is not None


@dataclass(frozen=True)
class Search:
    """The search for laws that leave least of the stress of some shells.

    Attributes
    ----------
    bench : Bench
    limits : Limits
    counted : ndarray of bool
        Of the controlled shells, those whose stress counts: the largest share that is left of any.
    delay : float
        Transits.
    corner : float or None
        Radians per transit.
    """

    bench: Bench
    limits: Limits
    counted: FloatArray
    delay: float
    corner: float | None

    @cached_property
    def frequency(self) -> float:
        """The ring frequency of the controlled shells, radians per transit."""
        walls = self.bench.problem.shells
        return max(float(walls[i].highest_frequency(Modes(np.ones(1)))[0]) for i in self.bench.at_run.shells)

    def reference(self, highest: int) -> Reference:
        """Return g and omega_0 for laws of the orders up to one."""
        at_rest = self.bench.contour.transfer[..., : highest + 1, 0].real
        own = np.stack([at_rest[i, i] for i in range(len(at_rest))]).ravel()
        largest = own[np.abs(own).argmax()]
        return Reference(-1.0 / float(largest), self.frequency)

    def best(self, kind: Kind, highest: int) -> Trial:
        """Return the best law of a kind that feeds back the orders up to one."""
        from scipy import optimize
        from scipy.stats import qmc

        known: list[Trial] = []
        low, high = np.log(np.array(kind.bounds)).T

        def score(x: FloatArray) -> float:
            inside = np.clip(x, low, high)
            known.append(self.tried(kind, highest, np.exp(inside)))
            return known[-1].score + float(np.abs(x - inside).sum())

        dimensions = len(kind.bounds)
        places = qmc.Halton(dimensions, scramble=False).random(_PLACES[dimensions] + 1)[1:]
        scores = [score(low + (high - low) * place) for place in places]
        start = low + (high - low) * places[int(np.argmin(scores))]
        simplex = np.vstack([start, start + 0.12 * np.diag(high - low)])
        options = {"maxfev": _STEPS, "initial_simplex": simplex, "xatol": 0.02, "fatol": 1e-3}
        optimize.minimize(score, start, method="Nelder-Mead", options=options)  # type: ignore[call-overload]
        return min(known, key=lambda one: one.score)

    def law(self, polynomials: Polynomials, highest: int) -> RationalLaw:
        """Return a law with corner, delay and modal filter."""
        return RationalLaw(*with_corner(polynomials, self.corner), self.delay, highest)

    def tried(self, kind: Kind, highest: int, numbers: FloatArray) -> Trial:
        """Return a law of some numbers, judged."""
        polynomials = kind.made(numbers, self.reference(highest))
        law = self.law(polynomials, highest)
        margins = self.bench.margins(law, highest)
        lack = sum(self._lacks(margins))
        if lack > 0.0:
            return Trial(kind.name, highest, polynomials, _REFUSED + lack, margins, None)
        effect = self.bench.effect(law)
        over = max(float((effect.volts / self.limits.volts).max()) - 1.0, 0.0)
        if self.limits.ceramic is not None:
            over += max(float(effect.ceramic.max()) / self.limits.ceramic - 1.0, 0.0)
        left = float((effect.core / self.bench.without.core)[self.counted].max())
        return Trial(kind.name, highest, polynomials, _REFUSED + over if over else left, margins, effect)

    def _lacks(self, margins: Margins) -> Iterator[float]:
        """Yield what a loop lacks of each margin, relative; all of it and more where poles grow."""
        if margins.unstable:
            yield 3.0 + margins.unstable
            return
        wanted = np.log(self.limits.gain_margin)
        if wanted > 0.0:
            yield max(1.0 - np.log(margins.gain) / wanted, 0.0)
            yield max(1.0 + np.log(margins.lesser) / wanted, 0.0) if margins.lesser > 0.0 else 0.0
        if self.limits.phase_margin > 0.0:
            yield max(1.0 - margins.phase / self.limits.phase_margin, 0.0)
