"""``coaxshell fit``: a study file of measured records, and the properties that meet them best."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Annotated

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.options import named_as_options
from coaxshell.apps.cli.output import write_figure
from coaxshell.apps.cli.running import FitRequest, with_options


@with_options(request=FitRequest)
def fit(
    study: Annotated[
        Path,
        typer.Argument(metavar="STUDY", help="A .toml file: scenario, measured records, what is looked for: see docs/howto/identify.md."),
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            metavar="FOLDER",
            help="Folder for fitted.toml, fit.json, records.csv.",
            show_default="STUDY.fit in this folder",
        ),
    ] = None,
    figure: Annotated[
        Path | None, typer.Option("--figure", metavar="FILE", help="Draw the records beside the run; .png, .pdf or .svg.")
    ] = None,
    store: options.StoreOption = None,
    *,
    request: FitRequest,
) -> None:
    """Identify properties from measured histories.

    Interrupted, by Ctrl-C or anything else, it goes on with --resume.
    """
    from coaxshell.studies import FIT_PARTS, FitStudy, fit_plan, read_study

    outputs = request.outputs
    target = outputs.folder(output or Path(f"{study.stem}.fit"), "--output", FIT_PARTS)
    outputs.figure(figure)

    plan = read_study(study, FitStudy).plan(study.parent)
    folder = store or Path(f"{study.stem}.store")
    with request.execution(folder) as execution:
        found = fit_plan(plan, execution)
    with named_as_options(folder="output", path="output"):
        found.save(target)
    if figure is not None:
        from coaxshell.plotting import figure_fit

        write_figure(figure_fit(found), figure)
    request.tell(found.to_dict, lambda: str(found), target, figure)
    if store is None:
        shutil.rmtree(folder, ignore_errors=True)
