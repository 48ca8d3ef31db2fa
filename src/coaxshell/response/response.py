"""The answer of a system, with names, units and coordinates."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import Late, supplied
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.progress import Progress
from coaxshell.response import absorbers, arguments, errors, histories, storage, wall_stress
from coaxshell.response.effort import ControlEffort, control_effort
from coaxshell.response.history_spectrum import history_spectrum
from coaxshell.response.margins import stability_margins
from coaxshell.response.participation import ParticipationOptions, participation
from coaxshell.response.shock_spectrum import SpectrumOptions, shock_spectrum
from coaxshell.response.solid_histories import displacement_at_depth
from coaxshell.response.strokes import absorber_stroke
from coaxshell.response.summary import Summary, response_card, summarise
from coaxshell.response.tables import history_table
from coaxshell.response.thinning import thinned
from coaxshell.response.translation import translation
from coaxshell.response.wall_motion import WallMotion
from coaxshell.response.wall_stress import WallPeak
from coaxshell.solver.electrodes import Segment
from coaxshell.solver.finite import require_finite_solution
from coaxshell.solver.settings import Settings
from coaxshell.solver.solution import Estimates, ModalSolution

if TYPE_CHECKING:  # no run needs them, and importing them takes as long as a tenth of one
    from coaxshell.response import energy, fields
else:
    energy, fields = Late("coaxshell.response.energy"), Late("coaxshell.response.fields")

HEAD_AND_TAIL = (0.0, 180.0)


class Response:
    """Hold the modal solution of a run and read it in SI.

    Angles are in degrees from the source direction. A shell is "inner", "outer" or its number from the inside, counted from 0; what
    depends on a shell or an angle raises InputError for one that is not there or not allowed.

    Parameters
    ----------
    solution : ModalSolution
        What the solver returned, or a file held.

    Attributes
    ----------
    solution : ModalSolution
    motion : WallMotion
        What quantities of shells are read from.

    Raises
    ------
    InputError
        If any of its numbers is NaN or infinite: with the array, the shell or absorber, the order and the first instant.
    """

    def __init__(self, solution: ModalSolution) -> None:
        require_finite_solution(solution)
        self.solution = solution
        self.motion = WallMotion(solution)

    @property
    def system(self) -> System:
        """The system that was solved."""
        return self.solution.problem.system

    @property
    def settings(self) -> Settings:
        """Resolution of the run."""
        return self.solution.settings

    @property
    def engine(self) -> str:
        """Name of the engine."""
        return self.solution.settings.engine

    @property
    def modes(self) -> int:
        """Highest circumferential order M."""
        return int(self.solution.normal.shape[2]) - 1

    @property
    def shells(self) -> int:
        """Number of shells."""
        return len(self.system.shells)

    @property
    def stations(self) -> FloatArray | None:
        """Axial positions at which a run in three dimensions answers, m, shape (stations,); None in two."""
        return None

    @property
    def motions(self) -> Sequence[WallMotion]:
        """What quantities of shells are read from, one a station in three dimensions."""
        return [self.motion]

    @property
    def time(self) -> FloatArray:
        """Instants in transits a/c_e, shape (T,)."""
        return self.solution.time

    @property
    def time_seconds(self) -> FloatArray:
        """Instants in seconds, shape (T,)."""
        return self.solution.time * self.solution.problem.scales.time

    @property
    def estimates(self) -> Estimates:
        """Relative errors estimated by the engine."""
        return self.solution.estimates

    def errors(self) -> xr.DataArray:
        """Return the relative errors estimated by the engine, dims (shell, quantity, cause): orders left out, time step, march, combined.

        See :func:`coaxshell.response.errors.errors`.
        """
        return errors.errors(self.solution)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Physics warnings of the run, one sentence each."""
        return self.solution.warnings

    @property
    def timings(self) -> dict[str, float]:
        """Seconds by stage."""
        return self.solution.timings

    def displacement(
        self,
        shell: int | str,
        angle: npt.ArrayLike = HEAD_AND_TAIL,
        component: str = "normal",
        *,
        relative: bool = False,
        depth: float | str | None = None,
        station: Any = None,
    ) -> xr.DataArray:
        """Return the displacement of the mid-surface, m, dims (time, angle): "normal" (positive inward) or "tangential".

        Three-dimensional runs have "axial" too. ``relative=True`` takes the translation of the shell's section off it, so that only what
        deforms the shell is left. An elastic wall is read at any *depth* (m outward of its middle, or a face).
        See :func:`coaxshell.response.histories.displacement`.
        """
        number = self._index(shell)
        if depth is not None:
            if relative:
                raise InputError("relative", "True is of the mid-surface", "leave out depth")
            return self._read(station, lambda motion: displacement_at_depth(motion, number, angle, depth, component))
        return self._read(station, lambda motion: histories.displacement(motion.solution, number, angle, component, relative=relative))

    def translation(self, shell: int | str, *, station: Any = None) -> xr.DataArray:
        """Return the translation of a shell's section (its centre of mass), m, dims (time, direction): x towards the source direction.

        See :func:`coaxshell.response.translation.translation`.
        """
        number = self._index(shell)
        return self._read(station, lambda motion: translation(motion.solution, number))

    def stress(
        self,
        shell: int | str,
        angle: npt.ArrayLike = HEAD_AND_TAIL,
        depth: float | str | None = None,
        *,
        component: str = "hoop",
        station: Any = None,
    ) -> xr.DataArray:
        """Return the stress, Pa, dims (time, angle): the core's at the mid-surface (Eq. 22), or at a depth (m outward, or a face).

        The component is "hoop", "axial" or "von_mises"; three-dimensional runs have "shear" too, elastic walls "radial" and
        "radial_hoop", and both together "radial_axial".
        See :func:`coaxshell.response.histories.stress`.
        """
        number = self._index(shell)
        return self._read(station, lambda motion: histories.stress(motion, number, angle, depth, component))

    def peak_stress(
        self, shell: int | str, component: str = "von_mises", *, window: Sequence[float] | None = None, station: Any = None
    ) -> WallPeak:
        """Return the largest stress anywhere in a wall: value (Pa), time (transits), angle (degrees), depth (m), layer, station, margin.

        Over all angles, layers and depths, the instants of a window (start, end), and all stations unless some are named. The component is
        "von_mises", "hoop", "axial", in three dimensions "shear", in elastic walls "radial" or "radial_hoop", in both together
        "radial_axial" too. See :mod:`coaxshell.response.wall_stress`. Of an elastic wall in three dimensions it takes about as long as the
        run.

        Raises
        ------
        InputError
            If the shell is rigid, the component or the window is not allowed, or a material lacks constants along the axis.
        """
        return wall_stress.of_wall(self.layer_peaks(shell, component, window=window, station=station))

    def layer_peaks(
        self, shell: int | str, component: str = "von_mises", *, window: Sequence[float] | None = None, station: Any = None
    ) -> list[WallPeak]:
        """Return the largest stress in each layer of a wall, from the inside out; as :meth:`peak_stress`."""
        number, span, motions = self._index(shell), arguments.time_window(self.time, window), self.stations_read(station)
        arguments.one_of("component", component, wall_stress.stress_through(motions[0][1], number).components)
        return wall_stress.layer_peaks(motions, number, component, span)

    def stations_read(self, station: Any) -> list[tuple[float | None, WallMotion]]:
        """Return what is read at stations, all unless some are named, with their positions (m); two dimensions have none."""
        if station is None:
            return [(None, self.motion)]
        raise InputError("station", f"{shown(station)} belongs to three dimensions", "run with dimensions=3 and stations=")

    def shell_velocity(
        self, shell: int | str, angle: npt.ArrayLike = HEAD_AND_TAIL, component: str = "normal", *, station: Any = None
    ) -> xr.DataArray:
        """Return the velocity of a shell's mid-surface, m/s, dims (time, angle): "normal" (positive inward) or "tangential".

        From the transforms of the run, not by differences. See :func:`coaxshell.response.histories.shell_velocity`.
        """
        number = self._index(shell)
        return self._read(station, lambda motion: histories.shell_velocity(motion, number, angle, component))

    def shell_acceleration(
        self, shell: int | str, angle: npt.ArrayLike = HEAD_AND_TAIL, component: str = "normal", *, station: Any = None
    ) -> xr.DataArray:
        """Return the acceleration of a shell's mid-surface, m/s^2, dims (time, angle): "normal" (positive inward) or "tangential".

        Where a front jumps, it jumps: see :func:`coaxshell.response.histories.shell_acceleration` for what the time step makes of that.
        """
        number = self._index(shell)
        return self._read(station, lambda motion: histories.shell_acceleration(motion, number, angle, component))

    def shock_spectrum(
        self,
        shell: int | str,
        angle: npt.ArrayLike = HEAD_AND_TAIL,
        frequency: npt.ArrayLike | None = None,
        *,
        station: Any = None,
        **options: Unpack[SpectrumOptions],
    ) -> xr.DataArray:
        """Return the shock response spectrum of points of a shell at natural frequencies (Hz), dims (frequency, angle).

        The largest answer of an oscillator that the shell carries: *kind* "pseudo-velocity", "absolute-acceleration" or
        "relative-displacement", of a *quality_factor* (10), *extreme* "maximax", "positive" or "negative", *during* the run ("primary"),
        after it ("residual") or "overall", under the "normal" or "tangential" *component* of the shell's motion.
        See :func:`coaxshell.response.shock_spectrum.shock_spectrum`.
        """
        number = self._index(shell)
        return self._read(station, lambda motion: shock_spectrum(motion, number, angle, frequency, **options))

    def spectrum(
        self,
        quantity: str | xr.DataArray = "stress",
        shell: int | str = "outer",
        angle: npt.ArrayLike = HEAD_AND_TAIL,
        frequency: npt.ArrayLike | None = None,
        *,
        per: str = "absolute",
        source: int | None = None,
        station: Any = None,
    ) -> xr.DataArray:
        """Return the Fourier transform of a history at frequencies (Hz), dims (frequency, angle): absolute or per "incident" pressure.

        Of a quantity of a shell by its name, or of any history that the response gave: ``r.spectrum(r.absorber_displacement())``. Of one
        that has died away it is what :func:`coaxshell.frequency_response` gives; a warning tells what is left at the end.
        See :func:`coaxshell.response.history_spectrum.history_spectrum`.
        """
        found = self.history(shell, angle, quantity, station=station) if isinstance(quantity, str) else quantity
        return history_spectrum(found, self.system.sources, frequency, per, source)

    def participation(self, shell: int | str, quantity: str = "stress", **options: Unpack[ParticipationOptions]) -> xr.Dataset:
        """Return which natural modes carry a quantity of a shell at its peak, or at an *angle* and *time*, and over time.

        Dims (order, mode): the orders that carry most unless an *order* is given, modes *up_to* a frequency. See
        :func:`coaxshell.response.participation.participation`.
        """
        return participation(self.motion, self._index(shell), quantity, **options)

    def history(
        self, shell: int | str, angle: npt.ArrayLike = HEAD_AND_TAIL, quantity: str = "stress", *, station: Any = None
    ) -> xr.DataArray:
        """Return the history of any quantity of a shell by its name, SI, dims (time, angle); the names are those of a plot.

        See :func:`coaxshell.response.histories.of_quantity`.
        """
        number = self._index(shell)
        return self._read(station, lambda motion: histories.of_quantity(motion, number, quantity, angle))

    def modal(self, shell: int | str, quantity: str = "displacement", *, station: Any = None) -> xr.DataArray:
        """Return modal amplitudes of "displacement", "tangential", "stress", "sensor_voltage", ... in SI, dims (half, mode, time).

        See :func:`coaxshell.response.histories.modal`.
        """
        number = self._index(shell)
        return self._read(station, lambda motion: histories.modal(motion, number, quantity))

    def sensor_voltage(
        self, shell: int | str, angle: npt.ArrayLike = HEAD_AND_TAIL, *, segment: Segment = "point", station: Any = None
    ) -> xr.DataArray:
        """Return the open-circuit voltage of the sensor, V, dims (time, angle) (Eq. 20): at points, or as means over a *segment* around.

        A segment is a length ("50 mm", m) or None for the one of the summary. Behind a sharp front only means converge with the orders.
        See :func:`coaxshell.response.histories.sensor_voltage`.
        """
        number = self._index(shell)
        return self._read(station, lambda motion: histories.sensor_voltage(motion.solution, number, angle, segment))

    def actuator_voltage(
        self, shell: int | str, angle: npt.ArrayLike = HEAD_AND_TAIL, *, segment: Segment = "point", station: Any = None
    ) -> xr.DataArray:
        """Return the control voltage on the actuator, V, dims (time, angle) (Eq. 17): at points, or as means over a *segment* around.

        See :func:`coaxshell.response.histories.actuator_voltage`.
        """
        number = self._index(shell)
        return self._read(station, lambda motion: histories.actuator_voltage(motion.solution, number, angle, segment))

    def pressure(
        self,
        x: npt.ArrayLike | None = None,
        y: npt.ArrayLike | None = None,
        z: npt.ArrayLike | None = None,
        **options: Unpack[fields.PressureOptions],
    ) -> xr.DataArray:
        """Return the acoustic pressure, Pa, dims (time, y, x) or (time, radius, angle).

        Give *x* and *y* or *radius* and *angle* (degrees), lengths in units of a, and *time* in transits;
        *part* is "total", "incident", "diffracted", "radiated" or "scattered", *front* "sharp" or, for pictures, "matched".
        A *z* belongs to three dimensions. See :func:`coaxshell.response.fields.evaluate.pressure`.
        """
        _refuse_z(z)
        return fields.pressure(self.motion.spectra, x, y, **options)

    def velocity(
        self,
        x: npt.ArrayLike | None = None,
        y: npt.ArrayLike | None = None,
        z: npt.ArrayLike | None = None,
        **options: Unpack[fields.PartOptions],
    ) -> xr.DataArray:
        """Return the particle velocity, m/s, with a dimension component, on the same grids as the pressure.

        See :func:`coaxshell.response.fields.evaluate.velocity`.
        """
        _refuse_z(z)
        return fields.velocity(self.motion.spectra, x, y, **options)

    def intensity(
        self,
        x: npt.ArrayLike | None = None,
        y: npt.ArrayLike | None = None,
        z: npt.ArrayLike | None = None,
        **options: Unpack[fields.FieldOptions],
    ) -> xr.DataArray:
        """Return the acoustic intensity p v, W/m^2, with a dimension component, on the same grids as the pressure.

        See :func:`coaxshell.response.fields.evaluate.intensity`.
        """
        _refuse_z(z)
        return fields.intensity(self.motion.spectra, x, y, **options)

    def pressure_rms(self, region: str | int, radius: float | None = None, **options: Unpack[fields.RmsOptions]) -> xr.DataArray:
        """Return the RMS of the total pressure over a region, Pa, dims (time,): "interior", "gap", its number, or "exterior" to *radius*.

        See :func:`coaxshell.response.fields.rms.pressure_rms`.
        """
        return fields.pressure_rms(self.motion.spectra, region, radius, **options)

    def cavitation(
        self, x: npt.ArrayLike | None = None, y: npt.ArrayLike | None = None, **options: Unpack[fields.CavitationOptions]
    ) -> xr.Dataset:
        """Return where the water outside falls below the pressure of vapour: when first, how low, how long; the system needs a sea.

        Options are *radius* and *angle* instead of x and y, *time* and *vapour_pressure*; see
        :func:`coaxshell.response.fields.cavitation.cavitation`.
        """
        return fields.cavitation(self.motion.spectra, x, y, **options)

    def _read(self, station: Any, read: Callable[[WallMotion], xr.DataArray]) -> xr.DataArray:
        """Return what is read of the motion of the walls; two dimensions have no stations."""
        ((_, motion),) = self.stations_read(station)
        return read(motion)

    def absorber_displacement(self) -> xr.DataArray:
        """Return the displacement of the absorbers' masses, m, positive inward, dims (absorber, time)."""
        return absorbers.absorber_displacement(self.solution)

    def absorber_force(self) -> xr.DataArray:
        """Return the forces of the absorbers on their shells, N/m, positive inward, dims (absorber, side, time)."""
        return absorbers.absorber_force(self.solution)

    def absorber_stroke(self) -> xr.DataArray:
        """Return how far the absorbers' masses move relative to the shells they link, m, dims (absorber, side, time); two dimensions."""
        return absorber_stroke(self.solution)

    def energy(self, every: int = 10, progress: Progress | None = None) -> xr.Dataset:
        """Return every store, flow and loss of energy and the closure residual, J per metre of length, at every so many instants.

        Takes ten to thirty seconds at the paper's resolution; *progress* is told how far it is.
        See :func:`coaxshell.response.energy.energy`.
        """
        return energy.energy(self.solution, every, progress, spectra=self.motion.spectra)

    def control_effort(self, *, segment: Segment = None, **limits: float | None) -> ControlEffort:
        """Return what control costs: voltage, field, charge, current, power of each shell, against limits of material and amplifier.

        Print it for a table. Limits are *voltage*, *current*, *apparent_power*: see :func:`coaxshell.response.effort.control_effort`.
        """
        return control_effort(self.motion, segment, **limits)

    def stability_margins(self) -> xr.Dataset:
        """Return gain, phase and delay margins of the feedback of each shell by order; see :func:`coaxshell.stability_margins`."""
        return stability_margins(self.system, settings=self.settings)

    def summary(self, window: Sequence[float] | None = None, *, segment: Segment = None) -> Summary:
        """Return peaks, RMS, error estimates and warnings within a window (start, end) in transits; print it for a table.

        Voltages are means over a *segment* of the wall: a length, None for what the pulse's band allows, or "point".
        See :func:`coaxshell.response.summary.summarise`.
        """
        return summarise(self.solution, window, segment, motion=self.motion)

    def without_transforms(self) -> Response:
        """Return the response without the transforms that a run keeps as long as it is in use: for keeping many responses at a time.

        They take a few times the memory of the histories. Without them fields, energies and rates are the same, and make them again.
        """
        return Response(replace(self.solution))

    def thin(self, every: int = 1, window: Sequence[float] | None = None) -> Response:
        """Return the response with every so many instants of a window (start, end) in transits, for a smaller file.

        Histories, modal amplitudes, voltages and the peaks at the instants that are left stay what they were; fields and energy need
        the whole history and are refused. See :func:`coaxshell.response.thinning.thinned`.
        """
        return Response(thinned(self.solution, every, window))

    def plot(
        self, quantity: str = "stress", shell: int | str | Sequence[int | str] | None = None, angle: npt.ArrayLike = HEAD_AND_TAIL
    ) -> Any:
        """Return a figure of a quantity against time: "stress", "relative_displacement", "actuator_voltage", ...; all shells unless named.

        Show it as the last line of a cell, or ``figure.savefig(path)``. See :func:`coaxshell.plotting.figure_curves`.
        """
        return supplied("figure_curves")(self, quantity, shell, arguments.angles(angle))

    def report(self, path: str | Path, compare: Response | None = None, **options: Any) -> Path:
        """Write a report that can be handed on, one HTML file of ten A4 pages at most when printed, and return its path.

        A second run is shown beside the first; *without* ("spectra", "energy", "fields") leaves out what takes long, *progress* is told
        how far it is. See :func:`coaxshell.apps.report.report`.
        """
        written: Path = supplied("report")(self, path, compare, **options)
        return written

    def to_dataframe(self) -> Any:
        """Return all histories at head and tail as a pandas DataFrame, one row an instant, indexed by time in transits.

        Columns carry their units; they are those of :func:`coaxshell.export.export_csv`.
        """
        columns = {name: ("time (a/c)", values) for name, values in self.history_table().items()}
        return xr.Dataset(columns).to_dataframe()

    def history_table(self) -> dict[str, FloatArray]:
        """Return all histories at head and tail as columns by names with units; see :func:`coaxshell.response.tables.history_table`."""
        return history_table([self.motion])

    def save(self, path: str | Path, *, compression: bool = False) -> Path:
        """Write everything to one self-describing NetCDF file, whole or not at all, and return its path.

        See :func:`coaxshell.response.storage.save`.
        """
        return storage.save(self.solution, path, compression=compression)

    def _index(self, shell: int | str) -> int:
        return self.system.shell_index(shell)

    def _repr_html_(self) -> str:
        return response_card(self.solution)

    def __repr__(self) -> str:
        name = f"{self.system.name!r}, " if self.system.name else ""
        return f"<Response: {name}{self.shells} shell{'s' * (self.shells != 1)}, {self.modes} modes, t = 0 to {self.time[-1]:g} transits>"


def _refuse_z(z: npt.ArrayLike | None) -> None:
    """Refuse an axial position of a field of two dimensions."""
    if z is not None:
        raise InputError("z", f"{shown(z)} belongs to three dimensions", "leave it out, or run with dimensions=3")
