"""State-space models of circumferential orders, as data: what a fit gives and a design takes."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.prefixes import engineering
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.response.summary_text import aligned
from coaxshell.solver.scaling import Problem
from coaxshell.solver.settings import Settings


@dataclass(frozen=True, eq=False)
class OrderModel:
    """dx/dt = A x + B u, y = C x + D u of one circumferential order, t in seconds.

    Attributes
    ----------
    order : int
    a, b, c, d : ndarray
    error : float
        Largest difference from the true transfer functions within the band, between the nodes of the fit, over the largest of each.
    """

    order: int
    a: FloatArray
    b: FloatArray
    c: FloatArray
    d: FloatArray
    error: float

    def at(self, s: ComplexArray) -> ComplexArray:
        """Return C (s - A)^-1 B + D at s (1/s), (outputs, inputs, nodes)."""
        inverse = np.linalg.solve(s[:, None, None] * np.eye(len(self.a)) - self.a, self.b.astype(np.complex128))
        return np.asarray(np.moveaxis(self.c @ inverse + self.d, 0, -1))

    @property
    def scipy(self) -> Any:
        """As ``scipy.signal.StateSpace``."""
        from scipy.signal import StateSpace

        return StateSpace(self.a, self.b, self.c, self.d)

    @property
    def control(self) -> Any:
        """As ``control.StateSpace`` of python-control; InputError if that is not installed."""
        try:
            toolbox = import_module("control")
        except ImportError:
            raise InputError("control", "python-control is not installed", "pip install control, or use .scipy") from None
        return toolbox.ss(self.a, self.b, self.c, self.d)


@dataclass(frozen=True, eq=False)
class FittedOrders:
    """State-space models of some orders, with the names of what goes in and comes out; files of them.

    Attributes
    ----------
    problem : Problem
    settings : Settings
    frequency : float
        Up to where they hold, Hz.
    inputs, outputs : tuple of str
        Volts on the actuators of each controlled shell and the modal pressure outside (Pa); volts of their sensors and the hoop stress of
        their cores (Pa).
    orders : tuple of OrderModel
    """

    problem: Problem
    settings: Settings
    frequency: float
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    orders: tuple[OrderModel, ...]

    def __getitem__(self, order: int) -> OrderModel:
        """Return the model of an order."""
        known = {one.order: one for one in self.orders}
        if order not in known:
            raise InputError("order", f"{order!r} was not fitted", f"allowed: {', '.join(map(str, known))}")
        return known[order]

    def __str__(self) -> str:
        """Return what each order takes and how well it is met."""
        rows = [("order", "states", "largest error"), *((str(x.order), str(len(x.a)), f"{x.error:.1e}") for x in self.orders)]
        head = f"up to {engineering(self.frequency, 'Hz')}, from {', '.join(self.inputs)} to {', '.join(self.outputs)}"
        return "\n".join([head, *aligned(rows)])

    def save(self, path: str | Path) -> Path:
        """Write A, B, C and D of every order to a MATLAB file and return its path; InputError if it has another ending."""
        from scipy.io import savemat

        if Path(path).suffix != ".mat":
            raise InputError("path", f"{str(path)!r} is no MATLAB file", "give a path that ends in .mat")
        orders = [{"order": x.order, "A": x.a, "B": x.b, "C": x.c, "D": x.d, "error": x.error} for x in self.orders]
        told = {"inputs": list(self.inputs), "outputs": list(self.outputs), "frequency": self.frequency}
        savemat(path, {"orders": np.array(orders, dtype=object), **told})
        return Path(path)
