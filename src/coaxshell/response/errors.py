"""The errors that a run estimates of itself, as one labelled array."""

from __future__ import annotations

import numpy as np

from coaxshell.model.places import shell_name
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.response.dataset import ERROR, ERRORS
from coaxshell.solver.solution import QUANTITIES, ModalSolution


def causes_shown(solution: ModalSolution) -> tuple[str, ...]:
    """Return the names of the causes of a run's errors, and of their sum."""
    return (*solution.estimates.causes, "combined")


def errors(solution: ModalSolution) -> xr.DataArray:
    """Return the estimated relative errors of a run, dims (shell, quantity, cause).

    ``|error|/|answer|``, both in the L2 norm over the surface of the shell and the whole time: sqrt(int oint x^2 dtheta dt). The quantity
    is "displacement" (normal) or "stress" (hoop, of the core at the mid-surface); the cause "orders" (those above M), "time step" (the
    band limit of the inverse transform), "march" (the steps of nonlinear absorbers and saturating actuators, 0 without them), in
    three dimensions "axial wavenumbers" (those above the highest), or "combined", their sum. NaN for what the engine does not estimate,
    and for a rigid shell.

    Parameters
    ----------
    solution : ModalSolution
    """
    count = len(solution.problem.shells)
    coordinates = {
        "shell": [shell_name(i, count) for i in range(count)],
        "quantity": list(QUANTITIES),
        "cause": list(causes_shown(solution)),
    }
    return xr.DataArray(error_numbers(solution), coordinates, ERROR, "error", {"units": "1", "long_name": ERRORS})


def error_numbers(solution: ModalSolution) -> FloatArray:
    """Return the same as bare numbers, shape (shells, quantities, causes and combined)."""
    found = solution.estimates.by_cause()
    values = np.concatenate([found, found.sum(axis=-1, keepdims=True)], axis=-1)
    values[[not wall.moves for wall in solution.problem.shells]] = np.nan
    return values


def error_table(solution: ModalSolution, shell: int) -> dict[str, dict[str, float | None]]:
    """Return those of one shell by quantity and cause, None for NaN."""
    rows = error_numbers(solution)[shell]
    return {
        quantity: {cause: float(one) if np.isfinite(one) else None for cause, one in zip(causes_shown(solution), row, strict=True)}
        for quantity, row in zip(QUANTITIES, rows, strict=True)
    }
