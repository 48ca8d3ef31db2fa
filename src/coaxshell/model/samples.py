"""Series of numbers as fields of a description: immutable, compared, hashed and pickled in milliseconds however long they are."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, overload

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import core_schema

from coaxshell.errors import InputError
from coaxshell.limits import RECORD_SAMPLES
from coaxshell.model.base import shown
from coaxshell.model.paths import within
from coaxshell.model.units import DIMENSIONS, Dimension, to_si

if TYPE_CHECKING:
    import numpy.typing as npt

    from coaxshell.numerics.arrays import FloatArray


_SHOWN = 8


class Samples(Sequence[float]):
    """Hold finite numbers like a tuple of floats, and as a read-only array for ``numpy.asarray``.

    Parameters
    ----------
    values : iterable of float
        Copied. InputError names the index of one that is not finite.
    """

    __slots__ = ("_array", "_hash")

    def __init__(self, values: Iterable[float]) -> None:
        import numpy as np

        array = np.array(values if hasattr(values, "__array__") else list(values), dtype=float)
        if array.ndim != 1:
            raise InputError("", f"an array of shape {array.shape} is not a series", "give one number for each sample")
        bad = np.flatnonzero(~np.isfinite(array))
        if bad.size:
            raise InputError(f"[{bad[0]}]", f"{float(array[bad[0]])!r} is not finite", "give finite numbers")
        array.flags.writeable = False
        self._array: FloatArray = array
        self._hash: int | None = None

    def __len__(self) -> int:
        return len(self._array)

    @overload
    def __getitem__(self, index: int) -> float: ...
    @overload
    def __getitem__(self, index: slice) -> Samples: ...
    def __getitem__(self, index: int | slice) -> float | Samples:
        return Samples(self._array[index]) if isinstance(index, slice) else float(self._array[index])

    def __iter__(self) -> Iterator[float]:
        return iter(self.tolist())

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[Any]:
        import numpy as np

        if copy or (dtype is not None and np.dtype(dtype) != self._array.dtype):
            return self._array.astype(dtype or float)
        return self._array

    def tolist(self) -> list[float]:
        """Return the numbers as a list."""
        listed: list[float] = self._array.tolist()
        return listed

    def __eq__(self, other: object) -> bool:
        import numpy as np

        if isinstance(other, Samples):
            return self is other or np.array_equal(self._array, other._array)
        return tuple(self) == other if isinstance(other, tuple) else NotImplemented

    def __hash__(self) -> int:
        if self._hash is None:
            self._hash = hash(tuple(self))
        return self._hash

    def __repr__(self) -> str:
        if len(self) <= _SHOWN:
            return repr(tuple(self))
        return f"({self[0]!r}, {self[1]!r}, ..., {self[-1]!r}; {len(self):,} numbers)"

    def __reduce__(self) -> tuple[type[Samples], tuple[FloatArray]]:
        return Samples, (self._array,)

    def __copy__(self) -> Samples:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Samples:
        return self


@dataclass(frozen=True)
class Series:
    """Mark a field as samples of one dimension, in ``Annotated[Samples, Series("time")]``; text such as "1 ms" is taken one by one."""

    kind: str

    def validate(self, value: object) -> Samples:
        """Return a value as samples in SI; InputError names the index of what is none."""
        if isinstance(value, Samples):
            return value
        kind = DIMENSIONS[self.kind]
        if isinstance(value, str | bytes | Mapping) or not hasattr(value, "__iter__"):
            raise InputError("", f"{shown(value)} is not a list", f"give a list of numbers in {kind.unit}")
        if hasattr(value, "__len__"):
            RECORD_SAMPLES.check(len(value), "")
        return Samples(_numbers(value, kind))

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        listed = core_schema.plain_serializer_function_ser_schema(lambda samples: samples.tolist(), when_used="json")
        return core_schema.no_info_plain_validator_function(self.validate, serialization=listed)

    def __get_pydantic_json_schema__(self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        kind = DIMENSIONS[self.kind]
        return {"type": "array", "items": {"type": "number", "unit": kind.unit, "examples": [kind.example]}}


def _numbers(value: Any, kind: Dimension) -> Iterable[float]:
    """Return plain numbers at once, and anything else one by one: texts are converted, what is no number is refused by its index."""
    import numpy as np

    if isinstance(value, np.ndarray) or hasattr(value, "__array__"):
        array = np.asarray(value)
        if array.dtype.kind in "iuf":
            return array.astype(float)
        if array.dtype.kind == "m" and kind.unit == "s":
            return array / np.timedelta64(1, "s")
        value = array.tolist()
    items = list(value)
    if set(map(type, items)) <= {float, int}:
        try:
            return np.array(items, dtype=float)
        except OverflowError:
            pass  # told below, with its index
    return [_one(item, kind, index) for index, item in enumerate(items)]


def _one(item: object, kind: Dimension, index: int) -> float:
    try:
        return to_si(item, kind)
    except InputError as error:
        raise within(f"[{index}]", error) from None


def not_increasing(samples: Samples) -> int | None:
    """Return the index of the first number that does not exceed the one before it; None where each does."""
    import numpy as np

    late = np.flatnonzero(np.diff(np.asarray(samples)) <= 0)
    return int(late[0]) + 1 if late.size else None
