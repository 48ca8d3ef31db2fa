"""What it costs to let fluids wet mid-surfaces instead of the true faces of walls: estimates from the geometry alone.

A pressure outside acts per angle on r_out = R + h_out and is given R: static loads and stresses of order 0 are low by h_out/R, those of a
pressure inside high by h_in/R (against Lame's exact ring to a tenth of that). A gap from mid-surface to mid-surface is wider than from
face to face: waves in it come late, and its resonances lie low, by the same part.
"""

from __future__ import annotations

from coaxshell.model.places import region_name, shell_phrase
from coaxshell.solver.scaling import Problem
from coaxshell.structure.shell_model import ShellModel

LIMIT = 0.05
"""Error from which it is told: the paper's walls of 12 mm have 1 % in load and 2.5 % in their gap."""


def true_faces(wall: ShellModel) -> tuple[float, float]:
    """Return the radii of the inner and the outer face of a wall, in a."""
    inner, outer = wall.faces
    return wall.radius + inner, wall.radius + outer


def load_error(wall: ShellModel) -> float:
    """Return the relative error of a static load on a wall, the larger of both sides: distance from wetted surface to face over R."""
    return max(abs(wetted - face) for wetted, face in zip(wall.wetted, true_faces(wall), strict=True)) / wall.radius


def gap_error(problem: Problem, region: int) -> float:
    """Return by which part a gap is wider than from face to face; 0 where it is a vacuum."""
    if problem.fluids[region] is None:
        return 0.0
    within, beyond = problem.shells[region - 1 : region + 1]
    true = true_faces(beyond)[0] - true_faces(within)[1]
    return (beyond.wetted[0] - within.wetted[1]) / true - 1.0


def remarks(problem: Problem) -> list[str]:
    """Return a sentence for each wall and each gap whose error is above the limit."""
    count, remedy = len(problem.shells), f'more than {LIMIT:.0%}; use wetted = "faces"'
    found = []
    for number, wall in enumerate(problem.shells):
        error = load_error(wall)
        if error > LIMIT:
            where = f"{shell_phrase(number, count)}: fluids at its mid-surface instead of its faces"
            found.append(f"{where} leave static loads and stresses about {error:.1%} off, {remedy}")
    for region in range(1, count):
        error = gap_error(problem, region)
        if error > LIMIT:
            where = f"{region_name(region, count)}: from mid-surface to mid-surface it is {error:.1%} wider than between the walls' faces"
            found.append(f"{where}, and its waves late by as much, {remedy}")
    return found
