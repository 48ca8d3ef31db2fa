"""The one call that searches for the best system."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, Unpack

from coaxshell.errors import InputError
from coaxshell.model.loading import SystemLike, as_system
from coaxshell.model.prefixes import engineering
from coaxshell.model.system import System
from coaxshell.numerics.keywords import showing
from coaxshell.numerics.progress import Progress
from coaxshell.numerics.scalars import plain
from coaxshell.solver.settings import Settings
from coaxshell.solver.solvable import require_solvable
from coaxshell.studies.execution import Execution, StudyKeywords, asked
from coaxshell.studies.gradients.gradient import require_gradient
from coaxshell.studies.metrics import ANYWHERE, require_readable
from coaxshell.studies.optimisation.by_gradient import Slopes, search_by_gradient
from coaxshell.studies.optimisation.confirmation import Confirmation, confirmed, finer
from coaxshell.studies.optimisation.feasibility import require_possible
from coaxshell.studies.optimisation.methods import Setting, chosen, search
from coaxshell.studies.optimisation.optimum import Optimum
from coaxshell.studies.optimisation.search import Candidate, EnoughError, Evaluations, Run, non_dominated
from coaxshell.studies.optimisation.targets import Targets, targets_of
from coaxshell.studies.optimisation.variables import Space, VariableLike, space_of
from coaxshell.studies.running import WorkerPool
from coaxshell.studies.uncertainty.distributions import Uncertain, uncertain_of
from coaxshell.studies.user_functions import UserCode


@dataclass(frozen=True)
class Problem:
    """An optimisation whose parts have been checked.

    Attributes
    ----------
    space, targets, resolution
        What may change, what is asked, at which resolution.
    uncertain : Uncertain
        The uncertain properties; none for a nominal study.
    method : str
        Not "auto" any more.
    setting : Setting
    evaluations : int
    finer : tuple of Settings
        Where baseline and best are confirmed.
    """

    space: Space
    targets: Targets
    resolution: Settings
    uncertain: Uncertain
    method: str
    setting: Setting
    evaluations: int
    finer: tuple[Settings, ...]

    def parts(self) -> dict[str, Any]:
        """Return what tells one study from another, as plain data by part; a larger budget goes on with the same study."""
        return {
            "scenario": self.space.base.canonical(),
            "variables": [repr(variable) for variable in self.space.variables],
            "objectives": [(goal.target.name, goal.target.metric.identity, goal.maximise) for goal in self.targets.goals],
            "constraints": [(limit.text, limit.target.metric.identity) for limit in self.targets.limits],
            "uncertain": self.uncertain.identity(),
            "resolution": self.resolution.arguments(),
            "method": [self.method, self.setting.seed, self.setting.population, self.setting.start.tolist()],
        }


@showing(StudyKeywords, Settings, Execution)
def optimise(
    system: SystemLike,
    *,
    variables: Mapping[str, VariableLike],
    objectives: Any,
    constraints: Sequence[str] | str = (),
    uncertain: Mapping[str, Any] | None = None,
    samples: int = 32,
    method: str = "auto",
    evaluations: int = 1000,
    population: int | None = None,
    start: Literal["auto", "system"] = "auto",
    seed: int = 0,
    confirm: Mapping[str, Any] | None = None,
    journal: str | Path | None = None,
    **keywords: Unpack[StudyKeywords],
) -> Optimum:
    """Return the best system within some ranges; the system given is the baseline.

    Parameters
    ----------
    system : System
    variables : mapping of path or name to :class:`Range`, :class:`Integer` or :class:`Choice`
        What may change, as ``{"absorbers.mass": Range(1, 20)}``. ``absorbers[*].mass`` stands for every absorber, one by one or in
        mirror images (``each="mirror"``). A list is a choice.
    objectives : metric, :class:`Objective`, or list of them
        What to make small, as ``"inner.peak_stress"``; ``Objective("absorbers.dissipated_energy", maximise=True)``; a function of a
        Response; ``"mean(METRIC)"``, ``"p95(METRIC)"`` or ``"worst(METRIC)"`` over the *uncertain* properties.
    constraints : list of str
        As ``"absorbers.mass <= 250 kg/m"``, ``"outer.peak_actuator_field <= 590 V/mm"``, ``"absorbers.spacing >= 0.1 m"``.
    uncertain : mapping of path to distribution, optional
        As for :func:`robustness`; every design is run at the same *samples* points of it.
    method : str
        "cma-es", "differential-evolution", "nsga2", "gradient" (for metrics of :func:`gradient` and ranges, many variables above all), or
        "auto": NSGA-II for several objectives, else CMA-ES.
    evaluations : int
        How many designs are tried.
    population : int, optional
        Designs in a generation, of "gradient" starts side by side; the method's own choice unless given.
    start : str
        "auto" begins at the system's own values where they are inside their ranges; "system" insists on it.
    seed : int
        Makes the search repeatable, whatever the number of workers.
    duration, time_step, modes, tolerance, refinement, engine, dimensions, stations, axial_modes, axial_period
        As those of :func:`coaxshell.simulate`.
    confirm : mapping, optional
        Settings of a finer resolution, as ``{"modes": 300}``: baseline and best are run there, and there at half the time step.
    journal : str or Path, optional
        Folder that keeps every evaluation, the *store* of an optimisation: a study killed at any moment goes on there and ends exactly
        as if it had not been.
    executor, workers, resume, dask, settings, execution
        As those of :func:`sweep`.
    progress : callable, optional
        Called with the fraction done and the best so far.

    Returns
    -------
    Optimum
        After Ctrl-C what was found until then, with ``complete`` false.

    Raises
    ------
    InputError
        Anything wrong with the study, before its first run.
    """
    system = as_system(system)
    resolution, execution = asked(system, keywords if journal is None else {**keywords, "store": journal})
    chance = (uncertain, samples)
    search_by = (method, evaluations, population, start, seed)
    problem = problem_of(system, variables, objectives, constraints, resolution, chance, search_by, confirm)
    return optimise_problem(problem, execution)


def problem_of(
    system: System,
    variables: Mapping[str, VariableLike],
    objectives: Any,
    constraints: Any,
    resolution: Settings,
    chance: tuple[Mapping[str, Any] | None, int],
    search_by: tuple[str, int, int | None, str, int],
    confirm: Mapping[str, Any] | None,
    code: UserCode = ANYWHERE,
) -> Problem:
    """Return the parts of an optimisation, all checked; InputError names what is wrong.

    Arguments as those of :func:`optimise`: *chance* is (uncertain, samples), *search_by* (method, evaluations, population, start, seed).
    *code* says where files of the user's lie, and whether they may be run.
    """
    (uncertain, samples), (method, evaluations, population, start, seed) = chance, search_by
    samples, evaluations, population, seed = map(plain, (samples, evaluations, population, seed))
    for name, number, least in (
        ("evaluations", evaluations, 1),
        ("population", population, 1 if method == "gradient" else 4),
        ("seed", seed, 0),
    ):
        if number is not None and (isinstance(number, bool) or not isinstance(number, int) or number < least):
            raise InputError(name, f"{number!r} is not allowed", f"give a whole number of {least} or more")
    if start not in ("auto", "system"):
        raise InputError("start", f"{start!r} is not allowed", 'must be "auto" or "system"')
    require_solvable(system, resolution)
    space = space_of(system, variables)
    targets = targets_of(objectives, constraints, space.base, code)
    require_readable(targets.metrics, resolution.dimensions)
    if targets.statistics and not uncertain:
        raise InputError(
            "uncertain", "is missing, and a statistic over it is asked for", "give the uncertain properties, or a plain metric"
        )
    properties = uncertain_of(space.base, uncertain or {}, samples, seed)
    setting = Setting(tuple(len(v.levels) for v in space.variables), space.start(), population, seed, len(targets.goals))
    require_possible(space, targets, insist=start == "system")
    method = chosen(method, setting)
    if method == "gradient":
        require_gradient(space.base, resolution)
        targets = Slopes.of(space, targets, {one.field.path for one in properties.coordinates}).targets
    return Problem(space, targets, resolution, properties, method, setting, evaluations, finer(system, resolution, confirm))


def optimise_problem(problem: Problem, execution: Execution) -> Optimum:
    """Search the best of a problem whose parts have been checked, its journal the store of *execution*; see :func:`optimise`."""
    metrics = problem.targets.metrics
    journal = execution.opened(problem.parts(), metrics, where="journal")
    with execution.started() as ready, WorkerPool(ready, metrics, journal) as pool:
        return searched(problem, pool, execution.progress)


def searched(problem: Problem, run: Run, progress: Progress | None = None) -> Optimum:
    """Search the best of a problem with whoever runs its systems; *progress* is told after every generation."""
    report = progress or (lambda fraction, stage: None)
    samples = problem.uncertain.scenarios

    def told(candidates: list[Candidate]) -> None:
        report(len(candidates) / problem.evaluations, f"optimising: {best_so_far(problem.targets, candidates)}")

    by_gradient = problem.method == "gradient"
    asked_for = (problem.space, problem.targets, samples, problem.resolution, run, problem.evaluations, told)
    evaluations = Evaluations(*asked_for, slopes=by_gradient)
    baseline, complete = evaluations.baseline(), True
    confirmations: tuple[Confirmation, ...] = ()
    try:
        if by_gradient:
            setting, slopes = problem.setting, Slopes(problem.targets, problem.space)
            search_by_gradient(evaluations.tables, slopes, setting.start, setting.population, setting.seed)
        else:
            search(problem.method, evaluations, problem.setting)
    except EnoughError:
        pass
    except KeyboardInterrupt:
        complete = False
    if not evaluations.candidates:
        raise KeyboardInterrupt
    answer = (problem.space, problem.targets, problem.resolution, problem.method, problem.setting.seed, tuple(evaluations.candidates))
    optimum = Optimum(*answer, baseline, (), complete)
    if complete and problem.finer and optimum.feasible:
        report(1.0, "confirming")
        confirmations = confirmed(problem.space.base, optimum.system, problem.finer, problem.targets, samples, run)
    return Optimum(*answer, baseline, confirmations, complete)


def best_so_far(targets: Targets, candidates: Sequence[Candidate]) -> str:
    """Return the best so far in words."""
    if len(targets.goals) > 1:
        return f"{len(non_dominated(candidates))} designs on the front"
    best = min(candidates, key=lambda one: one.rank)
    if not best.feasible:
        return "no design keeps the limits yet"
    goal = targets.goals[0].target
    value, unit = best.targets[goal.name], goal.metric.units
    plain = unit == "1" or unit.startswith("kg")  # nobody reads of millikilograms
    return f"best {goal.name} {f'{value:.4g} {unit}'.removesuffix(' 1') if plain else engineering(value, unit)}"
