"""Electrodes in segments, and voltages that stop at a limit, by hand: points around the circle, means and loads by quadrature."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre

from coaxshell.apps.verification.independent.assembly import Assembly
from coaxshell.model.gains import law_of
from coaxshell.model.piezoelectric import Piezoelectric
from coaxshell.model.shells import Shell
from coaxshell.numerics.arrays import FloatArray

_GAUSS = legendre.leggauss(24)
_FINE = 32
"""Points around the circle to each order, where electrodes are whole."""


@dataclass(frozen=True)
class Limits:
    """What laws ask for in orders, one row a block and law, as amplifiers give it.

    Attributes
    ----------
    laws : int
    read, apply : list of ndarray, shapes (points, blocks) and (blocks, points)
        Of each law: values at its points from those of the blocks, and back.
    most : list of float
        Volts; infinite where nothing stops.
    """

    laws: int
    read: list[FloatArray]
    apply: list[FloatArray]
    most: list[float]

    @classmethod
    def of(cls, assembly: Assembly, blocks: Sequence[tuple[int, int]]) -> Limits | None:
        """Return those of an assembly; None where electrodes are whole and nothing stops."""
        system, read, apply, most = assembly.system, [], [], []
        for i in system.controlled_shells:
            law, shell = law_of(system, i), system.shells[i]
            assert law is not None
            assert isinstance(shell, Shell)
            if law.segments is None and not law.saturation:
                return None
            pieces = _circle(blocks) if law.segments is None else _segments(law, shell.radius)
            waves = [np.array([weights @ _waves(blocks, angles) for angles, weights in pieces])]
            square = np.pi * np.array([2.0 if m == 0 else 1.0 for _, m in blocks])
            widths = np.array([weights.sum() for _, weights in pieces])
            read.append(waves[0] / widths[:, None])
            apply.append((waves[0] / square).T)
            fields = [
                x.thickness * (law.field_limit or x.material.field_limit) for x in shell.layers if isinstance(x.material, Piezoelectric)
            ]
            most.append(min(fields) if law.saturation else np.inf)
        return cls(len(read), read, apply, most)

    def given(self, asked: FloatArray) -> FloatArray:
        """Return what amplifiers give in orders, shape (blocks * laws,)."""
        by_block = asked.reshape(-1, self.laws)
        columns = zip(by_block.T, self.read, self.apply, self.most, strict=True)
        return np.stack([apply @ np.clip(read @ one, -most, most) for one, read, apply, most in columns], axis=1).ravel()


def _waves(blocks: Sequence[tuple[int, int]], theta: FloatArray) -> FloatArray:
    return np.stack([np.sin(m * theta) if parity else np.cos(m * theta) for parity, m in blocks], axis=1)


def _circle(blocks: Sequence[tuple[int, int]]) -> list[tuple[FloatArray, FloatArray]]:
    count = _FINE * (1 + max(m for _, m in blocks))
    step = 2 * np.pi / count
    return [(np.array([k * step]), np.array([step])) for k in range(count)]


def _segments(law: object, radius: float) -> list[tuple[FloatArray, FloatArray]]:
    """Return angles and weights within each live segment."""
    count, gap, dead = law.segments, law.segment_gap or 0.0, law.dead or ()  # type: ignore[attr-defined]
    half = np.pi / count - 0.5 * gap / radius
    nodes, weights = _GAUSS
    return [(2 * np.pi * k / count + half * nodes, half * weights) for k in range(count) if k not in dead]
