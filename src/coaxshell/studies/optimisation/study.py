"""An optimisation as a study file."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal

from pydantic import Field

from coaxshell.studies.optimisation.optimising import Problem, problem_of
from coaxshell.studies.study_file import Study

_ENTRIES = frozenset({"from", "to", "values", "uniform", "normal", "lognormal"})


class OptimisationStudy(Study):
    """Describe an optimisation; entries as the arguments of :func:`coaxshell.optimise`."""

    variables: dict[str, Any]
    """What may change: ranges by dotted path."""
    objectives: list[Any]
    """What to make small: names, or tables with metric and maximise."""
    constraints: list[str] = Field(default_factory=list)
    """Such as "absorbers.mass <= 250 kg/m"."""
    uncertain: dict[str, Any] = Field(default_factory=dict)
    """Distributions by dotted path."""
    samples: int = 32
    """Points at which the uncertain properties are sampled."""
    method: str = "auto"
    """"auto", "cma-es", "differential-evolution" or "nsga2"."""
    evaluations: int = 1000
    """How many designs are tried."""
    population: int | None = None
    """Designs in a generation."""
    start: Literal["auto", "system"] = "auto"
    """Whether the scenario must be an allowed start."""
    seed: int = 0
    """Makes the search repeatable."""
    confirm: dict[str, Any] = Field(default_factory=dict)
    """Settings of a finer resolution at which baseline and best are run."""

    def problem(self, folder: Path) -> Problem:
        """Return it with all parts checked; InputError names what is wrong. Files are relative to *folder*."""
        return problem_of(
            self.system(folder),
            tables(self.variables),
            self.objectives,
            self.constraints,
            self.resolution.checked(),
            (tables(self.uncertain), self.samples),
            (self.method, self.evaluations, self.population, self.start, self.seed),
            self.confirm,
            str(folder),
        )


def tables(given: dict[str, Any]) -> dict[str, Any]:
    """Return {path: table} of nested tables, where choices and distributions are values too."""
    found: dict[str, Any] = {}
    for key, value in given.items():
        if isinstance(value, dict) and not _ENTRIES & set(value):
            found |= {f"{key}{inner if inner.startswith('[') else '.' + inner}": item for inner, item in tables(value).items()}
        else:
            found[key] = value
    return found
