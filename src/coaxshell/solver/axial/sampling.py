"""The axial wavenumbers of a three-dimensional run: k_j = 2 pi j/L, the orders that go with each, and their shares at stations.

An amplitude F(k) that is even in z, and one that is odd, give at z

    (2/L) [F(k_0) + 2 sum_{j>=1} F(k_j) cos k_j z],        (4/L) sum_{j>=1} F(k_j) sin k_j z :

by Poisson's sum the answer to a source and its images at nL, of which causality keeps the images out
(:mod:`coaxshell.solver.axial.causality`). Orders and wavenumbers end on the ellipse (m/M)^2 + (k/k_max)^2 = 1, within which waves along
the wall are resolved alike in all directions.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from coaxshell.acoustics.sources import SphericalFrontGeometry
from coaxshell.errors import InputError
from coaxshell.model.layers import Shell
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.causality import Front, felt_length, first_arrival, least_period, rounded_up
from coaxshell.solver.axial.inclination import require_leading_fronts
from coaxshell.solver.scaling import Problem
from coaxshell.solver.settings import Settings
from coaxshell.solver.shared_parts import SharedParts
from coaxshell.structure.belts import Belts
from coaxshell.structure.laminate import require_axial_constants

_BELTS = 1.5
"""Stretches on which sources are felt, in a period for integrals along the whole axis where electrodes are cut along it."""
FAR = math.sqrt(3.0)
"""The wavenumber that stands for those left out, over the highest one kept."""
MOST_WAVES = 100_000
"""The most axial wavenumbers of a run."""


@dataclass(frozen=True, eq=False)
class AxialSampling:
    """Axial wavenumbers k_j = 2 pi j/L up to a highest one.

    Attributes
    ----------
    period : float
        L, in a.
    max_order : int
        M, the highest order, that of k = 0.
    highest : float
        k_max, in 1/a.
    fluids : SharedParts or None
        Where the added masses of the fluids at these waves are found, or left for the next run.
    """

    period: float
    max_order: int
    highest: float
    fluids: SharedParts | None = None

    @property
    def spacing(self) -> float:
        """2 pi/L."""
        return 2.0 * math.pi / self.period

    @cached_property
    def wavenumbers(self) -> FloatArray:
        """k_j, ascending from k_0 = 0, shape (waves,)."""
        return self.spacing * np.arange(math.floor(self.highest / self.spacing * (1.0 + 1e-12)) + 1, dtype=np.float64)

    @cached_property
    def tops(self) -> FloatArray:
        """The highest order with (m/M)^2 + (k/k_max)^2 <= 1 at every wavenumber, shape (waves,)."""
        room = np.maximum(1.0 - (self.wavenumbers / self.highest) ** 2, 0.0)
        return np.floor(self.max_order * np.sqrt(room) + 1e-9)

    @cached_property
    def modes(self) -> list[Modes]:
        """Orders with (m/M)^2 + (k/k_max)^2 <= 1 at every wavenumber."""
        return [Modes.up_to(int(top), float(k)) for top, k in zip(self.tops, self.wavenumbers, strict=True)]

    @cached_property
    def far(self) -> Modes:
        """All orders at the wavenumber that stands for those left out where a voltage moves them (:mod:`coaxshell.solver.axial.belts`)."""
        return Modes.up_to(self.max_order, FAR * self.highest)

    @cached_property
    def weights(self) -> FloatArray:
        """c_j: 2/L for k_0, 4/L for the others, shape (waves,)."""
        return np.where(self.wavenumbers == 0.0, 2.0, 4.0) / self.period

    @property
    def mean(self) -> FloatArray:
        """Mean squares along the axis of c_j cos k_j z, shape (waves,)."""
        return np.asarray(self.weights**2 * np.where(self.wavenumbers == 0.0, 1.0, 0.5))

    def shares(self, z: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return c_j cos k_j z and c_j sin k_j z, each (stations, waves).

        Parameters
        ----------
        z : ndarray, shape (stations,)
            Distances from the source's plane, in a.
        """
        phase = np.multiply.outer(z, self.wavenumbers)
        return self.weights * np.cos(phase), self.weights * np.sin(phase)


def axial_sampling(problem: Problem, settings: Settings) -> AxialSampling:
    """Return the axial wavenumbers of a run; k = 0 alone where all sources are uniform along the axis or travel along it.

    Parameters
    ----------
    problem : Problem
        Its spherical sources in three dimensions.
    settings : Settings
        With ``modes`` a number; ``axial_modes`` and ``axial_period`` where they are to be other than M and the least that causality asks.

    Raises
    ------
    InputError
        A material lacks its axial constants, the period given is too short, or something runs ahead of an inclined plane wave.
    """
    assert isinstance(settings.modes, int)
    for i, shell in enumerate(problem.system.shells):
        if isinstance(shell, Shell):
            require_axial_constants(shell, f"shells[{i}]")
    require_leading_fronts(problem, settings)
    highest, length = settings.axial_modes or float(settings.modes), problem.scales.length
    fastest = fastest_wave(problem, highest)
    fronts = spherical_fronts(problem)
    held = {one.z / length for one in problem.system.point_absorbers} | _reached(problem, settings, fronts, fastest)
    places = [*(z / length for z in settings.stations), *sorted(held)]
    fronts += [_from_point(problem, z, fronts, fastest) for z in sorted(held)]
    needed = least_period(settings.duration, places, fronts, fastest)
    if problem.belts is not None:
        needed = _of_belts(problem, settings, problem.belts, needed, fronts, fastest)
    given = None if settings.axial_period is None else settings.axial_period / length
    if given is not None and given < needed * (1.0 - 1e-12):
        felt = "stations, or images of dead electrodes," if problem.belts is not None and problem.belts.broken else "stations"
        raise InputError(
            "axial_period",
            f"{settings.axial_period:g} m is too short: images of the source, one period away, are felt at the {felt} within the run",
            f"give at least {rounded_up(needed * length):g} m, or leave it out",
        )
    if problem.belts is not None:
        _require_in_period(problem.belts, given or needed, length)
    if not fronts and problem.belts is None:
        return AxialSampling(math.pi / highest, settings.modes, highest)  # the next wavenumber would be 2 k_max
    period = given or needed
    waves = period * highest / (2.0 * math.pi)
    if waves > MOST_WAVES:
        found = f"an axial period of {period * length:.3g} m asks for {waves:.2g} axial wavenumbers, at most {MOST_WAVES:,} are solved"
        if given is not None:
            raise InputError("axial_period", found, "use a shorter one")
        farthest = max(abs(z) for z in settings.stations) / length < max(map(abs, held), default=0.0)
        where, nearer = ("absorbers", "absorbers with a nearer z") if farthest else ("stations", "nearer stations")
        raise InputError(where, found, f"use {nearer}, a shorter run, or fewer axial_modes")
    return AxialSampling(period, settings.modes, highest)


def whole_length_sampling(problem: Problem, settings: Settings) -> AxialSampling:
    """Return the axial wavenumbers of integrals along the whole axis: to the same highest one, so many that images stay out of all of it.

    Parameters
    ----------
    problem : Problem
    settings : Settings
        Of a finished run, with ``modes`` and ``axial_modes`` numbers.
    """
    assert isinstance(settings.modes, int)
    assert settings.axial_modes is not None
    highest, fronts = settings.axial_modes, spherical_fronts(problem)
    length = felt_length(settings.duration, fronts, fastest_wave(problem, highest))
    if problem.belts is not None:
        if problem.belts.broken and settings.axial_period is not None:  # whose numbers are those of the period of the run
            length = max(length, settings.axial_period / problem.scales.length / _BELTS)
        return AxialSampling(_whole_belts(problem.belts, _BELTS * length), settings.modes, highest)
    return AxialSampling(length or math.pi / highest, settings.modes, highest)


def _whole_belts(belts: Belts, length: float) -> float:
    """Return the least period of whole belts that is no shorter than a length, one at least, in a."""
    return max(1, math.ceil(length / belts.pitch - 1e-9)) * belts.pitch


def _of_belts(problem: Problem, settings: Settings, belts: Belts, needed: float, fronts: list[Front], speed: float) -> float:
    """Return the period of whole belts that images of the sources stay behind of, in a, *needed* where nothing is cut along the axis.

    A belt has one voltage, and what it reads at one end it gives at the other at once, which no speed of a wave bounds but fades from belt
    to belt; the period is longer by half of the stretch on which sources are felt.

    Raises
    ------
    InputError
        If wavenumbers end before they see an electrode, or the period given has no whole number of belts.
    """
    length = problem.scales.length
    require_seen(problem, belts, settings.axial_modes or float(settings.modes))
    if settings.axial_period is not None:
        count = settings.axial_period / length / belts.pitch
        if abs(count - round(count)) > 1e-6:
            found = f"{settings.axial_period:g} m is no whole number of electrodes {belts.pitch * length:g} m apart"
            raise InputError("axial_period", found, f"give {math.ceil(count) * belts.pitch * length:.10g} m, or leave it out")
    return _whole_belts(belts, needed + 0.5 * felt_length(settings.duration, fronts, speed))


def _require_in_period(belts: Belts, period: float, length: float) -> None:
    """Raise InputError if a belt that is dead is none of an axial period (in a), half of whose belts are on either side of z = 0."""
    most = belts.count(period) // 2
    for name, numbers in (("dead_belts", belts.dead_belts), ("dead_electrodes", [belt for belt, _ in belts.dead_electrodes])):
        far = [belt for belt in numbers if abs(belt) > most]
        if far:
            found = f"belt {far[0]} is outside the axial period of {belts.count(period)} belts, {period * length:.4g} m"
            least = (2 * abs(far[0]) + 1) * belts.pitch * length
            told = f"name belts from {-most} to {most}, or give axial_period={least:.10g} or more"
            raise InputError(f"control.{name}", found, told)


def require_seen(problem: Problem, belts: Belts, highest: float) -> None:
    """Raise InputError if axial wavenumbers (in 1/a) end before they see one of the electrodes that are cut along the axis."""
    length = problem.scales.length
    if highest * belts.length < math.pi * (1.0 - 1e-12):
        found = (
            f"{belts.length * length:g} m are less than half of the shortest wave along the axis, {2.0 * math.pi / highest * length:.3g} m"
        )
        least = math.ceil(math.pi / belts.length - 1e-9)
        raise InputError("control.segment_length", found, f"use axial_modes={least} or more, or longer electrodes")


def fastest_wave(problem: Problem, highest: float) -> float:
    """Return the greatest speed of any wave along the axis, in c_e, at wavenumbers up to a highest one (in 1/a)."""
    fluids = [1.0 / fluid.slowness for fluid in problem.fluids if fluid is not None]
    return max(fluids + [wall.fastest_wave(highest) for wall in problem.shells])


def _reached(problem: Problem, settings: Settings, fronts: list[Front], fastest: float) -> set[float]:
    """Return the ends of dead belts that something reaches within a run, in a."""
    ends = () if problem.belts is None else problem.belts.dead_ends
    return {z for z in ends if _from_point(problem, z, fronts, fastest).delay < settings.duration}


def _from_point(problem: Problem, z: float, fronts: list[Front], fastest: float) -> Front:
    """Return what starts from a wall that is held there, or where a dead belt ends, from the first instant at which it can move."""
    if len(fronts) < len(problem.sources):
        return Front(z, 0.0)  # other sources may reach it at once
    return Front(z, 0.0, min(front.delay + first_arrival(z - front.z, front.start, fastest) for front in fronts))


def spherical_fronts(problem: Problem) -> list[Front]:
    """Return the fronts of the spherical sources of a problem."""
    length, time = problem.scales.length, problem.scales.time
    return [
        Front(getattr(source, "z", 0.0) / length, geometry.distance - geometry.head, source.delay / time)
        for source, geometry in zip(problem.emitters, problem.sources, strict=True)
        if isinstance(geometry, SphericalFrontGeometry)
    ]
