"""A stress at one depth of a wall: its components by modes, what it can reach at an instant, and its magnitude at angles."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.circle import circle_angles, on_circle
from coaxshell.response.components import SIDES, solid_von_mises, von_mises
from coaxshell.response.synthesis import angle_basis, at_angles


@dataclass(frozen=True)
class CutVoltage:
    """What an actuator whose voltage is cut at its limit adds: no sum of orders.

    Attributes
    ----------
    per_volt : mapping of str to float
        Pa per volt of each component.
    limit : float
        V.
    volts : callable
        From angles (degrees) and a window to the voltage there, (T, A).
    """

    per_volt: Mapping[str, float]
    limit: float
    volts: Callable[[FloatArray, Any], FloatArray]


class DepthStress:
    """A stress at one depth.

    Parameters
    ----------
    modal : mapping of str to ndarray, shape (parities, M + 1, T)
        Modal amplitudes of its components, Pa: one, or all that the von Mises stress is made of.
    cut : CutVoltage, optional
    """

    def __init__(self, modal: Mapping[str, FloatArray], cut: CutVoltage | None = None) -> None:
        self.modal, self._cut = modal, cut if cut is not None and any(cut.per_volt.values()) else None

    @property
    def orders(self) -> int:
        """M + 1."""
        return int(next(iter(self.modal.values())).shape[1])

    def reach(self, window: slice) -> FloatArray:
        """Return what the magnitude cannot exceed at any angle, at the instants of a window: a sum over orders of a norm of amplitudes."""
        parts = {name: modal[..., window] for name, modal in self.modal.items()}
        if len(parts) == 1:
            squares = next(iter(parts.values())) ** 2
        elif "radial" in parts:
            squares = solid_von_mises(**parts) ** 2
        else:
            hoop, axial = parts["hoop"], parts["axial"]
            squares = hoop**2 + (axial - hoop) * axial
            if "shear" in parts:
                squares = squares + 3.0 * parts["shear"] ** 2
        bound = np.sqrt(np.maximum(squares.sum(axis=0), 0.0)).sum(axis=0)
        cut = sum(abs(x) for x in self._cut.per_volt.values()) * self._cut.limit if self._cut else 0.0
        return np.asarray((bound + cut) * (1.0 + 1e-9))

    def on_circle(self, instants: Any) -> FloatArray:
        """Return the magnitude at the angles of :func:`~coaxshell.numerics.circle.circle_angles` and some instants, (A, T)."""
        some = {name: modal[..., instants] for name, modal in self.modal.items()}
        if all(SIDES[name] == "normal" for name in some):  # all by one transform
            together = on_circle(np.concatenate(list(some.values()), axis=-1))
            fields = dict(zip(some, np.split(together, len(some), axis=-1), strict=True))
        else:
            fields = {name: on_circle(modal) if SIDES[name] == "normal" else _sines(modal) for name, modal in some.items()}
        if self._cut:
            parities, orders, _ = next(iter(self.modal.values())).shape
            volts = self._cut.volts(circle_angles(orders, parities), instants).T
            fields = {name: field + self._cut.per_volt.get(name, 0.0) * volts for name, field in fields.items()}
        return _magnitude(fields)

    def at_angles(self, theta: FloatArray, window: Any) -> FloatArray:
        """Return the magnitude at angles (degrees), (T, A)."""
        fields = {}
        for name, modal in self.modal.items():
            parities, orders, _ = modal.shape
            fields[name] = at_angles(modal[..., window], angle_basis(theta, orders, parities, SIDES[name]))
            if self._cut and self._cut.per_volt.get(name):
                volts = self._cut.volts(theta, window)
                fields[name] = fields[name] + self._cut.per_volt[name] * volts
        return _magnitude(fields)


def _magnitude(fields: Mapping[str, FloatArray]) -> FloatArray:
    if len(fields) == 1:
        return np.abs(next(iter(fields.values())))
    if "radial" in fields:
        return solid_von_mises(**fields)
    return von_mises(fields["hoop"], fields["axial"], fields.get("shear", 0.0))


def _sines(modal: FloatArray) -> FloatArray:
    """Return the sum of sin(m theta) and -cos(m theta) at the angles of the circle."""
    if len(modal) == 2:
        return on_circle(np.stack([-modal[1], modal[0]]))
    return on_circle(np.stack([np.zeros_like(modal[0]), modal[0]]))[: len(circle_angles(modal.shape[1], 1))]
