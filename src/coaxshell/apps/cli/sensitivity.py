"""``coaxshell sensitivity``: a study file of uncertain properties, computed."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Annotated

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.documents import statistics_document
from coaxshell.apps.cli.options import named_as_options
from coaxshell.apps.cli.output import write_figure
from coaxshell.apps.cli.progress import kept
from coaxshell.apps.cli.running import StudyRequest, tell_code, tell_study_time, with_options


@with_options(request=StudyRequest)
def sensitivity(
    study: Annotated[
        Path, typer.Argument(metavar="STUDY", help="A .toml file: scenario, what is uncertain, what to read: see docs/sensitivity.md.")
    ],
    output: options.DatasetOption = None,
    figure: Annotated[
        Path | None, typer.Option("--figure", metavar="FILE", help="Draw indices, or distributions without them; .png, .pdf or .svg.")
    ] = None,
    store: options.StoreOption = None,
    *,
    request: StudyRequest,
) -> None:
    """Find which uncertain properties matter, and how much.

    Interrupted, by Ctrl-C or anything else, it goes on with --resume.
    """
    outputs = request.outputs
    target = outputs.file(output or Path(f"{study.stem}.nc"), "--output", (".nc",))
    outputs.figure(figure)

    from coaxshell.numerics.netcdf import write_netcdf
    from coaxshell.studies import SensitivityStudy, read_study, uncertainty_of
    from coaxshell.studies.uncertainty.table import found_text, told

    plan = read_study(study, SensitivityStudy).plan(study.parent, allow_code=request.allow_code, tell=tell_code)
    folder = store or Path(f"{study.stem}.store")
    with kept(folder, len(plan.systems)), request.execution(folder) as execution:
        tell_study_time(plan.systems, plan.resolution, len(plan.systems), execution, quiet=request.quiet)
        found = uncertainty_of(plan, execution)
    with named_as_options(path="output"):
        write_netcdf(found, target)
    if figure is not None and told(found):
        from coaxshell.plotting import figure_sensitivity

        write_figure(figure_sensitivity(found), figure)
    if store is None and told(found):
        shutil.rmtree(folder, ignore_errors=True)
    request.tell(lambda: statistics_document(found), lambda: found_text(found), target, figure if told(found) else None)
