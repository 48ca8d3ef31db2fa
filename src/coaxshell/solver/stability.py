"""Whether the closed loop is stable: poles with a growth that would show within the duration, counted before any marching.

The modal determinants with and without feedback, D_m and D0_m, have the same leading behaviour, and D0_m has no zero in the
right half plane. By the argument principle the number of unstable poles of order m is minus the change of arg(D_m/D0_m) along
s = sigma_0 + i omega, omega from 0 to infinity, divided by pi.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from coaxshell.acoustics.bessel_ratios import ComplexArray
from coaxshell.acoustics.operators import FloatArray, all_orders
from coaxshell.errors import InputError
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.ingredients import OWN
from coaxshell.solver.scaling import ControlGains, Problem
from coaxshell.solver.workshop import Workshop

_MAX_NODES = 8192
_SPACING = 0.8
"""Node spacing over sigma_0: the phase of a pole on the imaginary axis turns by less than a radian between nodes."""
_BLOCK = 512


class UnstablePoles(NamedTuple):
    """Orders with unstable poles and how many each has."""

    orders: FloatArray
    counts: FloatArray


def with_gains(problem: Problem, proportional: float, derivative: float) -> Problem:
    """Return the problem with the gains of every controlled shell scaled by 0 or 1 each."""
    scaled = [
        None if s.gains is None else ControlGains(s.gains.proportional * proportional, s.gains.derivative * derivative)
        for s in problem.shells
    ]
    return replace(problem, shells=tuple(replace(s, gains=gains) for s, gains in zip(problem.shells, scaled, strict=True)))


def highest_frequency(problem: Problem, max_order: int) -> float:
    """Return a power of two above which feedback is less than half of every controlled shell's inertia."""
    orders = all_orders(max_order)
    highest = 1.0
    for i, shell in enumerate(problem.shells):
        if shell.gains is None:
            continue
        volts = np.abs(np.stack(problem.sensor_gain(i, orders))).max(axis=0) * abs(problem.actuator_pressure(i))
        damping = float((volts * abs(shell.gains.derivative)).max()) / shell.mass
        stiffness = float((volts * abs(shell.gains.proportional)).max()) / shell.mass
        highest = max(highest, 2.0 * damping + 2.0 * np.sqrt(stiffness))
    return float(2.0 ** np.ceil(np.log2(highest)))  # the same for gains that differ little, whose nodes can be shared


def _contour(problem: Problem, max_order: int, duration: float) -> tuple[float, FloatArray]:
    """Return sigma_0 and the frequencies: evenly spaced as far as shells resonate, then by a growing step to where feedback fades."""
    order = np.array([float(max_order)])
    resonances = [np.sqrt(problem.stiffness(i, order).vv[0] / s.mass) for i, s in enumerate(problem.shells) if s.section is not None]
    dense = min(1.2 * float(max(resonances)), highest_frequency(problem, max_order))
    shift = max(1.0 / duration, dense / (_SPACING * _MAX_NODES))
    even = np.arange(0.0, dense + _SPACING * shift, _SPACING * shift)
    beyond = np.geomspace(even[-1], max(highest_frequency(problem, max_order), 1.02 * even[-1]), 200)
    return shift, np.concatenate([even, beyond[1:]])


def unstable_poles(problem: Problem, max_order: int, duration: float, workshop: Workshop | None = None) -> UnstablePoles:
    """Return the orders whose response would grow by more than a factor e within the duration."""
    shift, frequencies = _contour(problem, max_order, duration)
    open_loop = replace(problem, shells=tuple(replace(shell, gains=None) for shell in problem.shells))
    known = (open_loop.shells, open_loop.fluids, open_loop.scales, max_order)
    orders = all_orders(max_order)
    turned = np.zeros(orders.size)
    for start in range(0, frequencies.size, _BLOCK):
        block = np.asarray(shift + 1j * frequencies[start : start + _BLOCK + 1], dtype=np.complex128)  # shares a node with the next
        closed = ModalSystem(problem, block, orders, workshop=workshop)
        without = partial(_determinant, open_loop, block, orders, closed)
        if workshop is not None and problem.ingredients == OWN:
            ratio = closed.determinant() / workshop.part(("open loop", *known, block.tobytes()), without)
        else:
            ratio = closed.determinant() / without()
        turned += np.angle(ratio[:, 1:] / ratio[:, :-1]).sum(axis=1)
    turned += np.angle(1.0 / ratio[:, -1])  # beyond the last node the ratio tends to 1 without turning
    counts = np.rint(-turned / np.pi)
    found = counts > 0
    return UnstablePoles(orders[found], counts[found])


def _determinant(problem: Problem, nodes: ComplexArray, orders: FloatArray, like: ModalSystem) -> ComplexArray:
    return ModalSystem(problem, nodes, orders, like=like).determinant()


def require_stable(problem: Problem, max_order: int, duration: float, workshop: Workshop | None = None) -> None:
    """Raise InputError, naming gain and order, if the closed loop is unstable."""
    if all(shell.gains is None for shell in problem.shells):
        return
    unstable = unstable_poles(problem, max_order, duration, workshop)
    if unstable.orders.size == 0:
        return
    control = problem.system.control
    assert control is not None
    gains = {"proportional": control.proportional, "derivative": control.derivative}
    alone = {
        "proportional": unstable_poles(with_gains(problem, 1.0, 0.0), max_order, duration).orders.size > 0,
        "derivative": unstable_poles(with_gains(problem, 0.0, 1.0), max_order, duration).orders.size > 0,
    }
    guilty = [name for name, bad in alone.items() if bad] or list(gains)
    listed = ", ".join(f"{order:.0f}" for order in unstable.orders[:5]) + (", ..." if unstable.orders.size > 5 else "")
    raise InputError(
        " and ".join(f"control.{name}" for name in guilty),
        f"{' and '.join(f'{gains[name]:g}' for name in guilty)} makes the closed loop unstable: order {listed} grows without bound",
        "use a smaller magnitude or the other sign (negative gains stiffen and damp)",
    )
