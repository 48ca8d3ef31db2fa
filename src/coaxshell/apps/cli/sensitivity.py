"""``coaxshell sensitivity``: a study file of uncertain properties, computed."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Annotated

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.entry import kept
from coaxshell.apps.cli.options import named_as_options
from coaxshell.apps.cli.output import Outputs, echo, print_document, statistics_document, write_figure
from coaxshell.apps.cli.running import study_options, tell_code, tell_study_time


def sensitivity(
    study: Annotated[
        Path, typer.Argument(metavar="STUDY", help="A .toml file: scenario, what is uncertain, what to read: see docs/sensitivity.md.")
    ],
    output: options.DatasetOption = None,
    figure: Annotated[
        Path | None, typer.Option("--figure", metavar="FILE", help="Draw indices, or distributions without them; .png, .pdf or .svg.")
    ] = None,
    store: options.StoreOption = None,
    resume: options.ResumeOption = False,
    allow_code: options.AllowCodeOption = False,
    workers: options.WorkersOption = None,
    dask: options.DaskOption = None,
    as_json: options.JsonOption = False,
    force: options.ForceOption = False,
    quiet: options.QuietOption = False,
) -> None:
    """Find which uncertain properties matter, and how much.

    Interrupted, by Ctrl-C or anything else, it goes on with --resume.
    """
    outputs = Outputs(force or resume)
    target = outputs.file(output or Path(f"{study.stem}.nc"), "--output", (".nc",))
    outputs.figure(figure)

    from coaxshell.numerics.netcdf import write_netcdf
    from coaxshell.studies import SensitivityStudy, read_study, uncertainty_of
    from coaxshell.studies.uncertainty.table import found_text, told

    plan = read_study(study, SensitivityStudy).plan(study.parent, allow_code=allow_code, tell=tell_code)
    folder = store or Path(f"{study.stem}.store")
    with kept(folder, len(plan.systems)), study_options(folder, resume, workers, dask, quiet) as execution:
        tell_study_time(plan.systems, plan.resolution, len(plan.systems), execution, quiet=quiet)
        found = uncertainty_of(plan, execution)
    with named_as_options(path="output"):
        write_netcdf(found, target)
    if figure is not None and told(found):
        from coaxshell.plotting import figure_sensitivity

        write_figure(figure_sensitivity(found), figure)
    if store is None and told(found):
        shutil.rmtree(folder, ignore_errors=True)
    if as_json:
        print_document(statistics_document(found))
    else:
        echo(found_text(found))
    echo(f"wrote {target}" + (f", {figure}" if figure is not None and told(found) else ""), aside=as_json)
