"""No result with NaN or infinity leaves without an error: the test that costs next to nothing, and the place where it fails."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError

Array = npt.NDArray[Any]


def first_bad(array: Array) -> tuple[int, ...] | None:
    """Return the index of the first NaN or infinity of an array of numbers, None if there is none.

    "First" is along the last axis before all others: the earliest instant or the lowest node at which anything fails. One sum
    tells at the speed of the memory whether there is any; only then is it looked for.
    """
    if array.size == 0 or array.dtype.kind not in "fc":
        return None
    with np.errstate(all="ignore"):  # what it finds is told below; a sum may overflow where no number does
        total = array.sum()
    if math.isfinite(total.real) and math.isfinite(total.imag):
        return None
    bad = ~np.isfinite(array)
    if not bad.any():
        return None
    rows = np.moveaxis(bad, -1, 0)
    return tuple(int(i) for i in (*np.argwhere(rows)[0][1:], np.argwhere(rows)[0][0]))


def require_finite(values: npt.ArrayLike, where: str, axes: Sequence[tuple[str, Array]] = (), remedy: str = "") -> None:
    """Refuse values with NaN or infinity.

    Parameters
    ----------
    values : array_like
    where : str
        What they are: "pressure".
    axes : sequence of (name, coordinates)
        One for each dimension, of which the error tells the place: ("time", times).
    remedy : str

    Raises
    ------
    InputError
        With the value found and where it is first.
    """
    array = np.asarray(values)
    index = first_bad(array)
    if index is None:
        return
    at = ", ".join(f"{name} = {_text(along[i])}" for (name, along), i in zip(axes, index, strict=False))
    raise InputError(where, f"is {array[index]}{f' at {at}' if at else ''}, and {_share(array)} of its values are no numbers", remedy)


def _share(array: Array) -> str:
    return f"{np.count_nonzero(~np.isfinite(array)):,} of {array.size:,}"


def _text(value: Any) -> str:
    return f"{float(value):.6g}" if np.asarray(value).dtype.kind in "fiu" else str(value)
