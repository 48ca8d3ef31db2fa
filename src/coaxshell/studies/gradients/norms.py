"""Norms over circle and time that have a derivative, and it: from the modal amplitudes of a quantity to one number."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.circle import circle_angles
from coaxshell.response.peaks import Amplitudes, Peak, peak_anywhere, peak_at
from coaxshell.response.quantities import Where
from coaxshell.response.synthesis import angle_basis, mean_square


class Norm(NamedTuple):
    """A norm: its value, the largest magnitude beside it, and what a unit of every amplitude changes of the value.

    ``slope`` has the shape of the amplitudes, (parities, M + 1, T).
    """

    value: float
    peak: float
    slope: FloatArray


def root_mean_square(modal: FloatArray, time: FloatArray) -> Norm:
    """Return the RMS over circle and time, J = sqrt(sum_n tau_n <q^2>_n), with tau_n the weights of the trapezoidal rule over the run.

    Parameters
    ----------
    modal : ndarray, shape (parities, M + 1, T)
    time : ndarray, shape (T,)
    """
    weight = np.full(modal.shape[:2], 0.5)
    weight[0, 0], weight[1:, 0] = 1.0, 0.0  # order 0 has no sine
    share = _shares(time)
    value = float(np.sqrt(mean_square(modal) @ share))
    slope = weight[..., None] * modal * (share / (value or 1.0))
    return Norm(value, _anywhere(modal, time).value, slope)


def power_mean(modal: FloatArray, time: FloatArray, power: float | None, where: Where, head: float) -> Norm:
    """Return the mean of the power p of the magnitude over circle and time, J = <|q|^p>^(1/p); the largest magnitude itself for None.

    It lies below the largest magnitude and approaches it as p grows. Of the head or the tail it is the mean over time there.

    Parameters
    ----------
    modal : ndarray, shape (parities, M + 1, T)
    time : ndarray, shape (T,)
    power : float or None
    where : str
        "anywhere", "head" or "tail".
    head : float
        Direction of the head, degrees.
    """
    parities, orders, _ = modal.shape
    if where == "anywhere":
        angles, peak = circle_angles(orders, parities), _anywhere(modal, time)
    else:
        angles = np.array([head + (180.0 if where == "tail" else 0.0)])
        peak = peak_at(_window(modal), time, slice(0, time.size), list(angles))[0]
    if power is None:
        return _largest(modal, time, peak)
    basis = angle_basis(angles, orders, parities).reshape(len(angles), -1)
    field = basis @ modal.reshape(-1, time.size)
    around = np.ones(len(angles))
    if len(angles) > 1 and parities == 1:  # half of the circle: its ends count half
        around[[0, -1]] = 0.5
    shares = (around / around.sum())[:, None] * _shares(time)
    largest = float(np.abs(field).max()) or 1.0
    relative = np.abs(field) / largest
    steep = relative ** (power - 1.0)
    mean = float((shares * steep * relative).sum())
    value = largest * mean ** (1.0 / power)
    steep *= shares * np.sign(field)
    steep *= mean ** (1.0 / power - 1.0) if mean > 0.0 else 0.0
    return Norm(value, peak.value, (basis.T @ steep).reshape(modal.shape))


def _largest(modal: FloatArray, time: FloatArray, peak: Peak) -> Norm:
    """Return the largest magnitude itself: its place and instant stay where they are to first order."""
    instant = int(np.argmin(np.abs(time - peak.time)))
    basis = angle_basis([peak.angle], modal.shape[1], modal.shape[0])[0]
    slope = np.zeros_like(modal)
    slope[..., instant] = basis * np.sign((basis * modal[..., instant]).sum())
    return Norm(peak.value, peak.value, slope)


def _anywhere(modal: FloatArray, time: FloatArray) -> Peak:
    width = len(circle_angles(modal.shape[1], modal.shape[0]))
    return peak_anywhere(_window(modal), time, slice(0, time.size), width)


def _window(modal: FloatArray) -> Amplitudes:
    return lambda window: modal[..., window]


def _shares(time: FloatArray) -> FloatArray:
    """Return the weights of the trapezoidal rule over some instants, whose sum is 1."""
    weight = np.zeros_like(time)
    step = np.diff(time)
    weight[:-1] += 0.5 * step
    weight[1:] += 0.5 * step
    return np.asarray(weight / weight.sum())
