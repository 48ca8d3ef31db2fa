"""``coaxshell verify``: the conformance suite, and another code's histories against ours."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.output import echo, print_document
from coaxshell.apps.cli.running import settings_of
from coaxshell.errors import InputError

if TYPE_CHECKING:
    from coaxshell.apps.verification import Report
    from coaxshell.model import System

FOLDER = Path("verification-report")


def verify(
    quick: Annotated[bool, typer.Option("--quick", help="Smaller versions of the checks: seconds instead of a minute or two.")] = False,
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FOLDER", help="Where report.md and report.html are written; made if need be.")
    ] = FOLDER,
    show_list: Annotated[bool, typer.Option("--list", help="List the checks and leave.")] = False,
    only: Annotated[list[str] | None, typer.Option("--only", metavar="NAME", help="Carry out this check only. May be repeated.")] = None,
    against: Annotated[
        Path | None, typer.Option("--against", metavar="FILE", help="Compare another code's histories (.csv) with ours; needs --case.")
    ] = None,
    case: Annotated[
        str | None, typer.Option("--case", metavar="SCENARIO", help="What the other code solved: a preset or a .toml file.")
    ] = None,
    template: Annotated[
        Path | None, typer.Option("--template", metavar="FILE", help="Write an example (.csv) for --against with our numbers for --case.")
    ] = None,
    tolerance: Annotated[
        str,
        typer.Option("--tolerance", metavar="ERROR", help="With --against: largest relative error that passes; inf judges nothing."),
    ] = "0.05",
    time_step: options.TimeStepOption = options.TIME_STEP,
    modes: Annotated[str, typer.Option("--modes", metavar="N", help="With --against, --template: highest order.")] = options.MODES,
    as_json: options.JsonOption = False,
    force: options.ForceOption = False,
    quiet: options.QuietOption = False,
) -> None:
    """Check the numbers and write a report.

    Against theory, reference values and independent methods. With --against FILE --case SCENARIO another code's histories are
    compared with ours instead: each history and each peak must be within the tolerance, and the likely cause of a deviation is named
    (sign, unit, a lag in time, head and tail exchanged). Exits with 1 if anything fails.
    """
    if show_list:
        return _list(as_json)
    if against is None and template is None:
        if case is not None:
            raise InputError("--case", "is for --against or --template", "give one of them, or leave --case out")
        return _tell(_suite(only, quick, output, force, quiet), output, as_json)

    from coaxshell.apps.cli.running import load_system

    if case is None:
        raise InputError("--case", "is missing", "name the preset or .toml file that the other code solved")
    system = load_system(case, where="--case")
    resolution = settings_of(system, {"time_step": time_step, "modes": modes})
    if resolution.modes == "auto":
        raise InputError("--modes", "'auto' is not allowed here", "give a whole number of 1 or more")
    if template is not None:
        _template(system, template, resolution.modes, force, as_json)
    if against is not None:
        limit = options.number("--tolerance", tolerance)
        _folder(output, force)
        _tell(_against(against, system, limit, (resolution.time_step, resolution.modes), quiet), output, as_json)
    return None


def _list(as_json: bool) -> None:
    from coaxshell.apps.verification import checks

    known = checks()
    if as_json:
        return print_document({"checks": [{"name": one.name, "title": one.title} for one in known]})
    width = max(len(one.name) for one in known)
    for one in known:
        echo(f"{one.name:{width}}  {one.title}")
    return None


def _suite(only: list[str] | None, quick: bool, output: Path, force: bool, quiet: bool) -> Report:
    from coaxshell.apps.cli.progress import progress
    from coaxshell.apps.verification import chosen, run
    from coaxshell.apps.verification.files import prepare

    wanted = chosen(only, quick)
    prepare(_folder(output, force))
    with progress(quiet) as report:
        return run(wanted, quick=quick, progress=report)


def _against(path: Path, system: System, limit: float, resolution: tuple[float, int], quiet: bool) -> Report:
    from coaxshell.apps.cli.progress import progress
    from coaxshell.apps.verification.against import against

    with options.named_as_options(), progress(quiet) as report:
        return against(path, system, time_step=resolution[0], modes=resolution[1], tolerance=limit, progress=report)


def _template(system: System, path: Path, modes: int, force: bool, as_json: bool) -> None:
    from coaxshell.apps.cli.output import Outputs
    from coaxshell.apps.verification.against import template

    Outputs(force).file(path, "--template", (".csv",))
    template(system, path, modes=modes)
    echo(f"wrote {path}", aside=as_json)


def _folder(output: Path, force: bool) -> Path:
    """Return the report's folder, found free."""
    from coaxshell.apps.cli.output import Outputs
    from coaxshell.apps.verification.files import NAMES

    outputs = Outputs(force)
    for name in NAMES if output.is_dir() else ():
        outputs.file(output / name, "--output", (".md", ".html"))
    return output


def _tell(found: Report, output: Path, as_json: bool) -> None:
    """Print the report, write its files, and leave with 1 if anything fails."""
    from coaxshell.apps.verification import write_report
    from coaxshell.apps.verification.terminal import drawn, plain

    paths = write_report(found, output)
    if as_json:
        from coaxshell.apps.cli.documents import report_document

        print_document(report_document(found))
    elif sys.stdout.isatty():
        from rich.console import Console

        Console().print(*drawn(found), sep="\n")
    else:
        echo(plain(found))
    echo("wrote " + ", ".join(str(path) for path in paths), aside=as_json)
    if found.failed:
        raise typer.Exit(1)
