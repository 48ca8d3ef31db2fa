"""Where the total pressure on a wetted surface falls so low that real water would cavitate.

The model's pressures are those of the shock alone: water at rest has p = 0 here. At the surface of the sea it stands under 0.1 MPa, so
p < -0.1 MPa is tension there. A system with a sea has a depth, whose pressure must be overcome first (:mod:`coaxshell.solver.cavitation`).

On the walls the transforms of the pressure follow from those of W by the fluids' operators. A part of the band and of the orders tells
"about 0.1 MPa" well enough, at a few hundredths of the run's cost.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from scipy import fft

from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.acoustics.operators import annulus
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.circle import circle_angles, on_circle
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.threads import WORKERS
from coaxshell.solver.cavitation import AMBIENT, least_on_wall
from coaxshell.solver.excitation import incident_on_surface
from coaxshell.solver.scaling import Problem

HARMLESS = 0.25
"""Largest sum of the sources' peaks, in ambient pressures, for which nothing is looked at: it would take tension four times as large."""
_RESOLUTION = 0.01
_MOST_ORDERS = 60
_LASTING = 4
"""Instants of _RESOLUTION that a place cavitates at least for the beginning to be told."""


class Tension(NamedTuple):
    """The lowest total pressure on one wetted surface.

    Attributes
    ----------
    region, shell : int
        Fluid and shell that meet there, counted from the inside.
    pressure : float
        Pa, negative.
    time, angle : float
        When (transits) and where (degrees from theta = 0).
    width, lasting : float
        Degrees of the circumference that cavitate at once at most, and transits during which any do.
    least : float
        Pressure below which the water cavitates at that angle, Pa, negative.
    first, first_angle : float
        When (transits) and where (degrees) it does so first.
    """

    region: int
    shell: int
    pressure: float
    time: float
    angle: float
    width: float
    lasting: float
    least: float = -AMBIENT
    first: float = 0.0
    first_angle: float = 0.0


def watched(problem: Problem) -> bool:
    """Return whether the sources are strong enough for tension to be looked for."""
    return sum(abs(source.pulse.peak) for source in problem.emitters) > HARMLESS * AMBIENT


def tensions(
    problem: Problem, grid: LaplaceGrid, normal: ComplexArray, outer: ComplexArray | None = None, returned: ComplexArray | None = None
) -> list[Tension]:
    """Return the wetted surfaces on which the total pressure falls so low within the run that the water cavitates.

    Parameters
    ----------
    problem : Problem
    grid : LaplaceGrid
    normal : ndarray, shape (shells, parities, M + 1, nodes)
        Transforms of W.
    outer : ndarray, optional
        Those of the outer faces, where faces move differently and ``normal`` holds the inner ones.
    returned : ndarray, shape (parities, M + 1, nodes), optional
        Load of what the planes of the sea send back.
    """
    if not watched(problem):
        return []
    coarse = _first_nodes(grid)
    within = coarse.time <= grid.time[-1] * (1 + 1e-12)
    window = np.exp(-20.0 * np.linspace(0.0, 1.0, coarse.nodes.size) ** 4)
    few, few_outer = (x[:, :, : _MOST_ORDERS + 1, : coarse.nodes.size] for x in (normal, normal if outer is None else outer))
    found = []
    for region, shell, spectra in wall_pressures(problem, coarse, few, few_outer, returned):
        modal = problem.scales.pressure * coarse.invert(spectra, window)[..., within]
        lowest = _lowest(problem, region, modal, coarse.time[within])
        if lowest is not None:
            found.append(Tension(region, shell, *lowest))
    return found


def spectra_of_motion(grid: LaplaceGrid, histories: FloatArray) -> ComplexArray:
    """Return transforms of displacements that are known until the end of a run, as :func:`tensions` takes them.

    The period lasts at least twice as long, and a motion that broke off would end in a pressure of its own. It goes on with its
    velocity and acceleration, faded out; until the end no pressure depends on what comes after it.

    Parameters
    ----------
    grid : LaplaceGrid
    histories : ndarray, shape (shells, parities, M + 1, T)

    Returns
    -------
    ndarray, shape (shells, parities, at most 61, nodes)
    """
    known = histories[:, :, : _MOST_ORDERS + 1]
    apart = max(1, min((known.shape[-1] - 1) // 2, round(_RESOLUTION / grid.time_step)))
    before, between, last = known[..., -1 - 2 * apart], known[..., -1 - apart], known[..., -1]
    interval = apart * grid.time_step
    velocity = (1.5 * last - 2.0 * between + 0.5 * before) / interval
    acceleration = (last - 2.0 * between + before) / interval**2
    after = grid.time_step * np.arange(1, grid.samples - known.shape[-1] + 1)
    fading = np.exp(-20.0 * (after / after[-1]) ** 4)
    rest = (last[..., None] + velocity[..., None] * after + 0.5 * acceleration[..., None] * after**2) * fading
    whole = np.concatenate([known, rest], axis=-1)
    whole *= grid.time_step * np.exp(-grid.shift * grid.time_step * np.arange(grid.samples))
    spectra: ComplexArray = fft.rfft(whole, axis=-1, workers=WORKERS)
    return spectra


def wall_pressures(
    problem: Problem,
    grid: LaplaceGrid,
    normal: ComplexArray,
    outer_faces: ComplexArray | None = None,
    returned: ComplexArray | None = None,
) -> Iterator[tuple[int, int, ComplexArray]]:
    """Yield (fluid, shell, transforms of the total pressure on that face) for every wetted face, each (parities, M + 1, nodes).

    W is given of all walls, or of their inner and of their outer faces.
    """
    radial = RadialBasis(Modes.up_to(normal.shape[2] - 1), grid.nodes)
    acceleration = grid.nodes**2 * normal
    beyond = acceleration if outer_faces is None else grid.nodes**2 * outer_faces
    count = len(problem.shells)
    for region, fluid in enumerate(problem.fluids):
        if fluid is None:
            continue
        outer = radial(fluid.slowness, problem.shells[region].wetted[0]) if region < count else None
        inner = radial(fluid.slowness, problem.shells[region - 1].wetted[1]) if region else None
        if inner is None and outer is not None:
            yield region, region, fluid.density * outer.disc * acceleration[region]
        elif outer is None and inner is not None:
            incident, slope = incident_on_surface(problem, grid, radial, returned)
            total = inner.exterior * beyond[-1]
            total[: len(incident)] += incident - inner.exterior * slope
            yield region, region - 1, total
        elif inner is not None and outer is not None:
            walls = annulus(inner, outer)
            below, above = fluid.density * beyond[region - 1], fluid.density * acceleration[region]
            yield region, region - 1, walls.aa * below + walls.ab * above
            yield region, region, walls.ba * below + walls.bb * above


def _first_nodes(grid: LaplaceGrid) -> LaplaceGrid:
    """Return the grid of the first nodes, up to pi/_RESOLUTION: same contour, same period, coarser step."""
    samples = 16 if grid.period < 16 * _RESOLUTION else int(np.ceil(grid.period / _RESOLUTION))
    while samples < grid.samples:
        samples = int(fft.next_fast_len(samples + samples % 2, real=True))
        coarse = LaplaceGrid(grid.period / samples, samples // 2 - 1, grid.wrap_around, fewest=0)
        if coarse.samples == samples and samples % 2 == 0:
            return coarse
        samples += 1
    return grid


def _lowest(problem: Problem, region: int, modal: np.ndarray, time: np.ndarray) -> tuple[float, ...] | None:
    """Return (pressure, time, angle, width, lasting, least, first, first angle) where a surface cavitates; None if it never does."""
    field = on_circle(modal)
    angles = circle_angles(modal.shape[1], modal.shape[0])
    least = least_on_wall(problem, region, np.asarray(angles))
    excess = field - least[:, None]
    low = excess < 0.0
    if not low.any():
        return None
    place, instant = np.unravel_index(int(excess.argmin()), field.shape)
    # Of few orders a front's series overshoots far from it, and before it; the means of its partial sums (Fejer) never do.
    fading = 1.0 - np.arange(modal.shape[1]) / modal.shape[1]
    means = on_circle(modal * fading[:, None]) - least[:, None]
    lasting_low = means < 0.0  # not what a front's band leaves before and behind it
    for later in range(1, _LASTING):
        lasting_low[:, :-later] &= means[:, later:] < 0.0
        lasting_low[:, -later:] = False
    start = int(lasting_low.any(axis=0).argmax()) if lasting_low.any() else int(instant)
    where = int(np.where(lasting_low[:, start], means[:, start], 0.0).argmin()) if lasting_low.any() else int(place)
    around = 360.0 / len(angles) if modal.shape[0] == 2 else 360.0 / (len(angles) - 1)
    width = min(360.0, float(low.sum(axis=0).max()) * around)
    lasting = float(low.any(axis=0).sum()) * float(time[1] - time[0])
    lowest = float(field[place, instant]), float(time[instant]), float(angles[place])
    return *lowest, width, lasting, float(least[place]), float(time[start]), float(angles[where])
