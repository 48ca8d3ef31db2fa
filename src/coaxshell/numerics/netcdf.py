"""Labelled arrays as a NetCDF file, whole or not at all."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from io import RawIOBase
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from coaxshell.numerics.files import replacing

if TYPE_CHECKING:
    import xarray as xr


class _Sink(RawIOBase):
    """A file that never fails: HDF5 ends the process when a disk is full. What went wrong is kept, and raised after HDF5 has closed."""

    def __init__(self, file: IO[bytes]) -> None:
        self.file, self.error = file, None

    error: BaseException | None

    def _tried(self, call: Callable[[], Any], otherwise: int) -> Any:
        if self.error is None:
            try:
                return call()
            except BaseException as error:  # noqa: BLE001  (an interruption, too, has to wait)
                self.error = error
        return otherwise

    def readable(self) -> bool:
        return True

    def writable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def readinto(self, buffer: Any) -> int:
        return int(self._tried(lambda: self.file.readinto(buffer), len(buffer)))  # type: ignore[attr-defined]

    def write(self, data: Any) -> int:
        return int(self._tried(lambda: self.file.write(data), len(data)))

    def seek(self, offset: int, whence: int = 0) -> int:
        return int(self._tried(lambda: self.file.seek(offset, whence), offset))

    def truncate(self, size: int | None = None) -> int:
        return int(self._tried(lambda: self.file.truncate(size), size or 0))


def write_netcdf(
    dataset: xr.Dataset,
    path: str | Path,
    encoding: Mapping[str, Mapping[str, Any]] | None = None,
    finish: Callable[[IO[bytes]], None] | None = None,
    *,
    where: str = "path",
) -> None:
    """Write a dataset to a NetCDF file.

    Parameters
    ----------
    dataset : xarray Dataset
    path : str or Path
    encoding : mapping, optional
        As of ``Dataset.to_netcdf``.
    finish : callable, optional
        Called with the written file, open for reading and writing, before it takes its place.
    where : str
        What errors call it.

    Raises
    ------
    InputError
        It cannot be written; an older file is as it was.
    """
    import h5netcdf
    from xarray.backends import H5NetCDFStore

    with replacing(path, where) as made, made.open("w+b") as file:
        sink = _Sink(file)
        try:
            with h5netcdf.File(sink, "w") as target:
                dataset.dump_to_store(H5NetCDFStore(target), encoding={name: dict(options) for name, options in (encoding or {}).items()})
        except Exception:
            if sink.error is None:
                raise
        if sink.error is not None:
            raise sink.error
        file.flush()
        if finish is not None:
            finish(file)
