"""The paper's figures, computed: recipes by number, from responses or from studies of many runs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from coaxshell.apps.paper.figures import FIGURES, figure_recipe
from coaxshell.apps.paper.known_runs import Runs
from coaxshell.apps.paper.recipes import Drawn, FigureRecipe, StudyRecipe
from coaxshell.numerics.renamed import renamed
from coaxshell.studies.structures import solve_each

__all__ = ["FIGURES", "Drawn", "FigureRecipe", "Runs", "StudyRecipe", "figure_recipe", "solve_each"]

if not TYPE_CHECKING:

    def __getattr__(name: str) -> Any:
        return renamed(__name__, name, Resolution="coaxshell.solver.settings.Settings")
