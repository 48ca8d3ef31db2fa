"""``coaxshell sweep``: a study file, computed."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.documents import cases_document
from coaxshell.apps.cli.options import named_as_options
from coaxshell.apps.cli.output import write_figure
from coaxshell.apps.cli.progress import kept
from coaxshell.apps.cli.running import StudyRequest, tell_code, tell_study_time, with_options
from coaxshell.errors import InputError

if TYPE_CHECKING:
    import xarray as xr


@with_options(request=StudyRequest)
def sweep(
    study: Annotated[
        Path, typer.Argument(metavar="STUDY", help="A .toml file: scenario, what to vary, what to read: see docs/studies.md.")
    ],
    output: options.DatasetOption = None,
    csv: Annotated[Path | None, typer.Option("--csv", metavar="FILE", help="Write a table (.csv) too, one case a line.")] = None,
    figure: Annotated[
        Path | None, typer.Option("--figure", metavar="FILE", help="Draw it too (over one or two fields); .png, .pdf or .svg.")
    ] = None,
    store: options.StoreOption = None,
    *,
    request: StudyRequest,
) -> None:
    """Compute a system at many points of some of its fields.

    Interrupted, by Ctrl-C or anything else, it goes on with --resume.
    """
    outputs = request.outputs
    target = outputs.file(output or Path(f"{study.stem}.nc"), "--output", (".nc",))
    if csv is not None:
        outputs.file(csv, "--csv", (".csv",))
    outputs.figure(figure)

    from coaxshell.studies import SweepStudy, read_study, sweep_design
    from coaxshell.studies.labelled import best_cases

    system, design, metrics, resolution = read_study(study, SweepStudy).parts(study.parent, allow_code=request.allow_code, tell=tell_code)
    if figure is not None and len(design.fields) > 2:
        raise InputError("--figure", f"{len(design.fields)} fields vary", "one or two can be drawn: leave it out and draw slices in Python")
    folder = store or Path(f"{study.stem}.store")
    with kept(folder, len(design.cases)), request.execution(folder) as execution:
        tell_study_time([system], resolution, len(design.cases), execution, quiet=request.quiet)
        dataset = sweep_design(system, design, metrics, resolution, execution)
    _write(dataset, target, csv, figure)
    if store is None:
        shutil.rmtree(folder, ignore_errors=True)
    request.tell(lambda: cases_document(dataset), lambda: best_cases(dataset), target, csv, figure)


def _write(dataset: xr.Dataset, target: Path, csv: Path | None, figure: Path | None) -> None:
    from coaxshell.numerics.netcdf import write_netcdf

    with named_as_options(path="output"):
        write_netcdf(dataset, target)
    if csv is not None:
        from coaxshell.studies.labelled import write_csv

        with named_as_options(path="csv"):
            write_csv(dataset, csv)
    if figure is not None:
        from coaxshell.plotting import figure_sweep

        write_figure(figure_sweep(dataset), figure)
