"""Where the energy goes: every store, flow and loss of a run, and how well they balance."""

from __future__ import annotations

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.cost import Cost
from coaxshell.numerics.finite import require_finite
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.progress import Progress
from coaxshell.numerics.scalars import plain
from coaxshell.response.energy.motion import Motion
from coaxshell.response.energy.parts import Entry, parts_of
from coaxshell.response.labels import time_coordinates
from coaxshell.solver.axial.solution import SpatialSolution
from coaxshell.solver.solution import ModalSolution
from coaxshell.solver.solved_spectra import SolvedSpectra

ARRAYS = 40.0
"""Arrays of the size of all normal displacements that stand side by side at the worst, as measured."""

BALANCE = "exterior_work = sum of the variables with the role store or loss + closure_residual"


def energy(
    solution: ModalSolution, every: int = 10, progress: Progress | None = None, *, spectra: SolvedSpectra | None = None
) -> xr.Dataset:
    """Return the energy balance of a run, J per metre of length: one variable with dims (time,) for every store, flow and loss.

    Each variable's attribute "role" says how it counts; exterior_work = sum of stores and losses + closure_residual.

    - store: ``<shell>_kinetic``, ``_strain`` (membrane and bending of all layers), ``_piezoelectric`` (open-circuit stiffening);
      ``interior_`` and ``gap_kinetic``, ``_compression``, integrated from the field in the fluid, not from work at its walls;
      ``absorber_kinetic``, ``absorber_spring``.
    - loss, since the start: ``damper_dissipation``; ``<shell>_dissipation`` of a wall that has losses; ``actuator_work``, taken from
      the shells by the actuators (negative: given). With electrodes ``amplifier_work`` (role work), the energy that amplifiers have
      supplied, is ``actuator_field``, what the driven layers' fields hold, less ``actuator_work``.
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
    every = whole_steps(every, solution.time.size - 1)
    Cost(ARRAYS * solution.normal.nbytes).require(
        f"the energy of {solution.time.size:,} instants and orders 0 to {solution.normal.shape[2] - 1:,}",
        "run fewer orders or a coarser step",
    )
    report = progress or (lambda fraction, stage: None)
    report(0.0, "motion again")
    motion = Motion.of(solution, every, spectra)
    return labelled(solution, every, parts_of(motion, report), solution.problem.scales.line_energy, "J/m")


def whole_steps(every: object, most: int) -> int:
    """Return a number of time steps from 1 to the most there are, of any type of whole number; InputError for anything else."""
    every = plain(every)
    if isinstance(every, bool) or not isinstance(every, (int, np.integer)) or not 1 <= every <= most:
        raise InputError("every", f"{every!r} is not allowed", f"give a whole number of time steps from 1 to {most}")
    return int(every)


def labelled(run: ModalSolution | SpatialSolution, every: int, parts: dict[str, Entry], unit: float, unit_name: str) -> xr.Dataset:
    """Return the parts of a balance and what is left of it in SI, at every so many instants of a run.

    Parameters
    ----------
    run : ModalSolution or SpatialSolution
    every : int
    parts : dict of str to Entry
        Dimensionless.
    unit : float
        SI value of one of their units.
    unit_name : str
    """
    coordinates = {name: variable[::every] for name, variable in time_coordinates(run).items()}
    variables = {}
    for name, entry in (parts | _closure(parts)).items():
        relative = name == "closure_relative"
        require_finite(entry.values, f"energy.{name}", [("time", run.time[::every])], "look for extreme layers or absorbers")
        attributes = {"units": "1" if relative else unit_name, "long_name": entry.long_name, "role": entry.role, "group": entry.group}
        variables[name] = xr.Variable("time", entry.values * (1.0 if relative else unit), attributes)
    return xr.Dataset(variables, coordinates, {"title": run.problem.system.name or "energy", "balance": BALANCE})


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
