"""Soft layers of elastic walls without losses: short shear waves ring in them for as long as a run lasts, which no rubber lets them."""

from __future__ import annotations

import math

from coaxshell.model.layers import Shell
from coaxshell.model.places import shell_phrase
from coaxshell.model.prefixes import engineering
from coaxshell.solver.scaling import Problem
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.lossy_solid import SOFT_DEGREE, is_soft


def remarks(problem: Problem, frequency: float) -> list[str]:
    """Return a sentence for each such layer, with the length of its waves at a frequency (radians per transit), the top of a run's band."""
    found, scales = [], problem.scales
    for number, (wall, shell) in enumerate(zip(problem.shells, problem.system.shells, strict=True)):
        if not isinstance(wall, ElasticWall) or not isinstance(shell, Shell):
            continue
        for i, layer in enumerate(wall.layers):
            if layer.factor is None and is_soft(layer, frequency):
                wave = engineering(2.0 * math.pi * layer.shear_speed / frequency * scales.length, "m")
                speed = engineering(layer.shear_speed * scales.length / scales.time, "m/s")
                where = f"{shell_phrase(number, len(problem.shells))}: layer {i + 1}, {shell.layers[i].material.name}"
                found.append(
                    f"{where}, has no losses, so that shear waves ring in it to the end ({speed}, {wave} long at the top of the band: "
                    f"a polynomial through it would need a degree above {SOFT_DEGREE}); give it a loss_factor, or use a Viscoelastic"
                )
    return found
