"""An optimisation as a study file."""

from __future__ import annotations

from pathlib import Path
from typing import Any, ClassVar, Literal

from pydantic import Field

from coaxshell.model.system import System
from coaxshell.studies.optimisation.optimising import Problem, problem_of
from coaxshell.studies.study_file import Study, Tell, flat
from coaxshell.studies.uncertainty.laws import LAWS
from coaxshell.studies.user_functions import UserCode

_ENTRIES = frozenset({"from", "to", "values"})


class OptimisationStudy(Study):
    """Describe an optimisation; entries as the arguments of :func:`coaxshell.optimise`."""

    _called: ClassVar[str] = "an optimisation"

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
    """"auto", "cma-es", "differential-evolution", "nsga2" or "gradient"."""
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

    def problem(self, folder: Path, *, allow_code: bool = False, tell: Tell | None = None) -> Problem:
        """Return it with all parts checked; InputError names what is wrong. Arguments as of :meth:`Study.twice`."""
        base = self.system(folder)
        return self.twice(
            lambda code: self._problem(base, code), folder, lambda problem: problem.targets.metrics, allow_code=allow_code, tell=tell
        )

    def _problem(self, base: System, code: UserCode) -> Problem:
        return problem_of(
            base,
            flat(self.variables, _ENTRIES),
            self.objectives,
            self.constraints,
            self.settings(base),
            (flat(self.uncertain, LAWS), self.samples),
            (self.method, self.evaluations, self.population, self.start, self.seed),
            self.confirm,
            code,
        )
