"""What a wall tells the rest of the house: the protocol behind which thin, rigid and any other walls stand.

Everything that goes in and comes out is dimensionless (lengths in a, times in a/c_e, pressures in rho_e c_e^2), voltages are in volts.
A wall is linear; per mode, an order m at an axial wavenumber k, and Laplace node s its normal displacement W (positive inward) answers
the net inward pressure on it by its impedance Z, and every other quantity is recovered from W:

    Z W = p,      V = (V/W) W,      U = (U/W) W,      a quantity = gain.v V + gain.w W + gain.u U.

The fluids inside and outside wet it at the radii r_i and r_o, where their pressures act per unit of the area of its reference surface, of
radius R: p = p_o r_o/R - p_i r_i/R. A wall whose faces move differently answers by receptances instead (:class:`FaceReceptance`).

In the first parities w = W cos m theta cos kz, v = V sin m theta cos kz and u = U cos m theta sin kz (axial); the others share all of it.

A wall of another theory is a subclass of :class:`ShellModel`; nothing else needs to know of it.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, Self, TypeVar

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.structure.control_law import ControlLaw
from coaxshell.structure.losses import Relaxation
from coaxshell.structure.segments import Segments

Ratio = TypeVar("Ratio", FloatArray, ComplexArray)


def _column(entry: FloatArray) -> FloatArray:
    return entry if entry.ndim == 2 else entry[:, None]


class Gain(NamedTuple):
    """A quantity per unit amplitude V, W and U, each of the shape of the orders; U counts where there is an axial wavenumber."""

    v: FloatArray
    w: FloatArray
    u: FloatArray | None = None

    @property
    def columns(self) -> Gain:
        """Gains with an axis for the nodes."""
        return Gain(_column(self.v), _column(self.w), None if self.u is None else _column(self.u))

    def times(self, factor: npt.NDArray[Any] | float) -> Gain:
        """Return the gain in other units, or times a factor for each order, or for each order and node where it has columns."""
        return Gain(factor * self.v, factor * self.w, None if self.u is None else factor * self.u)

    def recovered(self, tangential: Ratio, axial: Ratio | None = None) -> Ratio:
        """Return the quantity per unit W where V is ``tangential`` and U ``axial`` times W."""
        found = self.v * tangential + self.w
        return found if self.u is None or axial is None else found + self.u * axial


SOLID_STRESSES = ("radial", "hoop", "axial", "shear", "radial_axial", "radial_hoop")
"""Stresses of an elastic wall at its design depth."""
FIELDS = ("w", "w_z", "w_zz", "v", "v_z", "u", "u_z", *SOLID_STRESSES)
"""Displacements and their derivatives along the axis, at a station; the stresses of elastic walls."""


class FieldGain(NamedTuple):
    """A quantity of a station per unit of the fields there, each of the shape of the orders; None where a field does not count.

    Attributes
    ----------
    w, w_z, w_zz, v, v_z, u, u_z : ndarray or None
        Per unit amplitude of w, dw/dz, d2w/dz2, v, dv/dz, u and du/dz.
    radial, hoop, axial, shear, radial_axial, radial_hoop : ndarray or None
        Per unit of the stresses of an elastic wall.
    potential : float or ndarray
        Per volt of the potential of a piezoelectric layer, such as that in which the point lies.
    layer : int or None
        Its number among the piezoelectric layers, from the inside out.
    """

    w: FloatArray | None = None
    w_z: FloatArray | None = None
    w_zz: FloatArray | None = None
    v: FloatArray | None = None
    v_z: FloatArray | None = None
    u: FloatArray | None = None
    u_z: FloatArray | None = None
    radial: FloatArray | None = None
    hoop: FloatArray | None = None
    axial: FloatArray | None = None
    shear: FloatArray | None = None
    radial_axial: FloatArray | None = None
    radial_hoop: FloatArray | None = None
    potential: FloatArray | float = 0.0
    layer: int | None = None

    @property
    def fields(self) -> dict[str, FloatArray]:
        """Return the factors of the fields that count, by name."""
        return {name: getattr(self, name) for name in FIELDS if getattr(self, name) is not None}

    def recovered(self, fields: Mapping[str, FloatArray], potential: FloatArray | None = None) -> FloatArray:
        """Return the modal amplitudes of the quantity from those of the fields, by name, and of its layer's potential: (..., orders, T)."""
        total = sum((gain[:, None] * fields[name] for name, gain in self.fields.items()), np.zeros(1))
        if self.layer is None:
            return total
        if potential is None:
            raise ValueError("the point lies in a piezoelectric layer: give the potential of that layer")
        return total + self.potential * potential

    def plus(self, other: FieldGain) -> FieldGain:
        """Return the sum with a gain of fields alone."""
        added = {name: values + self.fields.get(name, 0.0) for name, values in other.fields.items()}
        return self._replace(**added)  # type: ignore[arg-type]

    def times(self, factor: FloatArray | float) -> FieldGain:
        """Return the gain in other units, or times a factor for each order."""
        fields = {name: factor * gain for name, gain in self.fields.items()}
        return FieldGain(**fields, potential=factor * self.potential, layer=self.layer)


@dataclass
class WallOperator:
    """One wall at some modes and nodes, each of shape (orders, nodes): dynamic stiffness Z (load per W), feedback included, V/W and U/W.

    ``axial`` is None where nothing moves along the axis, at k = 0.
    """

    impedance: ComplexArray
    tangential: ComplexArray
    axial: ComplexArray | None = None


class Leading(NamedTuple):
    """How a wall answers at once, Z = mass s^2 + damping s + O(1): ``damping`` is a number or of shape (orders, 1)."""

    mass: float
    damping: FloatArray | float


@dataclass(frozen=True)
class FaceReceptance:
    """How both faces of one wall answer inward loads on them, feedback included; arrays of shape (orders, nodes), or numbers.

        w_i = H_ii r_i q_i + H_io r_o q_o,      w_o = H_oi r_i q_i + H_oo r_o q_o,

    q_i = -p_i the inward load on the inner face, q_o = p_o that on the outer one. H is symmetric, but where sensors and actuators are not
    the same, and for a thin wall nearly of rank one: it must never be inverted.

    Attributes
    ----------
    inner, across, outer : ndarray
        H_ii, H_io and H_oo.
    characteristic : ndarray or float
        A function of s that vanishes at the poles of H with feedback and is free of poles but for those that it has without feedback too:
        of a thin wall its impedance. What feedback makes of it counts in the search for unstable poles.
    other : ndarray or None
        H_oi where it is not H_io.
    """

    inner: ComplexArray
    across: ComplexArray
    outer: ComplexArray
    characteristic: ComplexArray | float = 1.0
    other: ComplexArray | None = None

    @property
    def back(self) -> ComplexArray:
        """H_oi."""
        return self.across if self.other is None else self.other


class WallStiffness(NamedTuple):
    """Entries of the symmetric stiffness of a wall on (V, W), each of the shape of the orders."""

    vv: FloatArray
    vw: FloatArray
    ww: FloatArray


class WallMotion(NamedTuple):
    """Histories of one wall, of which energies are made.

    Attributes
    ----------
    orders : ndarray, shape (M + 1,)
    circle : ndarray, shape (M + 1,)
        Integrals of cos^2(m theta) over the circle, beta pi.
    w, v, w_rate, v_rate : ndarray, shape (parities, M + 1, T)
        W, V, dW/dt, dV/dt.
    u, u_rate : ndarray or None
        U and dU/dt, of the same shape, with an axial wavenumber.
    wavenumber : float
        k, in units of 1/a.
    """

    orders: FloatArray
    circle: FloatArray
    w: FloatArray
    v: FloatArray
    w_rate: FloatArray
    v_rate: FloatArray
    u: FloatArray | None = None
    u_rate: FloatArray | None = None
    wavenumber: float = 0.0


class WallEnergy(NamedTuple):
    """Energies of one wall, each of shape (T,), in units of rho_e c_e^2 a^2 per length; open-circuit stiffening is ``piezoelectric``."""

    kinetic: FloatArray
    strain: FloatArray
    piezoelectric: FloatArray


class Arm(NamedTuple):
    """A spring and a damper in series within a wall.

    Attributes
    ----------
    time : float
        tau, transits: the spring keeps s tau/(1 + s tau) of every motion.
    stored : callable
        From what it keeps of the motion of the wall to the energy in the spring, shape (T,); 2/tau of it is turned into heat per time.
    """

    time: float
    stored: Callable[[WallMotion], FloatArray]


def square(weight: FloatArray, a: FloatArray, b: FloatArray) -> FloatArray:
    """Return sum over m of weight_m a_m b_m over both parities, shape (T,), of histories (parities, M + 1, T)."""
    return np.asarray(np.einsum("m,hmt,hmt->t", weight, a, b), dtype=np.float64)


@dataclass(frozen=True, kw_only=True)
class ShellModel(ABC):
    """A wall on a cylinder.

    Attributes
    ----------
    radius : float
        R/a, of its reference surface: the mid-surface of a thin wall.
    mass : float
        I/(rho_e a), by which it resists at once; infinite if it does not move.
    gains : ControlLaw or None
        Feedback from its sensor to its actuator.
    """

    radius: float
    mass: float
    gains: ControlLaw | None = None

    def with_gains(self, gains: ControlLaw | None) -> Self:
        """Return the wall with other feedback, or with none."""
        return replace(self, gains=gains)

    # Motion

    @property
    def moves(self) -> bool:
        """Whether it moves at all."""
        return True

    @property
    def wetted(self) -> tuple[float, float]:
        """Radii r_i and r_o, in a, of the surfaces that the fluids inside and outside wet: the reference surface unless said otherwise."""
        return self.radius, self.radius

    def resolving(self, frequency: float) -> Self:
        """Return the wall resolving waves up to a frequency, radians per transit: itself where its theory has no such choice."""
        return self

    def along_alone(self, highest: FloatArray) -> Self:
        """Return the wall without motions through its thickness, which ring above frequencies, (2, orders): of orders, these."""
        return self

    @property
    def leverage(self) -> tuple[float, float]:
        """Load on W per pressure on the inner and on the outer wetted surface, r_i/R and r_o/R; exactly 1 on the reference surface."""
        inner, outer = self.wetted
        return inner / self.radius, outer / self.radius

    @property
    def faces_move_alike(self) -> bool:
        """Whether one normal displacement W serves both faces, as of all thin walls."""
        return True

    def receptance(self, modes: Modes, s: ComplexArray) -> FaceReceptance:
        """Return how its faces answer loads on them, feedback included; of a wall with one W of rank one, 1/(R Z)."""
        impedance = self.operator(modes, s).impedance
        both = np.reciprocal(self.radius * impedance)
        return FaceReceptance(both, both, both, impedance)

    @abstractmethod
    def passive(self, modes: Modes, s: ComplexArray) -> WallOperator:
        """Return impedance, V/W and U/W without feedback."""

    @abstractmethod
    def highest_frequency(self, modes: Modes) -> FloatArray:
        """Return the highest frequency at which each mode resonates by itself, radians per transit: steps and contours resolve it."""

    def along_frequencies(self, modes: Modes) -> FloatArray:
        """Return the frequencies at which each mode resonates along the wall where W is held, shape (orders, number of them)."""
        return self.highest_frequency(modes)[:, None]

    def fastest_wave(self, max_wavenumber: float) -> float:
        """Return the speed, in c_e, of the fastest wave along its axis up to a wavenumber; 0 where nothing runs along it."""
        return 0.0

    @property
    def damping(self) -> float:
        """Coefficient of s in its impedance without feedback as s grows: 0 for a wall without losses."""
        return 0.0

    @property
    def crossing_order(self) -> float:
        """An order above which its stress may rise again before it falls, 0 if there is none: orders left out are sampled beyond it."""
        return 0.0

    def stiffness(self, modes: Modes) -> WallStiffness:
        """Return K of a wall that is M d2(v, w)/dt2 + K (v, w), as the direct engine steps it; InputError if it is none."""
        raise InputError("engine", "'direct' cannot step a wall of this kind", 'use engine="spectral"')

    def operator(self, modes: Modes, s: ComplexArray) -> WallOperator:
        """Return impedance, V/W and U/W with feedback, which adds -H(s) times what it feeds back per gain (Eqs. 4, 17, 20)."""
        found = self.passive(modes, s)
        if self.gains is not None:
            found.impedance -= self.gains.at(s, modes) * self.fed_back(modes, found)
        return found

    def resistance(self, modes: Modes, s: ComplexArray) -> FloatArray:
        """Return Re Z/s with feedback, how much energy its motion loses in it, at nodes of shape (nodes,) or (orders, nodes)."""
        return np.asarray((self.operator(modes, s).impedance / s).real)

    def leading(self, modes: Modes) -> Leading:
        """Return mass and damping at once: its own, and what derivative feedback adds."""
        if self.gains is None:
            return Leading(self.mass, self.damping)
        return Leading(self.mass, self.damping - self.actuator_pressure * self.gains.at_once(modes) * self.sensor_gain(modes).columns.w)

    # Transducers

    def has(self, role: str) -> bool:
        """Return whether it has a piezoelectric layer of a role, "sensor" or "actuator"."""
        return False

    def sensor_gain(self, modes: Modes, role: str = "sensor") -> Gain:
        """Return volts of an open-circuit layer per unit (V, W, U) (Eq. 20); zeros if it has no such layer."""
        return Gain(np.zeros_like(modes.orders), np.zeros_like(modes.orders))

    def layer_number(self, role: str) -> int | None:
        """Return the number of the layer of a role among the piezoelectric layers, from the inside out; None if it has none."""
        return None

    @property
    def shares(self) -> dict[int, float] | None:
        """By how much its actuators answer the reading of each wall, by number; None for their own alone."""
        return None

    @property
    def electrode_segments(self) -> Segments | None:
        """Segments into which its electrodes are cut; None where they are whole."""
        return None

    @property
    def shows_control(self) -> bool:
        """Whether what the control law reads and gives are the last two of the voltages shown."""
        return False

    @property
    def shown_potentials(self) -> int:
        """How many voltages stations along the axis show."""
        return 0

    def shown_voltages(self, modes: Modes, s: ComplexArray) -> tuple[Gain, ...]:
        """Return these per unit (V, W, U), each of shape (orders, 1) or (orders, nodes), where one W serves both faces."""
        return ()

    def potential_gains(self, modes: Modes) -> tuple[Gain, ...]:
        """Return volts per unit (V, W, U) of every open-circuit layer, from the inside out (Eq. 20)."""
        return ()

    @property
    def actuator_pressure(self) -> float:
        """Inward pressure per volt of control (Eqs. 4, 13); 0 without an actuator."""
        return 0.0

    def drive(self, modes: Modes) -> Gain:
        """Return the load on (V, W) per volt of control: the actuator's pressure on W alone, unless said otherwise."""
        return Gain(np.zeros_like(modes.orders), np.full_like(modes.orders, self.actuator_pressure))

    def voltage_limit(self, field: float | None = None) -> float:
        """Return the largest voltage of its actuator, V, by its material's field limit or another (V per a); infinite without one."""
        return float("inf")

    def fed_back(self, modes: Modes, moving: WallOperator) -> ComplexArray:
        """Return the actuator's pressure per W and unit gain: pressure per volt times the sensor's voltage per W; V/W and U/W are given."""
        volts = self.sensor_gain(modes).columns.recovered(moving.tangential, moving.axial)
        return np.asarray(self.actuator_pressure * volts)

    def charges(self, modes: Modes) -> tuple[tuple[Gain, float], ...]:
        """Return the charge of each layer that an amplifier drives, per area: per unit (V, W), and per volt; none of the paper's law."""
        return ()

    def fed_back_along(self, modes: Modes, s: ComplexArray) -> ComplexArray | float:
        """Return what a unit gain takes off the relative stiffness along the hoop, without feedback: nothing of a normal pressure."""
        return 0.0

    def driven_along(self, modes: Modes, s: ComplexArray) -> ComplexArray | float:
        """Return V per volt of control while W is held: 0 under a normal pressure."""
        return 0.0

    def fastest_rate(self, modes: Modes) -> FloatArray:
        """Return the highest rate of each order that steps have to resolve, that of strong damping included."""
        return self.highest_frequency(modes)

    def feedback_frequency(self, modes: Modes) -> float:
        """Return a frequency above which feedback is less than half of its inertia; 0 without feedback."""
        if self.gains is None:
            return 0.0
        volts = np.abs(np.stack([x for x in self.sensor_gain(modes) if x is not None])).max(axis=0) * abs(self.actuator_pressure)
        return self.gains.fades(volts * np.abs(self.gains.weight(modes.orders)) / self.mass)

    # Stress, energy, range of the theory

    def stress_gain(self, modes: Modes, depth: float | None = None, component: str = "hoop") -> Gain:
        """Return a stress per unit (V, W, U): of the core at the mid-surface (Eq. 22), or at a depth (outward of the mid-surface).

        "hoop" and "axial" stress go with cos m theta cos kz, as w does, "shear" with sin m theta sin kz: around as v does, along as u.

        Raises
        ------
        InputError
            If it has no stress, or none of that component.
        """
        raise InputError("shell", "this wall has no stress", "choose another one")

    def field_gain(self, orders: FloatArray, depth: float | None = None, component: str = "hoop") -> FieldGain:
        """Return a stress, as :meth:`stress_gain` names it, per unit of the fields at a station, which are sums over all wavenumbers.

        Raises
        ------
        InputError
            If it has no stress, or none of that component.
        """
        raise InputError("shell", "this wall has no stress from fields", "choose another one")

    def stress_parts(self, modes: Modes, depth: float | None = None, component: str = "hoop") -> tuple[tuple[Relaxation | None, Gain], ...]:
        """Return a stress as a sum of parts, each under a factor g(s), None for 1: one part of a wall without losses."""
        return ((None, self.stress_gain(modes, depth, component)),)

    def field_parts(
        self, orders: FloatArray, depth: float | None = None, component: str = "hoop"
    ) -> tuple[tuple[Relaxation | None, FieldGain], ...]:
        """Return the same of a stress per unit of the fields at a station."""
        return ((None, self.field_gain(orders, depth, component)),)

    def control_stress(self, depth: float, component: str = "hoop") -> float:
        """Return a stress per volt of control at a depth (Eq. A.10)."""
        return 0.0

    @property
    def faces(self) -> tuple[float, float]:
        """Depths of its inner and its outer face."""
        return 0.0, 0.0

    @property
    def sampled_depths(self) -> tuple[tuple[float, ...], ...]:
        """Depths of each layer, from the inside out, among which a magnitude of its stress is largest, or nearly so; none if not known."""
        return ()

    @property
    def relaxes(self) -> bool:
        """Whether its stress has parts under a factor g(s): it then depends on the whole history of the strain."""
        return False

    @abstractmethod
    def energy(self, motion: WallMotion) -> WallEnergy:
        """Return the energies of a motion."""

    @property
    def dissipates(self) -> bool:
        """Whether any energy turns into heat in it."""
        return False

    def dissipated_power(self, motion: WallMotion) -> FloatArray:
        """Return the power that turns into heat in it, shape (T,), but for that of its arms."""
        return np.zeros(motion.w.shape[-1])

    def arms(self) -> Iterator[Arm]:
        """Yield the springs and dampers in series that its losses are made of, in energies."""
        yield from ()

    def remarks(self) -> list[str]:
        """Return a sentence for each respect in which it lies outside the range of its theory, with both numbers and the remedy."""
        return []
