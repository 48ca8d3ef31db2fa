"""Energy of walls of elastic solids, dimensionless (unit rho_e c_e^2 a^2 per length), from the amplitudes of their shapes.

With x = sum c_n (shape n), shapes normal to each other in mass and stiffness and u'Mu the integral over r dr of one mode, the energies of a
mode are (beta pi/2) sum dc_n/dt^2, kinetic, and (beta pi/2) sum omega_n^2 c_n^2, strain and piezoelectric together; that of potentials is
the sum over their rows L^-1 Q x (:class:`coaxshell.structure.elastic_basis.PotentialOfLayer`).
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.laplace_grid import WORKERS
from coaxshell.response.energy.motion import Motion
from coaxshell.structure.elastic_basis import OrdersBasis, PotentialOfLayer
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.shell_model import WallEnergy


def solid_energy(motion: Motion, shell: int) -> WallEnergy:
    """Return the energies of an elastic wall at the kept instants."""
    wall, solid = motion.problem.shells[shell], motion.solid
    assert isinstance(wall, ElasticWall)
    assert solid is not None
    pairs = [(part, place) for part in wall.basis(motion.modes) for place in range(part.orders.size)]

    def of_order(pair: tuple[OrdersBasis, int]) -> FloatArray:
        part, place = pair
        order = part.members.start + place
        weight = 0.5 * motion.circle[order]
        loads = solid.loads[:, shell, :, order] * np.array(wall.wetted)[:, None, None]
        return np.asarray(weight * sum(_of_parity(motion, part, place, loads[:, parity]) for parity in range(loads.shape[1])))

    with one_blas_thread(), ThreadPoolExecutor(WORKERS) as pool:
        total = np.sum(list(pool.map(of_order, pairs)), axis=0)
    return WallEnergy(*total)


def _of_parity(motion: Motion, part: OrdersBasis, place: int, loads: ComplexArray) -> FloatArray:
    """Return sums of squares of one parity of an order, shape (3, kept instants): kinetic, strain, piezoelectric."""
    grid, s = motion.grid, motion.grid.nodes
    pressed = -part.faces[place].T @ loads
    amplitude = pressed / (part.squares[place][:, None] + s * s)
    rate = grid.invert(amplitude * s)[:, motion.kept]
    amplitude_kept = grid.invert(amplitude)[:, motion.kept]
    whole = part.squares[place] @ amplitude_kept**2
    electric = np.zeros_like(whole)
    for layer in part.mesh.layers:
        if layer.layer.coupling is not None:
            rows = PotentialOfLayer(layer, part.orders[place : place + 1], part.wavenumber).rows[0]
            shown = np.einsum("icp,ncp->in", rows, part.shapes[place][..., layer.nodes])
            electric += np.sum((shown @ amplitude_kept) ** 2, axis=0)
    return np.stack([np.sum(rate**2, axis=0), whole - electric, electric])
