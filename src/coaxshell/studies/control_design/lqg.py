"""Linear-quadratic-Gaussian control of state-space models, and what it does to the true loop: spill-over.

Of each order the controller minimises the mean of |z|^2 + rho |u|^2, z the stresses of the cores, under white pressure outside and white
noise of the sensors: u = -K x, x estimated with the gain L, both by Riccati equations,

    H(s) = -K (s - A + B K + L C - L D K)^-1 L .

It knows the model alone. The true loop has more poles of the same order, which it may drive: det(1 - G H) with the plant of the whole
system counts those that grow and has the margins.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.winding import turning
from coaxshell.response.summary_text import aligned
from coaxshell.solver.margins import followed, margins_of
from coaxshell.solver.plant import Plant, loci
from coaxshell.studies.control_design.fitted_orders import FittedOrders, OrderModel


@dataclass(frozen=True, eq=False)
class LqgController:
    """u = H y of one order, from the sensors of all controlled shells to their actuators.

    Attributes
    ----------
    order : int
    a, b, c : ndarray
        Of H = C (s - A)^-1 B, s in 1/s.
    modelled, unstable : int
        Poles that grow: of the loop of the model, and of the true loop within the duration.
    gain_margin, phase_margin : float
        Of the true loop, all laws changed alike: a factor above 1, degrees; NaN where it is unstable.
    """

    order: int
    a: FloatArray
    b: FloatArray
    c: FloatArray
    modelled: int
    unstable: int
    gain_margin: float
    phase_margin: float

    def at(self, s: ComplexArray) -> ComplexArray:
        """Return H at s (1/s), (actuators, sensors, nodes)."""
        inverse = np.linalg.solve(s[:, None, None] * np.eye(len(self.a)) - self.a, self.b.astype(np.complex128))
        return np.asarray(np.moveaxis(self.c @ inverse, 0, -1))


@dataclass(frozen=True)
class LqgDesign:
    """The controllers of all orders; ``print(design)`` tells which of them the true loop stands."""

    controllers: tuple[LqgController, ...]

    @property
    def stable(self) -> bool:
        """Whether the true loop of every order is stable."""
        return all(one.unstable == 0 for one in self.controllers)

    def __str__(self) -> str:
        """Return the aligned table."""
        rows = [("order", "states", "growing: model", "true loop", "gain margin", "phase margin")]
        for one in self.controllers:
            margins = (f"{one.gain_margin:.3g}", f"{one.phase_margin:.3g} deg") if one.unstable == 0 else ("", "")
            rows.append((str(one.order), str(len(one.a)), str(one.modelled), str(one.unstable), *margins))
        return "\n".join(aligned(rows))


def lqg(model: FittedOrders, effort: float, noise: float) -> LqgDesign:
    """Return the controllers of a model, judged on the true loop.

    Parameters
    ----------
    model : FittedOrders
    effort : float
        Square root of rho, over the largest stress per volt: the smaller, the stronger.
    noise : float
        Of the sensors over what the pressure outside makes them read at most.

    Raises
    ------
    InputError
        If a number is not above 0.
    """
    for name, value in (("effort", effort), ("noise", noise)):
        if not 0.0 < value < float("inf"):
            raise InputError(name, f"{value!r} is not allowed", "must be above 0")
    return LqgDesign(tuple(_judged(model, one, *_gains(model, one, effort, noise)) for one in model.orders))


def _gains(model: FittedOrders, order: OrderModel, effort: float, noise: float) -> tuple[FloatArray, FloatArray]:
    """Return K and L."""
    from scipy.linalg import solve_continuous_are

    count = len(model.inputs) - 1
    push, struck = order.b[:, :count], order.b[:, count:]
    read, stress = order.c[:count], order.c[count:]
    shown = np.abs(order.at(np.asarray(2j * np.pi * np.linspace(0.0, model.frequency, 200), dtype=np.complex128)))
    scale = shown[count:, :count].max()
    stress, through = stress / scale, order.d[count:, :count] / scale
    weight = effort**2 * np.eye(count) + through.T @ through
    cost = solve_continuous_are(order.a, push, stress.T @ stress, weight, s=stress.T @ through)
    state = np.linalg.solve(weight, push.T @ cost + through.T @ stress)
    direct = order.d[:count, count:]
    loud = (noise * shown[:count, count:].max()) ** 2 * np.eye(count) + direct @ direct.T
    spread = solve_continuous_are(order.a.T, read.T, struck @ struck.T, loud, s=struck @ direct.T)
    return state, np.linalg.solve(loud, read @ spread + direct @ struck.T).T


def _judged(model: FittedOrders, order: OrderModel, state: FloatArray, estimate: FloatArray) -> LqgController:
    """Return the controller of one order with what its loops do."""
    count, time = len(model.inputs) - 1, model.problem.scales.time
    push, read, through = order.b[:, :count], order.c[:count], order.d[:count, :count]
    a = order.a - push @ state - estimate @ read + estimate @ through @ state
    loop = np.block([[order.a, -push @ state], [estimate @ read, a - estimate @ through @ state]])
    modelled = int((np.linalg.eigvals(loop).real > 0.0).sum())
    s = _contour(model, order.order, np.abs(np.linalg.eigvals(a)).max() * time)
    plant = Plant.of(model.problem, Modes(np.array([float(order.order)])), s)
    found = LqgController(order.order, a, estimate, -state, modelled, 0, np.nan, np.nan)
    values = loci(plant.transfer, found.at(s / time)[:, :, None, :])
    closed = np.prod(1.0 - values, axis=0)
    own = int((np.linalg.eigvals(a).real * time > s[0].real).sum())  # poles of H that grow by themselves
    unstable = int(np.rint(-(turning(closed) + np.angle(1.0 / closed[:, -1]))[0] / np.pi)) + own
    if unstable > 0:
        return LqgController(order.order, a, estimate, -state, modelled, unstable, np.nan, np.nan)
    margins = [margins_of(plant.modes.orders, s, one) for one in followed(values)]
    gain, phase = (min(float(getattr(one, name)[0]) for one in margins) for name in ("gain", "phase"))
    return LqgController(order.order, a, estimate, -state, modelled, 0, gain, float(np.degrees(phase)))


def _contour(model: FittedOrders, order: int, fastest: float) -> ComplexArray:
    """Return Re s = 1/duration, evenly beyond the walls' highest frequency and the controller's, then by a growing step."""
    ends = Modes(np.array([1.0, max(1.0, float(order))]))
    walls = max(float(np.hypot(*wall.highest_frequency(ends))) for wall in model.problem.shells if wall.moves)
    highest, least = 1.2 * max(walls, min(fastest, 20.0 * walls)), 1.0 / model.settings.duration
    nodes = np.union1d(np.arange(0.0, highest, 0.4 * least), np.geomspace(highest, 100.0 * highest, 200))
    return np.asarray(least + 1j * nodes, dtype=np.complex128)
