"""Rational functions with common stable poles through samples: vector fitting.

With sigma(s) = 1 + sum c_n/(s - p_n) one solves sigma f = sum r_n/(s - p_n) + d for all f at once by least squares, linear in c, r and d;
the zeros of sigma are better poles than p, and after some rounds sigma is 1 (Gustavsen and Semlyen, IEEE Transactions on Power Delivery
14, 1999, 1052-1061; the unknowns of each f eliminated first, Deschrijver et al., IEEE Microwave and Wireless Components Letters 18, 2008,
383-385). Poles come in conjugate pairs; those that would grow are mirrored.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray

_ROUNDS = 12


class RationalFit(NamedTuple):
    """f(s) = d + sum over poles r_n/(s - p_n), of each pair also the conjugate.

    Attributes
    ----------
    poles : ndarray, shape (P,)
        Real ones, and of each pair that with a positive imaginary part; all with a negative real part.
    residues : ndarray, shape (functions, P)
    constant : ndarray, shape (functions,)
    """

    poles: ComplexArray
    residues: ComplexArray
    constant: FloatArray

    def at(self, s: ComplexArray) -> ComplexArray:
        """Return the functions at nodes, (functions, nodes)."""
        pair = self.poles.imag > 0.0
        terms = self.residues @ (1.0 / (s - self.poles[:, None]))
        mirrored = self.residues[:, pair].conj() @ (1.0 / (s - self.poles[pair, None].conj()))
        return np.asarray(self.constant[:, None] + terms + mirrored)


def vector_fit(s: ComplexArray, values: ComplexArray, poles: int) -> RationalFit:
    """Return the fit with so many poles (of a pair both counted) to functions, (functions, nodes), each weighed by its largest."""
    weight = 1.0 / np.abs(values).max(axis=1)
    f = values * weight[:, None]
    present = _first_poles(s, poles)
    for _ in range(_ROUNDS):
        present = _relocated(s, f, present)
    basis = _basis(s, present)
    matrix = _stacked(np.concatenate([basis, np.ones((1, s.size))]))
    scale = np.linalg.norm(matrix, axis=0)
    found = np.linalg.lstsq(matrix / scale, np.concatenate([f.real, f.imag], axis=1).T, rcond=None)[0] / scale[:, None]
    real, pair = present.imag == 0.0, present.imag > 0.0
    residues = np.zeros((len(f), present.size), np.complex128)
    residues[:, real] = found[: real.sum()].T
    rest = found[real.sum() : -1].reshape(pair.sum(), 2, len(f))
    residues[:, pair] = (rest[:, 0] + 1j * rest[:, 1]).T
    return RationalFit(present, residues / weight[:, None], found[-1] / weight)


def _first_poles(s: ComplexArray, count: int) -> ComplexArray:
    """Return pairs spread evenly over the band, little damped, and one real pole of an odd number."""
    highest = float(np.abs(s.imag).max())
    at = np.linspace(highest / count, highest, count // 2)
    real = [-highest / 2.0] if count % 2 else []
    return np.concatenate([np.asarray(real, np.complex128), -0.02 * at + 1j * at])


def _basis(s: ComplexArray, poles: ComplexArray) -> ComplexArray:
    """Return 1/(s - p) of real poles, and of each pair sum and i times difference: real coefficients make real functions."""
    rows = [1.0 / (s - p.real) for p in poles[poles.imag == 0.0]]
    for p in poles[poles.imag > 0.0]:
        one, other = 1.0 / (s - p), 1.0 / (s - p.conjugate())
        rows += [one + other, 1j * (one - other)]
    return np.stack(rows)


def _stacked(rows: ComplexArray) -> FloatArray:
    return np.concatenate([rows.real, rows.imag], axis=1).T


def _relocated(s: ComplexArray, f: ComplexArray, poles: ComplexArray) -> ComplexArray:
    """Return the zeros of sigma."""
    basis = _basis(s, poles)
    own, count = _stacked(np.concatenate([basis, np.ones((1, s.size))])), len(basis)
    rows, right = [], []
    for one in f:
        q, r = np.linalg.qr(np.concatenate([own, _stacked(-one * basis)], axis=1))
        rows.append(r[count + 1 :, count + 1 :])
        right.append(q[:, count + 1 :].T @ np.concatenate([one.real, one.imag]))
    matrix = np.concatenate(rows)
    scale = np.maximum(np.linalg.norm(matrix, axis=0), 1e-300)
    sigma = np.linalg.lstsq(matrix / scale, np.concatenate(right), rcond=None)[0] / scale
    state, drive = np.zeros((count, count)), np.zeros(count)
    place = 0
    for p in poles[poles.imag == 0.0]:
        state[place, place], drive[place], place = p.real, 1.0, place + 1
    for p in poles[poles.imag > 0.0]:
        state[place : place + 2, place : place + 2] = [[p.real, p.imag], [-p.imag, p.real]]
        drive[place], place = 2.0, place + 2
    found = np.linalg.eigvals(state - np.outer(drive, sigma))
    found = np.where(found.real > 0.0, -found.conj(), found)
    near = np.abs(found.imag) < 1e-9 * np.abs(found)
    return np.concatenate([found[near].real.astype(np.complex128), found[~near & (found.imag > 0.0)]])
