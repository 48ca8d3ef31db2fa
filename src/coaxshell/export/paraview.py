"""A run as a time series for ParaView: the pressure on a square, and the shells with their stress and displacement."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict, Unpack, cast

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.export.vtk_xml import write_collection, write_image, write_lines
from coaxshell.model import RigidShell
from coaxshell.model.base import shown as written
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.cost import Cost
from coaxshell.numerics.files import replacing_folder
from coaxshell.numerics.progress import Progress
from coaxshell.numerics.scalars import plain
from coaxshell.response.quantities import QUANTITIES, Quantity, columns
from coaxshell.solver.stations import stations_of

if TYPE_CHECKING:
    from coaxshell.export.paraview_space import SpaceOptions
    from coaxshell.response import Response
    from coaxshell.response.spatial import SpatialResponse

Report = Progress

PARAVIEW_PARTS = ("data", "field.pvd", "across.pvd", "along.pvd", "volume.pvd", "shells.pvd", "system.toml")
"""What an exported folder holds."""

_STAGE = "ParaView"
_BLOCK_BYTES = 0.4e9
_ANGLES: FloatArray = np.arange(0.0, 360.0, 0.5)


def export_paraview(
    response: Response,
    folder: str | Path,
    *,
    times: Sequence[float] | FloatArray | None = None,
    half_width: float = 3.0,
    points: int = 301,
    displaced: float = 0.0,
    cuts: bool = True,
    volume: int | None = None,
    velocity: bool = False,
    station: Any = None,
    force: bool = False,
    progress: Report | None = None,
) -> Path:
    """Write a folder with field.pvd and shells.pvd, to be opened both in ParaView; lengths in m, times in s.

    field.pvd: the total pressure (Pa) on a square of points. shells.pvd: each shell as a closed line in steps of half a degree
    with hoop_stress (Pa), displacement (vector, m), normal_displacement (m, positive inward), shell_velocity and shell_acceleration and
    their normal parts likewise (m/s, m/s^2) and, for each line, the shell's number.

    Of a run in three dimensions across.pvd and along.pvd are the pressure on squares across the axis, at a station, and along it, at y = 0;
    volume.pvd, if asked for, that in all fluids of a cylinder, a curved grid for each. shells.pvd holds the shells as surfaces over all
    stations with hoop_stress, axial_stress, shear_stress, von_mises_stress (Pa), displacement (vector, m), normal_displacement and, where
    the run keeps its transforms, normal_shell_velocity and normal_shell_acceleration; where sources are alike on both sides of z = 0,
    stations count for both.

    Parameters
    ----------
    response : Response
    folder : str or Path
        Made by this call.
    times : sequence of float, optional
        In transits, each taken at the run's nearest instant; 101 from start to end when left out.
    half_width : float
        Half of the square's side, in a.
    points : int
        Points along its side.
    displaced : float
        The shells are drawn displaced by this many times their displacement; 0 draws them at rest.
    cuts : bool
        Of three dimensions: write the cuts.
    volume : int, optional
        Of three dimensions: write a volume too, of so many points along its diameter and its length; 41 is a good start.
    velocity : bool
        Of three dimensions: write the particle velocity (vector, m/s) on cuts and in the volume too.
    station : float or str, optional
        Of three dimensions: z of the cut across the axis, m or text, any; the run's first station when left out.
    force : bool
        Replace the folder if it holds an earlier export; what holds anything else is never replaced.
    progress : callable, optional
        Called with the fraction done and the name of the stage.

    Raises
    ------
    InputError
        An argument is not allowed, the folder exists, or it cannot be written.
    """
    check_grid(half_width, points, displaced)
    index = _instants(response, _default_times(response) if times is None else times)
    if response.stations is not None:
        spatial = cast("SpatialResponse", response)
        options = space_options(spatial, half_width, points, displaced, cuts=cuts, volume=volume, velocity=velocity, station=station)
        return _export_space(spatial, folder, index, options, force=force, progress=progress)
    for name, given in (("volume", volume), ("velocity", velocity or None), ("station", station)):
        if given is not None:
            raise InputError(name, f"{written(given)} belongs to three dimensions", "leave it out, or give a run in three dimensions")
    seconds = np.asarray(response.time_seconds, dtype=np.float64)[index]
    shown, kept = 3.0 * response.time.size, 1.0 * len(_arrays(response)) * len(response.system.shells) * len(index)
    Cost(8.0 * _ANGLES.size * (shown + kept) + 4.0 * _BLOCK_BYTES).require(
        f"ParaView's series of {len(index):,} instants of a run of {response.time.size:,}", "give fewer times, or run a coarser step"
    )
    with replacing_folder(folder, PARAVIEW_PARTS, force=force) as partial:
        (partial / "data").mkdir()
        fields = _write_fields(response, partial, index, half_width, points, progress)
        shells = _write_shells(response, partial, index, displaced)
        write_collection(partial / "field.pvd", list(seconds), [[name] for name in fields])
        write_collection(partial / "shells.pvd", list(seconds), [[name] for name in shells])
        (partial / "system.toml").write_text(response.system.to_toml_string(), encoding="utf-8")
    return Path(folder)


class SpatialFields(TypedDict):
    """What :func:`export_paraview` is told of runs in three dimensions."""

    cuts: bool
    volume: int | None
    velocity: bool
    station: Any


def paraview_cost(
    response: Response, times: Sequence[float] | None, half_width: float, points: int, **fields: Unpack[SpatialFields]
) -> Cost:
    """Return what the fields of a run in three dimensions cost that :func:`export_paraview` writes."""
    from coaxshell.export.paraview_space import check_space, space_cost

    spatial = cast("SpatialResponse", response)
    index = _instants(response, _default_times(response) if times is None else times)
    options = space_options(spatial, half_width, points, 0.0, **fields)
    check_space(spatial, options, len(index))
    return space_cost(spatial, options, index)


def _default_times(response: Response) -> FloatArray:
    return np.linspace(0.0, float(response.time[-1]), 101)


def space_options(
    response: SpatialResponse,
    half_width: float,
    points: int,
    displaced: float,
    *,
    cuts: bool = True,
    volume: int | None = None,
    velocity: bool = False,
    station: Any = None,
) -> SpaceOptions:
    """Return what of a run in three dimensions is written; see :func:`export_paraview`."""
    from coaxshell.export.paraview_space import SpaceOptions

    z = float(response.stations[0] if station is None else stations_of(station)[0])
    return SpaceOptions(half_width, points, cuts, volume, velocity, z, displaced)


def _export_space(
    response: SpatialResponse,
    folder: str | Path,
    index: npt.NDArray[np.intp],
    options: SpaceOptions,
    *,
    force: bool,
    progress: Report | None,
) -> Path:
    from coaxshell.export.paraview_space import check_space, write_space

    check_space(response, options, len(index))
    with replacing_folder(folder, PARAVIEW_PARTS, force=force) as partial:
        (partial / "data").mkdir()
        write_space(response, partial, index, options, progress)
        (partial / "system.toml").write_text(response.system.to_toml_string(), encoding="utf-8")
    return Path(folder)


def check_grid(half_width: float, points: int, displaced: float) -> None:
    """Raise InputError if a square of so many points or a factor of displacement is not allowed."""
    if not (math.isfinite(half_width) and half_width > 0):
        raise InputError("width", f"{2 * half_width:g} is not allowed", "give a positive number, in outermost radii")
    points = plain(points)
    if isinstance(points, bool) or not isinstance(points, int) or not 2 <= points <= 4000:
        raise InputError("points", f"{points!r} is not allowed", "give a whole number from 2 to 4000")
    if not math.isfinite(displaced):
        raise InputError("displaced", f"{displaced!r} is not allowed", "give a finite factor; 0 draws the shells at rest")


def _instants(response: Response, times: Sequence[float] | FloatArray) -> npt.NDArray[np.intp]:
    from coaxshell.plotting.frames import instants

    return np.unique(instants(response, times))


def _write_fields(
    response: Response, folder: Path, index: npt.NDArray[np.intp], half_width: float, points: int, progress: Report | None
) -> list[str]:
    x = np.linspace(-half_width, half_width, points)
    a = response.system.reference_radius
    names = [f"data/field_{number:05d}.vti" for number in range(len(index))]
    block = max(1, int(_BLOCK_BYTES // (8 * points**2)))
    for start in range(0, len(index), block):
        chosen = index[start : start + block]
        pressure = response.pressure(x=x, y=x, time=np.asarray(response.time)[chosen])
        for number, values in enumerate(np.asarray(pressure, dtype=np.float32), start):
            write_image(folder / names[number], (-a * half_width,) * 2, (a * float(x[1] - x[0]),) * 2, {"pressure": values})
            if progress is not None:
                progress((number + 1) / len(index), _STAGE)
    return names


def _write_shells(response: Response, folder: Path, index: npt.NDArray[np.intp], displaced: float) -> list[str]:
    shells = response.system.shells
    theta = np.radians(_ANGLES)
    radial = np.stack([np.cos(theta), np.sin(theta), np.zeros_like(theta)], axis=1)
    around = np.stack([-np.sin(theta), np.cos(theta), np.zeros_like(theta)], axis=1)
    found = {quantity.name: [_on_wall(response, shell, index, quantity) for shell in range(len(shells))] for quantity in _arrays(response)}
    names = [f"data/shells_{number:05d}.vtp" for number in range(len(index))]
    for number, name in enumerate(names):
        data: dict[str, FloatArray] = {}
        for quantity in _points(response):
            values = [each[number] for each in found[quantity.name]]
            if not quantity.partner:
                data[quantity.label.replace(" ", "_")] = np.concatenate(values)
                continue
            vectors = [v[number][:, None] * around - w[:, None] * radial for w, v in zip(values, found[quantity.partner], strict=True)]
            data |= {quantity.name: np.concatenate(vectors), f"normal_{quantity.name}": np.concatenate(values)}
        moved = np.split(data["displacement"], len(shells))
        lines = [shell.radius * radial + displaced * vector for shell, vector in zip(shells, moved, strict=True)]
        write_lines(folder / name, lines, data, {"shell": np.arange(len(shells), dtype=np.int32)})
    return names


def _points(response: Response) -> list[Quantity]:
    """Return the quantities that every point of a shell is given: those with columns, voltages left out, and what a run cannot give."""
    return [quantity for quantity in columns() if not quantity.roles and response.motion.has_rate(quantity.rate)]


def _arrays(response: Response) -> list[Quantity]:
    """Return them with the tangential components of those that are vectors."""
    found = _points(response)
    return [*found, *(QUANTITIES[quantity.partner] for quantity in found if quantity.partner)]


def _on_wall(response: Response, shell: int, index: npt.NDArray[np.intp], quantity: Quantity) -> FloatArray:
    """Return a quantity at all points of a shell and the chosen instants, shape (instants, angles); zeros for a rigid one."""
    if isinstance(response.system.shells[shell], RigidShell):
        return np.zeros((len(index), len(_ANGLES)))
    return np.asarray(response.history(shell, _ANGLES, quantity.name), dtype=np.float64)[index]
