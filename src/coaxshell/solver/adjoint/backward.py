"""The march backwards in time: what a change of a link's law at any step changes in a number read from the run.

With V the causal sum over step weights from forces f at the points to velocities there, I the trapezoidal integral and B the sum of a
mass's two links, the march is

    f = c r + k_l D + k_nl D^3,   r = B u - v - V f,   D = q - w - I V f,   m u = -I B^T f,   q = I u,

v and w the motion without forces. Its transpose, with T = k_l + 3 k_nl D^2 of every step of the march, is

    lambda = F - V^T psi + B eta,      psi = c lambda + I^T (T lambda),      m eta = -I^T B^T psi,

F what a unit of force at a step changes of the number. Read from the last step to the first, V^T is a causal sum with transposed kernels
and I^T the same trapezoidal rule: one more march, linear, with springs whose stiffness is known. Adding g to the law of a link changes
the number by sum_n lambda_n g_n.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.convolution import History, HistorySum, KernelTable
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints
from coaxshell.solver.interface.block_response import block_toeplitz

_TOLERANCE = 1e-14
_MOST_ITERATIONS = 12
_SLOWEST = 0.2
"""Contraction above which the inverse kept is made anew."""
_LONGEST_BLOCK = 32
_BLOCK_UNKNOWNS = 512


@dataclass(frozen=True)
class BackwardMarch:
    """Histories of the march backwards, in the order of time.

    Attributes
    ----------
    law : ndarray, shape (2N, T)
        lambda.
    force : ndarray, shape (2N, T)
        psi.
    mass : ndarray, shape (N, T)
        eta.
    velocity : ndarray, shape (shells, parities, M + 1, T)
        What a modal pressure at a step changes through the links: K^T of the modal amplitudes of psi.
    """

    law: FloatArray
    force: FloatArray
    mass: FloatArray
    velocity: FloatArray


class Forces(NamedTuple):
    """psi of a step backwards, ahead + at_once lambda; both of shape (2N,)."""

    ahead: FloatArray
    at_once: FloatArray


class LawsBackwards(Protocol):
    """What the laws of the links make of lambda, from the last step to the first."""

    def forces(self) -> Forces:
        """Return psi of the next step backwards."""
        ...

    def take(self, law: FloatArray) -> None:
        """Go on with lambda of that step, (2N,)."""
        ...


class CubicBackwards:
    """Dampers and springs of which the tangent is known: psi = c lambda + I^T (T lambda).

    Parameters
    ----------
    damping : ndarray, shape (2N,)
    tangent : ndarray, shape (2N, T)
        T of every link at every step.
    half : float
        dt/2.
    """

    def __init__(self, damping: FloatArray, tangent: FloatArray, half: float) -> None:
        self._damping, self._half = damping, half
        self._slopes = np.ascontiguousarray(tangent.T[::-1])
        self._integral, self._flow = np.zeros_like(damping), np.zeros_like(damping)
        self._step = 0

    def forces(self) -> Forces:
        """Return psi of the next step backwards."""
        self._ahead = self._integral + self._half * self._flow  # of I^T (T lambda)
        return Forces(self._ahead, self._damping + self._half * self._slopes[self._step])

    def take(self, law: FloatArray) -> None:
        """Go on with lambda of that step."""
        flow = self._slopes[self._step] * law
        self._integral, self._flow = self._ahead + self._half * flow, flow
        self._step += 1


def march_backwards(
    kernels: KernelTable, absorbers: AbsorberSet, points: InterfacePoints, laws: LawsBackwards, load: FloatArray, time_step: float
) -> BackwardMarch:
    """March from the last step to the first.

    Parameters
    ----------
    kernels : KernelTable
        Step weights of the velocities with outputs and inputs exchanged.
    absorbers : AbsorberSet
    points : InterfacePoints
    laws : LawsBackwards
    load : ndarray, shape (2N, T)
        F.
    time_step : float

    Raises
    ------
    InputError
        If a massless absorber has nothing but cubic springs: where they pass through rest its place is not determined.
    """
    steps, count = load.shape[1], points.count
    length = max(1, min(_LONGEST_BLOCK, _BLOCK_UNKNOWNS // max(count, 1), steps - 1))
    weights = kernels.kernels[..., :length].swapaxes(0, 1)
    own = np.stack([points.immediate(weights[..., lag]).T for lag in range(weights.shape[-1])])
    step = _LinkStep(absorbers, own[0], laws, 0.5 * time_step)
    toeplitz = block_toeplitz(own)
    earlier = [toeplitz[k * count : (k + 1) * count, : k * count] for k in range(length)]
    sums, history = HistorySum(kernels, points.parities), History()
    law, psi, eta = np.zeros((steps, count)), np.zeros((steps, count)), np.zeros((steps, absorbers.count))
    velocity = np.zeros((points.surfaces, points.parities, points.modes, steps))
    loads = np.ascontiguousarray(load.T[::-1])
    for start in range(0, steps - 1, length):  # forces begin at step 1: the first instant is at rest
        block = slice(start, min(start + length, steps - 1))
        ahead = sums.forcing(history, block.stop - start)
        known = loads[block] - points.project_transposed(ahead).T
        for k in range(block.stop - start):
            before = psi[start : start + k].ravel()
            law[start + k], psi[start + k], eta[start + k] = step(known[k] - earlier[k] @ before if k else known[k])
        history, given = sums.push(history, points.evaluate_transposed(psi[block].T))
        velocity[..., block] = ahead + given
    return BackwardMarch(law[::-1].T, psi[::-1].T, eta[::-1].T, velocity[..., ::-1])


class _LinkStep:
    """One step backwards: lambda, psi and eta from what is known of lambda.

    Unknown is lambda alone: (1 + Z d) lambda = known - Z psi_known + B eta_known with d what it adds to psi at once, c + T dt/2, Z the
    answer of points and masses within the step. d changes little from step to step: an inverse is kept and the rest iterated.

    Parameters
    ----------
    absorbers : AbsorberSet
    own : ndarray, shape (2N, 2N)
        V^T within the step.
    laws : LawsBackwards
    half : float
        dt/2.
    """

    def __init__(self, absorbers: AbsorberSet, own: FloatArray, laws: LawsBackwards, half: float) -> None:
        n = absorbers.count
        self._n, self._laws = n, laws
        self._heavy = absorbers.mass > 0
        self._mobility = np.divide(half, absorbers.mass, out=np.zeros(n), where=self._heavy)
        self._pairs = np.tile(np.eye(n), (2, 1))
        self._answer = own + (self._pairs * self._mobility) @ self._pairs.T
        self._eta, self._sum = np.zeros(n), np.zeros(n)
        self._inverse: FloatArray | None = None

    def __call__(self, known: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return lambda, psi and eta of the next step backwards."""
        n = self._n
        ahead, at_once = self._laws.forces()
        eta = self._eta - self._mobility * self._sum
        if self._heavy.all():
            law = self._solved(known - self._answer @ ahead + np.concatenate([eta, eta]), at_once)
        else:
            law, eta = self._with_massless(known, ahead, at_once, eta)
        self._laws.take(law)
        psi = ahead + at_once * law
        self._sum = psi[:n] + psi[n:]
        self._eta = np.where(self._heavy, eta - self._mobility * self._sum, eta)
        return law, psi, self._eta

    def _solved(self, right: FloatArray, at_once: FloatArray) -> FloatArray:
        """Return lambda of (1 + Z d) lambda = right."""
        answer = self._answer
        if self._inverse is not None:
            law = self._inverse @ right
            last, aim = np.inf, _TOLERANCE * float(np.abs(right).max(initial=0.0))
            for _ in range(_MOST_ITERATIONS):
                missing = right - law - answer @ (at_once * law)
                size = float(np.abs(missing).max(initial=0.0))
                if size <= aim:
                    return law
                if size > _SLOWEST * last:
                    break
                law += self._inverse @ missing
                last = size
        inverse = self._inverse = np.asarray(np.linalg.inv(np.eye(2 * self._n) + answer * at_once), dtype=np.float64)
        law = inverse @ right
        law += inverse @ (right - law - answer @ (at_once * law))
        return law

    def _with_massless(self, known: FloatArray, ahead: FloatArray, at_once: FloatArray, eta: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return lambda, and eta before what heavy masses gain within the step: of a massless one that for which B^T psi = 0."""
        n, loose = self._n, ~self._heavy
        pairs = self._pairs[:, loose]
        system = np.block(
            [[np.eye(2 * n) + self._answer * at_once, -pairs], [pairs.T * at_once, np.zeros((pairs.shape[1], pairs.shape[1]))]]
        )
        held = np.where(self._heavy, eta, 0.0)
        right = np.concatenate([known - self._answer @ ahead + np.concatenate([held, held]), -pairs.T @ ahead])
        try:
            found = np.linalg.solve(system, right)
        except np.linalg.LinAlgError:
            remedy = "give them a linear stiffness, however small, such as 1 kN/m^2, or a mass"
            raise InputError("absorbers", "without mass, springs that are slack at rest leave them loose: no gradient", remedy) from None
        held[loose] = found[2 * n :]
        return found[: 2 * n], held
