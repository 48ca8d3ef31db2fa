"""The hoop strain of a wall at a depth, as a gauge on a face reads it.

Of thin walls, with the normal displacement W inwards and zeta outwards from the middle,

    eps = (m V - W)/R + zeta (m V - m^2 W)/R^2,

of walls of elastic solids (u_r + m u_theta)/r, from the displacements at the radius r.
"""

from __future__ import annotations

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.shells import Shell
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response import arguments
from coaxshell.response.modal import combined, orders
from coaxshell.response.synthesis import angle_basis, at_angles
from coaxshell.response.wall_motion import WallMotion
from coaxshell.solver.solution import ModalSolution
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.shell_model import Gain


def hoop_strain(motion: WallMotion, shell: int, angle: FloatArray, depth: float | str | None = None) -> FloatArray:
    """Return the hoop strain at angles (degrees), shape (T, A), positive in tension.

    Parameters
    ----------
    motion : WallMotion
    shell : int
    angle : ndarray, shape (A,)
    depth : float, str or None
        Outward of the middle of the wall (m), or a face, "inner" or "outer"; the middle unless given.

    Raises
    ------
    InputError
        If the shell is rigid, or the depth is outside its wall; of an elastic wall in three dimensions.
    """
    solution = motion.solution
    wall, described = solution.problem.shells[shell], solution.problem.system.shells[shell]
    if not isinstance(described, Shell):
        raise InputError(f"shells[{shell}]", "a rigid shell has no strain", "choose an elastic one")
    half = 0.5 * described.thickness
    if not isinstance(wall, ElasticWall):
        z = 0.0 if depth is None else arguments.depth_of((-half, half), depth)
        return combined(solution, shell, hoop_strain_gain(solution, shell, z), angle)
    if solution.along is not None:
        problem = "the strain of an elastic wall is not read at stations"
        raise InputError(f"shells[{shell}].theory", problem, 'use dimensions=2, or theory = "thin"')
    length = solution.problem.scales.length
    middle = 0.5 * (wall.faces[0] + wall.faces[1]) * length
    z = middle if depth is None else arguments.depth_of((length * wall.faces[0], length * wall.faces[1]), depth)
    m = orders(solution)[:, None]
    modal = (m * motion.within(shell, "tangential", z) - motion.within(shell, "normal", z)) / (described.radius + z)
    return at_angles(modal, angle_basis(np.atleast_1d(angle), modal.shape[1], modal.shape[0]))


def hoop_strain_gain(solution: ModalSolution, shell: int, depth: float) -> Gain:
    """Return the gain of the hoop strain of a thin wall at a depth (m outward), per unit V and W of each order."""
    m, radius = orders(solution), solution.problem.system.shells[shell].radius
    per, bent = solution.problem.scales.length / radius, depth / radius
    return Gain(per * (1.0 + bent) * m, -per * (1.0 + bent * m**2))
