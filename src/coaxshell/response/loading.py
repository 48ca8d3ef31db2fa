"""Open a saved response."""

from __future__ import annotations

from pathlib import Path

from coaxshell.response.response import Response
from coaxshell.response.storage import load_solution
from coaxshell.solver.finite import require_finite_solution


def load_response(path: str | Path) -> Response:
    """Return the response saved in a file, equal bit by bit to the one that was saved.

    Raises
    ------
    InputError
        If there is no such file, or it is not ours, cut short, damaged (NaN or infinity in an array too), or of a newer format.
    """
    solution = load_solution(path)
    require_finite_solution(solution, str(path), "write the file again")
    return Response(solution)
