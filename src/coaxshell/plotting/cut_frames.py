"""What sheets and films of runs show: of two dimensions the cross-section, of three the one at a station and the plane along the axis."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Protocol, cast

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.model import RigidShell
from coaxshell.model.base import shown as written
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.cost import Cost
from coaxshell.plotting.frames import BLOCK_BYTES, WALL_ANGLES, FieldView, Frames, Report, field_frames, gathered, instants
from coaxshell.plotting.panels import AlongAxis, Panel, Section
from coaxshell.plotting.unrolled import alike_on_both_sides, along_stations, mirrored_stations

if TYPE_CHECKING:
    from coaxshell.response import Response
    from coaxshell.response.fields.cuts import Cut
    from coaxshell.response.fields.request import FieldRequest
    from coaxshell.response.spatial import SpatialResponse

_STAGE = "fields"
_SAMPLES, _SAMPLE_PIXELS = 40, 90
_ENDS = (0.0, 180.0)


@dataclass(frozen=True)
class Shown:
    """A run as sheets and films show it.

    Attributes
    ----------
    response : Response
    panels : tuple of Panel
        One, or in three dimensions two.
    station : float or None
        z of the cross-section in three dimensions, m.
    """

    response: Response
    panels: tuple[Panel, ...]
    station: float | None = None

    def solved(self, times: Sequence[float] | FloatArray, view: FieldView, progress: Report | None = None) -> Solved:
        """Return its fields at the run's instants nearest to *times*, ready to be drawn."""
        return _Plane(self.response, times, view) if self.station is None else _Cuts(self, times, view, progress)

    def cost(self, count: int, view: FieldView) -> Cost:
        """Return what it takes to solve so many instants; nothing of note in two dimensions."""
        if self.station is None:
            return Cost(0.0)
        from coaxshell.response.fields.cut_field import field_cost

        spatial, times = _spatial(self), np.linspace(0.0, float(self.response.time[-1]), count)
        costs = [field_cost(spatial.spatial, _cut(self, panel, view), _asked(spatial, None), times, 1) for panel in self.panels]
        return Cost(sum(one.memory for one in costs), sum(one.seconds for one in costs))

    def across(self) -> Shown:
        """Return the cross-section alone of a run in three dimensions."""
        return replace(self, panels=self.panels[:1])

    def along(self) -> Shown:
        """Return the plane along the axis alone of a run in three dimensions."""
        return replace(self, panels=self.panels[1:])


def shown_runs(responses: Sequence[Response], names: Sequence[str], station: Any = None) -> list[Shown]:
    """Return how runs are shown; InputError for a station of runs that have none.

    Parameters
    ----------
    responses : sequence of Response
    names : sequence of str
        Their headings.
    station : float or str, optional
        Of the cross-sections of runs in three dimensions; the first of each when left out.
    """
    if station is not None and all(response.stations is None for response in responses):
        raise InputError("station", f"{written(station)} belongs to three dimensions", "leave it out, or give a run in three dimensions")
    return [_shown(response, name, station, alone=len(responses) == 1) for response, name in zip(responses, names, strict=True)]


def _shown(response: Response, name: str, station: Any, *, alone: bool) -> Shown:
    if response.stations is None:
        return Shown(response, (Section(response.system, name),))
    spatial = cast("SpatialResponse", response)
    chosen = float(spatial.at(spatial.stations[0] if station is None else station).stations[0])
    before, (z, _) = "" if alone else f"{name}: ", mirrored_stations(spatial)
    across = Section(response.system, f"{before}across, z = {chosen:g} m")
    ends = (float(z[0]), float(z[-1])) if z.size > 1 else None
    return Shown(response, (across, AlongAxis(response.system, f"{before}along, y = 0", ends)), chosen)


class Solved(Protocol):
    """Fields of the panels of a run at some instants."""

    def sample(self) -> list[Frames]:
        """Return some of them, from which scales are chosen."""
        ...

    def frames(self, progress: Report | None, memory: float = BLOCK_BYTES) -> Iterator[tuple[Frames, ...]]:
        """Yield all of them, one a panel, in blocks that stay within the memory."""
        ...


@dataclass(frozen=True)
class _Plane:
    """Hold the fields of a run in two dimensions: found as they are asked for, samples on a coarse grid."""

    response: Response
    times: Sequence[float] | FloatArray
    view: FieldView

    def sample(self) -> list[Frames]:
        coarse = FieldView(self.view.half_width, min(self.view.pixels, _SAMPLE_PIXELS))
        chosen = self.times[:: max(1, len(self.times) // _SAMPLES)]
        return [gathered(field_frames(self.response, chosen, coarse))]

    def frames(self, progress: Report | None, memory: float = BLOCK_BYTES) -> Iterator[tuple[Frames, ...]]:
        return ((frames,) for frames in field_frames(self.response, self.times, self.view, progress=progress, memory=memory))


class _Cuts:
    """Hold the fields of a run in three dimensions: its cuts are solved at once for all instants."""

    def __init__(self, shown: Shown, times: Sequence[float] | FloatArray, view: FieldView, progress: Report | None) -> None:
        from coaxshell.response.fields.cut_field import CutField

        spatial = _spatial(shown)
        index = instants(spatial, times)
        self._pixels = view.pixels
        self._time = np.asarray(spatial.time, dtype=np.float64)[index]
        self._milliseconds = 1e3 * np.asarray(spatial.time_seconds, dtype=np.float64)[index]
        self._pascal = spatial.solution.problem.scales.pressure
        self._stress, self._fields = [], []
        for number, panel in enumerate(shown.panels):
            along = isinstance(panel, AlongAxis)
            self._stress.append(_axial_stress(spatial, panel, view, index) if along else _section_stress(spatial, shown.station, index))
            asked = _asked(spatial, _share(progress, number, len(shown.panels)))
            self._fields.append(CutField(spatial.spatial, _cut(shown, panel, view), asked, self._time, ("pressure",)))

    def sample(self) -> list[Frames]:
        return list(self._block(slice(None, None, max(1, self._time.size // _SAMPLES))))

    def frames(self, progress: Report | None, memory: float = BLOCK_BYTES) -> Iterator[tuple[Frames, ...]]:
        per_block, count = max(1, int(memory // (16 * self._pixels**2))), self._time.size
        for start in range(0, count, per_block):
            block = slice(start, min(start + per_block, count))
            yield self._block(block)
            if progress is not None:
                progress(block.stop / count, _STAGE)

    def _block(self, chosen: slice) -> tuple[Frames, ...]:
        found = []
        for field, stress in zip(self._fields, self._stress, strict=True):
            (values,) = field.values(chosen)
            pressure = (self._pascal * values).astype(np.float32).reshape(values.shape[0], -1, self._pixels)
            at = tuple(None if around is None else around[chosen] for around in stress)
            found.append(Frames(self._time[chosen], self._milliseconds[chosen], pressure, at))
        return tuple(found)


def _spatial(shown: Shown) -> SpatialResponse:
    return cast("SpatialResponse", shown.response)


def _cut(shown: Shown, panel: Panel, view: FieldView) -> Cut:
    """Return the cross-section or the plane along the axis, its upper half where the lower is its mirror image."""
    from coaxshell.response.fields.cuts import cut_of

    assert shown.station is not None
    x, middle, system = view.centres, view.pixels // 2, shown.response.system
    if isinstance(panel, AlongAxis):
        return cut_of(x, 0.0, x[middle:] if alike_on_both_sides(system) else x, None, None)
    y = x[middle:] if shown.response.solution.normal.shape[1] == 1 else x
    return cut_of(x, y, shown.station / system.reference_radius, None, None)


def _asked(spatial: SpatialResponse, progress: Report | None) -> FieldRequest:
    from coaxshell.response.fields.spatial_pressure import spatial_request

    return spatial_request(spatial.spatial, front="matched", progress=progress)


def _share(progress: Report | None, number: int, count: int) -> Report | None:
    """Return a report for one of some cuts."""

    def report(share: float, _: str) -> None:
        if progress is not None:
            progress((number + share) / count, "waves")

    return report if progress is not None else None


def _section_stress(response: SpatialResponse, station: float | None, index: npt.NDArray[np.intp]) -> list[FloatArray | None]:
    """Return the hoop stress of each shell around a station, (instants, degrees)."""
    few = response.at(station).at_instants(index)
    shells = enumerate(response.system.shells)
    return [None if isinstance(shell, RigidShell) else np.asarray(few.stress(i, WALL_ANGLES))[:, 0] for i, shell in shells]


def _axial_stress(response: SpatialResponse, panel: Panel, view: FieldView, index: npt.NDArray[np.intp]) -> list[FloatArray | None]:
    """Return the hoop stress of head and tail of each shell in turn at the rows of pixels that stations cover, (instants, rows)."""
    assert isinstance(panel, AlongAxis)
    heights, few = panel.covered(view), response.at_instants(index)
    found: list[FloatArray | None] = []
    for shell, described in enumerate(response.system.shells):
        if not heights.size or isinstance(described, RigidShell):
            found += [None, None]
            continue
        z, stress = along_stations(few, shell, _ENDS, None)
        found += [np.array([np.interp(heights, z, row) for row in stress[:, :, side]]) for side in (0, 1)]
    return found
