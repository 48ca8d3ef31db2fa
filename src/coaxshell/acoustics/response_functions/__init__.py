"""Response functions in time: pressure of a fluid region per unit impulse of its wall's acceleration."""

from __future__ import annotations

from coaxshell.acoustics.response_functions.fronts import arrivals
from coaxshell.acoustics.response_functions.functions import exterior, gap, interior
from coaxshell.acoustics.response_functions.walls import AnnulusWalls, WallFunctions, annulus_wall, disc_wall, exterior_wall, wall_functions
from coaxshell.numerics.arrays import FloatArray

__all__ = [
    "AnnulusWalls",
    "FloatArray",
    "WallFunctions",
    "annulus_wall",
    "arrivals",
    "disc_wall",
    "exterior",
    "exterior_wall",
    "gap",
    "interior",
    "wall_functions",
]
