"""A run in three dimensions as time series for ParaView: cuts and a volume of the fluids, and the shells as surfaces over the stations."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.export.vtk_xml import write_collection, write_image, write_surface
from coaxshell.model import RigidShell
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.cost import Cost
from coaxshell.numerics.progress import Progress
from coaxshell.plotting.unrolled import mirrored_stations
from coaxshell.response.fields.cut_field import CutField
from coaxshell.response.fields.cuts import Cut, cut_of
from coaxshell.response.fields.request import regions
from coaxshell.response.fields.spatial_pressure import FLOW, spatial_request, turned

if TYPE_CHECKING:
    from coaxshell.response.spatial import SpatialResponse

_STAGE = "ParaView"
_BLOCK_BYTES = 0.3e9
_ANGLES: FloatArray = np.arange(0.0, 361.0, 2.0)
"""Of the shells' surfaces, closed."""
_WITHIN = 1e-9
"""Share of its radius by which a point of the fluid inside a wall lies inside the wall."""
_SCALARS = ("hoop_stress", "axial_stress", "shear_stress", "von_mises_stress")
_ODD = ("shear_stress", "axial_displacement")
"""Quantities that change their sign with z where sources are alike on both sides of z = 0."""


@dataclass(frozen=True)
class SpaceOptions:
    """What of a run in three dimensions is written.

    Attributes
    ----------
    half_width : float
        Half of the sides of cuts, the outer radius and half of the length of the volume, in a.
    points : int
        Points along a side of the cuts.
    cuts : bool
    volume : int or None
        Points along the diameter of the volume, None for no volume.
    velocity : bool
        Write the particle velocity too.
    station : float
        z of the cut across the axis, m.
    displaced : float
    """

    half_width: float
    points: int
    cuts: bool
    volume: int | None
    velocity: bool
    station: float
    displaced: float


def write_space(
    response: SpatialResponse, folder: Path, index: npt.NDArray[np.intp], options: SpaceOptions, progress: Progress | None
) -> None:
    """Write across.pvd, along.pvd, volume.pvd, as they are asked for, and shells.pvd into a folder."""
    seconds = list(np.asarray(response.time_seconds, dtype=np.float64)[index])
    tasks = [*(("across", "along") if options.cuts else ()), *(("volume",) if options.volume else ())]
    for number, task in enumerate(tasks):

        def report(share: float, _: str = "", number: int = number) -> None:
            if progress is not None:
                progress((number + share) / len(tasks), _STAGE)

        write = _write_volume if task == "volume" else _write_cut
        write_collection(folder / f"{task}.pvd", seconds, write(response, folder, task, index, options, report))
    write_collection(folder / "shells.pvd", seconds, _write_surfaces(response, folder, index, options.displaced))
    if progress is not None:
        progress(1.0, _STAGE)


def check_space(response: SpatialResponse, options: SpaceOptions, count: int) -> None:
    """Raise InputError if a volume of so many points is not allowed, or surfaces of so many instants do not fit into memory."""
    points = options.volume
    if points is not None and not 5 <= points <= 400:
        raise InputError("volume", f"{points!r} is not allowed", "give a whole number of points from 5 to 400")
    if not options.cuts and points is None and options.velocity:
        raise InputError("velocity", "is of cuts or of a volume, and neither is written", "ask for one of them, or leave it out")
    held = 8.0 * count * response.stations.size * _ANGLES.size * len(response.system.shells) * 12.0
    Cost(held + 4.0 * _BLOCK_BYTES).require(
        f"ParaView's surfaces of {count:,} instants and {response.stations.size:,} stations", "give fewer times, or fewer stations"
    )


def space_cost(response: SpatialResponse, options: SpaceOptions, index: npt.NDArray[np.intp]) -> Cost:
    """Return what the fields of an export cost."""
    from coaxshell.response.fields.cut_field import field_cost

    cuts = [_cut(response, name, options) for name in ("across", "along")] if options.cuts else []
    if options.volume:
        cuts.append(_cylinder(response, options)[0])
    total, quantities = Cost(0.0), 4 if options.velocity else 1
    times = np.asarray(response.time, dtype=np.float64)[index]
    for cut in cuts:
        total = total.then(field_cost(response.spatial, cut, spatial_request(response.spatial), times, quantities))
    return total


def _fields(
    response: SpatialResponse, cut: Cut, index: npt.NDArray[np.intp], *, velocity: bool, report: Any
) -> Iterator[dict[str, npt.NDArray[np.float32]]]:
    """Yield, instant by instant, the pressure on a cut, (z and points), and the velocity if asked for, (z and points, 3)."""
    scales, times = response.solution.problem.scales, np.asarray(response.time, dtype=np.float64)[index]
    asked = spatial_request(response.spatial, progress=lambda share, _: report(0.8 * share))
    field = CutField(response.spatial, cut, asked, times, ("pressure", *FLOW) if velocity else ("pressure",))
    block = max(1, int(_BLOCK_BYTES // (8.0 * cut.points * cut.z.size * (12 if velocity else 2))))
    for start in range(0, times.size, block):
        level, *flow = (each.reshape(each.shape[0], -1) for each in field.values(slice(start, start + block)))
        moving = turned(cut, flow, cartesian=True) if velocity else None
        for i, values in enumerate(level):
            found = {"pressure": (scales.pressure * values).astype(np.float32)}
            if moving is not None:
                found["velocity"] = (scales.velocity * moving[i].T).astype(np.float32)
            yield found
            report(0.8 + 0.2 * (start + i + 1) / times.size)


def _cut(response: SpatialResponse, name: str, options: SpaceOptions) -> Cut:
    x = np.linspace(-options.half_width, options.half_width, options.points)
    if name == "across":
        return cut_of(x, x, options.station / response.system.reference_radius, None, None)
    return cut_of(x, 0.0, x, None, None)


def _write_cut(
    response: SpatialResponse, folder: Path, name: str, index: npt.NDArray[np.intp], options: SpaceOptions, report: Any
) -> list[Sequence[str]]:
    a, points = response.system.reference_radius, options.points
    low, step = -a * options.half_width, 2.0 * a * options.half_width / (points - 1)
    across = name == "across"
    origin, axes = ((low, low, options.station), (0, 1)) if across else ((low, 0.0, low), (0, 2))
    names: list[Sequence[str]] = []
    fields = _fields(response, _cut(response, name, options), index, velocity=options.velocity, report=report)
    for number, found in enumerate(fields):
        names.append((f"data/{name}_{number:05d}.vti",))
        arrays = {label: values.reshape(points, points, *values.shape[1:]) for label, values in found.items()}
        write_image(folder / names[-1][0], origin, (step, step), arrays, axes=axes)
    return names


def _cylinder(response: SpatialResponse, options: SpaceOptions) -> tuple[Cut, list[FloatArray]]:
    """Return the volume, and the radii of each fluid in it, from wall to wall."""
    assert options.volume is not None
    step, edge = 2.0 * options.half_width / (options.volume - 1), options.half_width
    by_fluid: list[FloatArray] = []
    for region in regions(response.solution.problem):
        outer = edge if region.exterior else min(region.outer, edge) * (1.0 - _WITHIN)
        if region.fluid is not None and outer > region.inner:
            by_fluid.append(np.linspace(region.inner, outer, max(2, math.ceil((outer - region.inner) / step) + 1)))
    turns = 4 * max(4, math.ceil(0.5 * math.pi / step))
    z = np.linspace(-edge, edge, options.volume)
    return cut_of(None, None, z, np.concatenate(by_fluid), np.linspace(0.0, 360.0, turns + 1)), by_fluid


def _write_volume(
    response: SpatialResponse, folder: Path, name: str, index: npt.NDArray[np.intp], options: SpaceOptions, report: Any
) -> list[Sequence[str]]:
    """Write a structured grid for each fluid: pressures jump at walls, between points of two grids."""
    cut, by_fluid = _cylinder(response, options)
    a, theta = response.system.reference_radius, np.radians(cut.grid.axes[1])
    starts = np.cumsum([0, *(radii.size for radii in by_fluid)])
    grids = []
    for radii in by_fluid:
        z, r, angle = np.meshgrid(cut.z, radii, theta, indexing="ij")
        grids.append((a * np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=-1)).astype(np.float32))
    names: list[Sequence[str]] = []
    for number, found in enumerate(_fields(response, cut, index, velocity=options.velocity, report=report)):
        names.append([f"data/{name}_{number:05d}_{fluid}.vts" for fluid in range(len(by_fluid))])
        whole = {label: values.reshape(cut.z.size, starts[-1], theta.size, *values.shape[1:]) for label, values in found.items()}
        for fluid, file in enumerate(names[-1]):
            part = {label: values[:, starts[fluid] : starts[fluid + 1]] for label, values in whole.items()}
            write_surface(folder / file, grids[fluid], part)
    return names


def _write_surfaces(response: SpatialResponse, folder: Path, index: npt.NDArray[np.intp], displaced: float) -> list[Sequence[str]]:
    """Write each shell as a surface over angle and z, or, of one station alone, as a line."""
    (z, numbers), theta = mirrored_stations(response), np.radians(_ANGLES)
    radial = np.stack([np.cos(theta), np.sin(theta), np.zeros_like(theta)], axis=-1)
    around = np.stack([-np.sin(theta), np.cos(theta), np.zeros_like(theta)], axis=-1)
    axial, few = np.array([0.0, 0.0, 1.0]), response.at_instants(index)
    rates = [name for rate, name in ((1, "shell_velocity"), (2, "shell_acceleration")) if response.motion.has_rate(rate)]
    names: list[list[str]] = [[] for _ in index]
    for shell, described in enumerate(response.system.shells):

        def read(source: SpatialResponse, name: str, shell: int = shell, rigid: bool = isinstance(described, RigidShell)) -> FloatArray:
            if rigid:
                return np.zeros((index.size, z.size, _ANGLES.size))
            values = np.asarray(source.history(shell, _ANGLES, name), dtype=np.float64)[:, np.abs(numbers) - 1]
            return np.asarray(values * np.sign(numbers)[:, None] if name in _ODD else values)

        scalars = {name: read(few, name.removeprefix("hoop_")) for name in _SCALARS}
        w, v, u = (read(few, name)[..., None] for name in ("displacement", "tangential_displacement", "axial_displacement"))
        moved = v * around - w * radial + u * axial
        scalars["normal_displacement"] = w[..., 0]
        scalars |= {f"normal_{name}": read(response, name)[index] for name in rates}
        rest = described.radius * radial + response.system.reference_radius * z[:, None, None] * axial
        for i, files in enumerate(names):
            files.append(f"data/shells_{i:05d}_{shell}.vts")
            data = {name: values[None, i] for name, values in scalars.items()} | {"displacement": moved[None, i]}
            write_surface(folder / files[-1], (rest + displaced * moved[i])[None], data)
    return [tuple(files) for files in names]
