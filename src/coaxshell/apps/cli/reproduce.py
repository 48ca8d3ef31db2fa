"""``coaxshell reproduce``: the paper's figures, claims and slips in one report."""

from __future__ import annotations

from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.output import echo, print_document
from coaxshell.apps.cli.progress import Interrupted, progress, tell_time
from coaxshell.apps.cli.running import settings_of
from coaxshell.errors import InputError

if TYPE_CHECKING:
    from coaxshell.apps.paper.reproduction import Results
    from coaxshell.solver.settings import Settings

FOLDER = Path("reproduction")


def reproduce(
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FOLDER", help="Where the report and the finished parts are kept; made if need be.")
    ] = FOLDER,
    only: Annotated[
        list[str] | None,
        typer.Option("--only", metavar="figures|claims|slips|sphere|walls|film|estimate", help="This part only. May be repeated."),
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="A coarse trial of everything: a minute instead of several.")] = False,
    film: Annotated[bool, typer.Option("--film/--no-film", help="Make a film of bare against hybrid.")] = True,
    duration: options.DurationOption = options.DURATION,
    time_step: options.TimeStepOption = options.TIME_STEP,
    modes: Annotated[str, typer.Option("--modes", metavar="N", help="Highest circumferential order.")] = options.MODES,
    workers: options.WorkersOption = None,
    as_json: options.JsonOption = False,
    quiet: options.QuietOption = False,
) -> None:
    """Compute the whole paper and write one report.

    Figures 2 to 14, a film, claims under the corrected model and under slips, the slips. Finished parts are kept: a second call goes on.
    """
    from coaxshell.apps.paper.reproduction import TOPICS, write
    from coaxshell.apps.paper.reproduction import reproduce as compute
    from coaxshell.apps.verification.files import prepare

    wanted = frozenset(only or ())
    for name in sorted(wanted - set(TOPICS)):
        raise InputError("--only", f"there is no topic {name!r}", f"allowed: {', '.join(TOPICS)}")
    resolution = _resolution(quick, duration, time_step, modes)
    count = None if workers is None else options.whole("--workers", workers)
    prepare(output)
    told = partial(tell_time, what="what is left to do", quiet=quiet)
    suffix = (".mp4" if find_spec("imageio_ffmpeg") else ".webp") if film else None
    try:
        with options.named_as_options(), progress(quiet, left=True) as report:
            found = compute(output, resolution, only=wanted, film_suffix=suffix, workers=count, progress=report, tell=told)
    except KeyboardInterrupt:
        raise Interrupted(f"interrupted; finished parts are kept in {str(output)!r}: the same command goes on") from None
    paths = write(found, output)
    if as_json:
        from coaxshell.apps.cli.documents import claims_document

        print_document(claims_document(found))
    else:
        _tell(found)
    echo("wrote " + ", ".join(str(path) for path in paths), aside=as_json)


def _resolution(quick: bool, duration: str, time_step: str, modes: str) -> Settings:
    from coaxshell.apps.paper.reproduction import QUICK
    from coaxshell.apps.paper.sphere.judged import LEAST
    from coaxshell.model import presets

    chosen = settings_of(presets.load("bare"), {"duration": duration, "time_step": time_step, "modes": modes})
    if chosen.modes == "auto":
        raise InputError("--modes", "'auto' is not allowed here", "give a whole number of 1 or more")
    if chosen.duration < LEAST:
        raise InputError("--duration", f"{chosen.duration:g} is too short for the claims", f"give at least {LEAST:g} transits")
    return QUICK if quick else chosen


def _tell(found: Results) -> None:
    from coaxshell.apps.paper.reproduction import VARIANTS

    for name in VARIANTS if found.judged else ():
        tally = found.tally(name)
        echo(f"claims, {name}: " + ", ".join(f"{count} {verdict}" for verdict, count in tally.items()))
    echo(f"{len(found.figures)} figures, {len(found.seconds)} parts in {found.elapsed:.0f} s")
