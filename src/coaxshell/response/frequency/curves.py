"""The curves over the frequency, or over the angle, that an answer consists of, with their names: for figures, tables and files."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import NamedTuple

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.late import xarray as xr


class Curve(NamedTuple):
    """Values over the frequency at one place, or over the angle at one frequency; the label tells which, empty where there is only one."""

    label: str
    values: ComplexArray | FloatArray


def curves_of(found: xr.DataArray, over: str = "frequency") -> Iterator[Curve]:
    """Yield the curves of an answer at several frequencies, over these or over another of its dims, in the order of the others.

    Raises
    ------
    InputError
        It has no dim frequency.
    """
    if not isinstance(found, xr.DataArray) or "frequency" not in found.dims:
        raise InputError("found", f"{shown(type(found).__name__)} has no frequencies to draw", "ask for a list of them")
    rest = [str(dim) for dim in found.dims if dim != over]
    ordered = found.transpose(*rest, over).to_numpy()
    for index in product(*(range(found.sizes[dim]) for dim in rest)):
        yield Curve(", ".join(_place(found, dim, i) for dim, i in zip(rest, index, strict=True)), ordered[index])


def _place(found: xr.DataArray, dim: str, index: int) -> str:
    if dim == "frequency":
        return f"{float(found['frequency'][index]):g} Hz"
    if dim == "angle":
        return f"{float(found['angle'][index]):g}°"
    if dim == "radius":
        return f"r = {float(found['radius'][index]):g} a"
    if dim == "absorber":
        where = f" at {float(found['absorber_angle'][index]):g}°" if "absorber_angle" in found.coords else ""
        return f"absorber {index}{where}"
    if dim == "side":
        return f"on the {found['side'].values[index]} shell"
    return f"{dim} {found[dim].values[index] if dim in found.coords else index}"


def is_level(found: xr.DataArray) -> bool:
    """Return whether an answer is real: a level in dB, or a width."""
    return not np.iscomplexobj(found.to_numpy())
