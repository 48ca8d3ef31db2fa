"""A file from elsewhere, read by h5py alone: what it says of itself is judged before anything is allocated, and no other file is opened.

Links to other files, virtual datasets and arrays kept outside are refused; so are types, filters and sizes that we do not write.
"""

from __future__ import annotations

import math
import os
import stat
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import product
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from coaxshell.errors import InputError
from coaxshell.limits import SAVED_ARRAYS, SAVED_CHUNK, SAVED_STRUCTURE, SAVED_TEXT
from coaxshell.numerics.allowance import at_most
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.seal import is_sealed
from coaxshell.response.dataset import OURS

BROKEN = (OSError, ValueError, KeyError, TypeError, RuntimeError, AttributeError, IndexError, OverflowError, MemoryError, zlib.error)
"""What HDF5, h5py and our own readers raise on files that are damaged, or something else altogether."""


class ForeignFile:
    """An open file.

    Attributes
    ----------
    sealed : bool
        Whether a digest of all its bytes has been found right.
    """

    def __init__(self, file: h5py.File, sealed: bool, size: int) -> None:
        self._file, self.sealed, self._size = file, sealed, size
        self._allocated = 0

    def attribute(self, name: str) -> str | int | float | None:
        """Return an attribute, a text or one number; None if it is not there. ValueError if it is anything else."""
        with at_most(SAVED_STRUCTURE.value):
            return self._attribute(name.encode(), name)

    def _attribute(self, key: bytes, name: str) -> str | int | float | None:
        if not h5py.h5a.exists(self._file.id, key):
            return None
        opened = h5py.h5a.open(self._file.id, key)
        kind, space = opened.get_type(), opened.get_space()
        if space.get_simple_extent_npoints() != 1 or space.get_simple_extent_ndims() > 1:
            raise ValueError(f"{name} is not a single value")
        if not isinstance(kind, h5py.h5t.TypeStringID | h5py.h5t.TypeIntegerID | h5py.h5t.TypeFloatID):
            raise TypeError(f"{name} is neither a text nor a number")
        if opened.get_storage_size() > SAVED_TEXT.value:
            raise ValueError(f"{name} is too long")
        value = self._file.attrs[name]
        value = value.item() if isinstance(value, np.ndarray | np.generic) else value
        value = value.decode() if isinstance(value, bytes) else value
        if not isinstance(value, str | int | float):
            raise TypeError(f"{name} is neither a text nor a number")
        return value

    def text(self, name: str) -> str:
        """Return the text in a scalar dataset."""
        with at_most(SAVED_STRUCTURE.value):
            return self._text(name)

    def _text(self, name: str) -> str:
        dataset = self._dataset(name)
        if not isinstance(dataset.get_type(), h5py.h5t.TypeStringID) or dataset.get_space().get_simple_extent_npoints() != 1:
            raise TypeError(f"{name} is not a text")
        if dataset.get_type().get_size() > SAVED_TEXT.value or _filters(dataset):
            raise ValueError(f"{name} is no text of ours")
        value = self._file[name][()]
        value = value.item() if isinstance(value, np.ndarray) else value
        text = value.decode() if isinstance(value, bytes) else str(value)
        SAVED_TEXT.check(len(text), name)
        return text

    def __contains__(self, name: str) -> bool:
        return bool(self._file.id.links.exists(name.encode()))

    def shape(self, name: str) -> tuple[int, ...]:
        """Return the shape of an array of floats in double precision, judged; nothing is allocated."""
        with at_most(SAVED_STRUCTURE.value):
            return self._shape(name)

    def _shape(self, name: str) -> tuple[int, ...]:
        dataset = self._dataset(name)
        kind = dataset.get_type()
        if not any(kind.equal(known) for known in (h5py.h5t.IEEE_F64LE, h5py.h5t.IEEE_F64BE)):
            raise TypeError(f"{name} does not hold numbers in double precision")
        shape = tuple(dataset.get_space().get_simple_extent_dims())
        SAVED_ARRAYS.check(8 * math.prod(shape), name)
        self._judge_storage(dataset, name, shape)
        return shape

    def array(self, name: str) -> FloatArray:
        """Return an array."""
        shape = self.shape(name)
        self._allocated += 8 * math.prod(shape)
        SAVED_ARRAYS.check(self._allocated, "arrays")
        dataset = self._dataset(name)
        if dataset.get_create_plist().get_layout() == h5py.h5d.CHUNKED:
            found = _from_chunks(dataset, shape)
        else:
            found = np.empty(shape)
            if found.size:
                dataset.read(h5py.h5s.ALL, h5py.h5s.ALL, found)
        return found

    def _dataset(self, name: str) -> Any:
        """Return a dataset that lies in this file and nowhere else."""
        key, links = name.encode(), self._file.id.links
        if not links.exists(key):
            raise KeyError(f"{name} is missing")
        if links.get_info(key).type != h5py.h5l.TYPE_HARD:
            raise ValueError(f"{name} is a link to another place")
        dataset = h5py.h5o.open(self._file.id, key)
        if not isinstance(dataset, h5py.h5d.DatasetID):
            raise TypeError(f"{name} is not an array")
        plan = dataset.get_create_plist()
        if plan.get_layout() == h5py.h5d.VIRTUAL or plan.get_external_count():
            raise ValueError(f"{name} lies in another file")
        return dataset

    def _judge_storage(self, dataset: Any, name: str, shape: tuple[int, ...]) -> None:
        """Refuse an array whose numbers are not all in the file: its size would be a mere claim."""
        plan, size = dataset.get_create_plist(), 8 * math.prod(shape)
        if plan.get_layout() != h5py.h5d.CHUNKED:
            if (size and dataset.get_storage_size() != size) or size > self._size:
                raise ValueError(f"{name} holds less than its shape says")
            return
        chunk = plan.get_chunk()
        SAVED_CHUNK.check(8 * math.prod(chunk), name)
        if (size and 8 * math.prod(chunk) > 4096 * self._size) or unknown(_filters(dataset)):
            raise ValueError(f"{name} is packed in a way that is not ours")
        if dataset.get_num_chunks() != math.prod(-(-extent // step) for extent, step in zip(shape, chunk, strict=True)):
            raise ValueError(f"{name} holds less than its shape says")


def unknown(filters: list[int]) -> bool:
    """Return whether filters are others than those that we write: shuffle, then deflate."""
    return filters not in ([], [h5py.h5z.FILTER_SHUFFLE], [h5py.h5z.FILTER_DEFLATE], [h5py.h5z.FILTER_SHUFFLE, h5py.h5z.FILTER_DEFLATE])


def _filters(dataset: Any) -> list[int]:
    plan = dataset.get_create_plist()
    return [plan.get_filter(number)[0] for number in range(min(plan.get_nfilters(), 3))]


def _from_chunks(dataset: Any, shape: tuple[int, ...]) -> FloatArray:
    """Put an array together; each chunk is unpacked here, to its own size and not a byte more."""
    plan = dataset.get_create_plist()
    chunk, filters = plan.get_chunk(), _filters(dataset)
    kind = np.dtype("<f8") if dataset.get_type().equal(h5py.h5t.IEEE_F64LE) else np.dtype(">f8")
    size = 8 * math.prod(chunk)
    found = np.empty(shape)
    for offset in product(*(range(0, extent, step) for extent, step in zip(shape, chunk, strict=True))):
        if dataset.get_chunk_info_by_coord(offset).size > size + size // 100 + 1000:
            raise ValueError("a chunk is larger than what it holds")
        skipped, packed = dataset.read_direct_chunk(offset)
        data = _unpacked(packed, [one for bit, one in enumerate(filters) if not skipped >> bit & 1], size)
        values = np.frombuffer(data, kind).reshape(chunk)
        here = tuple(slice(start, start + step) for start, step in zip(offset, chunk, strict=True))
        part = found[here]
        part[...] = values[tuple(slice(extent) for extent in part.shape)]
    return found


def _unpacked(data: bytes, filters: list[int], size: int) -> bytes:
    """Return the bytes of a chunk; ValueError unless there are exactly so many."""
    if h5py.h5z.FILTER_DEFLATE in filters:
        data = zlib.decompressobj().decompress(data, size + 1)
    if len(data) != size:
        raise ValueError("a chunk has another size than it should")
    if h5py.h5z.FILTER_SHUFFLE in filters:
        return np.frombuffer(data, np.uint8).reshape(8, -1).T.tobytes()
    return data


@contextmanager
def opened(path: str | Path) -> Iterator[ForeignFile]:
    """Yield a file to read from.

    Raises
    ------
    InputError
        It does not exist, cannot be read, is no such file, is cut short or damaged; also for any failure inside the ``with`` block.
    """
    try:
        number = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))  # a pipe must not hold us up
    except FileNotFoundError:
        raise InputError(str(path), "does not exist", OURS) from None
    except IsADirectoryError:
        raise InputError(str(path), "is a folder", OURS) from None
    except PermissionError:
        problem = "is a folder" if Path(path).is_dir() else "cannot be read (permission denied)"
        raise InputError(str(path), problem, "choose another file") from None
    except (OSError, ValueError) as error:
        raise InputError(str(path), f"cannot be read ({getattr(error, 'strerror', None) or error})", OURS) from None
    state = os.fstat(number)
    if not stat.S_ISREG(state.st_mode):
        os.close(number)
        raise InputError(str(path), "is a folder" if stat.S_ISDIR(state.st_mode) else "is a device or a pipe", OURS)
    with open(number, "rb") as file:
        try:
            sealed = is_sealed(file)
            with at_most(SAVED_STRUCTURE.value):
                inside = h5py.File(file, "r")
        except BROKEN as error:
            raise InputError(str(path), f"is not a NetCDF file, or is cut short or damaged ({_short(error)})", OURS) from None
        try:
            with inside:
                yield ForeignFile(inside, sealed, state.st_size)
        except InputError:
            raise
        except RecursionError:
            raise InputError(str(path), "is damaged (nested too deeply)", "write it again") from None
        except BROKEN as error:
            raise InputError(str(path), f"is damaged ({_short(error)})", "write it again") from None


def _short(error: BaseException) -> str:
    return (str(error.args[0]) if error.args else type(error).__name__)[:120]
