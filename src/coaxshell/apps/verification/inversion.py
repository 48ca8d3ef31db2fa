"""Inverse Laplace transforms good to 1e-10 behind fronts, for comparison with tables."""

from __future__ import annotations

import numpy as np
from scipy.special import gamma

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid


def sharp_inverse(grid: LaplaceGrid, spectrum: ComplexArray, lead: float, terms: int = 4) -> FloatArray:
    """Return the inverse of spectra that behave as s^-lead (c_0 + c_1/s + ...) at high frequency, fronts at t = 0 included.

    Terms (s + 1)^-p, p = lead, lead + 1, ..., are fitted to the upper three quarters of the band, taken off, and their known
    inverses t^(p-1) e^-t/Gamma(p) added back. That is exact whatever the fit; a good fit leaves little for the band limit to spoil.
    """
    power = lead + np.arange(terms)
    scale = abs(grid.nodes[-1] + 1.0)
    basis = ((grid.nodes[:, None] + 1.0) / scale) ** -power
    upper = slice(grid.nodes.size // 4, None)
    weight = 1.0 / np.abs(basis[upper, 0])
    matrix, values = basis[upper] * weight[:, None], (spectrum[..., upper] * weight).T
    fit = np.linalg.lstsq(np.concatenate([matrix.real, matrix.imag]), np.concatenate([values.real, values.imag]))[0]
    inverse = scale ** power[:, None] / gamma(power)[:, None] * np.maximum(grid.time, 1e-300) ** (power[:, None] - 1.0)
    result: FloatArray = grid.invert(spectrum - (basis @ fit).T) + fit.T @ (inverse * np.exp(-grid.time))
    return result
