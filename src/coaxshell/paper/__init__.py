"""The paper's figures, computed: recipes by number, from responses or from studies of many runs."""

from __future__ import annotations

from coaxshell.paper.figures import FIGURES, figure_recipe
from coaxshell.paper.known_runs import Runs
from coaxshell.paper.recipes import Drawn, FigureRecipe, StudyRecipe
from coaxshell.paper.runs import Resolution, solve_each

__all__ = ["FIGURES", "Drawn", "FigureRecipe", "Resolution", "Runs", "StudyRecipe", "figure_recipe", "solve_each"]
