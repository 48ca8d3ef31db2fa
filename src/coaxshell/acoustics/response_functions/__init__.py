"""Response functions in time: pressure of a fluid region per unit impulse of its wall's acceleration."""

from __future__ import annotations

from coaxshell.acoustics.response_functions.echoes import arrivals
from coaxshell.acoustics.response_functions.functions import (
    AnnulusWalls,
    WallFunctions,
    annulus_wall,
    disc_wall,
    exterior,
    exterior_wall,
    gap,
    interior,
    wall_functions,
)
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
