"""Many cases of one system: sweeps, with what they share done once, on one machine or a cluster."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from coaxshell.numerics.renamed import renamed
from coaxshell.studies.control_design import ControlDesign, StateSpaceModel, design_control, to_state_space
from coaxshell.studies.execution import Execution
from coaxshell.studies.executors import dask_executor
from coaxshell.studies.fitting.fitted import FIT_PARTS, Fit
from coaxshell.studies.fitting.fitting import fit, fit_plan
from coaxshell.studies.fitting.measurement import Measurement
from coaxshell.studies.fitting.study import FitStudy
from coaxshell.studies.gradients.gradient import gradient
from coaxshell.studies.optimisation.optimising import optimise, optimise_problem
from coaxshell.studies.optimisation.optimum import OPTIMUM_PARTS, Optimum
from coaxshell.studies.optimisation.study import OptimisationStudy
from coaxshell.studies.optimisation.targets import Objective
from coaxshell.studies.optimisation.variables import Choice, Integer, Range
from coaxshell.studies.structures import solve_each
from coaxshell.studies.study_file import SweepStudy, read_study
from coaxshell.studies.sweeping import sweep, sweep_design
from coaxshell.studies.uncertainty.laws import LogNormal, Normal, Uniform
from coaxshell.studies.uncertainty.sensitivity import robustness, sensitivity, uncertainty_of
from coaxshell.studies.uncertainty.study import SensitivityStudy

__all__ = [
    "FIT_PARTS",
    "OPTIMUM_PARTS",
    "Choice",
    "ControlDesign",
    "Execution",
    "Fit",
    "FitStudy",
    "Integer",
    "LogNormal",
    "Measurement",
    "Normal",
    "Objective",
    "OptimisationStudy",
    "Optimum",
    "Range",
    "SensitivityStudy",
    "StateSpaceModel",
    "SweepStudy",
    "Uniform",
    "dask_executor",
    "design_control",
    "fit",
    "fit_plan",
    "gradient",
    "optimise",
    "optimise_problem",
    "read_study",
    "robustness",
    "sensitivity",
    "solve_each",
    "sweep",
    "sweep_design",
    "to_state_space",
    "uncertainty_of",
]

if not TYPE_CHECKING:

    def __getattr__(name: str) -> Any:
        return renamed(__name__, name, How="coaxshell.studies.execution.Execution", Resolution="coaxshell.solver.settings.Settings")
