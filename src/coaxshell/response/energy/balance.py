"""Where the energy goes: every store, flow and loss of a run, and how well they balance."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.places import region_name, shell_name, shell_phrase
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.cost import Cost
from coaxshell.numerics.finite import require_finite
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.progress import Progress, ShareDone
from coaxshell.numerics.scalars import plain
from coaxshell.response.energy.absorbers import absorber_energy
from coaxshell.response.energy.fluids import fluid_energy
from coaxshell.response.energy.motion import Motion
from coaxshell.response.energy.shells import actuator_work, shell_dissipation, shell_energy
from coaxshell.response.energy.work import SurfaceWork, surface_pressures
from coaxshell.response.labels import time_coordinates
from coaxshell.solver.solution import ModalSolution
from coaxshell.solver.solved_spectra import SolvedSpectra

_ARRAYS = 40.0
"""Arrays of the size of all normal displacements that stand side by side at the worst, as measured."""

BALANCE = "exterior_work = sum of the variables with the role store or loss + closure_residual"


class Entry(NamedTuple):
    """One history of the balance: at the kept instants, dimensionless until it is labelled.

    ``role`` is "store", "loss", "work" or "balance"; ``group`` names what it belongs to.
    """

    values: FloatArray
    role: str
    group: str
    long_name: str


def energy(
    solution: ModalSolution, every: int = 10, progress: Progress | None = None, *, spectra: SolvedSpectra | None = None
) -> xr.Dataset:
    """Return the energy balance of a run, J per metre of length: one variable with dims (time,) for every store, flow and loss.

    Each variable's attribute "role" says how it counts; exterior_work = sum of stores and losses + closure_residual.

    - store: ``<shell>_kinetic``, ``_strain`` (membrane and bending of all layers), ``_piezoelectric`` (open-circuit stiffening);
      ``interior_`` and ``gap_kinetic``, ``_compression``, integrated from the field in the fluid, not from work at its walls;
      ``absorber_kinetic``, ``absorber_spring``.
    - loss, since the start: ``damper_dissipation``; ``<shell>_dissipation`` of a wall that has losses; ``actuator_work``, taken from
      the shells by the actuators (negative: given).
    - work on the outer shell, since the start: ``exterior_work`` of the total exterior pressure, the sum of ``incident_work``
      (the wave as if nothing were there), ``scattered_work`` (what a rigid cylinder adds to it) and ``radiated_work``. The
      ``radiated_energy`` is minus the last: all that the shell's motion gave the exterior fluid, its near field included.
    - balance: ``closure_residual`` and ``closure_relative`` (to the largest work); ``damper_defect``, what the forces
      on the moving ends make of the dissipation less the c (dD/dt)^2 that is used: an error of the time step.

    Parameters
    ----------
    solution : ModalSolution
    every : int
        Energies are taken at every such instant of the run; work and losses are integrated over all of them.
    progress : callable, optional
        Called with the fraction done and the name of the stage.
    spectra : SolvedSpectra, optional
        Those of the solution, if known.

    Raises
    ------
    InputError
        If *every* is not a whole number from 1 to the number of time steps.
    """
    every = plain(every)
    if isinstance(every, bool) or not isinstance(every, (int, np.integer)) or not 1 <= every < solution.time.size:
        raise InputError("every", f"{every!r} is not allowed", f"give a whole number of time steps from 1 to {solution.time.size - 1}")
    Cost(_ARRAYS * solution.normal.nbytes).require(
        f"the energy of {solution.time.size:,} instants and orders 0 to {solution.normal.shape[2] - 1:,}",
        "run fewer orders or a coarser step",
    )
    report = progress or (lambda fraction, stage: None)
    report(0.0, "motion again")
    motion = Motion(solution, int(every), spectra)
    report(0.1, "work on the surface")
    entries = _surface(motion)
    report(0.25, "shells and absorbers")
    entries |= {**_shells(motion), **_absorbers(motion)}
    entries |= _fluids(motion, lambda fraction: report(0.35 + 0.65 * fraction, "fluids"))
    return _labelled(motion, entries | _closure(entries))


def _surface(motion: Motion) -> dict[str, Entry]:
    """Return the work of the exterior pressure and its parts on the outermost shell, and the energy radiated."""
    parts = surface_pressures(motion.spectra)
    work = SurfaceWork(motion.grid, motion.problem.shells[-1].radius * motion.circle, motion.normal_velocity[-1])
    incident, scattered, radiated = (work(part)[motion.kept] for part in parts)
    where = "on the outer shell, since the start"
    return {
        "exterior_work": Entry(incident + scattered + radiated, "work", "exterior", f"work of the total exterior pressure {where}"),
        "incident_work": Entry(incident, "work", "exterior", f"work of the incident pressure {where}"),
        "scattered_work": Entry(scattered, "work", "exterior", f"work of the rigidly scattered pressure {where}"),
        "radiated_work": Entry(radiated, "work", "exterior", f"work of the radiated pressure {where}"),
        "radiated_energy": Entry(-radiated, "work", "exterior", "energy given by the outer shell's motion to the exterior fluid"),
    }


def _shells(motion: Motion) -> dict[str, Entry]:
    count = len(motion.problem.shells)
    entries: dict[str, Entry] = {}
    for i in range(count):
        if not motion.problem.shells[i].moves:
            continue
        found, lost = shell_energy(motion, i), shell_dissipation(motion, i)
        name = shell_name(i, count) if i in (0, count - 1) else f"shell_{i}"
        group = shell_phrase(i, count)
        for part, what in (("kinetic", "kinetic"), ("strain", "strain"), ("piezoelectric", "piezoelectric (open-circuit)")):
            entries[f"{name}_{part}"] = Entry(getattr(found, part), "store", group, f"{what} energy of the {group}")
        if lost is not None:
            entries[f"{name}_dissipation"] = Entry(lost, "loss", group, f"energy dissipated in the {group}")
    taken = actuator_work(motion)[motion.kept]
    return entries | {"actuator_work": Entry(taken, "loss", "actuators", "work that the actuators have taken from the shells")}


def _absorbers(motion: Motion) -> dict[str, Entry]:
    kinetic, spring, dissipated, defect = absorber_energy(motion)
    law = "what the forces on the moving ends make of the dampers' dissipation, less damper_dissipation: error of the time step"
    return {
        "absorber_kinetic": Entry(kinetic, "store", "absorbers", "kinetic energy of the absorbers' masses"),
        "absorber_spring": Entry(spring, "store", "absorbers", "energy of the absorbers' springs, linear and cubic"),
        "damper_dissipation": Entry(dissipated, "loss", "dampers", "energy dissipated in the absorbers' dampers"),
        "damper_defect": Entry(defect, "balance", "dampers", law),
    }


def _fluids(motion: Motion, progress: ShareDone) -> dict[str, Entry]:
    regions = len(motion.problem.shells)
    entries: dict[str, Entry] = {}
    for i in range(regions):
        found = fluid_energy(motion, i, lambda fraction, i=i: progress((i + fraction) / regions))  # type: ignore[misc]
        if found is None:
            continue
        region = region_name(i, regions)
        name, group = region.replace(" ", "_"), f"fluid of {region}" if " " in region else f"{region} fluid"
        entries[f"{name}_kinetic"] = Entry(found.kinetic, "store", group, f"kinetic energy of the {group}")
        entries[f"{name}_compression"] = Entry(found.compression, "store", group, f"compression energy of the {group}")
    return entries


def _closure(entries: dict[str, Entry]) -> dict[str, Entry]:
    """Return work of the exterior pressure minus all stores and losses, and the same relative to the largest work."""
    work = entries["exterior_work"].values
    residual = work - sum(entry.values for entry in entries.values() if entry.role in ("store", "loss"))
    largest = float(np.max(np.abs(work)))
    what = "work of the total exterior pressure minus all stores and losses"
    return {
        "closure_residual": Entry(residual, "balance", "balance", what),
        "closure_relative": Entry(residual / (largest or 1.0), "balance", "balance", f"{what}, relative to the largest work"),
    }


def _labelled(motion: Motion, entries: dict[str, Entry]) -> xr.Dataset:
    unit = motion.problem.scales.line_energy
    variables = {}
    for name, entry in entries.items():
        relative = name == "closure_relative"
        require_finite(entry.values, f"energy.{name}", [("time", motion.grid.time[motion.kept])], "look for extreme layers or absorbers")
        attributes = {"units": "1" if relative else "J/m", "long_name": entry.long_name, "role": entry.role, "group": entry.group}
        variables[name] = xr.Variable("time", entry.values * (1.0 if relative else unit), attributes)
    every = motion.every // motion.solution.settings.refinement
    coordinates = {name: variable[::every] for name, variable in time_coordinates(motion.solution).items()}
    return xr.Dataset(variables, coordinates, {"title": motion.problem.system.name or "energy", "balance": BALANCE})
