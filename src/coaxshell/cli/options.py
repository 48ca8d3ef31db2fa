"""Options that several commands share. Values come as text; :mod:`coaxshell.cli.values` turns them into numbers."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

DURATION, TIME_STEP, MODES = "5", "1e-3", "150"
"""The paper's resolution, as the help shows it."""

SetOption = Annotated[
    list[str] | None,
    typer.Option(
        "--set", "-s", metavar="PATH=VALUE", help='Change an entry of the system, as in source.peak_pressure="50 kPa". May be repeated.'
    ),
]
DurationOption = Annotated[
    str, typer.Option("--duration", metavar="TIME", help='How long, in acoustic transits a/c_e of the outermost radius, or as in "3 ms".')
]
TimeStepOption = Annotated[str, typer.Option("--time-step", metavar="TIME", help='Time step, likewise: transits, or as in "2 us".')]
ModesOption = Annotated[str, typer.Option("--modes", metavar="N|auto", help="Highest circumferential order, or auto to meet --tolerance.")]
ToleranceOption = Annotated[str, typer.Option("--tolerance", metavar="ERROR", help="Relative error that --modes auto aims at.")]
EngineOption = Annotated[str, typer.Option("--engine", metavar="spectral|direct", help="How to solve.")]
RefinementOption = Annotated[
    str, typer.Option("--refinement", metavar="N", help="Solve at time-step/N and keep every N-th instant: for stiff absorbers.")
]
ForceOption = Annotated[bool, typer.Option("--force", help="Overwrite what exists already.")]
QuietOption = Annotated[bool, typer.Option("--quiet", "-q", help="Show no progress.")]
WorkersOption = Annotated[str | None, typer.Option("--workers", metavar="N", help="Processes; one a core unless given.")]
DaskOption = Annotated[
    str | None,
    typer.Option("--dask", metavar="ADDRESS", help="Work on the Dask cluster whose scheduler is here, as in tcp://10.0.0.1:8786."),
]
DatasetOption = Annotated[
    Path | None, typer.Option("--output", "-o", metavar="FILE", help="Where to, as NetCDF (.nc).", show_default="STUDY.nc in this folder")
]
StoreOption = Annotated[
    Path | None,
    typer.Option(
        "--store",
        metavar="FOLDER",
        help="Keep every finished case here.",
        show_default="STUDY.store in this folder, removed when all is done",
    ),
]
AllowCodeOption = Annotated[bool, typer.Option("--allow-code", help="Run Python files that the study names outside its folder too.")]
ResumeOption = Annotated[bool, typer.Option("--resume", help="Go on with what has been kept.")]
