"""Many cases of one system: sweeps, with what they share done once, on one machine or a cluster."""

from __future__ import annotations

from coaxshell.studies.cluster import dask_executor
from coaxshell.studies.optimisation.optimising import optimise, optimise_problem
from coaxshell.studies.optimisation.optimum import Optimum
from coaxshell.studies.optimisation.study import OptimisationStudy
from coaxshell.studies.optimisation.targets import Objective
from coaxshell.studies.optimisation.variables import Choice, Integer, Range
from coaxshell.studies.resolution import Resolution
from coaxshell.studies.structures import solve_each
from coaxshell.studies.study_file import SweepStudy, read_study
from coaxshell.studies.sweeping import sweep, sweep_design

__all__ = [
    "Choice",
    "Integer",
    "Objective",
    "OptimisationStudy",
    "Optimum",
    "Range",
    "Resolution",
    "SweepStudy",
    "dask_executor",
    "optimise",
    "optimise_problem",
    "read_study",
    "solve_each",
    "sweep",
    "sweep_design",
]
