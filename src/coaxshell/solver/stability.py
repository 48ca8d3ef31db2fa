"""Whether the closed loop is stable: poles with a growth that would show within the duration, counted before any marching.

The modal determinants with and without feedback, D_m and D0_m, have the same leading behaviour, and D0_m has no zero in the
right half plane. By the argument principle the number of unstable poles of order m is minus the change of arg(D_m/D0_m) along
s = sigma_0 + i omega, omega from 0 to infinity, divided by pi.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import NamedTuple

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.errors import InputError
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.winding import turning
from coaxshell.solver.coupling import ModalSystem, determinant
from coaxshell.solver.scaling import Problem
from coaxshell.solver.shared_parts import SharedParts

_MAX_NODES = 8192
_SPACING = 0.8
"""Node spacing over sigma_0: the phase of a pole on the imaginary axis turns by less than a radian between nodes."""
_BLOCK = 512


class UnstablePoles(NamedTuple):
    """Orders with unstable poles and how many each has."""

    orders: FloatArray
    counts: FloatArray


@dataclass(frozen=True)
class OpenLoop:
    """The system without feedback at some nodes, and what feedback adds to it per unit gain: the same for all gains.

    Attributes
    ----------
    diagonal, coupling : sequence of ndarray, shape (orders, nodes)
        Of its tridiagonal matrix; see :class:`coaxshell.solver.coupling.ModalSystem`.
    determinant : ndarray, shape (orders, nodes)
    fed_back : dict of int to ndarray
        By number of the controlled shell.
    """

    diagonal: Sequence[ComplexArray]
    coupling: Sequence[ComplexArray | float]
    determinant: ComplexArray
    fed_back: dict[int, ComplexArray]

    @property
    def nbytes(self) -> int:
        """Bytes of all arrays."""
        arrays = [*self.diagonal, *self.coupling, self.determinant, *self.fed_back.values()]
        return sum(x.nbytes for x in arrays if isinstance(x, np.ndarray))

    @classmethod
    def of(cls, problem: Problem, nodes: ComplexArray, modes: Modes, shared: SharedParts | None) -> OpenLoop:
        """Return it for a problem, whose gains only tell which shells are controlled."""
        system = ModalSystem(problem.open_loop, nodes, modes, shared=shared)
        fed_back = {
            i: wall.fed_back(modes, operator)
            for i, (wall, operator) in enumerate(zip(problem.shells, system.shells, strict=True))
            if wall.gains is not None
        }
        return cls(system.diagonal, system.coupling, determinant(system.diagonal, system.coupling), fed_back)

    def closed(self, problem: Problem, nodes: ComplexArray) -> ComplexArray:
        """Return D_m/D0_m, the determinant with the feedback of a problem over that without."""
        diagonal = list(self.diagonal)
        for i, pressure in self.fed_back.items():
            gains = problem.shells[i].gains
            if gains is not None:
                diagonal[i] = diagonal[i] - gains.at(nodes) * pressure
        return np.asarray(determinant(diagonal, self.coupling) / self.determinant)


def with_gains(problem: Problem, proportional: float, derivative: float) -> Problem:
    """Return the problem with the gains of every controlled shell scaled by 0 or 1 each."""
    shells = (wall.with_gains(None if wall.gains is None else wall.gains.scaled(proportional, derivative)) for wall in problem.shells)
    return replace(problem, shells=tuple(shells))


def highest_frequency(problem: Problem, max_order: int, wavenumber: float | ComplexArray = 0.0) -> float:
    """Return a power of two above which feedback is less than half of every controlled shell's inertia."""
    highest = max(1.0, *(wall.feedback_frequency(Modes.up_to(max_order, wavenumber)) for wall in problem.shells))
    return float(2.0 ** np.ceil(np.log2(highest)))  # the same for gains that differ little, whose nodes can be shared


def _contour(problem: Problem, modes: Modes, duration: float) -> tuple[float, FloatArray]:
    """Return sigma_0 and the frequencies: evenly spaced as far as shells resonate, then by a growing step to where feedback fades."""
    highest = Modes(modes.orders[-1:], modes.wavenumber)
    resonance = max(float(wall.highest_frequency(highest)[0]) for wall in problem.shells)
    fades = highest_frequency(problem, modes.max_order, modes.wavenumber)
    dense = min(1.2 * resonance, fades)
    shift = max(1.0 / duration, dense / (_SPACING * _MAX_NODES))
    even = np.arange(0.0, dense + _SPACING * shift, _SPACING * shift)
    beyond = np.geomspace(even[-1], max(fades, 1.02 * even[-1]), 200)
    return shift, np.concatenate([even, beyond[1:]])


def unstable_poles(
    problem: Problem, max_order: int, duration: float, shared: SharedParts | None = None, wavenumber: float = 0.0
) -> UnstablePoles:
    """Return the orders whose response, at an axial wavenumber, would grow by more than a factor e within the duration."""
    modes = Modes.up_to(max_order, wavenumber)
    shift, frequencies = _contour(problem, modes, duration)
    controlled = tuple(shell.gains is not None for shell in problem.shells)
    known = (problem.open_loop.shells, controlled, problem.fluids, problem.scales, modes.key)
    orders = modes.orders
    turned = np.zeros(orders.size)
    for start in range(0, frequencies.size, _BLOCK):
        block = np.asarray(shift + 1j * frequencies[start : start + _BLOCK + 1], dtype=np.complex128)  # shares a node with the next
        make = partial(OpenLoop.of, problem, block, modes, shared)
        if shared is not None:
            open_loop = shared.get_or_make(("open loop", *known, block.tobytes()), make)
        else:
            open_loop = make()
        ratio = open_loop.closed(problem, block)
        turned += turning(ratio)
    turned += np.angle(1.0 / ratio[:, -1])  # beyond the last node the ratio tends to 1 without turning
    counts = np.rint(-turned / np.pi)
    found = counts > 0
    return UnstablePoles(orders[found], counts[found])


def require_stable(problem: Problem, max_order: int, duration: float, shared: SharedParts | None = None, wavenumber: float = 0.0) -> None:
    """Raise InputError, naming gain and order, if the closed loop is unstable at an axial wavenumber."""
    if all(shell.gains is None for shell in problem.shells):
        return
    unstable = unstable_poles(problem, max_order, duration, shared, wavenumber)
    if unstable.orders.size == 0:
        return
    control = problem.system.control
    assert control is not None
    gains = {"proportional": control.proportional, "derivative": control.derivative}
    alone = {
        "proportional": unstable_poles(with_gains(problem, 1.0, 0.0), max_order, duration, wavenumber=wavenumber).orders.size > 0,
        "derivative": unstable_poles(with_gains(problem, 0.0, 1.0), max_order, duration, wavenumber=wavenumber).orders.size > 0,
    }
    guilty = [name for name, bad in alone.items() if bad] or list(gains)
    where = f" at the axial wavenumber {wavenumber:.3g}/a" if wavenumber else ""
    listed = ", ".join(f"{order:.0f}" for order in unstable.orders[:5]) + (", ..." if unstable.orders.size > 5 else "")
    raise InputError(
        " and ".join(f"control.{name}" for name in guilty),
        f"{' and '.join(f'{gains[name]:g}' for name in guilty)} makes the closed loop unstable: order {listed}{where} grows without bound",
        "use a smaller magnitude or the other sign (negative gains stiffen and damp)",
    )
