"""The motion of the walls of a finished run and its rates: what every quantity of a shell is read from.

Rates come from the transforms, s W and s^2 W inverted on the grid of the run under its own roll-off of the top fifth of the band
(:meth:`coaxshell.numerics.laplace_grid.LaplaceGrid.taper`), so that displacement, velocity and acceleration belong to one motion: each is
the exact derivative of the one before within the band. The direct engine marches instants, not transforms: its rates are the central
differences that it is made of.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import cached_property
from typing import Any, NamedTuple, TypeVar

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.response import through
from coaxshell.response.modal import amplitudes
from coaxshell.response.peaks import Amplitudes
from coaxshell.response.relaxing import Relaxing
from coaxshell.response.synthesis import at_angles
from coaxshell.solver.recompute import marches, spectra_of
from coaxshell.solver.solution import ModalSolution
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.structure.elastic_depth import Shown
from coaxshell.structure.shell_model import FieldGain, Gain

Made = TypeVar("Made")
_KEPT_DEPTHS = 8
"""Quantities within elastic walls that are kept."""


class MotionSpectra(NamedTuple):
    """Transforms of W and V, (shells, parities, M + 1, nodes), on the grid of a run."""

    grid: LaplaceGrid
    normal: ComplexArray
    tangential: ComplexArray


class WallMotion:
    """W and V of all walls by modes: their histories and, made when first needed and kept, their transforms.

    Parameters
    ----------
    solution : ModalSolution
    """

    def __init__(self, solution: ModalSolution) -> None:
        self.solution = solution
        self._within: dict[tuple[int, str, float], FloatArray] = {}
        self._made: dict[Hashable, Any] = {}

    @cached_property
    def spectra(self) -> SolvedSpectra:
        """Transforms of W and V; InputError if instants of the run are missing."""
        return spectra_of(self.solution)

    @cached_property
    def for_rates(self) -> MotionSpectra:
        """Transforms of W and V whose derivatives do not feel that the forces of a march end with the run."""
        found = spectra_of(self.solution, continued=True) if marches(self.solution) else self.spectra
        return MotionSpectra(found.grid, found.normal, found.tangential)

    def within(self, shell: int, what: Shown, depth: float) -> FloatArray:
        """Return modal histories of a quantity at a depth (m) of an elastic wall, SI, (parities, M + 1, T).

        See :func:`coaxshell.response.through.within`; InputError if instants are missing. The last few are kept.
        """
        key = (shell, what, depth)
        if key not in self._within:
            while len(self._within) >= _KEPT_DEPTHS:
                self._within.pop(next(iter(self._within)))
            self._within[key] = through.within(self.spectra, shell, what, depth)[..., :: self.solution.settings.refinement]
        return self._within[key]

    def kept(self, key: Hashable, make: Callable[[], Made]) -> Made:
        """Return what is made of this motion once, by its key."""
        if key not in self._made:
            self._made[key] = make()
        found: Made = self._made[key]
        return found

    def has_rate(self, rate: int) -> bool:
        """Return whether derivatives of an order can be given: 0 always, others of a run with all its instants."""
        return rate == 0 or self.solution.whole

    def amplitudes(self, shell: int, gain: Gain | FieldGain | Relaxing, rate: int = 0) -> Amplitudes:
        """Return what gives the modal amplitudes gain.v V + gain.w W of a shell at a slice of time indices.

        Parameters
        ----------
        shell : int
        gain : Gain, FieldGain or Relaxing
        rate : int
            0, 1 or 2: order of the time derivative; SI, per second each.

        Raises
        ------
        InputError
            For a derivative, or the stress of a wall with losses, of a run that lacks instants.
        """
        if isinstance(gain, Relaxing):
            all_of_it = amplitudes(self.solution, shell, gain)
            return lambda window: all_of_it[..., window]
        if rate == 0:
            return lambda window: amplitudes(self.solution, shell, gain, window)
        values = self._differences(shell, gain, rate) if self._direct else self._inverse(self._spectrum(shell, gain, rate))
        return lambda window: values[..., window]

    def rates_at(self, shell: int, gain: Gain | FieldGain, rate: int, basis: FloatArray) -> FloatArray:
        """Return sums of the orders of a derivative at the angles of a basis (:func:`~coaxshell.response.synthesis.angle_basis`), (T, A).

        Few angles are summed before the inverse transform, so that only they are inverted.
        """
        if self._direct or len(basis) >= basis[0].size:
            return at_angles(self.amplitudes(shell, gain, rate)(slice(None)), basis)
        spectrum = self._spectrum(shell, gain, rate)
        return self._inverse(basis.reshape(len(basis), -1) @ spectrum.reshape(-1, spectrum.shape[-1])).T

    @property
    def _direct(self) -> bool:
        return self.solution.settings.engine == "direct"

    def _spectrum(self, shell: int, gain: Gain | FieldGain, rate: int) -> ComplexArray:
        """Return the transform of a derivative by modes, SI."""
        assert isinstance(gain, Gain)  # rates of the fields along the axis are no quantities
        spectra, per_second = self.for_rates, self.solution.problem.scales.time**-rate
        wanted: ComplexArray = spectra.normal[shell] * (per_second * gain.w[:, None])
        if np.any(gain.v):
            wanted += spectra.tangential[shell] * (per_second * gain.v[:, None])
        wanted *= spectra.grid.nodes**rate
        return wanted

    def _inverse(self, spectrum: ComplexArray) -> FloatArray:
        return self.for_rates.grid.invert(spectrum)[..., :: self.solution.settings.refinement]

    def _differences(self, shell: int, gain: Gain | FieldGain, rate: int) -> FloatArray:
        """Return central differences; at the end, where none is, one-sided ones of the same order. The run begins at rest."""
        self.solution.need_every_instant("a velocity or acceleration of a shell")
        x, step = amplitudes(self.solution, shell, gain), self.solution.settings.time_step * self.solution.problem.scales.time
        if rate == 1:
            return np.asarray(np.gradient(x, step, axis=-1, edge_order=2), dtype=np.float64)
        result = np.empty_like(x)
        result[..., 1:-1] = x[..., 2:] - 2.0 * x[..., 1:-1] + x[..., :-2]
        result[..., 0] = x[..., 1] - 2.0 * x[..., 0]
        result[..., -1] = 2.0 * x[..., -1] - 5.0 * x[..., -2] + 4.0 * x[..., -3] - x[..., -4]
        return result / step**2
