"""The energy balance of a three-dimensional run over the whole length of the shells: a sum of balances, one an axial wavenumber.

With the weights of Parseval's theorem (:mod:`coaxshell.solver.axial.motion`) for the axial period L

    E = L [E(k_0) + (1/2) sum_{j>=1} E(k_j)],

E(k) the balance in two dimensions of the amplitudes at k, shares 2/L and 4/L of the sources included. Every wavenumber closes by itself,
without point absorbers: these take from some and give to others, and what they hold and dissipate closes the sum.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from coaxshell.acoustics.sources import PlaneGeometry, SphericalFrontGeometry
from coaxshell.errors import InputError
from coaxshell.model.gains import saturates
from coaxshell.numerics.cost import Cost
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.progress import Progress
from coaxshell.numerics.threads import WORKERS
from coaxshell.response.energy.balance import ARRAYS, labelled, whole_steps
from coaxshell.response.energy.held_points import HeldPoints
from coaxshell.response.energy.lines import WallsAtLines, lines_energy
from coaxshell.response.energy.motion import Motion
from coaxshell.response.energy.parts import Entry, absorber_entries, parts_of
from coaxshell.solver.axial.blocks import on_threads
from coaxshell.solver.axial.forces import WallForces
from coaxshell.solver.axial.lack import VoltageLack
from coaxshell.solver.axial.limited import solve_limited_waves
from coaxshell.solver.axial.line_solve import LineSolution, solve_lines
from coaxshell.solver.axial.lines import line_layout
from coaxshell.solver.axial.motion import wave_motions
from coaxshell.solver.axial.sampling import AxialSampling, whole_length_sampling
from coaxshell.solver.axial.solution import SpatialSolution
from coaxshell.solver.axial.solve import with_shapes
from coaxshell.solver.cost import run_cost
from coaxshell.solver.scaling import Problem

_WAVE, _ENTRY = 0.08, 5e-5
"""Seconds of a core for a wavenumber, and for an order, a parity and an instant of it."""
_ALIKE = 10.0
"""What a fluid may lose of its spectrum at a wavenumber, in so many of what it may lose at the usual one."""


def whole_length_energy(solution: SpatialSolution, every: int = 10, progress: Progress | None = None) -> xr.Dataset:
    """Return the energy balance of a three-dimensional run over the whole length of the shells, J; stations do not matter.

    Variables, roles and attributes are those of :func:`coaxshell.response.energy.energy`; ``extent`` of the dataset says along what they
    count. Sources that are all uniform along the axis (line sources, plane waves across it) have an energy per length, J/m: that of two
    dimensions.

    The axial wavenumbers are solved again, for a period so long that images of the sources meet nothing of them (about twice as many as
    a run of one station has), and each costs about half of what a balance in two dimensions does.

    Parameters
    ----------
    solution : SpatialSolution
    every : int
        Energies are taken at every such instant of the run; work and losses are integrated over all of them.
    progress : callable, optional
        Called with the fraction done and the name of the stage.

    Raises
    ------
    InputError
        If *every* is not a whole number from 1 to the number of time steps, and as :func:`require_balanced`.
    """
    problem, settings = solution.problem, solution.settings
    every = whole_steps(every, solution.time.size - 1)
    along = along_the_length(solution, progress)
    uniform, grid, sampling, linked, held, forces = along.uniform, along.grid, along.sampling, along.linked, along.held, along.forces
    walls = None if linked is None else WallsAtLines(linked, grid)
    count = along.count
    total: dict[str, Entry] = {}
    power = np.zeros(len(problem.shells))
    for j, wave in enumerate(wave_motions(problem, sampling, grid, forces)):
        moved = wave.normal, wave.tangential, wave.axial
        known = every * settings.refinement, wave.incident
        motion = Motion(
            problem, grid, wave.modes, *moved, *known, solid=wave.solid, voltage=wave.voltage, around=wave.around, charged=wave.charged
        )
        power += [wave.length * motion.power(wall).sum() for wall in range(power.size)]
        if not uniform:
            motion = replace(motion, usual_power=_ALIKE * power / (count * wave.length))

        def report(fraction: float, stage: str, j: int = j) -> None:
            if progress is not None:
                progress((j + fraction) / count, f"axial wavenumber {j + 1:,} of {count:,}")

        report(0.0, "")
        for name, part in parts_of(motion, report).items():
            before = total[name].values if name in total else np.zeros_like(part.values)
            total[name] = part._replace(values=before + wave.length * part.values)
        if held is not None:
            held.add(wave)
        if walls is not None:
            walls.add(wave, j)
    kept = slice(None, None, every * settings.refinement)
    if held is not None:
        total |= absorber_entries(held.energy(kept))
    if walls is not None:
        total |= absorber_entries(lines_energy(walls, kept, 1.0 if uniform else sampling.period))
    scales = problem.scales
    found = labelled(solution, every, total, scales.line_energy if uniform else scales.energy, "J/m" if uniform else "J")
    return found.assign_attrs(extent="per metre of length" if uniform else "over the whole length")


@dataclass(frozen=True, eq=False)
class AlongTheLength:
    """What integrals along the whole axis of a run are made with.

    Attributes
    ----------
    uniform : bool
        Whether all sources are, so that one wavenumber, k = 0, is a run per length.
    grid : LaplaceGrid
    sampling : AxialSampling
    linked : LineSolution or None
        What line absorbers do.
    held : HeldPoints or None
        What point absorbers hold.
    lack : VoltageLack or None
        What amplifiers at their limit lack.
    """

    uniform: bool
    grid: LaplaceGrid
    sampling: AxialSampling
    linked: LineSolution | None
    held: HeldPoints | None
    lack: VoltageLack | None = None

    @property
    def count(self) -> int:
        """Number of axial wavenumbers."""
        return len(self.sampling.modes)

    @property
    def forces(self) -> WallForces | None:
        """Forces of the absorbers at the wavenumbers, or what amplifiers lack; None without any."""
        if self.held is not None:
            return self.held.forces
        return self.lack if self.linked is None else self.linked.forces


def along_the_length(solution: SpatialSolution, progress: Progress | None = None) -> AlongTheLength:
    """Return what integrals along the whole axis of a run are made with, its absorbers solved again.

    Raises
    ------
    InputError
        If instants of the run are missing, and as :func:`require_balanced`.
    """
    problem, settings = solution.problem, solution.settings
    require_balanced(problem)
    solution.at(0).need_every_instant("what is computed from its transforms (energy)")
    grid = LaplaceGrid(settings.time_step / settings.refinement, settings.steps * settings.refinement)
    sampling = whole_length_sampling(problem, settings)
    Cost(2.0 * ARRAYS * solution.fields["w"][0].nbytes * settings.refinement).require(
        f"the energy of {solution.time.size:,} instants and orders 0 to {sampling.max_order:,}", "run fewer orders or a coarser step"
    )
    linked = _lines(solution, sampling, grid, progress)
    held = HeldPoints(problem, grid, sampling) if problem.system.point_absorbers else None
    waves = with_shapes(problem, sampling, on_threads) if saturates(problem.system) else sampling
    limited = solve_limited_waves(problem, grid, waves, on_threads, progress) if saturates(problem.system) else None
    lack = None if limited is None else limited.with_waves(sampling).forces
    del waves
    return AlongTheLength(not isinstance(problem.sources[0], SphericalFrontGeometry), grid, sampling, linked, held, lack)


def whole_length_cost(solution: SpatialSolution) -> Cost:
    """Return what :func:`whole_length_energy` takes; measured with thin walls, lines of absorbers not counted.

    Raises
    ------
    InputError
        As :func:`require_balanced`.
    """
    problem, settings = solution.problem, solution.settings
    require_balanced(problem)
    sampling = whole_length_sampling(problem, settings)
    entries = float(solution.fields["w"][0].shape[0] * (sampling.max_order + 1) * settings.steps * settings.refinement)
    memory = 2.0 * ARRAYS * solution.fields["w"][0].nbytes * settings.refinement
    return Cost(memory, len(sampling.modes) * (_WAVE + _ENTRY * entries) / WORKERS)


def _lines(solution: SpatialSolution, sampling: AxialSampling, grid: LaplaceGrid, progress: Progress | None) -> LineSolution | None:
    """Return what line absorbers do all along the axis, None if there are none."""
    problem, settings = solution.problem, solution.settings
    if not problem.system.absorber_list:
        return None
    longer = replace(settings, axial_period=max(sampling.period * problem.scales.length, settings.axial_period or 0.0))
    run_cost(problem, longer).require("line absorbers over the whole length", "run fewer orders or a coarser step")
    return solve_lines(line_layout(problem, sampling), grid, on_threads, progress)


def require_balanced(problem: Problem) -> None:
    """Refuse what has neither an energy over the whole length nor one per length: InputError names the sources, or the absorbers."""
    for number, geometry in enumerate(problem.sources):
        if isinstance(geometry, PlaneGeometry) and geometry.inclination:
            where = f"source[{number}].inclination" if isinstance(problem.system.source, tuple) else "source.inclination"
            raise InputError(
                where,
                f"{geometry.inclination:g} degrees: an inclined wave carries energy along the shells, so that none is balanced at a place",
                "ask for the energy of an upright one, or of a spherical source far away",
            )
    spherical = [isinstance(geometry, SphericalFrontGeometry) for geometry in problem.sources]
    if any(spherical) and not all(spherical):
        raise InputError(
            "source",
            "spherical sources have an energy, in J, line sources and plane waves one per length, in J/m: together they have neither",
            "ask for the energy of each kind in a run of its own",
        )
    if problem.system.point_absorbers and not any(spherical):
        raise InputError(
            "absorbers",
            "points hold an energy, in J, line sources and plane waves give one per length, in J/m: together they have neither",
            "ask for the energy under spherical sources, or of line absorbers in two dimensions",
        )
