"""Feedback by any rational law: u = H(s) phi_s with delay, corners of its electronics and a weight for each order."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import BeforeValidator, WithJsonSchema, model_validator

from coaxshell.errors import InputError
from coaxshell.model.base import Described, shown
from coaxshell.model.control import CurrentLimit, End, PDControl, Transducers, _shells, require_current
from coaxshell.model.segments import Count, Dead, DeadBelts, DeadElectrodes, Gap, Length, require_segments
from coaxshell.model.units import DIMENSIONS, Delay, Frequency, quantity, to_si
from coaxshell.numerics.scalars import plain

if TYPE_CHECKING:
    import numpy.typing as npt

    from coaxshell.numerics.arrays import ComplexArray

_NUMBERS = {"type": "array", "items": {"type": "number", "unit": "", "examples": ["0.3"]}}
_ROUNDING = 1e-6
"""Real part of a pole, over its magnitude, that may be the rounding of one on the axis: twofold roots have half the digits."""


def _coefficients(value: Any) -> tuple[float, ...]:
    """Return the coefficients of a polynomial, highest power first, without leading zeros; one number is a constant."""
    value = plain(value)
    if not isinstance(value, list | tuple) and not hasattr(value, "tolist"):
        value = [value]
    found = []
    for place, one in enumerate(value if isinstance(value, list | tuple) else value.tolist()):
        try:
            found.append(to_si(one, DIMENSIONS["number"]))
        except InputError as error:
            raise InputError(f"[{place}]", error.problem, error.remedy) from None
    if not found:
        raise InputError("", "the list is empty", "give the coefficients of a polynomial in s, highest power first")
    while len(found) > 1 and found[0] == 0.0:
        del found[0]
    return tuple(found)


def _weights(value: Any) -> int | tuple[float, ...] | None:
    """Return the highest order that is fed back, a weight for each order from 0 on, or None for all alike."""
    value = plain(value)
    if value is None:
        return None
    remedy = "give the highest order that is fed back, or a list of weights of the orders 0, 1, 2, ..."
    if isinstance(value, int) and not isinstance(value, bool) and value >= 0:
        return value
    if not isinstance(value, list | tuple):
        raise InputError("", f"{shown(value)} is not allowed", remedy)
    found = []
    for place, one in enumerate(value):
        try:
            found.append(to_si(one, DIMENSIONS["number"]))
        except InputError as error:
            raise InputError(f"[{place}]", error.problem, error.remedy) from None
    if not found:
        raise InputError("", "the list is empty", remedy)
    return tuple(found)


def _matrix(value: Any) -> tuple[tuple[float, ...], ...] | None:
    """Return the rows of a square matrix, not all 0; None stays."""
    value = plain(value.tolist() if hasattr(value, "tolist") else value)
    if value is None:
        return None
    remedy = "give a row for each shell under control, with a number for each, as in [[1, 0.5], [0.5, 1]]"
    if not isinstance(value, list | tuple) or not value or not all(isinstance(row, list | tuple) for row in value):
        raise InputError("", f"{shown(value)} is not allowed", remedy)
    rows = []
    for place, row in enumerate(value):
        if len(row) != len(value):
            raise InputError(f"[{place}]", f"has {len(row)} numbers, and there are {len(value)} rows", remedy)
        try:
            rows.append(tuple(to_si(plain(one), DIMENSIONS["number"]) for one in row))
        except InputError as error:
            raise InputError(f"[{place}]", error.problem, error.remedy) from None
    if not any(map(any, rows)):
        raise InputError("", "holds nothing but 0: nothing is fed back", "leave control out, or give an entry that is not 0")
    return tuple(rows)


Coefficients = Annotated[tuple[float, ...], BeforeValidator(_coefficients), WithJsonSchema(_NUMBERS)]


class Feedback(Described):
    """Describe the control law u = H(s) e^{-s delay} phi_s, phi_s the sensor's potential and u the actuator's (V), s in 1/s.

    H is a ratio of polynomials, times 1/(1 + s/(2 pi corner)) for each corner. With the paper's transducers negative gains stiffen and
    damp, with electrodes positive ones. A :class:`PDControl` of k_p and k_d is the numerator [k_d a/c_e, k_p].
    """

    numerator: Coefficients
    """Coefficients of the numerator of H, highest power of s (1/s) first; V/V times s for each power."""
    denominator: Coefficients = (1.0,)
    """Coefficients of the denominator of H, highest power of s first."""
    delay: Delay = 0.0
    """Time by which the actuator answers late, of converters and computation (s)."""
    sensor_corner: Frequency | None = None
    """Frequency above which the sensor's amplifier falls off, of first order (Hz); at once unless given."""
    amplifier_corner: Frequency | None = None
    """The same of the amplifier that drives the actuator (Hz)."""
    weights: Annotated[int | tuple[float, ...] | None, BeforeValidator(_weights)] = None
    """Modal filter: the highest order that is fed back, or a list of weights of the orders 0, 1, 2, ..., 0 beyond; else all alike."""
    matrix: Annotated[tuple[tuple[float, ...], ...] | None, BeforeValidator(_matrix)] = None
    """Who reads whom, a row for each shell as "shells" has them: its actuators get H of the sum of the row times all readings."""
    bridge_imbalance: Annotated[float, quantity("number", above=-1)] = 0.0
    """By how much the bridge of self-sensing layers takes more off their charge than their capacitance holds, over it (-0.02: 2 % less)."""
    transducers: Transducers = "paper"
    """What reads and drives: "paper" reads curvature and drives by a pressure alone, "electrodes" strain, by traction and moment too."""
    shells: Annotated[tuple[int | End, ...] | Literal["all"], BeforeValidator(_shells)] = "all"
    """Which shells: "all", or numbers from 0 inside, "inner", "outer", "middle"; ``System.controlled_shells`` gives the numbers."""
    saturation: bool = False
    """Whether the actuator's voltage stops at the field limit."""
    field_limit: Annotated[float, quantity("electric field", above=0)] | None = None
    """Largest field on the actuator (V/m), above which a warning is given; the material's own unless given."""
    current_limit: CurrentLimit | None = None
    """Largest current of an amplifier over the area of wall that it drives (A/m^2), above which a warning is given."""
    current_saturation: bool = False
    """Whether the current stops at the current limit; the voltage then is what that current leaves."""
    segments: Count | None = None
    """Electrodes around each wall, all layers cut at the same places, each with its own loop; one that varies freely unless given."""
    segment_gap: Gap | None = None
    """Between neighbouring segments along the mid-surface, a strip held at ground (m)."""
    segment_pitch: Length | None = None
    """In three dimensions from electrode to electrode along the axis, middle to middle, one at z = 0 (m); not cut along it unless given."""
    segment_length: Length | None = None
    """Of each electrode along the axis (m), what is left of the pitch held at ground; the whole pitch unless given."""
    dead: Dead | None = None
    """Segments held at ground, which neither sense nor push: 0 has its middle at theta = 0, the others follow counterclockwise."""
    dead_belts: DeadBelts | None = None
    """Single belts held at ground whole: 0 has its middle at z = 0, n at n times segment_pitch."""
    dead_electrodes: DeadElectrodes | None = None
    """Single segments of single belts held at ground, pairs of a belt and a segment such as [0, 3]."""

    @classmethod
    def from_zeros(cls, zeros: Sequence[complex], poles: Sequence[complex], gain: float, **others: Any) -> Self:
        """Return the law gain prod(s - zero)/prod(s - pole), zeros and poles in 1/s; complex ones in conjugate pairs.

        Raises
        ------
        InputError
            If a complex zero or pole lacks its conjugate, or the law is not allowed.
        """
        import numpy as np

        parts = []
        for name, roots in (("zeros", zeros), ("poles", poles)):
            found = np.atleast_1d(np.poly(np.asarray(roots, dtype=np.complex128)) if len(roots) else 1.0)
            if np.any(np.abs(found.imag) > 1e-9 * np.abs(found)):
                raise InputError(name, f"{shown(list(roots))} has a complex one alone", "give its conjugate too")
            parts.append(found.real)
        return cls(numerator=(to_si(gain, "number") * parts[0]).tolist(), denominator=parts[1].tolist(), **others)

    @classmethod
    def from_transfer_function(cls, system: Any, **others: Any) -> Self:
        """Return the law of a transfer function of python-control or scipy.signal: anything with ``num`` and ``den``, or A, B, C and D.

        Raises
        ------
        InputError
            If it is none of these, has several inputs or outputs, or is one of discrete time.
        """
        import numpy as np

        if getattr(system, "dt", None) not in (None, 0, 0.0):
            raise InputError(
                "system", f"is one of discrete time, dt = {system.dt!r}", "give the law in continuous time, and the delay beside it"
            )
        if not hasattr(system, "num") and all(hasattr(system, name) for name in "ABCD"):
            from scipy.signal import ss2tf

            a, b, c, d = (np.asarray(getattr(system, name), dtype=np.float64) for name in "ABCD")
            numerator, denominator = ss2tf(a, b, c, d)
        elif hasattr(system, "num") and hasattr(system, "den"):
            numerator, denominator = system.num, system.den
        else:
            kind = type(system).__name__
            raise InputError("system", f"{kind} is no transfer function", "give one of python-control or scipy.signal, with num and den")
        return cls(numerator=_single(numerator, "num"), denominator=_single(denominator, "den"), **others)

    @property
    def polynomials(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Numerator and denominator of H with the corners, highest power of s (1/s) first."""
        denominator = list(self.denominator)
        for corner in (self.sensor_corner, self.amplifier_corner):
            if corner is not None:
                time = 1.0 / (6.283185307179586 * corner)
                denominator = [a * time + b for a, b in zip([*denominator, 0.0], [0.0, *denominator], strict=True)]
        return self.numerator, tuple(denominator)

    def bridged(self, share: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return numerator and denominator of u per phi_s, H/(1 - x H), x the *share* of layers with a bridge times its imbalance.

        The bridge reads phi_s + x u of a layer that is driven. Without the delay, which is no ratio.
        """
        numerator, denominator = self.polynomials
        through = share * self.bridge_imbalance
        if not through:
            return numerator, denominator
        size = max(len(numerator), len(denominator))
        top, bottom = ((0.0,) * (size - len(x)) + x for x in (numerator, denominator))
        return numerator, tuple(b - through * a for a, b in zip(top, bottom, strict=True))

    def response(self, frequency: npt.ArrayLike) -> ComplexArray:
        """Return u per phi_s at frequencies (Hz), with corners and delay: H(2 pi i f) e^{-2 pi i f delay}."""
        import numpy as np

        s = 2j * np.pi * np.asarray(frequency, dtype=np.float64)
        numerator, denominator = self.polynomials
        return np.asarray(np.polyval(numerator, s) / np.polyval(denominator, s) * np.exp(-self.delay * s), dtype=np.complex128)

    @model_validator(mode="after")
    def _checked(self) -> Self:
        if self.shells != "all" and (not self.shells or len(set(self.shells)) < len(self.shells)):
            raise InputError("shells", f"{list(self.shells)!r} is not allowed", "must name at least one shell, and each only once")
        require_segments(self)
        require_current(self)
        for name in ("dead", "dead_electrodes"):
            if getattr(self, name) and self.weights is not None:
                found = "a modal filter reads all segments, and some are dead"
                raise InputError("weights", found, f"leave weights out, which are those of orders, or {name}")
        if self.matrix is not None and self.transducers != "electrodes":
            raise InputError("matrix", "is not known to the paper's law", 'use transducers = "electrodes", or leave matrix out')
        if self.denominator == (0.0,):
            raise InputError("denominator", "is zero", "give at least one coefficient that is not, such as [1]")
        above = len(self.numerator) - len(self.denominator)
        corners = sum(corner is not None for corner in (self.sensor_corner, self.amplifier_corner))
        if above > corners and not (above == 1 and len(self.denominator) == 1):
            raise InputError(
                "numerator",
                f"has degree {len(self.numerator) - 1} over a denominator of degree {len(self.denominator) - 1}: no device answers so",
                "give as many poles as zeros, or sensor_corner or amplifier_corner; only [k_d, k_p] over [1] may stand as it is",
            )
        growing = _fastest(self.denominator)
        if growing is not None:
            found = f"has a pole at {growing.real:.4g} ± {abs(growing.imag):.4g}i 1/s, which grows by itself"
            raise InputError("denominator", found, "give a denominator whose roots have no positive real part")
        self._require_bridge()
        return self

    def _require_bridge(self) -> None:
        """Check that what a bridge lets through does not grow by itself, whatever the wall does."""
        if not self.bridge_imbalance:
            return
        where = "bridge_imbalance"
        if self.transducers != "electrodes":
            raise InputError(where, "is of self-sensing layers, which the paper's law does not know", 'use transducers = "electrodes"')
        if self.matrix is not None:
            raise InputError(where, "is not known beside a matrix of shells", "leave one of the two out")
        if isinstance(self.weights, tuple) and not set(self.weights) <= {0.0, 1.0}:
            raise InputError(where, "is not known beside weights other than 0 and 1", "give weights as the highest order, or of 0 and 1")
        growing = _fastest(self.bridged(1.0)[1])
        remedy = "balance the bridge with less capacitance, or give the law less gain or lower corners: H times the imbalance below 1"
        if growing is not None:
            told = f"{self.bridge_imbalance:g} feeds the amplifier its own voltage, which grows by e^({growing.real:.3g} 1/s t) by itself"
            raise InputError(where, told, remedy)
        if self.delay and self.through >= 1.0:
            told = f"{self.bridge_imbalance:g} times the largest |H|, {self.through:.3g} at some frequency, is fed back late"
            raise InputError(where, told, remedy)

    @property
    def through(self) -> float:
        """Largest magnitude of the imbalance times H at any frequency."""
        import numpy as np

        numerator, denominator = self.polynomials
        if len(numerator) > len(denominator):
            return float("inf")
        roots = [np.abs(np.roots(x)) for x in (numerator, denominator) if len(x) > 1]
        special = np.concatenate([np.ones(1), *roots])
        special = special[special > 0.0]
        omega = np.concatenate([np.zeros(1), np.geomspace(1e-3 * special.min(), 1e3 * special.max(), 4000), special])
        with np.errstate(divide="ignore", invalid="ignore"):
            size = np.abs(np.polyval(numerator, 1j * omega) / np.polyval(denominator, 1j * omega))
        return float(abs(self.bridge_imbalance) * np.nanmax(size))


def _fastest(polynomial: Sequence[float]) -> complex | None:
    """Return the root of a polynomial with the largest real part if that is above 0, beyond rounding; None otherwise."""
    import numpy as np

    roots = np.roots(polynomial)
    if not roots.size:
        return None
    worst = complex(roots[roots.real.argmax()])
    return worst if worst.real > _ROUNDING * np.abs(roots).max() else None


def _single(entry: Any, name: str) -> list[float]:
    """Return the one polynomial that python-control keeps in a matrix of one entry, and scipy as it is."""
    while hasattr(entry, "__len__") and len(entry) and hasattr(entry[0], "__len__"):
        if len(entry) != 1:
            raise InputError(
                "system", f"{name} has {len(entry)} rows: several inputs or outputs", "give the law of one sensor and one actuator"
            )
        entry = entry[0]
    return [float(one) for one in entry]


LAW = frozenset(Feedback.model_fields) - frozenset(PDControl.model_fields)
"""Entries that tell this law from another one."""
