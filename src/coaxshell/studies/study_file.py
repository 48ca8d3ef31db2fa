"""Study files, read and written: a base scenario, what to vary, what to read, at which resolution, as TOML. Sweeps here; others extend."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from copy import deepcopy
from pathlib import Path
from typing import Annotated, Any, ClassVar, TypeVar

import tomli_w
from pydantic import BeforeValidator, Field

from coaxshell.errors import InputError
from coaxshell.model import presets, toml
from coaxshell.model.base import Described, shown
from coaxshell.model.naming import suggestion
from coaxshell.model.paths import joined, within
from coaxshell.model.system import System
from coaxshell.model.toml_text import parsed
from coaxshell.solver.settings import Settings
from coaxshell.studies.design import Design, design_of
from coaxshell.studies.metrics import Metric, metrics_of
from coaxshell.studies.user_functions import UserCode
from coaxshell.studies.varied_fields import varied

MetricTexts = list[str] | dict[str, str]
SweepParts = tuple[System, Design, tuple[Metric, ...], Settings]
Tell = Callable[[list[str]], None]
P = TypeVar("P")


def _scenario(given: Any) -> Any:
    if not isinstance(given, str | dict):
        raise InputError("", f"{shown(given)} is not a scenario", "give a preset, a .toml file, or the description as a table")
    return given


class Study(Described):
    """Describe what every study has: a base system and a resolution. Kinds of studies are subclasses."""

    scenario: Annotated[str | dict[str, Any], BeforeValidator(_scenario)]
    """A preset, a .toml file beside the study, or the description itself as a table."""
    changes: dict[str, Any] = Field(default_factory=dict, alias="set")
    """Changes of the scenario by dotted path."""
    resolution: dict[str, Any] = Field(default_factory=dict)
    """Resolution of every run: entries as the options of ``coaxshell run``."""

    def system(self, folder: Path) -> System:
        """Return the base system; InputError if there is none, or a change is not allowed. Files are relative to *folder*."""
        if isinstance(self.scenario, dict):
            try:
                base = System.model_validate(toml.resolved(deepcopy(self.scenario), folder))
            except InputError as error:
                raise within("scenario", error) from None
        elif self.scenario in presets.names():
            base = presets.load(self.scenario)
        elif Path(self.scenario).suffix.lower() in (".toml", ".txt"):
            try:
                base = System.from_toml(folder / self.scenario)
            except InputError as error:
                raise within("scenario", error) from None
        else:
            remedy = suggestion(self.scenario, presets.names())
            raise InputError("scenario", f"there is no preset {self.scenario!r}", f"{remedy}, or a .toml file")
        try:
            return varied(base, flat(self.changes))
        except InputError as error:
            raise within("set", error) from None

    def settings(self, system: System) -> Settings:
        """Return the resolution of runs of a base system; InputError if no run accepts it."""
        return Settings.of(system, self.resolution, where="resolution")

    def twice(
        self,
        make: Callable[[UserCode], P],
        folder: Path,
        metrics: Callable[[P], Iterable[Metric]],
        *,
        allow_code: bool = False,
        tell: Tell | None = None,
    ) -> P:
        """Return what is made of the study, looked through before any code of the user's is run.

        Parameters
        ----------
        make : callable
            Makes it; with code that may not be run yet, then, if any metric is a function of the user's, with code that may.
        folder : Path
            That of the study: its files are relative to it.
        metrics : callable
            From what was made to its metrics.
        allow_code : bool
            Whether Python files outside the folder may be run.
        tell : callable, optional
            Called with "file.py:function" of all functions before any is run.
        """
        made = make(UserCode(str(folder), allow_code, run=False))
        functions = [metric.function for metric in metrics(made) if metric.function is not None]
        if not functions:
            return made
        if tell is not None:
            tell(list(dict.fromkeys(f"{function.file}:{function.function}" for function in functions)))
        return make(UserCode(str(folder), allow_code))


class SweepStudy(Study):
    """Describe a sweep."""

    _called: ClassVar[str] = "a sweep"

    over: dict[str, Any]
    """What to vary: values by dotted path."""
    metrics: MetricTexts
    """What to read: names, or a table of names of your own."""
    points: str = "grid"
    """"grid", "zip", "latin-hypercube" or "sobol"."""
    samples: int | None = None
    """Number of sampled points."""
    seed: int = 0
    """Makes sampled points repeatable."""

    def parts(self, folder: Path, *, allow_code: bool = False, tell: Tell | None = None) -> SweepParts:
        """Return system, design, metrics and resolution, all checked; InputError names what is wrong. Arguments as of :meth:`twice`."""
        system = self.system(folder)
        resolution = self.settings(system)
        design = design_of(system, flat(self.over), self.points, self.samples, self.seed)

        def make(code: UserCode) -> SweepParts:
            return system, design, metrics_of(self.metrics, system, code), resolution

        return self.twice(make, folder, lambda parts: parts[2], allow_code=allow_code, tell=tell)


S = TypeVar("S", bound=Study)


def read_study(path: str | Path, kind: type[S]) -> S:
    """Return the study of a file.

    Raises
    ------
    InputError
        The file cannot be read, is not TOML, or has an entry that is missing, unknown or of the wrong kind.
    """
    return kind.model_validate(parsed(toml.read(Path(path)), str(path)))


SPANS = frozenset({"from", "to", "type"})


def flat(tables: Mapping[str, Any], entries: frozenset[str] = SPANS) -> dict[str, Any]:
    """Return {path: value} of nested tables: ``absorbers.count = 3`` and ``"absorbers.count" = 3`` are the same to a reader.

    A table with any of the given *entries* is a value.
    """
    found: dict[str, Any] = {}
    for key, value in tables.items():
        if isinstance(value, Mapping) and not entries & set(value):
            found |= {joined(key, inner): item for inner, item in flat(value, entries).items()}
        else:
            found[key] = value
    return found


def study_text(command: str, system: System, entries: Mapping[str, Any], tables: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the study file of a command; its reader gives back the same study.

    Parameters
    ----------
    command : str
        "sweep", "optimise" or "sensitivity".
    system : System
        Its scenario: the name of the preset that it equals, else the description itself at the end.
    entries : mapping
        Single entries such as "metrics" in their order, numbers exact; None leaves one out.
    tables : mapping of mappings
        Such as "variables" and "resolution", one line an entry.
    """
    preset = next((name for name in presets.names() if presets.load(name) == system), None)
    lines = [f"# for coaxshell {command} FILE.toml", *([] if preset is None else [f"scenario = {_inline(preset)}"])]
    lines += [f"{_key(name)} = {_inline(value)}" for name, value in entries.items() if value is not None]
    for title, table in tables.items():
        lines += ["", f"[{_key(title)}]", *(f"{_key(name)} = {_inline(value)}" for name, value in table.items())]
    text = "\n".join(lines) + "\n"
    return text if preset is not None else f"{text}\n{tomli_w.dumps({'scenario': toml.tables(system)})}"


def _inline(value: Any) -> str:
    """Return a value on one line."""
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(name)} = {_inline(item)}" for name, item in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_inline(item) for item in value) + "]"
    return tomli_w.dumps({"x": value}).removeprefix("x = ").rstrip("\n")


def _key(name: str) -> str:
    """Return a key, in quotation marks where it needs them."""
    return tomli_w.dumps({name: 0}).removesuffix(" = 0\n")
