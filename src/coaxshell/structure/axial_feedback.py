"""A thin wall at an axial wavenumber whose feedback acts on all of (U, V, W): A = K + I s^2 - H P S', of which U and V are eliminated.

P is the load per volt and S the reading, rows on (U, V, W). A is symmetric only where both are alike. Elimination leaves

    Z = A_ww + (A_wu, A_wv) (U/W, V/W),      (U/W, V/W) = -B^-1 (A_uw, A_vw),      B = ((A_uu, A_uv), (A_vu, A_vv)).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.structure.axial import AxialStiffness
from coaxshell.structure.shell_model import Gain, WallOperator


class FedBack(NamedTuple):
    """Entries of A, each of shape (orders, nodes)."""

    uu: ComplexArray
    uv: ComplexArray
    uw: ComplexArray
    vu: ComplexArray
    vv: ComplexArray
    vw: ComplexArray
    wu: ComplexArray
    wv: ComplexArray
    ww: ComplexArray

    @classmethod
    def of(cls, k: AxialStiffness, inertia: ComplexArray, modes: Modes, push: Gain, read: Gain, law: ComplexArray | float) -> FedBack:
        """Return A from K, I s^2, P, S (of :attr:`Gain.columns`) and H; V_0, which couples to nothing, has the stiffness of U_0."""
        assert push.u is not None
        assert read.u is not None
        vv = np.where(modes.column == 0, k.uu, k.vv)
        open_loop = ((k.uu + inertia, k.uv, k.uw), (k.uv, vv + inertia, k.vw), (k.uw, k.vw, k.ww + inertia))
        rows, columns = (push.u, push.v, push.w), (read.u, read.v, read.w)
        return cls(*(open_loop[a][b] - law * (rows[a] * columns[b]) for a in range(3) for b in range(3)))

    def eliminated(self) -> WallOperator:
        """Return impedance, V/W and U/W of the wall, whose load is normal to it."""
        inverse = np.reciprocal(self._determinant)
        axial = (self.uv * self.vw - self.vv * self.uw) * inverse
        tangential = (self.vu * self.uw - self.uu * self.vw) * inverse
        return WallOperator(self.ww + self.wu * axial + self.wv * tangential, tangential, axial)

    def along_resistance(self, s: ComplexArray) -> FloatArray:
        """Return the least eigenvalue of the Hermitian part of B/s: what the least resisted motion along the wall loses in it."""
        uu, vv, uv = (self.uu / s).real, (self.vv / s).real, 0.5 * (self.uv / s + np.conj(self.vu / s))
        return np.asarray(0.5 * (uu + vv) - np.hypot(0.5 * (uu - vv), np.abs(uv)))

    def driven_along(self, push: Gain) -> tuple[ComplexArray, ComplexArray]:
        """Return B^-1 P_a as V and U per volt while W is held, P_a the parts of P along the wall."""
        assert push.u is not None
        inverse = np.reciprocal(self._determinant)
        return (self.uu * push.v - self.vu * push.u) * inverse, (self.vv * push.u - self.uv * push.v) * inverse

    def answered_along(self, push: Gain, read: Gain) -> ComplexArray:
        """Return S_a B^-1 P_a, of the parts of P and S along the wall: what a unit gain takes off det B over det B."""
        assert read.u is not None
        tangential, axial = self.driven_along(push)
        return np.asarray(read.v * tangential + read.u * axial)

    @property
    def _determinant(self) -> ComplexArray:
        return np.asarray(self.uu * self.vv - self.uv * self.vu)
