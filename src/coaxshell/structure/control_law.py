"""Control laws as the walls see them, dimensionless: u = H(s) phi_s, for each order."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes


class ControlLaw(ABC):
    """The feedback of one wall, from its sensor's potential to its actuator's voltage."""

    delay: float

    @abstractmethod
    def at(self, s: ComplexArray, modes: Modes) -> ComplexArray:
        """Return u per phi_s, H(s) e^{-s delay}: shape (nodes,), or (orders, nodes) where orders differ."""

    @abstractmethod
    def at_once(self, modes: Modes) -> FloatArray | float:
        """Return u per dphi_s/dt as s grows, of each order as a column or of all: what answers a jump of the velocity at once."""

    @abstractmethod
    def weight(self, orders: FloatArray) -> FloatArray | float:
        """Return by what each order is fed back."""

    @abstractmethod
    def stiffening(self, orders: FloatArray, frequency: FloatArray) -> FloatArray | float:
        """Return the real part of H at the frequency of each order, before the delay."""

    @abstractmethod
    def rate(self, size: FloatArray) -> FloatArray:
        """Return how fast the loop of each order damps at most, where |H| of it is divided by its inertia's omega^2/size."""

    @abstractmethod
    def fades(self, size: FloatArray) -> float:
        """Return a frequency above which |H| size < omega^2/2 for all sizes: feedback is less than half of the inertia."""

    @abstractmethod
    def late(self, delay: float) -> Self:
        """Return the law that answers by as much later."""

    @abstractmethod
    def times(self, factor: float) -> Self:
        """Return the law with a factor on its gain."""

    @property
    def zero(self) -> bool:
        """Whether nothing is fed back."""
        return False

    @property
    def resonances(self) -> tuple[tuple[float, float], ...]:
        """Frequency and width of each pole of the law beside the axis."""
        return ()


@dataclass(frozen=True)
class ControlGains(ControlLaw):
    """PD feedback of one wall: u = proportional * phi_s + derivative * dphi_s/dt, t dimensionless (Eq. 17); by a *delay* later."""

    proportional: float
    derivative: float
    delay: float = 0.0

    def at(self, s: ComplexArray, modes: Modes | None = None) -> ComplexArray:
        """Return u per phi_s, k_p + k_d s."""
        at_once = self.proportional + self.derivative * s
        return at_once * np.exp(-self.delay * s) if self.delay else at_once

    def at_once(self, modes: Modes) -> float:
        """Return k_d."""
        return self.derivative

    def weight(self, orders: FloatArray) -> float:
        """Return 1."""
        return 1.0

    def stiffening(self, orders: FloatArray, frequency: FloatArray) -> float:
        """Return k_p."""
        return self.proportional

    def rate(self, size: FloatArray) -> FloatArray:
        """Return |k_d| size."""
        return abs(self.derivative) * size

    def fades(self, size: FloatArray) -> float:
        """Return 2 |k_d| size + 2 sqrt(|k_p| size)."""
        return float(2.0 * (abs(self.derivative) * size).max() + 2.0 * np.sqrt(abs(self.proportional) * size).max())

    def late(self, delay: float) -> ControlGains:
        """Return the law that answers by as much later."""
        return ControlGains(self.proportional, self.derivative, self.delay + delay)

    @property
    def zero(self) -> bool:
        """Whether both gains are 0."""
        return self.proportional == self.derivative == 0.0

    def times(self, factor: float) -> ControlGains:
        """Return the law with a factor on both gains."""
        return self.scaled(factor, factor)

    def scaled(self, proportional: float, derivative: float) -> ControlGains:
        """Return the gains times a factor each."""
        return ControlGains(proportional * self.proportional, derivative * self.derivative, self.delay)


@dataclass(frozen=True)
class RationalLaw(ControlLaw):
    """Feedback by a ratio of polynomials in s, with a delay and a weight for each order.

    Attributes
    ----------
    numerator, denominator : tuple of float
        Coefficients, highest power of s first.
    delay : float
    weights : tuple of float, int or None
        Of the orders 0, 1, ..., 0 beyond; the highest order that is fed back; or None for all alike.
    """

    numerator: tuple[float, ...]
    denominator: tuple[float, ...]
    delay: float = 0.0
    weights: tuple[float, ...] | int | None = None

    @classmethod
    def of(
        cls,
        numerator: tuple[float, ...],
        denominator: tuple[float, ...],
        delay: float,
        weights: tuple[float, ...] | int | None,
        time: float,
    ) -> RationalLaw:
        """Return the law of polynomials in 1/s and a delay in seconds, *time* the seconds of one unit."""
        top, bottom = (tuple(a / time ** (len(x) - 1 - i) for i, a in enumerate(x)) for x in (numerator, denominator))
        return cls(top, bottom, delay / time, weights)

    def _rational(self, s: ComplexArray) -> ComplexArray:
        return np.asarray(np.polyval(self.numerator, s) / np.polyval(self.denominator, s), dtype=np.complex128)

    def at(self, s: ComplexArray, modes: Modes) -> ComplexArray:
        """Return H(s) e^{-s delay}, times the weight of each order where there are weights."""
        law = self._rational(s)
        if self.delay:
            law = law * np.exp(-self.delay * s)
        return law if self.weights is None else self.weight(modes.orders)[:, None] * law

    def at_once(self, modes: Modes) -> FloatArray | float:
        """Return the ratio of the leading coefficients where the numerator's degree is the higher and nothing delays it, else 0."""
        if self.delay or len(self.numerator) != len(self.denominator) + 1:
            return 0.0
        factor = self.numerator[0] / self.denominator[0]
        return factor if self.weights is None else self.weight(modes.orders)[:, None] * factor

    def weight(self, orders: FloatArray) -> FloatArray:
        """Return the weights of some orders."""
        if self.weights is None:
            return np.ones_like(orders)
        if isinstance(self.weights, int):
            return np.where(orders <= self.weights, 1.0, 0.0)
        known = np.append(self.weights, 0.0)
        return np.asarray(known[np.minimum(orders, len(self.weights)).astype(int)])

    def stiffening(self, orders: FloatArray, frequency: FloatArray) -> FloatArray:
        """Return Re H(i omega) of each order at its frequency, times its weight; 0 where it damps or drives more than it stiffens."""
        law = self.weight(orders) * self._rational(np.asarray(1e-3 + 1j * frequency, dtype=np.complex128))  # beside poles on the axis
        return np.where(np.abs(law.real) > np.abs(law.imag), law.real, 0.0)

    def rate(self, size: FloatArray) -> FloatArray:
        """Return the highest frequency of each order at which |H| size reaches omega^2."""
        return self._reach(size, 1.0)

    def fades(self, size: FloatArray) -> float:
        """Return the highest frequency at which the largest size times |H| reaches omega^2/2."""
        return float(self._reach(size, 0.5).max())

    def late(self, delay: float) -> RationalLaw:
        """Return the law that answers by as much later."""
        return replace(self, delay=self.delay + delay)

    def times(self, factor: float) -> RationalLaw:
        """Return the law with a factor on its numerator."""
        return replace(self, numerator=tuple(factor * x for x in self.numerator))

    @property
    def zero(self) -> bool:
        """Whether the numerator or all weights are 0."""
        none = not isinstance(self.weights, int) and self.weights is not None and not any(self.weights)
        return none or not any(self.numerator)

    @property
    def resonances(self) -> tuple[tuple[float, float], ...]:
        """Imaginary part and minus the real part of each pole, pairs once."""
        poles = np.roots(self.denominator) if len(self.denominator) > 1 else np.zeros(0)
        return tuple((float(pole.imag), float(-pole.real)) for pole in poles if pole.imag >= 0.0)

    def _reach(self, size: FloatArray, share: float) -> FloatArray:
        """Return the highest frequency of each size at which |H| size reaches a share of omega^2, found to 2 per cent, from above."""
        frequency, most = self._envelope
        reaches = most[None, :] * size[:, None] >= share
        last = np.where(reaches.any(axis=1), reaches.shape[1] - 1 - reaches[:, ::-1].argmax(axis=1) + 1, 0)
        return np.where(reaches.any(axis=1), frequency[np.minimum(last, frequency.size - 1)], 0.0)

    @cached_property
    def _envelope(self) -> tuple[FloatArray, FloatArray]:
        """Frequencies, and the largest |H|/omega^2 at each of them or above."""
        roots = [np.abs(np.roots(x)) for x in (self.numerator, self.denominator) if len(x) > 1]
        special = np.concatenate([np.zeros(0), *roots])
        frequency = np.union1d(np.geomspace(1e-3, 1e7, 1200), special[(special > 1e-3) & (special < 1e7)])
        size = np.abs(self._rational(1j * frequency + 1e-3)) / frequency**2  # beside poles on the axis
        return frequency, np.maximum.accumulate(size[::-1])[::-1]


@dataclass(frozen=True)
class BridgedLaw(RationalLaw):
    """Late feedback by a bridge that lets a part x of the actuator's own voltage through: u = H e^{-s delay} (phi_s + x u).

    Attributes
    ----------
    through : float
        x; |x H| < 1 at all frequencies, so that the loop of the amplifier by itself has no pole that grows.
    """

    through: float = 0.0

    def at(self, s: ComplexArray, modes: Modes) -> ComplexArray:
        """Return H e^{-s delay}/(1 - x H e^{-s delay}), 0 for orders that are not fed back."""
        law = RationalLaw(self.numerator, self.denominator, self.delay, self.weights).at(s, modes)
        return np.asarray(law / (1.0 - self.through * law))

    def _rational(self, s: ComplexArray) -> ComplexArray:
        """Return H over 1 - |x H|: the most that it comes to at any phase."""
        law = super()._rational(s)
        return np.asarray(law / np.maximum(1.0 - np.abs(self.through * law), 1e-2))

    def times(self, factor: float) -> BridgedLaw:
        """Return the law with a factor on u per phi_s, x being that of the bridge at the gain given."""
        return replace(self, numerator=tuple(factor * x for x in self.numerator), through=self.through / factor if factor else 0.0)
