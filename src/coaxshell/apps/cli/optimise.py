"""``coaxshell optimise``: a study file, searched for its best system."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Annotated

import typer

from coaxshell.apps.cli.options import named_as_options
from coaxshell.apps.cli.output import write_figure
from coaxshell.apps.cli.progress import Interrupted
from coaxshell.apps.cli.running import StudyRequest, tell_code, tell_study_time, with_options


@with_options(request=StudyRequest)
def optimise(
    study: Annotated[
        Path, typer.Argument(metavar="STUDY", help="A .toml file: scenario, what may change, what to make small: see docs/optimisation.md.")
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            metavar="FOLDER",
            help="Folder for best.toml, optimum.json, history.csv.",
            show_default="STUDY.optimum in this folder",
        ),
    ] = None,
    figure: Annotated[
        Path | None,
        typer.Option("--figure", metavar="FILE", help="Draw convergence and front, or the best against the baseline; .png, .pdf or .svg."),
    ] = None,
    journal: Annotated[
        Path | None,
        typer.Option(
            "--journal",
            metavar="FOLDER",
            help="Keep every evaluation here.",
            show_default="STUDY.journal in this folder, removed when all is done",
        ),
    ] = None,
    *,
    request: StudyRequest,
) -> None:
    """Search for the best system within some ranges.

    Interrupted, by Ctrl-C or anything else, it goes on with --resume and ends as if it had not been.
    """
    from coaxshell.studies import OPTIMUM_PARTS, OptimisationStudy, optimise_problem, read_study

    outputs = request.outputs
    target = outputs.folder(output or Path(f"{study.stem}.optimum"), "--output", OPTIMUM_PARTS)
    outputs.figure(figure)

    problem = read_study(study, OptimisationStudy).problem(study.parent, allow_code=request.allow_code, tell=tell_code)
    folder = journal or Path(f"{study.stem}.journal")
    with request.execution(folder) as execution:
        runs = problem.evaluations * max(1, len(problem.uncertain.points))
        tell_study_time([problem.space.base], problem.resolution, runs, execution, quiet=request.quiet)
        optimum = optimise_problem(problem, execution)
    with named_as_options(folder="output", path="output"):
        optimum.save(target)
    if figure is not None:
        from coaxshell.plotting import figure_optimum

        write_figure(figure_optimum(optimum), figure)
    request.tell(optimum.to_dict, lambda: str(optimum), target, figure)
    if not optimum.complete:
        done = len(optimum.history)
        raise Interrupted(
            f"interrupted after {done} of {problem.evaluations} evaluations; the best so far is in {str(target)!r}: go on with --resume"
        )
    if journal is None:
        shutil.rmtree(folder, ignore_errors=True)
