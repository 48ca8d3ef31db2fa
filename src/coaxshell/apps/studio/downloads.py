"""Files to take home, made by a worker in the server's own temporary folder."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path
from typing import Any

from coaxshell.apps.studio import refusals, worker
from coaxshell.errors import InputError
from coaxshell.model import System
from coaxshell.model.naming import slug
from coaxshell.response.storage import scenario
from coaxshell.solver.settings import Settings

TYPES = {
    "toml": "application/toml",
    "nc": "application/x-netcdf",
    "csv": "text/csv",
    "png": "image/png",
    "svg": "image/svg+xml",
    "mp4": "video/mp4",
    "webp": "image/webp",
    "html": "text/html",
}

Run = tuple[System, Settings]


def named(system: str, suffix: str, what: str = "") -> str:
    """Return the name of a file to take home: of which system, what it holds, when it was made."""
    words = [slug(system)[:40].rstrip("-") or "coaxshell", what, datetime.now().astimezone().strftime("%Y-%m-%d-%H%M%S")]
    return f"{'-'.join(word for word in words if word)}.{suffix}"


def netcdf(run: Run, path: Path) -> None:
    """Write a run to a NetCDF file."""
    worker.answer(*run).save(path, compression=True)


def csv(run: Run, path: Path) -> None:
    """Write the histories of a run as CSV."""
    from coaxshell.export import export_csv

    export_csv(worker.answer(*run), path)


def figure(runs: list[Run], quantity: str, time: float, path: Path) -> None:
    """Draw the stress histories of runs side by side, or the field of the first one at an instant."""
    import matplotlib as mpl

    mpl.use("Agg")
    from coaxshell.plotting import figure_comparison, plot_field, save_figure

    if quantity == "field":
        save_figure(plot_field(worker.answer(*runs[0]), time).figure, path)  # type: ignore[arg-type]
        return
    save_figure(figure_comparison(dict(zip(_names(runs), (worker.answer(*run) for run in runs), strict=True))), path)


def movie(runs: list[Run], frames: int, fps: float, size: int, path: Path) -> None:
    """Write a film of runs side by side."""
    from coaxshell.plotting import FieldView, save_film

    save_film(
        *(worker.answer(*run) for run in runs),
        path=path,
        frames=frames,
        fps=fps,
        view=FieldView(3.0, size),
        names=_names(runs),
        progress=worker.report,
    )


def report(runs: list[Run], without: list[str], path: Path) -> None:
    """Write the report of a run, against a second one if there is one."""
    import matplotlib as mpl

    mpl.use("Agg")
    first, *others = (worker.answer(*run) for run in runs)
    first.report(path, others[0] if others else None, without=without, progress=worker.report)


def described(path: Path) -> tuple[str, dict[str, Any]]:
    """Return description and settings of an uploaded NetCDF file; its arrays are never read."""
    try:
        with refusals.readable("file"):
            return scenario(path)
    except InputError as error:
        raise InputError("file", error.problem, error.remedy) from None


def _names(runs: list[Run]) -> list[str]:
    """Return a name for each run, numbered where two would be the same."""
    names: list[str] = []
    for system, _ in runs:
        base = system.name or "system"
        names.append(base if base not in names else f"{base} ({sum(name.split(' (')[0] == base for name in names) + 1})")
    return names
