"""What amplifiers lack that stop at a limit, as a further input to the waves of a three-dimensional run.

With a what the loops ask for and u = a + delta what is given, delta goes along the axis as the forces of line absorbers do,

    delta(z) = (1/L) [F(k_0) + 2 sum_{j>=1} F(k_j) cos k_j (z - z_0)] + odd,

and in each wave and pattern (:mod:`coaxshell.solver.electrode_patterns`) u = (1 - H K C)^-1 (H K phi_0 + delta), phi_0 what is read without
voltages.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.forces import WallForces
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.axial.tied_wave import motion_parities
from coaxshell.solver.electrode_patterns import Patterns, patterns_of
from coaxshell.solver.scaling import Problem
from coaxshell.solver.voltage_response import controlled


def wave_patterns(problem: Problem, modes: Modes) -> Patterns:
    """Return the patterns of the voltages of all walls under control in one wave."""
    return patterns_of(problem, controlled(problem), modes.orders, motion_parities(problem))


@dataclass(frozen=True, eq=False)
class Channels:
    """All patterns of all waves of a run in a row, wave by wave.

    Attributes
    ----------
    sampling : AxialSampling
    counts : ndarray, shape (waves,)
        Patterns of each wave, whole numbers.
    cut : bool
        Whether they are those of segments, as many in every wave, instead of orders.
    parities : int
        Around the circle.
    """

    sampling: AxialSampling
    counts: FloatArray
    cut: bool
    parities: int

    @classmethod
    def of(cls, problem: Problem, sampling: AxialSampling) -> Channels:
        """Return those of a run."""
        first, parities = wave_patterns(problem, sampling.modes[0]), motion_parities(problem)
        counts = np.full(len(sampling.modes), first.numbers.count) if first.cut else parities * (sampling.tops.astype(int) + 1)
        return cls(sampling, counts, first.cut, parities)

    @property
    def count(self) -> int:
        """How many there are."""
        return int(self.counts.sum())

    def of_wave(self, wave: int) -> slice:
        """Return where those of a wave stand."""
        start = int(self.counts[:wave].sum())
        return slice(start, start + int(self.counts[wave]))

    def places(self) -> FloatArray:
        """Return where each stands in an array (waves, patterns of the first wave), flat."""
        found = []
        most = int(self.counts[0])
        for wave, count in enumerate(self.counts):
            each = count if self.cut else count // self.parities
            blocks = 1 if self.cut else self.parities
            within = [np.arange(each) + number * (most // blocks) for number in range(blocks)]
            found.append(wave * most + np.concatenate(within))
        return np.concatenate(found)


@dataclass(frozen=True, eq=False)
class VoltageLack:
    """Transforms of what amplifiers lack.

    Attributes
    ----------
    channels : Channels
    lack : ndarray, shape (walls under control, axial parities, channels, nodes)
        F, V times a.
    origin : float
        z_0, in a.
    """

    channels: Channels
    lack: ComplexArray
    origin: float

    @property
    def parities(self) -> int:
        """How many parities the motion around the circle has."""
        return self.channels.parities

    @property
    def axial_parities(self) -> int:
        """1 where everything is even about the origin, else 2."""
        return int(self.lack.shape[1])

    @property
    def sampling(self) -> AxialSampling:
        """The waves at whose wavenumbers it is known."""
        return self.channels.sampling

    def at(self, nodes: slice) -> VoltageLack:
        """Return it at a slice of its nodes."""
        return replace(self, lack=self.lack[..., nodes])

    def loads(self, problem: Problem, modes: Modes, *, odd: bool) -> dict[int, list[ComplexArray]]:
        """Return no pressures: voltages are no loads on a surface alone."""
        return {}

    def of(self, modes: Modes, *, odd: bool) -> ComplexArray:
        """Return F in the patterns of a wave, (walls, patterns, nodes): between the wavenumbers of the run those of the nearest."""
        sampling = self.channels.sampling
        wave = min(round(float(np.real(np.asarray(modes.wavenumber))) / sampling.spacing), len(sampling.modes) - 1)
        found = self.lack[:, int(odd), self.channels.of_wave(wave)]
        if self.channels.cut or modes.count == sampling.modes[wave].count:
            return found
        each = found.reshape(len(found), self.parities, -1, found.shape[-1])
        fitted = np.zeros((*each.shape[:2], modes.count, each.shape[3]), np.complex128)
        known = np.flatnonzero(modes.orders < each.shape[2])
        fitted[:, :, known] = each[:, :, modes.orders[known].astype(int)]
        return fitted.reshape(len(found), -1, found.shape[-1])


def lack_of(channels: Channels, amplitudes: ComplexArray, origin: float) -> VoltageLack:
    """Return it from transforms of amplitudes along the axis: F_0 = L f_0, else L f_j/2."""
    wavenumbers, period = channels.sampling.wavenumbers, channels.sampling.period
    weight = np.repeat(np.where(wavenumbers == 0.0, period, 0.5 * period), channels.counts.astype(int))
    return VoltageLack(channels, amplitudes * weight[:, None], origin)


def lacks(forces: WallForces | None) -> bool:
    """Return whether forces are the lack of voltages instead."""
    return isinstance(forces, VoltageLack)


def without_lack(forces: WallForces | None) -> WallForces | None:
    """Return forces of absorbers, None for the lack of voltages."""
    return None if lacks(forces) else forces
