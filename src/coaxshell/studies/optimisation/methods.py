"""The search methods, all of one form: given a function that evaluates a batch of points of the unit cube, go on for ever.

Each is seeded and asks for whole generations, so that its path depends on the values alone and not on who computes them. The caller
ends it by raising from the function.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from importlib.util import find_spec
from typing import Any, NamedTuple

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import stats
from coaxshell.studies.optimisation.targets import energy

Evaluate = Callable[[FloatArray], tuple[FloatArray, FloatArray]]
"""From points, shape (K, n), to objectives, shape (K, objectives), and violations, shape (K,)."""

METHODS = ("auto", "cma-es", "differential-evolution", "nsga2", "gradient")

SPREAD = 1e-5
"""Standard deviation in the unit cube at which a run of CMA-ES has arrived."""
FIRST_SPREAD = 0.25
"""The one with which it begins."""


class Setting(NamedTuple):
    """What a method needs to know.

    Attributes
    ----------
    levels : tuple of int
        How many values each coordinate has; 0 for an interval.
    start : ndarray, shape (n,)
        The base system's place.
    population : int or None
        Points in a generation; the method's own choice if None.
    seed : int
    objectives : int
    """

    levels: tuple[int, ...]
    start: FloatArray
    population: int | None
    seed: int
    objectives: int


def chosen(method: str, setting: Setting) -> str:
    """Return the method that "auto" stands for; InputError if the one asked for is unknown, not installed, or does not fit."""
    if method not in METHODS:
        raise InputError("method", f"{method!r} is unknown", f"allowed: {', '.join(METHODS)}")
    if method == "auto":
        method = "nsga2" if setting.objectives > 1 else "cma-es" if len(setting.levels) > 1 else "differential-evolution"
    if method == "nsga2" and find_spec("pymoo") is None:
        raise InputError("method", '"nsga2" needs the package pymoo', 'install it: pip install "coaxshell[optimise]"')
    if method != "nsga2" and setting.objectives > 1:
        raise InputError("method", f"{method!r} takes one objective, and {setting.objectives} are given", 'use method="nsga2"')
    return method


def search(method: str, evaluate: Evaluate, setting: Setting) -> None:
    """Search until *evaluate* raises; gradients need more than its numbers (:mod:`coaxshell.studies.optimisation.by_gradient`)."""
    {"cma-es": _cma_es, "differential-evolution": _differential_evolution, "nsga2": _nsga2}[method](evaluate, setting)


def generation_size(method: str, setting: Setting) -> int:
    """Return how many points a (first) generation has: as asked, or by the usual rule of each method."""
    n = len(setting.levels)
    if setting.population is not None:
        return setting.population
    if method == "cma-es":
        return max(8, 2 * math.ceil((4 + 3 * math.log(n)) / 2))
    return min(64, max(20, 5 * n)) if method == "differential-evolution" else 40


def _first(setting: Setting, size: int) -> FloatArray:
    """Return the base system and a Latin hypercube, shape (size, n)."""
    points = stats.qmc.LatinHypercube(len(setting.levels), rng=setting.seed).random(size)
    points[0] = setting.start
    return points


def _cma_es(evaluate: Evaluate, setting: Setting) -> None:
    """Search by covariance matrix adaptation (with margin where values can be counted), restarted with twice the population.

    N. Hansen, The CMA evolution strategy: a tutorial, arXiv:1604.00772; R. Hamano et al., CMA-ES with margin, GECCO 2022; A. Auger and
    N. Hansen, A restart CMA evolution strategy with increasing population size, CEC 2005. It sees only ranks, so that feasibility rules
    order designs without any penalty factor.
    """
    rng = np.random.default_rng(setting.seed)
    size, mean = generation_size("cma-es", setting), setting.start
    while True:
        _cma_run(evaluate, setting, mean, size, int(rng.integers(2**31)))
        size, mean = 2 * size, rng.random(len(setting.levels))


def _cma_run(evaluate: Evaluate, setting: Setting, mean: FloatArray, size: int, seed: int) -> None:
    from cmaes import CMA, CMAwM

    n, levels = len(setting.levels), np.array(setting.levels, dtype=np.float64)
    width = max(2, n)  # the library needs two coordinates; a second one beside a single one changes nothing
    steps = np.zeros(width)
    steps[:n] = np.where(levels > 0, 1.0 / np.maximum(levels, 1.0), 0.0)
    bounds = np.stack([0.5 * steps, 1.0 - 0.5 * steps], axis=1)
    begin = np.clip(np.append(mean, np.full(width - n, 0.5)), bounds[:, 0], bounds[:, 1])
    arguments: dict[str, Any] = {"bounds": bounds, "seed": seed, "population_size": size}
    countable = bool(steps.any())
    optimiser = CMAwM(begin, FIRST_SPREAD, steps=steps, **arguments) if countable else CMA(begin, FIRST_SPREAD, **arguments)
    patience, best, idle = 10 + math.ceil(30 * n / size), math.inf, 0
    generation = 0
    while idle < patience and not optimiser.should_stop():
        asked = [optimiser.ask() for _ in range(size)]
        if generation == 0:
            asked[0] = (begin, begin) if countable else begin  # the base system itself is tried too
        generation += 1
        points = np.clip(np.array([one[0] if countable else one for one in asked]), 0.0, 1.0)
        objectives, violation = evaluate(points[:, :n])
        order = energy(objectives[:, 0], violation)
        ranks = stats.rankdata(order, method="min")
        optimiser.tell([(one[1] if countable else one, float(rank)) for one, rank in zip(asked, ranks, strict=True)])
        idle, best = (0, float(order.min())) if order.min() < best else (idle + 1, best)
        if float(points[:, :n].std(axis=0).max()) < SPREAD:
            return


def _differential_evolution(evaluate: Evaluate, setting: Setting) -> None:
    """Search by differential evolution (R. Storn and K. Price, J. Global Optim. 11 (1997) 341-359), a generation at a time."""
    from scipy.optimize import differential_evolution

    size = max(5, generation_size("differential-evolution", setting))

    def function(points: Any) -> Any:
        objectives, violation = evaluate(points.T)
        return energy(objectives[:, 0], violation)

    bounds: Any = [(0.0, 1.0)] * len(setting.levels)
    options: dict[str, Any] = {"rng": setting.seed, "polish": False, "updating": "deferred", "vectorized": True, "tol": 0.0}
    while True:  # a population that has become one point ends the library's run: a fresh one goes on
        differential_evolution(function, bounds, init=_first(setting, size), maxiter=1_000_000, **options)
        options["rng"] += 1
        setting = setting._replace(seed=setting.seed + 1)


def _nsga2(evaluate: Evaluate, setting: Setting) -> None:
    """Search a front by NSGA-II (K. Deb et al., IEEE Trans. Evol. Comput. 6 (2002) 182-197), constraints by constrained domination."""
    from pymoo.algorithms.moo.nsga2 import NSGA2
    from pymoo.core.problem import Problem
    from pymoo.core.termination import NoTermination

    n, size = len(setting.levels), generation_size("nsga2", setting)
    algorithm = NSGA2(pop_size=size, sampling=_first(setting, size))
    problem = Problem(n_var=n, n_obj=setting.objectives, n_ieq_constr=1, xl=np.zeros(n), xu=np.ones(n))
    algorithm.setup(problem, termination=NoTermination(), seed=setting.seed)
    while True:
        asked = algorithm.ask()
        objectives, violation = evaluate(np.asarray(asked.get("X"), dtype=np.float64))
        asked.set("F", np.where(np.isfinite(objectives), objectives, 1e100), "G", violation[:, None])
        algorithm.evaluator.n_eval += len(asked)
        for one in asked:
            one.evaluated.update(("F", "G", "H"))
        algorithm.tell(infills=asked)
