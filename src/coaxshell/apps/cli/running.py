"""From the arguments of a command to systems, responses and studies.

A system is a TOML file, standard input or a preset, with changes; a response is a saved run as it is, or a system solved at the
resolution of the options; a study is worked on by as many processes, or the cluster, that the options name.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, ExitStack, contextmanager
from dataclasses import dataclass, fields, replace
from functools import wraps
from inspect import Parameter, signature
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.options import named_as_options, overrides
from coaxshell.apps.cli.output import Outputs, echo, print_document, tell_warnings
from coaxshell.apps.cli.progress import progress, tell_time
from coaxshell.errors import InputError

if TYPE_CHECKING:
    from coaxshell.model import System
    from coaxshell.response import Response
    from coaxshell.solver.settings import Settings
    from coaxshell.studies import Execution


STANDARD_INPUT = ("-", "/dev/stdin")
_FITTINGS = ("absorbers", "control")


def load_system(scenario: str, changes: Sequence[str] = (), where: str = "SCENARIO") -> System:
    """Return the system of a preset, a TOML file or standard input ("-"), with ``path=value`` changes applied.

    *where* is the argument that names it.

    Raises
    ------
    InputError
        No such preset or file, something wrong in the file, or a change that is not allowed.
    """
    from coaxshell.model.loading import as_system

    wanted = overrides(changes)
    if scenario in STANDARD_INPUT:
        system = _of_input(where)
    else:
        try:
            system = as_system(scenario, where)
        except InputError as error:  # another file may have been given beside it
            option = where.startswith("-") and error.where != where
            raise InputError(f"{where}, {error.where}", error.problem, error.remedy) if option else error from None
    return system.with_overrides(wanted) if wanted else system


def load_reference(scenario: str, changes: Sequence[str] = (), where: str = "--compare") -> System:
    """Return the system to compare with. Changes to absorbers and control are for a system that has them; all others for both.

    Raises
    ------
    InputError
        No such preset or file, something wrong in the file, or a change that is not allowed.
    """
    from coaxshell.model.paths import parts

    plain = load_system(scenario, where=where)
    missing = [[name] for name, there in zip(_FITTINGS, (plain.absorbers != (), plain.control is not None), strict=True) if not there]
    return load_system(scenario, [change for change in changes if parts(change.partition("=")[0])[:1] not in missing], where)


def _of_input(where: str) -> System:
    """Return the system whose TOML text comes from standard input; files that it names are relative to the current folder."""
    import sys

    from coaxshell.limits import TOML_BYTES
    from coaxshell.model import System, toml

    content = sys.stdin.buffer.read(TOML_BYTES.value + 1)
    TOML_BYTES.check(len(content), "standard input")
    try:
        return System.model_validate(toml.loads(toml.text_of(content, "standard input"), Path(), "standard input"))
    except InputError as error:
        raise InputError(f"{where}, {error.where}", error.problem, error.remedy) if where.startswith("-") else error from None


@dataclass(frozen=True)
class Request:
    """The options of a command that solves, as typed: changes of the system, and the resolution; alike for all of them.

    The defaults are the texts of :class:`coaxshell.solver.settings.Settings`', which takes too long to import for a page of help.
    """

    changes: options.SetOption = None
    duration: options.DurationOption = options.DURATION
    time_step: options.TimeStepOption = options.TIME_STEP
    modes: options.ModesOption = options.MODES
    tolerance: options.ToleranceOption = "1e-3"
    engine: options.EngineOption = "spectral"
    refinement: options.RefinementOption = "1"
    dimensions: options.DimensionsOption = options.DIMENSIONS
    stations: options.StationsOption = "0"
    axial_modes: options.AxialModesOption = None
    axial_period: options.AxialPeriodOption = None

    def solve(self, system: System, *, quiet: bool, execution: Execution | None = None) -> Response:
        """Solve the system at this resolution, showing progress; InputError names the option that is wrong."""
        from coaxshell.response import simulate
        from coaxshell.solver.cost import run_cost

        self.check(system)
        settings = self.settings(system)
        with options.named_as_options(), WorkRequest.named(), progress(quiet) as report:
            if settings.modes != "auto":
                tell_time(run_cost(system, settings), "the run", quiet)
            response = simulate(system, settings=settings, progress=report, execution=execution)
            _ = response.warnings  # which are told later; estimating errors may take as long as the run and shows how far it is
            return response

    def check(self, system: System) -> None:
        """Refuse what a run in three dimensions does not know, before any other run is begun; InputError."""
        settings = self.settings(system)
        if settings.dimensions == 3:
            from coaxshell.solver.axial.solve import require_known
            from coaxshell.solver.scaling import dimensionless

            with options.named_as_options():
                require_known(dimensionless(system, dimensions=3), settings)

    def settings(self, system: System) -> Settings:
        """Return the settings of a run of a system; InputError names the option that is wrong."""
        return settings_of(system, {name: text for name in RESOLUTION if (text := getattr(self, name)) is not None})

    def require_energy(self, system: System) -> None:
        """Refuse what has no energy balance in three dimensions, before the run."""
        if self.settings(system).dimensions == 3:
            from coaxshell.response.energy.whole_length import require_balanced
            from coaxshell.solver.scaling import dimensionless

            require_balanced(dimensionless(system, dimensions=3))

    def require_two_dimensions(self, system: System) -> None:
        """Refuse runs in three dimensions for a command that shows two."""
        if self.settings(system).dimensions == 3:
            raise InputError("--dimensions", "3 is not for this command, which shows two", "use coaxshell run, or --dimensions 2")


@dataclass(frozen=True)
class WorkRequest:
    """The options that say where a run in three dimensions is worked on, and where its finished parts are kept; as typed."""

    workers: options.RunWorkersOption = None
    dask: options.DaskOption = None
    store: options.RunStoreOption = None
    resume: options.ResumeOption = False

    def execution(self, settings: Settings) -> Execution | None:
        """Return what they ask of a run; None if nothing.

        Raises
        ------
        InputError
            An option has no effect on the run, or beside another one; no number of processes.
        """
        given = {"workers": self.workers, "dask": self.dask, "store": self.store, "resume": self.resume or None}
        asked = [name for name, value in given.items() if value is not None]
        if not asked:
            return None
        if settings.dimensions == 2:
            raise InputError(f"--{asked[0]}", "is for a run in three dimensions", "leave it out, or use --dimensions 3")
        if self.resume and self.store is None:
            raise InputError("--resume", "does not say where the run is kept", "give its --store")
        with self.named():
            return execution_of(self.workers, self.dask, self.store, resume=self.resume)

    @staticmethod
    def named() -> AbstractContextManager[None]:
        """Let errors about where a run is worked on name the options."""
        return named_as_options(workers="workers", address="dask", dask="dask", store="store")


def execution_of(workers: str | None, dask: str | None, store: Path | None, *, resume: bool) -> Execution:
    """Return the execution that the texts of some options describe; InputError if there is no such number of processes."""
    from coaxshell.solver.settings import whole
    from coaxshell.studies import Execution
    from coaxshell.studies.executors import MAX_WORKERS

    number = None if workers is None else whole("workers", workers, MAX_WORKERS)
    return Execution(workers=number, store=store, resume=resume, dask=dask)


def settings_of(system: System, given: Mapping[str, str]) -> Settings:
    """Return the settings that the texts of some options describe; InputError names the option that is wrong."""
    from coaxshell.solver.settings import Settings

    with options.named_as_options():
        return Settings.of(system, given)


RESOLUTION = tuple(field.name for field in fields(Request))[1:]
"""The names of the resolution's parameters."""


def with_options(**holders: Callable[..., Any]) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Let the parameters of a command that are named be filled from options of their own, the fields of a dataclass, which stand there."""

    def of_command(command: Callable[..., None]) -> Callable[..., None]:
        shown: list[Parameter] = []
        for parameter in signature(command, eval_str=True).parameters.values():
            holder = holders.get(parameter.name)
            shown += [parameter] if holder is None else signature(holder, eval_str=True).parameters.values()

        @wraps(command)
        def filled(**given: Any) -> None:
            held = {name: holder(**{each: given.pop(each) for each in signature(holder).parameters}) for name, holder in holders.items()}
            command(**given, **held)

        told: Any = filled
        told.__signature__ = signature(command).replace(parameters=[each.replace(kind=Parameter.KEYWORD_ONLY) for each in shown])
        return filled

    return of_command


with_resolution = with_options(request=Request)
"""Of a command whose parameter ``request`` is filled from the options of a :class:`Request`."""


_FOR_SOLVING = {"changes": "--set", **{name: "--" + name.replace("_", "-") for name in RESOLUTION}}


def is_saved(source: str) -> bool:
    """Return whether a source names a saved run."""
    return Path(source).suffix.lower() == ".nc"


def answers(
    context: typer.Context,
    sources: Sequence[str],
    request: Request,
    *,
    quiet: bool,
    arguments: tuple[str, str] = ("SOURCE", "--compare"),
    dimensions: int = 2,
) -> list[Response]:
    """Return the response of each source: a saved run (.nc), a preset or a scenario (.toml).

    *arguments* are those that name the first and the second source; *dimensions* are those that the command shows. Of a saved run
    in three dimensions --stations chooses what is shown.

    Raises
    ------
    InputError
        There is no such source, it has more dimensions, or every one is a saved run and an option for solving is given.
    """
    saved = {source: _opened(context, source, dimensions) for source in sources if is_saved(source)}
    if len(saved) == len(set(sources)):
        _refuse_solving_options(context, chooses_stations=any(response.stations is not None for response in saved.values()))
    systems: dict[int, System] = {}
    for number, source in enumerate(sources):
        if source not in saved:
            load = load_reference if number else load_system
            systems[number] = load(source, request.changes or (), arguments[number > 0])
            if dimensions == 2:
                request.require_two_dimensions(systems[number])
            request.check(systems[number])
    return [saved[source] if source in saved else request.solve(systems[i], quiet=quiet) for i, source in enumerate(sources)]


def _opened(context: typer.Context, source: str, dimensions: int) -> Response:
    """Return a saved run, of three dimensions at the stations that are asked for."""
    from coaxshell.response import load_response

    response = load_response(source)
    if response.stations is None:
        return response
    if dimensions == 2:
        raise InputError(source, "is a run in three dimensions, this command shows two", "use coaxshell info, plot or export --to csv")
    if not _typed(context, "stations"):
        return response
    from coaxshell.response.spatial import SpatialResponse

    assert isinstance(response, SpatialResponse)
    with options.named_as_options(station="stations"):
        return response.at(context.params["stations"])


def _typed(context: typer.Context, parameter: str) -> bool:
    """Return whether an option was given on the command line."""
    source = context.get_parameter_source(parameter)
    return source is not None and source.name == "COMMANDLINE"


def _refuse_solving_options(context: typer.Context, *, chooses_stations: bool) -> None:
    for parameter, option in _FOR_SOLVING.items():
        if _typed(context, parameter) and not (chooses_stations and parameter == "stations"):
            raise InputError(option, "has no effect on a saved run", "leave it out, or name a preset or a .toml file to solve")


def tell_all_warnings(responses: Sequence[Response]) -> None:
    """Tell the warnings of all responses, each once."""
    tell_warnings(dict.fromkeys(text for response in responses for text in response.warnings))


@dataclass(frozen=True)
class FitRequest:
    """The options of a command that works on a study file without code of the user's, as typed."""

    resume: options.ResumeOption = False
    workers: options.WorkersOption = None
    dask: options.DaskOption = None
    as_json: options.JsonOption = False
    force: options.ForceOption = False
    quiet: options.QuietOption = False

    @property
    def outputs(self) -> Outputs:
        """What is to be written; what an interrupted study left is its own to replace."""
        return Outputs(self.force or self.resume)

    @contextmanager
    def execution(self, store: Path) -> Iterator[Execution]:
        """Yield how the study is worked on: on a Dask cluster if there is the address of one, else by a pool of processes of our own.

        Raises
        ------
        InputError
            No number of processes, or one beside a cluster; no cluster at the address.
        """
        with ExitStack() as stack:
            with named_as_options(workers="workers", address="dask", dask="dask"):
                asked = execution_of(self.workers, self.dask, store, resume=self.resume)
                ready = stack.enter_context(asked.started())
            yield replace(ready, progress=stack.enter_context(progress(self.quiet, left=True)))

    def tell(self, document: Callable[[], Mapping[str, Any]], text: Callable[[], str], *written: Path | None) -> None:
        """Print what was found, for programs or for people, and where it was written."""
        if self.as_json:
            print_document(document())
        else:
            echo(text())
        echo("wrote " + ", ".join(str(path) for path in written if path is not None), aside=self.as_json)


@dataclass(frozen=True)
class StudyRequest(FitRequest):
    """The options of a command that works on a study file, as typed."""

    allow_code: options.AllowCodeOption = False


def tell_study_time(systems: Sequence[System | InputError], resolution: Settings, count: int, execution: Execution, *, quiet: bool) -> None:
    """Say how long a study of so many runs will take, from some of its systems."""
    from coaxshell.studies.cost import case_cost

    if resolution.modes != "auto":
        cost = case_cost(systems, resolution).times(count, execution.capacity)
        tell_time(cost, f"{count:,} runs", quiet)


def tell_code(functions: list[str]) -> None:
    """Say which functions of the user's are about to be run."""
    sys.stderr.write(f"runs code: {', '.join(functions)}\n")
