"""How a number read from a run changes with walls, fluids and sources: one pass over the nodes, then a product for every variable.

At each order and node W = D^{-1} L, D the tridiagonal matrix of impedances and added masses, L the loads of sources and links, V = (V/W) W.
If Re sum(X dW) is what the number changes by (:class:`coaxshell.solver.adjoint.answer.Backwards`), then

    d(number) = Re sum(a dL - a W^T dD + X_V W d(V/W)),        a = D^{-T} (X_W + (V/W) X_V),

and step weights of the velocity kernels, which are transforms of s D^{-1}, add -D^{-T} X_K D^{-T} to what D is multiplied by. What a
variable changes in D, L and V/W costs no Bessel function where it belongs to a wall; it is differenced, not the run.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy import fft

from coaxshell.acoustics.basis import RadialBasis
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.threads import WORKERS
from coaxshell.solver.adjoint.answer import Backwards, Felt
from coaxshell.solver.adjoint.planes import of_planes
from coaxshell.solver.coupling import fluid_matrix
from coaxshell.solver.excitation import SurfaceLoads
from coaxshell.solver.kernels import exponential_weights, initial_decay
from coaxshell.solver.quadrature import trapezoidal_weights, unresolved_orders
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solved_spectra import SolvedSpectra


@dataclass(frozen=True)
class _Bars:
    """What a number changes by per unit of the ingredients of the modal system, each (M + 1, nodes), in lists by shell."""

    diagonal: ComplexArray
    upper: ComplexArray
    lower: ComplexArray
    tangential: ComplexArray
    load: ComplexArray


class StructureSensitivity:
    """What a number changes by with the structure of a run whose walls have one W.

    Parameters
    ----------
    solved : SolvedSpectra
    back : Backwards
    """

    def __init__(self, solved: SolvedSpectra, back: Backwards) -> None:
        self._solved, self._back = solved, back
        self._structure, self._grid, self._modes = solved.structure, solved.grid, solved.modes

    def change(self, before: Problem, after: Problem) -> float:
        """Return what the number changes by to first order from one problem near that of the run to another, absorbers left as they are."""
        bars, s, total = self._bars, self._grid.nodes, 0.0
        pairs = list(zip(before.shells, after.shells, strict=True))
        for i, (old, new) in enumerate(pairs):
            if old != new and new.moves:
                first, second = old.operator(self._modes, s), new.operator(self._modes, s)
                total += summed(bars.diagonal[i], second.impedance - first.impedance)
                total += summed(bars.tangential[i], second.tangential - first.tangential)
                total += self._back.tighter[i] * float(np.log(old.radius / new.radius))
        wetted = any((old.radius, old.wetted) != (new.radius, new.wetted) for old, new in pairs)
        if wetted or before.fluids != after.fluids:
            total += self._of_fluids(before, after)
        if wetted or before.sources != after.sources or before.scales != after.scales or before.system.sources != after.system.sources:
            first_load, second_load = (self._load(problem) for problem in (before, after))
            total += summed(bars.load, second_load - first_load)
        if self._weights is not None:
            closed = [_closed_weights(problem, self._grid, self._modes) for problem in (before, after)]
            total += float(np.einsum("imt,imt->", np.einsum("iimt->imt", self._resolved), closed[1] - closed[0]))
            if self._late.any():
                total += self._of_late_orders(before, after)
        return total + of_planes(self._solved, self._back, before, after)

    def _of_fluids(self, before: Problem, after: Problem) -> float:
        s, bars = self._grid.nodes, self._bars
        first, second = (fluid_matrix(problem, RadialBasis(self._modes, s)) for problem in (before, after))
        free, total, s2 = [wall.moves for wall in after.shells], 0.0, s * s
        for i, moves in enumerate(free):
            if not moves:
                continue
            total += summed(bars.diagonal[i], s2 * (second.diagonal[i] - first.diagonal[i]))
            if i + 1 < len(free) and free[i + 1]:
                total += summed(bars.upper[i], s2 * (second.upper[i] - first.upper[i]))
            if i > 0 and free[i - 1]:
                total += summed(bars.lower[i], s2 * (second.lower[i] - first.lower[i]))
        return total

    def _load(self, problem: Problem) -> ComplexArray:
        """Return the load on W of the outermost shell, shape (parities, M + 1, nodes)."""
        radial = RadialBasis(self._modes, self._grid.nodes)
        loads = SurfaceLoads(problem, self._grid, self._modes, None, self._structure.returned)(radial, slice(0, self._grid.nodes.size))
        return problem.shells[-1].leverage[1] * np.stack(loads[: self._bars.load.shape[0]])

    def _of_late_orders(self, before: Problem, after: Problem) -> float:
        """Return the change by the kernels of orders that the step does not resolve, whose nodes are others."""
        assert self._weights is not None
        modes = type(self._modes)(self._modes.orders[self._late])
        first, second = (trapezoidal_weights(problem, self._grid, modes, [])[0] for problem in (before, after))
        return float(np.einsum("ijmt,ijmt->", self._weights[:, :, self._late], second - first))

    @cached_property
    def _late(self) -> npt.NDArray[np.bool_]:
        return unresolved_orders(self._solved.problem, self._grid, self._modes)

    @cached_property
    def _weights(self) -> FloatArray | None:
        """What the number changes by per unit of every step weight, shape (shells, shells, M + 1, T); None where nothing was marched."""
        return None if self._back.felt is None else weights_of(self._back.felt)

    @cached_property
    def _resolved(self) -> FloatArray:
        """Return what the number changes by per unit of every step weight, 0 for orders that the step does not resolve."""
        assert self._weights is not None
        return np.where(self._late[:, None], 0.0, self._weights)

    @cached_property
    def _bars(self) -> _Bars:
        back, solved, grid = self._back, self._solved, self._grid
        compliance, ratio = self._structure.compliance, self._structure.tangential_ratio[:, None]
        normal, source = solved.normal, self._structure.normal
        h, sources = normal.shape[1], source.shape[1]
        answers = _through(compliance, back.reading.normal + ratio * back.reading.tangential)
        matrix = -np.einsum("ihmk,jhmk->ijmk", answers, normal)
        load = answers[-1, :sources].copy()
        tangential = np.einsum("ihmk,ihmk->imk", back.reading.tangential, normal)
        if back.felt is not None:
            shared = min(sources, back.felt.displacement.shape[1])
            felt = grid.invert_transposed(back.felt.displacement[:, :shared])
            felt += grid.nodes * grid.invert_transposed(back.felt.velocity[:, :shared])
            answers = _through(compliance, felt)
            matrix -= np.einsum("ihmk,jhmk->ijmk", answers, source[:, :shared])
            load[:shared] += answers[-1]
            kernels = grid.invert_transposed(self._resolved) * (grid.nodes * grid.hat * grid.time_step)
            matrix -= np.einsum("kimn,klmn,jlmn->ijmn", compliance, kernels, compliance, optimize=True)
        assert h >= sources
        n = len(solved.problem.shells)
        nothing = np.zeros_like(matrix[0, 0])
        return _Bars(
            diagonal=np.stack([matrix[i, i] for i in range(n)]),
            upper=np.stack([matrix[i, i + 1] if i + 1 < n else nothing for i in range(n)]),
            lower=np.stack([matrix[i, i - 1] if i > 0 else nothing for i in range(n)]),
            tangential=tangential,
            load=load,
        )


def _through(compliance: ComplexArray, per_motion: ComplexArray) -> ComplexArray:
    """Return what a number changes by per unit of load from what it changes by per unit of W: D^{-T} X."""
    return np.asarray(np.einsum("ijmk,ihmk->jhmk", compliance, per_motion))


def summed(bar: ComplexArray, change: ComplexArray | float) -> float:
    """Return the real part of the sum of products."""
    return float(np.vdot(np.conjugate(bar), np.broadcast_to(change, bar.shape)).real)


def weights_of(felt: Felt) -> FloatArray:
    """Return sum over steps n of what velocities at n change times pressures k steps before, shape (shells, shells, M + 1, T)."""
    steps = felt.pressure.shape[-1]
    length = fft.next_fast_len(2 * steps - 1, real=True)
    velocity, pressure = (fft.rfft(x, length, axis=-1, workers=WORKERS) for x in (felt.forced, felt.pressure))
    product = np.einsum("ihmk,jhmk->ijmk", velocity, np.conjugate(pressure))
    return np.asarray(fft.irfft(product, length, axis=-1, workers=WORKERS)[..., :steps])


def _closed_weights(problem: Problem, grid: LaplaceGrid, modes: Modes) -> FloatArray:
    """Return the part of a shell's step weights on itself that depends on its mass and decay alone, shape (shells, M + 1, T)."""
    found = np.zeros((len(problem.shells), modes.count, grid.time.size))
    hat = grid.hat * grid.time_step
    for i, wall in enumerate(problem.shells):
        if wall.moves:
            mass, decay = wall.leading(modes).mass, initial_decay(problem, i, modes)
            found[i] = exponential_weights(decay, grid) / mass - grid.invert(hat / (mass * (grid.nodes + decay)))
    return found
