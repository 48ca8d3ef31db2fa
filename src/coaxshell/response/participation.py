"""Which natural modes carry a peak: shares of orders and, within them, of modes, at the instant and over time.

See :mod:`coaxshell.solver.mode_residues` for how a mode's share is told from the rest.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple, TypedDict

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.places import shell_name
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.circle import circle_angles
from coaxshell.numerics.late import xarray as xr
from coaxshell.response import arguments
from coaxshell.response.labels import time_coordinates
from coaxshell.response.modal import elastic_wall
from coaxshell.response.peaks import peak_anywhere, peak_at
from coaxshell.response.quantities import QUANTITIES, Quantity
from coaxshell.response.relaxing import Relaxing
from coaxshell.response.resonances import highest_frequency, whole_orders
from coaxshell.response.synthesis import angle_basis
from coaxshell.response.wall_motion import WallMotion
from coaxshell.solver.mode_residues import ModeResidue, loads_of, mode_residues, mode_spectrum
from coaxshell.structure.shell_model import Gain

MOST_ORDERS = 8
"""Orders told unless any are given: those that carry most."""
_LEAST = 0.01
"""Share of a peak that an order carries at least, to be told unless asked for."""
_MOST_DAMPED = 0.5
_HIGHEST, _OF_BAND = 60.0, 0.5
"""Radians per transit up to which modes are looked for unless told, and share of the run's band at most."""


class ParticipationOptions(TypedDict, total=False):
    """Options of a participation by name; see :func:`participation`."""

    angle: float | None
    time: float | None
    order: Iterable[int] | int | None
    up_to: float | str | None


def participation(
    motion: WallMotion,
    shell: int,
    quantity: str = "stress",
    angle: float | None = None,
    time: float | None = None,
    order: Iterable[int] | int | None = None,
    *,
    up_to: float | str | None = None,
) -> xr.Dataset:
    """Return which natural modes carry a quantity of a shell at its peak, or at an angle and an instant, and over time at that angle.

    Parameters
    ----------
    motion : WallMotion
    shell : int
    quantity : str
        One that is linear in the motion, such as "stress", "displacement", "shell_velocity" or "sensor_voltage".
    angle : float, optional
        Degrees from the source direction; where the largest magnitude is unless given.
    time : float, optional
        Transits, the nearest instant counts; when the magnitude there is largest unless given.
    order : int or iterable of int, optional
        Circumferential orders; those that carry a hundredth of it or more, at most eight, unless given.
    up_to : float or str, optional
        Highest natural frequency (Hz or text, as "5 kHz"); omega a/c_e = 60, or half the run's band if that is less, unless given. Half a
        second of processor time an order.

    Returns
    -------
    Dataset
        ``frequency`` (Hz), ``damping_ratio``, ``contribution`` (in the quantity's unit, signed) and ``share`` (of the value) with dims
        (order, mode), NaN where an order has fewer modes; ``order_contribution``, ``order_share`` and ``rest_share`` (what no mode of the
        order carries) with (order); ``history`` (order, mode, time) and ``order_history`` (order, time) at the angle. Attributes hold the
        ``value`` with its ``time`` and ``angle``, and ``other_orders``, the share of orders not told.

    Raises
    ------
    InputError
        The run is one of three dimensions, of the direct engine, or lacks instants; a wall is an elastic solid; an argument is not allowed.
    """
    entry = _readable(motion, shell, quantity)
    orders_of = entry.amplitudes(motion, shell)
    solution = motion.solution
    if angle is None and time is None:
        parities, count = solution.normal.shape[1:3]
        whole = slice(0, solution.time.size)
        peak = peak_anywhere(orders_of, solution.time, whole, len(circle_angles(count, parities)))
        theta, instant = peak.angle, int(np.abs(solution.time - peak.time).argmin())
    else:
        theta = solution.problem.system.sources[0].angle if angle is None else float(arguments.angles(angle))
        at = peak_at(orders_of, solution.time, slice(0, solution.time.size), [theta])[0].time if time is None else float(time)
        instant = _instant(solution.time, at)
    modal = orders_of(slice(None))
    basis = angle_basis([theta], modal.shape[1], modal.shape[0], entry.component)[0]
    histories = np.einsum("pm,pmt->mt", basis, modal)
    value = float(histories[:, instant].sum())
    chosen = _chosen(order, histories[:, instant], value)
    scales, band = solution.problem.scales, np.pi / solution.settings.time_step
    highest = min(_HIGHEST, _OF_BAND * band) if up_to is None else highest_frequency(up_to, scales.time)
    found = [_of_order(motion, shell, entry, m, basis[:, m], highest) for m in chosen]
    return _labelled(motion, shell, entry, _Peak(value, theta, instant), chosen, histories[chosen], found)


class _Peak(NamedTuple):
    value: float
    angle: float
    instant: int


class _Carried(NamedTuple):
    """Modes of an order: their poles, s in 1/s, and what each carries over time."""

    poles: ComplexArray
    histories: FloatArray


def _readable(motion: WallMotion, shell: int, quantity: str) -> Quantity:
    """Return the entry of a quantity whose modes can be told apart; InputError if not."""
    linear = [name for name, entry in QUANTITIES.items() if entry.gain is not None and entry.dimensions == 2]
    entry = QUANTITIES[arguments.one_of("quantity", quantity.replace("-", "_"), linear)]
    solution = motion.solution
    elastic_wall(solution.problem, shell)
    if solution.along is not None:
        raise InputError("participation", "is told in two dimensions", "run with dimensions=2")
    for number, wall in enumerate(solution.problem.shells):
        if wall.moves and not wall.faces_move_alike:
            raise InputError(f"shells[{number}].theory", "participation is told of thin walls", 'use theory = "thin"')
    if solution.settings.engine == "direct":
        raise InputError(
            "engine", "the direct engine has no transforms that natural modes could be told from", 'run with engine="spectral"'
        )
    lack = entry.lack(solution.problem.system, shell)
    if lack is not None:
        raise InputError("quantity", f"{quantity!r} needs a shell that {lack}", "choose another shell or quantity")
    return entry


def _instant(times: FloatArray, time: float) -> int:
    if not 0.0 <= time <= times[-1] * (1.0 + 1e-9):
        raise InputError("time", f"{shown(time)} is not within the run", f"give transits from 0 to {times[-1]:g}")
    return int(np.abs(times - time).argmin())


def _chosen(order: Iterable[int] | int | None, carried: FloatArray, value: float) -> list[int]:
    """Return the orders asked for, or those that carry most of a value."""
    if order is not None:
        asked = whole_orders(order)
        if max(asked) >= carried.size:
            raise InputError("order", f"{max(asked)} is above the run's {carried.size - 1}", "give lower ones, or run with more modes")
        return asked
    most = np.argsort(-np.abs(carried), kind="stable")[:MOST_ORDERS]
    return sorted(int(m) for m in most if abs(carried[m]) >= _LEAST * abs(value)) or [int(most[0])]


def _of_order(motion: WallMotion, shell: int, entry: Quantity, order: int, basis: FloatArray, highest: float) -> _Carried:
    """Return what each mode of an order carries at an angle, whose cosine and sine the basis holds."""
    spectra, solution = motion.spectra, motion.solution
    problem, nodes = spectra.passive.problem, spectra.grid.nodes
    normal = np.einsum("p,spk->sk", basis, spectra.normal[:, :, order])
    loads = loads_of(problem, order, nodes, normal)
    modes = mode_residues(problem, order, highest, _MOST_DAMPED)
    histories = np.empty((len(modes), solution.time.size))
    for number, mode in enumerate(modes):
        weight = _gain_at(motion, shell, entry, order, mode) * mode.shape[shell]
        histories[number] = spectra.grid.invert(mode_spectrum(mode, weight, loads, nodes))[:: solution.settings.refinement]
    return _Carried(np.array([mode.pole for mode in modes], dtype=np.complex128) / problem.scales.time, histories)


def _gain_at(motion: WallMotion, shell: int, entry: Quantity, order: int, mode: ModeResidue) -> complex:
    """Return the quantity per W of a mode, SI."""
    assert entry.gain is not None
    gain = entry.gain(motion.solution, shell)
    parts = gain.parts if isinstance(gain, Relaxing) else ((None, gain),)
    at, found = np.array([mode.pole]), 0j
    for factor, part in parts:
        assert isinstance(part, Gain)
        relaxed = 1.0 if factor is None else complex(factor.at(at)[0])
        found += relaxed * (part.w[order] + part.v[order] * mode.tangential[shell])
    return found * (mode.pole / motion.solution.problem.scales.time) ** entry.rate


def _labelled(
    motion: WallMotion, shell: int, entry: Quantity, peak: _Peak, orders: list[int], histories: FloatArray, found: list[_Carried]
) -> xr.Dataset:
    solution, instant = motion.solution, peak.instant
    wide = max(1, *(one.poles.size for one in found))
    poles = np.full((len(orders), wide), np.nan + 0j)
    carried = np.full((len(orders), wide, solution.time.size), np.nan)
    for row, one in enumerate(found):
        poles[row, : one.poles.size], carried[row, : one.poles.size] = one.poles, one.histories
    told, value = histories[:, instant], peak.value or np.nan
    by_modes = np.array([one.histories[:, instant].sum() for one in found])
    unit = {"units": entry.unit}
    dims, share = ("order", "mode"), {"units": "1", "long_name": "share of the value"}
    variables: dict[str, Any] = {
        "frequency": (dims, poles.imag / (2.0 * np.pi) + 0.0 * poles.real, {"units": "Hz", "long_name": "natural frequency, wet"}),
        "damping_ratio": (dims, -poles.real / np.abs(poles), {"units": "1", "long_name": "damping ratio"}),
        "contribution": (dims, carried[..., instant], unit | {"long_name": f"what each mode carries of the {entry.noun}"}),
        "share": (dims, carried[..., instant] / value, share),
        "order_contribution": ("order", told, unit | {"long_name": "what each order carries"}),
        "order_share": ("order", told / value, share),
        "rest_share": ("order", (told - by_modes) / value, share | {"long_name": "share of the value that no mode of the order carries"}),
        "history": ((*dims, "time"), carried, unit | {"long_name": f"{entry.noun} carried by each mode"}),
        "order_history": (("order", "time"), histories, unit | {"long_name": f"{entry.noun} carried by each order"}),
    }
    coordinates = {**time_coordinates(solution), "order": ("order", orders, {"long_name": "circumferential order m"})}
    attributes = {
        "quantity": entry.name,
        "units": entry.unit,
        "value": peak.value,
        "time": float(solution.time[instant]),
        "angle": peak.angle,
        "shell": shell,
        "shell_name": shell_name(shell, len(solution.problem.shells)),
        "other_orders": 1.0 - float(told.sum() / value),
    }
    return xr.Dataset(variables, coordinates, attributes)


class ModeShare(NamedTuple):
    """A mode of a participation: its order, number, frequency (Hz), damping ratio, what it carries (SI) and its share of the value."""

    order: int
    mode: int
    frequency: float
    damping_ratio: float
    contribution: float
    share: float


def largest_modes(found: xr.Dataset, most: int | None = None, least: float = 0.0) -> list[ModeShare]:
    """Return the modes of a participation whose share is at least so large in magnitude, largest first."""
    rows = [
        ModeShare(
            int(found["order"][i]), int(j), *(float(found[name][i, j]) for name in ("frequency", "damping_ratio", "contribution", "share"))
        )
        for i, j in zip(*np.nonzero(np.isfinite(found["frequency"].to_numpy())), strict=True)
    ]
    return sorted((row for row in rows if abs(row.share) >= least), key=lambda row: -abs(row.share))[:most]
