"""How fast a system with a slip grows, where the slip makes it unstable: its fastest pole, by the argument principle.

The modal determinants with and without slips, D_m and D0_m, have the same leading behaviour (the shells' inertia), and D0_m has no zero
in the right half plane. The number of zeros of D_m with a real part above sigma is therefore minus the change of arg(D_m/D0_m) along
sigma + i omega, omega from 0 to infinity, over pi. sigma is bisected roughly; Newton's method from the contour's smallest |D_m/D0_m|
then finds the zero itself, for every order that has one beyond it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.acoustics.operators import all_orders
from coaxshell.apps.paper.slips.switches import slipped
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.winding import turning
from coaxshell.solver.contour import highest_frequency
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.scaling import Problem, dimensionless

if TYPE_CHECKING:
    from coaxshell.model import System

_SPACING = 0.4
_BLOCK = 512
_STEP = 4.0
_ROUGHLY = 1.15
_ITERATIONS = 40


@dataclass(frozen=True)
class Growth:
    """The fastest growing motion: amplitudes e^{rate t} of circumferential order *order*, t in transits."""

    rate: float
    order: int


def growth(system: System, slips: frozenset[str], modes: int, slowest: float = 0.2) -> Growth | None:
    """Return the fastest growth of a system without its absorbers, with slips turned on; None if nothing grows faster than *slowest*.

    Parameters
    ----------
    system : System
    slips : frozenset of str
    modes : int
        Highest circumferential order.
    slowest : float
        Per transit; 0.2 is a factor e in the paper's five transits.
    """
    problem = slipped(system.replace(absorbers=()), slips)
    reference = dimensionless(problem.system.replace(control=None))
    orders = all_orders(modes)
    rate = 2.0 * _highest(problem, modes)
    while not (found := _unstable(problem, reference, orders, rate)).any():
        if rate <= slowest:
            return None
        rate = max(rate / _STEP, slowest)
    low, high = rate, rate * _STEP
    while high / low > _ROUGHLY:
        middle = float(np.sqrt(low * high))
        above = _unstable(problem, reference, orders[found], middle)
        if above.any():
            low, found[found] = middle, above
        else:
            high = middle
    roots = [(_root(problem, reference, order, low), int(order)) for order in orders[found]]
    fastest, order = max(roots)
    return Growth(fastest, order)


def _root(problem: Problem, reference: Problem, order: float, shift: float) -> float:
    """Return the real part of the zero of one order's determinant next to a contour, at least *shift* itself."""
    frequencies = _contour(problem, int(order), shift)
    only = Modes(np.array([order]))

    def determinant(s: complex) -> complex:
        nodes = np.array([s], np.complex128)
        without = ModalSystem(reference, nodes, only)
        return complex((ModalSystem(problem, nodes, only, radial=without.radial).determinant() / without.determinant())[0, 0])

    nodes = np.asarray(shift + 1j * frequencies, dtype=np.complex128)
    without = ModalSystem(reference, nodes, only)
    size = np.abs(ModalSystem(problem, nodes, only, radial=without.radial).determinant() / without.determinant())[0]
    s = complex(nodes[int(size.argmin())])
    for _ in range(_ITERATIONS):
        step = 1e-6 * abs(s)
        change = determinant(s) * 2.0 * step / (determinant(s + step) - determinant(s - step))
        s = complex(max((s - change).real, 0.5 * shift), (s - change).imag)
        if abs(change) < 1e-9 * abs(s):
            break
    return max(s.real, shift)


def _highest(problem: Problem, modes: int) -> float:
    """Return a frequency above all resonances of the shells and above which feedback no longer matters."""
    order = Modes(np.array([float(modes)]))
    resonances = [float(wall.highest_frequency(order)[0]) for wall in problem.shells]
    return 1.2 * max(*resonances, highest_frequency(problem, modes))


def _contour(problem: Problem, modes: int, shift: float) -> FloatArray:
    """Return frequencies evenly spaced as far as the shells resonate, then by a growing step to where slips and feedback fade."""
    order = Modes(np.array([float(modes)]))
    resonance = 1.2 * max(float(wall.highest_frequency(order)[0]) for wall in problem.shells)
    even = np.arange(0.0, resonance + 2.0 * shift, _SPACING * shift)
    top = 10.0 * max(_highest(problem, modes), even[-1])
    return np.concatenate([even, np.geomspace(even[-1], top, 400)[1:]])


def _unstable(problem: Problem, reference: Problem, orders: FloatArray, shift: float) -> np.ndarray:
    """Return, for every order, whether a zero of its determinant has a real part above *shift*."""
    frequencies = _contour(problem, int(orders[-1]), shift)
    turned = np.zeros(orders.size)
    for start in range(0, frequencies.size - 1, _BLOCK):
        nodes = np.asarray(shift + 1j * frequencies[start : start + _BLOCK + 1], dtype=np.complex128)  # shares a node with the next
        without = ModalSystem(reference, nodes, Modes(orders))
        ratio = ModalSystem(problem, nodes, Modes(orders), radial=without.radial).determinant() / without.determinant()
        turned += turning(ratio)
    turned += np.angle(1.0 / ratio[:, -1])
    unstable: np.ndarray = np.rint(-turned / np.pi) > 0
    return unstable
