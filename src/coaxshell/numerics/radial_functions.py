"""Modified Bessel functions on a circle at all orders, as bounded ratios: what fields and operators of a radial problem are made of."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from coaxshell.numerics import bessel_ratios as br
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.bessel_samples import BesselSample, i_sample, k_sample
from coaxshell.numerics.large_arguments import LargeArguments


@dataclass(frozen=True, eq=False)
class RadialFunctions:
    """Modified Bessel functions at the arguments kappa * radius, as ratios, computed when first asked for.

    Parameters
    ----------
    kappa : ndarray, shape (n,)
        Radial wavenumbers, Re kappa > 0 unless ``left``.
    radius : float
        Radius in units of the reference radius.
    orders : ndarray, shape (M,)
        Ascending circumferential orders to be kept, all or a sample; the recurrences run through all of them.
    sparse : bool
        Whether they run by the functions themselves, of which the sample is kept, instead of by ratios of all orders; where arguments are
        large no recurrence runs at all.
    left : bool
        Whether arguments may lie to the left of the imaginary axis too, where a response rings (not of a sparse sample).
    """

    kappa: ComplexArray
    radius: float
    orders: FloatArray
    sparse: bool = False
    left: bool = False

    @cached_property
    def argument(self) -> ComplexArray:
        """kappa * radius."""
        return self.kappa * self.radius

    @property
    def max_order(self) -> int:
        """The highest order."""
        return int(self.orders[-1])

    def keep(self, rows: ComplexArray) -> ComplexArray:
        """Return the rows of the orders to be kept, from rows of all orders."""
        return rows if self.orders.size == rows.shape[0] else rows[self.orders.astype(int)]

    @cached_property
    def i_ratios(self) -> ComplexArray:
        """I_{m+1}/I_m for all orders 0..max_order, shape (max_order + 1, n)."""
        return br.i_ratios(self.max_order, self.argument, left=self.left)

    @cached_property
    def k_ratios(self) -> ComplexArray:
        """K_{m+1}/K_m for all orders 0..max_order, shape (max_order + 1, n)."""
        return br.k_ratios(self.max_order, self.argument, left=self.left)

    @cached_property
    def i_sample(self) -> BesselSample:
        """I_m at the orders kept."""
        return i_sample(self.orders.astype(np.int64), self.argument)

    @cached_property
    def k_sample(self) -> BesselSample:
        """K_m at the orders kept."""
        return k_sample(self.orders.astype(np.int64), self.argument)

    @cached_property
    def large(self) -> LargeArguments | None:
        """The functions by their expansions, of a sample of orders where the arguments are large."""
        return LargeArguments.of(self.orders, self.argument) if self.sparse else None

    @cached_property
    def i_slope(self) -> ComplexArray:
        """kr I_m'(kr)/I_m(kr) = m + kr R_m (DLMF 10.29.2), shape (M, n)."""
        if self.large is not None:
            return self.large.i_slope
        slope = self.argument * (self.i_sample.ratio if self.sparse else self.keep(self.i_ratios))
        slope += self.orders[:, None]
        return slope

    @cached_property
    def k_slope(self) -> ComplexArray:
        """kr K_m'(kr)/K_m(kr) = m - kr S_m (DLMF 10.29.2), shape (M, n)."""
        if self.large is not None:
            return self.large.k_slope
        slope = self.argument * (self.k_sample.ratio if self.sparse else self.keep(self.k_ratios))
        return np.subtract(self.orders[:, None], slope, out=slope)

    @cached_property
    def disc(self) -> ComplexArray:
        """I_m(kr)/(k I_m'(kr)) = r/(m + kr R_m), shape (M, n): wall pressure per unit wall acceleration of a disc of radius r."""
        return np.asarray(self.radius / self.i_slope)

    @cached_property
    def exterior(self) -> ComplexArray:
        """K_m(kr)/(k K_m'(kr)) = r/(m - kr S_m), shape (M, n): the same of the unbounded fluid outside radius r."""
        return np.asarray(self.radius / self.k_slope)


def i_across(inner: RadialFunctions, outer: RadialFunctions) -> ComplexArray:
    """Return I_m(kr)/I_m(k r1), the smaller of two radii over the larger, shape (M, n)."""
    za, zb = inner.argument, outer.argument
    if inner.large is not None and outer.large is not None:
        return inner.large.i_over(outer.large)
    if inner.sparse:
        return np.asarray(inner.i_sample.over(outer.i_sample) * np.exp(za.real - zb.real), dtype=np.complex128)
    return inner.keep(br.i_across(inner.i_ratios, outer.i_ratios, za, zb, left=inner.left))


def k_across(inner: RadialFunctions, outer: RadialFunctions) -> ComplexArray:
    """Return K_m(kr)/K_m(k r1), the larger of two radii over the smaller, shape (M, n)."""
    za, zb = inner.argument, outer.argument
    if inner.large is not None and outer.large is not None:
        return outer.large.k_over(inner.large)
    if inner.sparse:
        return np.asarray(outer.k_sample.over(inner.k_sample) * np.exp(za - zb), dtype=np.complex128)
    return inner.keep(br.k_across(inner.k_ratios, outer.k_ratios, za, zb, left=inner.left))
