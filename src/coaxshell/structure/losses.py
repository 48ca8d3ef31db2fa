"""How the modulus of a layer depends on the Laplace variable s: a factor g(s) on the modulus that it has at one frequency, or at rest.

Springs and dampers in series beside a spring, a Prony series,

    g(s) = g_0 + sum_i g_i s tau_i/(1 + s tau_i),        g_0, g_i, tau_i > 0,

are causal and passive whatever their numbers are. A loss factor that is the same at all frequencies of a band is had in two ways.

- A fit: poles half a decade beyond both ends of the band, evenly spaced in the logarithm, and strengths g_i >= 0 by least squares of
  Im g - eta Re g, which is linear in them. Below the band it is a spring, above it a stiffer one.
- Kjartansson's constant Q, g = (s/w_0)^{2 gamma} with gamma = arctan(eta)/pi, whose loss factor is tan(pi gamma) = eta at all frequencies;
  it has no limit at rest (a constant load creeps) nor at a front. As a Prony series it is a continuous one,

      s^a = (sin(pi a)/pi) integral of s/(s + x) x^{a - 1} dx over x > 0,      a = 2 gamma < 1,

  of which the trapezoidal rule in ln x, with a step h, makes arms that err by 2 exp(-pi^2/h) at all s = i w within their range.

Both have |g(i w_0)| = 1 at the reference frequency. E. Kjartansson, Constant Q-wave propagation and attenuation, J. Geophys. Res. 84 (1979)
4737-4748. Everything here is dimensionless: times in transits, frequencies in radians per transit.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple, Protocol

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray

ARM_SPACING = 0.75
"""Decades between the poles of a fit, at most: eta is then held within 2 % over the band, within 5 % where it is above 0.3."""
_BEYOND = 0.5
"""Decades by which poles reach beyond the band."""
_GRADES = 2.0
"""Ends of bands are rounded outwards to so many to the decade, so that runs of similar steps have the same material."""
_TRAPEZOIDAL = 0.7
"""Step of ln x of the arms that stand for constant Q: they err by 2e-6 at most."""
_MARGIN = 1e2
"""Factor by which those arms reach beyond the band."""


class Band(NamedTuple):
    """Lowest and highest angular frequency of a run."""

    low: float
    high: float

    @classmethod
    def of(cls, duration: float, time_step: float) -> Band:
        """Return that of a run: from pi/T to pi/dt, rounded outwards to half a decade."""
        low, high = (_GRADES * math.log10(math.pi / time) for time in (duration, time_step))
        return cls(10.0 ** (math.floor(low + 1e-9) / _GRADES), 10.0 ** (math.ceil(high - 1e-9) / _GRADES))

    def with_frequency(self, frequency: float) -> Band:
        """Return the band that holds a frequency too."""
        return Band(min(self.low, frequency), max(self.high, frequency))


USUAL_BAND = Band.of(5.0, 1e-3)
"""That of a run at the default settings."""


class Relaxation(Protocol):
    """A factor g(s) on a modulus."""

    def at(self, s: ComplexArray) -> ComplexArray:
        """Return g at Laplace nodes."""

    @property
    def stiffest(self) -> float:
        """The largest |g| of the run: that of a front, or at the highest frequency of the band."""

    @property
    def series(self) -> Prony:
        """The Prony series that it is, or that stands for it in energies."""


@dataclass(frozen=True)
class Prony:
    """A Prony series.

    Attributes
    ----------
    at_rest : float
        g_0.
    strengths, times : tuple of float
        g_i and tau_i.
    """

    at_rest: float
    strengths: tuple[float, ...]
    times: tuple[float, ...]

    def at(self, s: ComplexArray) -> ComplexArray:
        """Return g at Laplace nodes."""
        total = np.full(np.shape(s), complex(self.at_rest))
        for strength, time in zip(self.strengths, self.times, strict=True):
            total += strength * (s * time) / (1.0 + s * time)
        return total

    @property
    def stiffest(self) -> float:
        """g of a front, the sum of all strengths."""
        return self.at_rest + sum(self.strengths)

    @property
    def series(self) -> Prony:
        """Itself."""
        return self

    def times_factor(self, factor: float) -> Prony:
        """Return it times a factor."""
        return Prony(factor * self.at_rest, tuple(factor * x for x in self.strengths), self.times)


@dataclass(frozen=True)
class ConstantQ:
    """Kjartansson's power law, (s/w_0)^{2 gamma}.

    Attributes
    ----------
    exponent : float
        2 gamma.
    reference : float
        w_0.
    band : Band
        Of the run: where arms stand for it in energies, and where it is stiffest.
    """

    exponent: float
    reference: float
    band: Band

    def at(self, s: ComplexArray) -> ComplexArray:
        """Return g at Laplace nodes."""
        return np.asarray((s / self.reference) ** self.exponent)

    @property
    def stiffest(self) -> float:
        """|g| at the highest frequency of the band."""
        return float((self.band.high / self.reference) ** self.exponent)

    @property
    def series(self) -> Prony:
        """Arms by the trapezoidal rule in ln x; all those below their range are one, and all above: to second order what they are."""
        a, h, low, high = self.exponent, _TRAPEZOIDAL, self.band.low / _MARGIN, self.band.high * _MARGIN
        x = low * np.exp(h * np.arange(math.ceil(math.log(high / low) / h) + 1))
        slow = [x[0] ** p / math.expm1(p * h) for p in (a, a + 1.0)]  # geometric sums of x^p over all that is left out
        fast = [x[-1] ** p / math.expm1(-p * h) for p in (a - 1.0, a - 2.0)]
        strengths = np.array([slow[0], *x**a, fast[0] ** 2 / fast[1]])
        times = np.array([slow[0] / slow[1], *(1.0 / x), fast[1] / fast[0]])
        scale = h * math.sin(math.pi * a) / math.pi * self.reference**-a
        return Prony(0.0, tuple((scale * strengths).tolist()), tuple(times.tolist()))


def exponent_of(loss_factor: float) -> float:
    """Return 2 gamma = 2 arctan(eta)/pi, the power with which moduli grow with the frequency."""
    return 2.0 * math.atan(loss_factor) / math.pi


def constant_q(loss_factor: float, reference: float, band: Band) -> ConstantQ:
    """Return the power law of a loss factor, 1 in magnitude at the reference frequency."""
    return ConstantQ(exponent_of(loss_factor), reference, band)


def arm_count(band: Band) -> int:
    """Return how many arms a fit over a band has unless told."""
    return 1 + math.ceil((math.log10(band.high / band.low) + 2.0 * _BEYOND) / ARM_SPACING - 1e-9)


@lru_cache(maxsize=256)
def prony_fit(loss_factor: float, reference: float, band: Band, arms: int | None = None) -> Prony:
    """Return the Prony series whose loss factor is the wanted one over a band, by non-negative least squares.

    Parameters
    ----------
    loss_factor : float
        eta, above 0.
    reference : float
        Angular frequency at which |g| = 1.
    band : Band
        Where eta is wanted.
    arms : int, optional
        How many.
    """
    from scipy.optimize import nnls

    count, beyond = arms or arm_count(band), 10.0**_BEYOND
    rates = np.geomspace(band.low / beyond, band.high * beyond, count)
    frequency = np.geomspace(band.low, band.high, 20 * count)
    x = frequency[:, None] / rates
    weight = (frequency / band.low) ** -exponent_of(loss_factor) / loss_factor  # eta relative, whatever the modulus has grown to
    strengths, _ = nnls((x - loss_factor * x * x) / (1.0 + x * x) * weight[:, None], loss_factor * weight)
    kept = strengths > 0.0
    fitted = Prony(1.0, tuple(strengths[kept].tolist()), tuple((1.0 / rates[kept]).tolist()))
    return fitted.times_factor(1.0 / float(abs(fitted.at(np.array([1j * reference]))[0])))


def relaxing_sum(base: float, at_rest: float, strengths: FloatArray, times: FloatArray) -> Prony:
    """Return 1/(base + x(s)), negated, as far as it relaxes: the arms of -1/(base + x) of a Prony series x.

    1/D(s) with D = D_inf - b' (s + R)^{-1} b, R the rates 1/tau_i and b_i^2 = x_i/tau_i, is

        1/D_inf + b' (s + R - b b'/D_inf)^{-1} b/D_inf^2:

    its poles are eigenvalues of a symmetric matrix, and -1/D = -1/D(0) + sum_j c_j s T_j/(1 + s T_j), c_j > 0.
    """
    rates = 1.0 / times
    instant, b = base + at_rest + strengths.sum(), np.sqrt(strengths * rates)
    poles, vectors = np.linalg.eigh(np.diag(rates) - np.outer(b, b) / instant)
    residues = (b @ vectors) ** 2 / instant**2
    return Prony(-1.0 / (base + at_rest), tuple((residues / poles).tolist()), tuple((1.0 / poles).tolist()))
