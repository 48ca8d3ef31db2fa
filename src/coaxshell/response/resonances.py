"""Natural frequencies of a system, dry and wet, by circumferential order and axial half wavelength.

On an infinite shell, or one of length L on shear diaphragms, motion goes with cos m theta cos kz, k = pi/L the axial wavenumber; orders
are the circumferential m. A mode rings at |Im s|/(2 pi) and dies away with the damping ratio -Re s/|s|, s its pole
(:mod:`coaxshell.solver.natural_modes`).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import product
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.loading import SystemLike, as_system
from coaxshell.model.places import shell_name
from coaxshell.model.units import to_si
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.scalars import plain
from coaxshell.solver.natural_modes import dry_poles, wet_modes
from coaxshell.solver.scaling import Problem, dimensionless

ORDERS = range(13)
HIGHEST_ORDER = 200
TRANSITS = 10.0
"""Highest frequency unless given, omega a/c_e."""
MOST_DAMPED = 0.2
_LONGEST = 500.0
"""Highest frequency allowed, omega a/c_e: a search of some minutes."""


class _Found(NamedTuple):
    """Poles of one wavenumber and order, s in 1/s: wet with shapes, and dry of each shell."""

    wet: ComplexArray
    shapes: ComplexArray
    dry: list[ComplexArray]


def natural_frequencies(
    system: SystemLike,
    order: Iterable[int] | int = ORDERS,
    axial_half_wavelength: npt.ArrayLike | str | None = None,
    *,
    axial_wavenumber: npt.ArrayLike | None = None,
    up_to: float | str | None = None,
    most_damped: float = MOST_DAMPED,
) -> xr.Dataset:
    r"""Return natural frequencies of the shells in their fluids (wet), and of each shell by itself (dry).

    Parameters
    ----------
    system : System, str or Path
        A description, the name of a preset, or a scenario file. Absorbers are left out; feedback is not; sources do not matter.
    order : int or iterable of int
        Circumferential orders m.
    axial_half_wavelength : float, str or list of them, optional
        L of cos(pi z/L): the length of a shell on shear diaphragms over the number of half waves along it (m or text). Nothing changes
        along the axis unless given; several add a dimension: dispersion curves.
    axial_wavenumber : float or list of them, optional
        The same by k = pi/L, rad/m.
    up_to : float or str, optional
        Highest frequency (Hz or text, as "2 kHz"); omega a/c_e = 10 unless given.
    most_damped : float
        Largest damping ratio of what counts as a resonance, from 0 up to 0.5; waves that creep around the shell have more.

    Returns
    -------
    Dataset
        ``frequency`` (Hz) and ``damping_ratio`` of wet modes, dims (order, mode) or (axial_half_wavelength, order, mode), ascending, NaN
        where an order has fewer; ``shape``, complex, with a last dimension ``shell``: normal motion of the outer faces, the largest 1;
        ``dry_frequency`` and ``dry_damping_ratio`` with (shell, order, dry_mode) in the place of (order, mode).
        Motions that no normal load excites (torsion) are not among them; a negative damping ratio is that of an unstable loop.

    Raises
    ------
    InputError
        An argument is not allowed, or the system cannot be solved at such wavenumbers.
    """
    described = as_system(system).replace(absorbers=())
    orders, lengths = whole_orders(order), _lengths(_half_wavelengths(axial_half_wavelength, axial_wavenumber))
    dimensions = 2 if lengths is None else 3
    problem = dimensionless(described, dimensions)
    scales = problem.scales
    highest = TRANSITS if up_to is None else highest_frequency(up_to, scales.time)
    damped = _ratio(most_damped)
    problem = problem.resolving(highest)
    wavenumbers = [0.0] if lengths is None else [math.pi * scales.length / length for length in np.atleast_1d(lengths)]
    found = [_found(problem, m, k, highest, damped) for k, m in product(wavenumbers, orders)]
    dataset = _dataset(problem, orders, wavenumbers, found)
    if lengths is None:
        return dataset.isel(axial_half_wavelength=0, drop=True)
    attributes = {"units": "m", "long_name": "axial half wavelength"}
    dataset = dataset.assign_coords(
        axial_half_wavelength=("axial_half_wavelength", np.atleast_1d(lengths), attributes),
        axial_wavenumber=(
            "axial_half_wavelength",
            math.pi / np.atleast_1d(lengths),
            {"units": "rad/m", "long_name": "axial wavenumber"},
        ),
    )
    return dataset if np.ndim(lengths) else dataset.isel(axial_half_wavelength=0)


def _found(problem: Problem, order: int, wavenumber: float, highest: float, most_damped: float) -> _Found:
    wet = wet_modes(problem, order, wavenumber, highest, most_damped)
    dry = [dry_poles(wall, order, wavenumber, highest, most_damped) / problem.scales.time for wall in problem.shells]
    return _Found(wet.poles / problem.scales.time, wet.shapes, dry)


def _dataset(problem: Problem, orders: list[int], wavenumbers: list[float], found: list[_Found]) -> xr.Dataset:
    """Return what was found, by wavenumber and order, labelled."""
    shells = len(problem.shells)
    names = [shell_name(i, shells) for i in range(shells)]
    wide, grid = max(1, *(one.wet.size for one in found)), (len(wavenumbers), len(orders))
    dry_wide = max(1, *(poles.size for one in found for poles in one.dry))
    wet = np.full((*grid, wide), np.nan + 0j)
    shapes = np.full((*grid, wide, shells), np.nan + 0j)
    dry = np.full((len(wavenumbers), shells, len(orders), dry_wide), np.nan + 0j)
    for (k, m), one in zip(product(*map(range, grid)), found, strict=True):
        wet[k, m, : one.wet.size], shapes[k, m, : one.wet.size] = one.wet, one.shapes
        for shell, poles in enumerate(one.dry):
            dry[k, shell, m, : poles.size] = poles
    along = "axial_half_wavelength"
    dims, dry_dims = (along, "order", "mode"), (along, "shell", "order", "dry_mode")
    return xr.Dataset(
        {
            "frequency": (dims, *_hertz(wet, "wet natural frequency")),
            "damping_ratio": (dims, *_damping(wet, "damping ratio of wet modes")),
            "shape": ((*dims, "shell"), shapes, {"units": "1", "long_name": "normal motion of the outer faces, the largest 1"}),
            "dry_frequency": (dry_dims, *_hertz(dry, "dry natural frequency")),
            "dry_damping_ratio": (dry_dims, *_damping(dry, "damping ratio of dry modes")),
        },
        coords={"order": ("order", orders, {"long_name": "circumferential order m"}), "shell": names},
        attrs={"system": problem.system.name, "absorbers": "left out", "sound_speed": problem.system.exterior.sound_speed},
    )


def _hertz(poles: ComplexArray, words: str) -> tuple[Any, dict[str, str]]:
    return np.asarray(poles.imag / (2.0 * math.pi)) + 0.0 * poles.real, {"units": "Hz", "long_name": words}


def _damping(poles: ComplexArray, words: str) -> tuple[Any, dict[str, str]]:
    return -poles.real / np.abs(poles) + 0.0, {"units": "1", "long_name": words}


def whole_orders(order: object) -> list[int]:
    """Return orders as a list; InputError if one is none."""
    remedy = f"give whole numbers from 0 to {HIGHEST_ORDER}, as range(13)"
    values = [plain(one) for one in _each(order, "order", remedy)]
    for value in values:
        if isinstance(value, bool) or not isinstance(value, int | float) or value != int(value) or not 0 <= value <= HIGHEST_ORDER:
            raise InputError("order", f"{shown(value)} is not allowed", remedy)
    if len(set(values)) < len(values):
        raise InputError("order", f"{shown(values)} names one twice", "give each once")
    return [int(value) for value in values]


def _each(value: object, name: str, remedy: str) -> Iterator[Any]:
    """Yield the one or several that are meant; InputError if there are none."""
    listed: Sequence[Any] = [value] if isinstance(value, str) or not isinstance(value, Iterable) else list(value)
    if not listed:
        raise InputError(name, "is empty", remedy)
    yield from listed


def _half_wavelengths(length: Any, wavenumber: Any) -> Any:
    """Return half wavelengths as they were given, or pi/k; InputError if both are, or a wavenumber is none."""
    if wavenumber is None:
        return length
    remedy = "give wavenumbers above 0 in rad/m"
    if length is not None:
        raise InputError("axial_wavenumber", "is given beside axial_half_wavelength", "give one of them: k = pi/L")
    try:
        values = np.asarray(wavenumber, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError("axial_wavenumber", f"{shown(wavenumber)} is not a number or a list of numbers", remedy) from None
    if values.ndim > 1 or values.size == 0 or not np.all(np.isfinite(values) & (values > 0.0)):
        raise InputError("axial_wavenumber", f"{shown(wavenumber)} is not allowed", remedy)
    return math.pi / values


def _lengths(value: Any) -> float | npt.NDArray[np.float64] | None:
    """Return half wavelengths in m, one or several; None for none."""
    if value is None:
        return None
    remedy = 'give a length above 0 in m, a text such as "3 m", or a list of them'
    several = not isinstance(value, str) and np.ndim(value) > 0
    found = []
    for one in _each(value, "axial_half_wavelength", remedy):
        try:
            length = to_si(plain(one), "length")
        except InputError as error:
            raise InputError("axial_half_wavelength", error.problem, remedy) from None
        if not 0.0 < length < math.inf:
            raise InputError("axial_half_wavelength", f"{length:g} m is not allowed", remedy)
        found.append(length)
    return np.array(found) if several else found[0]


def highest_frequency(value: object, time: float) -> float:
    """Return the highest frequency that is looked at (Hz, or a text), radians per transit of so many seconds; InputError if it is none."""
    most = _LONGEST / (2.0 * math.pi * time)
    remedy = f'give a frequency above 0 and up to {most:.4g} Hz, or a text such as "2 kHz"'
    try:
        hertz = to_si(plain(value), "frequency")
    except InputError as error:
        raise InputError("up_to", error.problem, remedy) from None
    if not 0.0 < hertz <= most:
        raise InputError("up_to", f"{hertz:g} Hz is not allowed", remedy)
    return 2.0 * math.pi * time * hertz


def _ratio(value: object) -> float:
    number = plain(value)
    if isinstance(number, bool) or not isinstance(number, int | float) or not 0.0 <= number <= 0.5:
        raise InputError("most_damped", f"{shown(value)} is not allowed", "give a damping ratio from 0 to 0.5")
    return float(number)
