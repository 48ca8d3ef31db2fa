"""Single numbers read from a response, each computed only when asked for."""

from __future__ import annotations

import math
from functools import cached_property, partial
from itertools import pairwise

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.absorbers import gaps_of
from coaxshell.model.layers import Shell
from coaxshell.model.sources import UnderwaterExplosion
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.circle import circle_angles
from coaxshell.response import Response
from coaxshell.response.energy.absorbers import absorber_energy
from coaxshell.response.energy.motion import Motion
from coaxshell.response.peaks import Amplitudes, peak_anywhere, peak_at, root_mean_square
from coaxshell.response.quantities import Quantity, Where, shell_metrics
from coaxshell.response.spatial import SpatialResponse
from coaxshell.response.voltages import actuator_limit, cut_voltage, demanded_voltage, largest_demanded_voltage, largest_sensor_voltage
from coaxshell.response.wall_motion import WallMotion
from coaxshell.response.wall_stress import usual_component
from coaxshell.solver.electrodes import segment_length
from coaxshell.studies.spectrum_metrics import MountedMetric, SpectrumMetric
from coaxshell.studies.steady_metrics import SteadyMetric


class DesignReading:
    """What metrics take from a system alone, without a run; SI, line absorbers and shells per metre of length, point absorbers as they are.

    Parameters
    ----------
    system : System
    """

    def __init__(self, system: System) -> None:
        self.system = system

    def mass(self, shell: int) -> float:
        """Return the mass of a shell, kg/m."""
        return shell_mass(self._wall(shell))

    def number(self, name: str, place: str | int) -> float:
        """Return a number by the name of its property, or of its method and the place that it is given."""
        found = getattr(self, name)
        return float(found(place) if callable(found) else found)

    def _wall(self, shell: int) -> Shell:
        wall = self.system.shells[shell]
        assert isinstance(wall, Shell)  # metrics refuse rigid shells before the run
        return wall

    @cached_property
    def absorber_count(self) -> float:
        """How many absorbers there are."""
        return float(len(self.system.absorber_list) + len(self.system.point_absorbers))

    @cached_property
    def absorber_mass(self) -> float:
        """Mass of all absorbers, kg/m, or kg of those at points."""
        return absorber_mass(self.system)

    @cached_property
    def absorber_spacing(self) -> float:
        """Smallest distance between absorbers of one gap along the inner of the two shells they link, m."""
        return absorber_spacing(self.system)

    @cached_property
    def total_mass(self) -> float:
        """Mass of all shells and line absorbers, kg/m."""
        shells = sum(shell_mass(wall) for wall in self.system.shells if isinstance(wall, Shell))
        return shells + self.absorber_mass


class MetricSource(DesignReading):
    """What metrics take from one response, in three dimensions the largest over its stations; units as of :class:`DesignReading`.

    Parameters
    ----------
    response : Response
    """

    def __init__(self, response: Response) -> None:
        super().__init__(response.system)
        self.response = response
        self.solution = response.solution
        self._solutions = [motion.solution for motion in response.motions]
        self._whole = slice(0, self.solution.time.size)
        self._width = len(circle_angles(self.solution.normal.shape[2], self.solution.normal.shape[1]))
        self._head = self.system.sources[0].angle

    def number(self, name: str, place: str | int) -> float:
        """Return a number by its name: the largest magnitude or RMS of a quantity of a shell, or what a method or property here gives.

        With stations the largest of them all.
        """
        spectrum = SpectrumMetric.read(name)
        if spectrum is not None:
            assert isinstance(place, int)
            return max(spectrum.largest(motion, place, self._head) for motion in self.response.motions)
        steady, mounted = SteadyMetric.read(name), MountedMetric.read(name)
        if steady is not None:
            return steady.value(self.system, place)
        if mounted is not None:
            assert isinstance(place, int)
            return mounted.value(self.response, place)
        entry = shell_metrics().get(name)
        if entry is None:
            return super().number(name, place)
        assert isinstance(place, int)
        if entry[0].through:
            return self.response.peak_stress(place, usual_component(self.solution, place)).value
        return max(self._largest(*entry, place, motion) for motion in self.response.motions)

    def _largest(self, quantity: Quantity, where: Where, shell: int, motion: WallMotion) -> float:
        if quantity.gain is None and quantity.largest is not None:
            return float(quantity.largest(motion.solution, shell, self._whole, 0.0).value)
        amplitudes, time = quantity.amplitudes(motion, shell), self.solution.time
        if where == "rms":
            return root_mean_square(amplitudes, time, self._whole, self._width)
        # What the summary shows at head, tail and anywhere is never less anywhere than there.
        beside = where == "anywhere" and {"head", "anywhere"} <= set(quantity.summary)
        turns = {"head": [0.0], "tail": [180.0], "anywhere": [0.0, 180.0] if beside else []}[where]
        found = [peak_at(amplitudes, time, self._whole, [self._head + turn])[0].value for turn in turns]
        return max(found) if where != "anywhere" else max([self._anywhere(amplitudes), *found])

    def _anywhere(self, amplitudes: Amplitudes) -> float:
        return peak_anywhere(amplitudes, self.solution.time, self._whole, self._width).value

    def peak_actuator_voltage(self, shell: int) -> float:
        """Return the largest voltage that the control law asks for anywhere, before any saturation, V; 0 without control."""
        if self.solution.problem.shells[shell].gains is None:
            return 0.0
        cut = [one for one in (cut_voltage(solution, shell, asked=True) for solution in self._solutions) if one is not None]
        if cut:
            return max(one.largest(self.solution.time, self._whole).value for one in cut)
        voltages = (demanded_voltage(solution, shell) for solution in self._solutions)
        return max(self._anywhere(partial(_window, voltage)) for voltage in voltages)

    def peak_actuator_field(self, shell: int) -> float:
        """Return the same as a field across the actuator, V/m."""
        return self.peak_actuator_voltage(shell) / self._thinnest(shell)

    def _thinnest(self, shell: int) -> float:
        """Return the thickness of the thinnest actuator of a shell, m, in which the field is largest."""
        return min(layer.thickness for layer in self._wall(shell).serving("actuator"))

    def actuator_field_ratio(self, shell: int) -> float:
        """Return the same over what the actuator stands (its material's or the controller's field limit)."""
        return self.peak_actuator_voltage(shell) / actuator_limit(self.solution, shell).volts

    def segment_sensor_voltage(self, shell: int) -> float:
        """Return the largest sensor voltage as a mean over the default segment (:mod:`coaxshell.solver.electrodes`), V."""
        length = segment_length(self.solution.problem, shell)
        return max(largest_sensor_voltage(solution, shell, self._whole, length).value for solution in self._solutions)

    def segment_actuator_voltage(self, shell: int) -> float:
        """Return the largest voltage asked for as a mean over the default segment, before any saturation, V; 0 without control."""
        if self.solution.problem.shells[shell].gains is None:
            return 0.0
        length = segment_length(self.solution.problem, shell)
        return max(largest_demanded_voltage(solution, shell, self._whole, length).value for solution in self._solutions)

    def segment_actuator_field(self, shell: int) -> float:
        """Return the same as a field across the actuator, V/m."""
        return self.segment_actuator_voltage(shell) / self._thinnest(shell)

    def segment_field_ratio(self, shell: int) -> float:
        """Return the same over what the actuator stands (its material's or the controller's field limit)."""
        return self.segment_actuator_voltage(shell) / actuator_limit(self.solution, shell).volts

    def strength_margin(self, shell: int) -> float:
        """Return the least strength of a layer over its largest stress, of all stations; InputError if no layer has a strength."""
        margin = self.response.peak_stress(shell, usual_component(self.solution, shell)).margin
        if margin is None:
            raise InputError(f"shells[{shell}].layers", "no material has a strength", "give one, such as strength = 235 MPa of a steel")
        return margin

    def stress_truncation(self, shell: int) -> float:
        """Return the estimate of what the orders above M would add to the stress, relative."""
        return float(self.solution.estimates.modal_stress[shell])

    def rms_pressure(self, region: str | int) -> float:
        """Return the root mean square of the total pressure over a fluid region and time, Pa; the exterior up to 3 a."""
        history = self.response.pressure_rms(region)
        time, values = history["time"].to_numpy(), history.to_numpy()
        return math.sqrt(float(np.trapezoid(values**2, time)) / float(time[-1] - time[0]))

    @cached_property
    def absorber_displacement(self) -> float:
        """Largest displacement of any absorber's mass, m; 0 without absorbers."""
        return float(np.abs(self.response.absorber_displacement()).max()) if self.absorber_count else 0.0

    @cached_property
    def absorber_force(self) -> float:
        """Largest force of any absorber on either of its shells, N/m, or N of those at points; 0 without absorbers."""
        return float(np.abs(self.response.absorber_force()).max()) if self.absorber_count else 0.0

    def _of_absorbers(self, what: str) -> FloatArray | None:
        """Return histories of line absorbers, dimensionless, at all stations where there are any."""
        require_lines(self.system)
        response = self.response
        if isinstance(response, SpatialResponse):
            return response.spatial.line_displacement if what == "displacement" else response.spatial.line_force
        return self.solution.absorber_displacement if what == "displacement" else self.solution.absorber_force

    @cached_property
    def dissipated_energy(self) -> float:
        """Energy that the absorbers' dampers have turned into heat by the end of the run, J/m; 0 without absorbers."""
        if self.solution.absorber_force is None:
            return 0.0
        last = Motion.of(self.solution, self.solution.time.size - 1)
        return float(absorber_energy(last).dissipated[-1]) * self.solution.problem.scales.line_energy

    @property
    def hull_shock_factor(self) -> float:
        """Largest hull shock factor of the charges, kg^(1/2)/m."""
        return max(charge.hull_shock_factor for charge in charges_of(self.system))

    @property
    def keel_shock_factor(self) -> float:
        """Largest keel shock factor of the charges, kg^(1/2)/m: the surface lies where the sea says, 90 degrees without one."""
        up = 90.0 if self.system.sea is None else self.system.sea.up
        return max(charge.keel_shock_factor(up) for charge in charges_of(self.system))

    @cached_property
    def time_window_error(self) -> float:
        """Estimate of the error of the inverse transform, relative."""
        return float(self.solution.estimates.time_window)


def charges_of(system: System) -> list[UnderwaterExplosion]:
    """Return the sources that are charges."""
    return [source for source in system.sources if isinstance(source, UnderwaterExplosion)]


def require_lines(system: System) -> None:
    """Refuse what is per metre of absorbers that have no length: InputError."""
    if system.point_absorbers:
        raise InputError("absorbers", "point absorbers are not read by metrics, which are per metre", "use a function of the response")


def shell_mass(shell: Shell) -> float:
    """Return the mass of a shell per metre of length, kg/m: sum over its layers of rho pi (r_out^2 - r_in^2)."""
    total, inside = 0.0, shell.inner_radius
    for layer in shell.layers:
        outside = inside + layer.thickness
        total += layer.material.density * math.pi * (outside**2 - inside**2)
        inside = outside
    return total


def absorber_mass(system: System) -> float:
    """Return the mass of all absorbers of a system: per metre of length, kg/m, of lines, kg of points."""
    return float(sum(absorber.mass for absorber in system.absorber_list or system.point_absorbers))


def absorber_spacing(system: System) -> float:
    """Return the smallest distance between absorbers of one gap, m, along the shell inside it; one past a shell is in every gap it crosses.

    Of lines the arc between neighbours, of points sqrt((R theta)^2 + z^2). A gap's whole circumference where it has a single absorber,
    that of the outermost shell where there are none.
    """
    spacings = [math.tau * system.reference_radius]
    for i in {gap for absorber in system.absorber_list for gap in gaps_of(absorber)}:
        angles = sorted(absorber.angle % 360.0 for absorber in system.absorber_list if i in gaps_of(absorber))
        steps = [after - before for before, after in pairwise([*angles, angles[0] + 360.0])]
        spacings.append(math.radians(min(steps)) * system.shells[i].radius)
    for i in {gap for absorber in system.point_absorbers for gap in gaps_of(absorber)}:
        places = [(absorber.angle, absorber.z) for absorber in system.point_absorbers if i in gaps_of(absorber)]
        spacings.append(_closest(np.array(places), system.shells[i].radius))
    return min(spacings)


def _closest(places: FloatArray, radius: float) -> float:
    """Return the smallest distance between points of a cylinder (angle in degrees, z), the circumference of a single one."""
    turns = np.abs((places[:, None, 0] - places[:, 0] + 180.0) % 360.0 - 180.0)
    apart = np.hypot(np.radians(turns) * radius, places[:, None, 1] - places[:, 1])
    return float(np.min(apart[~np.eye(len(places), dtype=bool)], initial=math.tau * radius))


def _window(modal: FloatArray, block: slice) -> FloatArray:
    return modal[:, :, block]
