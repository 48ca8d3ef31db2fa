"""Histories at head and tail as CSV, and histories with all modal amplitudes as a MATLAB file."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np
import numpy.typing as npt

from coaxshell._version import __version__
from coaxshell.errors import InputError
from coaxshell.model import RigidShell
from coaxshell.numerics.cost import Cost
from coaxshell.numerics.files import replacing
from coaxshell.numerics.memory import words_of
from coaxshell.plotting.saving import known_suffix
from coaxshell.response import tables
from coaxshell.response.quantities import Quantity, columns

if TYPE_CHECKING:
    from coaxshell.response import Response

_LARGEST = 2**31 - 2**20
"""Bytes that MATLAB reads in one variable of this format, here the struct array of the shells."""
_HELD = 5.0
"""Copies of the modal amplitudes that stand side by side: read, gathered, written out and compressed."""


def history_table(response: Response) -> dict[str, npt.NDArray[np.float64]]:
    """Return all histories at head and tail as columns by names with units; see :func:`coaxshell.response.tables.history_table`."""
    return response.history_table()


def export_csv(response: Response, path: str | Path) -> Path:
    """Write the histories at head and tail as CSV, one row an instant, names and units in the first row.

    Raises
    ------
    InputError
        The file is not a .csv or cannot be written.
    """
    known_suffix(Path(path), (".csv",))
    return write_csv(history_table(response), path)


def write_csv(table: Mapping[str, npt.NDArray[np.float64]], path: str | Path) -> Path:
    """Write columns by their names as CSV; InputError if the file is not a .csv or cannot be written."""
    return write_rows(table, zip(*(values.tolist() for values in table.values()), strict=True), path)


def write_rows(names: Iterable[str], rows: Iterable[Iterable[Any]], path: str | Path) -> Path:
    """Write rows under their names as CSV, None as an empty cell; InputError if the file is not a .csv or cannot be written."""
    target = Path(path)
    known_suffix(target, (".csv",))
    with replacing(target) as partial, partial.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(names)
        writer.writerows([_cell(value) for value in row] for row in rows)
    return target


def _cell(value: Any) -> Any:
    return "" if value is None else f"{value:.12g}" if isinstance(value, float) else value


def export_mat(response: Response, path: str | Path) -> Path:
    """Write histories and modal amplitudes as a MATLAB (version 5) file.

    Variables: ``time`` (a/c), ``time_seconds``, ``head_angle`` (degrees), ``scenario`` (TOML), ``version``, ``shells``: a struct array
    with radius (m), the quantities that tables hold (stress, displacement, voltages, ...; SI) at [head, tail] (T x 2), and
    ``modal_normal``, ``modal_tangential`` (m, parities x orders x T); ``absorber_displacement`` (m, absorbers x T) where there are any.
    In three dimensions ``stations`` (z, m) and, in the shells, a last dimension of stations and ``modal_axial``.

    Raises
    ------
    InputError
        The file is not a .mat, cannot be written, or an array is larger than the format holds.
    """
    from scipy.io import savemat

    target = Path(path)
    known_suffix(target, (".mat",))
    _require_room(response)
    content: dict[str, Any] = {
        "time": np.asarray(response.time),
        "time_seconds": np.asarray(response.time_seconds),
        "head_angle": float(response.system.sources[0].angle),
        "scenario": response.system.to_toml_string(),
        "version": f"coaxshell {__version__}",
        "shells": _shell_structs(response),
    }
    if response.stations is not None:
        content["stations"] = response.stations
    if response.system.absorber_list or response.system.point_absorbers:
        content["absorber_displacement"] = np.asarray(response.absorber_displacement())
    with replacing(target) as partial, partial.open("wb") as file:
        savemat(cast(Any, file), content, do_compression=True, oned_as="column")
    return target


def _require_room(response: Response) -> None:
    """Raise InputError if the modal amplitudes of a run do not fit into a MATLAB file, or into memory while it is written."""
    stations = 1 if response.stations is None else response.stations.size
    modal = (2.0 if response.stations is None else 3.0) * response.solution.normal.nbytes * stations
    what = f"{response.time.size:,} instants and orders 0 to {response.modes:,}" + (f", {stations} stations" if stations > 1 else "")
    if modal > _LARGEST:
        problem = f"modal amplitudes of {what}, {words_of(modal)}, do not fit a .mat file"
        raise InputError("path", problem, f"at most {words_of(_LARGEST)}: use a coarser time step, or Response.thin")
    Cost(_HELD * modal).require(f"a .mat file of {what}", "use a coarser time step, or Response.thin")


def _shell_structs(response: Response) -> npt.NDArray[np.object_]:
    structs, spatial = [], response.stations is not None
    for shell, described in enumerate(response.system.shells):
        struct: dict[str, Any] = {"radius": described.radius, "rigid": isinstance(described, RigidShell)}
        given = [] if struct["rigid"] else tables.quantities_of(response.motion, shell)
        for quantity in columns(3 if spatial else 2):
            struct[quantity.name] = _at_ends(response, quantity, shell) if quantity in given else np.empty((0, 2))
        struct["modal_normal"] = np.asarray(response.modal(shell, "displacement"))
        struct["modal_tangential"] = np.asarray(response.modal(shell, "tangential"))
        if spatial:
            struct["modal_axial"] = np.asarray(response.modal(shell, "axial_displacement"))
        structs.append(struct)
    # Equal fields in one object array become a MATLAB struct array.
    names = [(name, object) for name in structs[0]]
    table = np.zeros((1, len(structs)), dtype=names)
    for number, struct in enumerate(structs):
        for name, value in struct.items():
            table[name][0, number] = value
    return table


def _at_ends(response: Response, quantity: Quantity, shell: int) -> npt.NDArray[np.float64]:
    """Return a quantity at head and tail, (T, 2), in three dimensions with a last dimension of stations."""
    if response.stations is None:
        return tables.at_ends(response.motion, quantity, shell)
    return np.stack([tables.at_ends(motion, quantity, shell) for motion in response.motions], axis=-1)
