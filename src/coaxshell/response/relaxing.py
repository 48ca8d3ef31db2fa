"""What layers with losses make of a history: g(s) times its transform, made of the samples of the run itself.

A run holds what happened until its end, and a period of the transform lasts at least twice as long: the history is continued beyond the
end by value, slope and curvature, faded out. What comes after an instant changes nothing of it; but a history that broke off there would
have a spectrum up to the end of the band, where g is cut.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy import fft

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.threads import WORKERS
from coaxshell.solver.solution import ModalSolution
from coaxshell.structure.losses import Relaxation
from coaxshell.structure.shell_model import FieldGain, Gain

_FADING, _FADED = 20.0, 128
"""Strength of the fading, and after how many steps nothing is left: far more than a wavelength at the end of the band."""


class Relaxing(NamedTuple):
    """A quantity that is a sum of gains, each under a factor g(s), None for 1."""

    parts: tuple[tuple[Relaxation | None, Gain | FieldGain], ...]


def relaxed(solution: ModalSolution, factor: Relaxation | None, histories: FloatArray) -> FloatArray:
    """Return g(s) of histories at all instants of a run (last axis); InputError if instants of the run are missing.

    Parameters
    ----------
    solution : ModalSolution
    factor : Relaxation or None
        None leaves them as they are.
    histories : ndarray, shape (..., T)
    """
    if factor is None:
        return histories
    solution.need_every_instant("the stress of a wall with losses")
    grid = LaplaceGrid(solution.settings.time_step, solution.time.size - 1)
    damped = _continued(histories, grid)
    damped *= np.exp(-grid.shift * grid.time_step * np.arange(grid.samples))
    spectrum = fft.rfft(damped, axis=-1, workers=WORKERS, overwrite_x=True)
    spectrum *= factor.at(grid.nodes)
    found = fft.irfft(spectrum, grid.samples, axis=-1, workers=WORKERS, overwrite_x=True)[..., : grid.time.size]
    return np.asarray(found * np.exp(grid.shift * grid.time))


def relaxed_transposed(solution: ModalSolution, factor: Relaxation | None, slope: FloatArray) -> FloatArray:
    """Return the transpose of :func:`relaxed`: what histories change, (..., T), from what g(s) of them changes, of the same shape."""
    if factor is None:
        return slope
    grid = LaplaceGrid(solution.settings.time_step, solution.time.size - 1)
    whole = np.zeros((*slope.shape[:-1], grid.samples))
    whole[..., : grid.time.size] = slope * np.exp(grid.shift * grid.time)
    spectrum = fft.rfft(whole, axis=-1, workers=WORKERS, overwrite_x=True)
    spectrum *= np.conj(factor.at(grid.nodes))
    found = fft.irfft(spectrum, grid.samples, axis=-1, workers=WORKERS, overwrite_x=True)
    found *= np.exp(-grid.shift * grid.time_step * np.arange(grid.samples))
    kept, beyond = found[..., : grid.time.size].copy(), found[..., grid.time.size :]
    steps = np.arange(1.0, beyond.shape[-1] + 1)
    faded = beyond * _fading(steps)
    value, slopes, curvatures = faded.sum(axis=-1), faded @ steps, faded @ (0.5 * steps**2)
    kept[..., -1] += value + 1.5 * slopes + curvatures
    kept[..., -2] -= 2.0 * (slopes + curvatures)
    kept[..., -3] += 0.5 * slopes + curvatures
    return np.asarray(kept)


def _fading(steps: FloatArray) -> FloatArray:
    """Return by how much what lies so many steps beyond the end of a run has faded."""
    return np.asarray(np.exp(-_FADING * np.minimum(steps / min(_FADED, steps.size), 2.0) ** 4))


def _continued(histories: FloatArray, grid: LaplaceGrid) -> FloatArray:
    """Return histories over a whole period: beyond their end a parabola, faded out."""
    third, second, last = histories[..., -3, None], histories[..., -2, None], histories[..., -1, None]
    steps = np.arange(1.0, grid.samples - histories.shape[-1] + 1)
    fading = _fading(steps)
    slope, curvature = 1.5 * last - 2.0 * second + 0.5 * third, last - 2.0 * second + third
    return np.concatenate([histories, (last + slope * steps + 0.5 * curvature * steps**2) * fading], axis=-1)


def relaxed_solution(solution: ModalSolution, factor: Relaxation | None, shell: int) -> ModalSolution:
    """Return a run whose motion of one shell is g(s) times what it was: many quantities of one factor are then read as without losses."""
    if factor is None:
        return solution

    def of(field: FloatArray) -> FloatArray:
        return np.broadcast_to(relaxed(solution, factor, field[shell]), field.shape)

    along = solution.along
    if along is not None:
        u, w_z, w_zz, v_z, u_z = (of(field) for field in (along.u, along.w_z, along.w_zz, along.v_z, along.u_z))
        potentials = tuple(of(x) for x in along.potentials)
        along = along._replace(u=u, w_z=w_z, w_zz=w_zz, v_z=v_z, u_z=u_z, potentials=potentials, potential_rates=())
    return replace(solution, normal=of(solution.normal), tangential=of(solution.tangential), along=along)
