"""Energy of walls of elastic solids, dimensionless (unit rho_e c_e^2 a^2 per length), from the amplitudes of their shapes.

With x = sum c_n (shape n), shapes normal to each other in mass and stiffness and u'Mu the integral over r dr of one mode, the energies of a
mode are (beta pi/2) sum dc_n/dt^2, kinetic, and (beta pi/2) sum omega_n^2 c_n^2, strain and piezoelectric together; that of potentials is
the sum over their rows L^-1 Q x (:attr:`coaxshell.structure.elastic_basis.OrdersBasis.electric_rows`).
"""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.threads import map_on_threads
from coaxshell.response.energy.motion import Motion
from coaxshell.response.energy.solid_transducers import driven_at, open_fields, volts_of
from coaxshell.structure.elastic_basis import OrdersBasis
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.shell_model import WallEnergy
from coaxshell.structure.solid_transducers import along_wall, inertia_left_out


def solid_energy(motion: Motion, shell: int) -> WallEnergy:
    """Return the energies of an elastic wall at the kept instants."""
    wall, solid = motion.problem.shells[shell], motion.solid
    assert isinstance(wall, ElasticWall)
    assert solid is not None
    pairs = [(part, place) for part in wall.basis(motion.modes) for place in range(part.orders.size)]
    volts = volts_of(motion, shell)
    for part in wall.basis(motion.modes):
        assert part.electric_rows is not None  # made before all threads ask for them

    def of_order(pair: tuple[OrdersBasis, int]) -> FloatArray:
        part, place = pair
        order = part.members.start + place
        weight = 0.5 * motion.circle[order]
        loads = solid.loads[:, shell, :, order] * np.array(wall.wetted)[:, None, None]
        total = np.zeros((3, motion.grid.time[motion.kept].size))
        for parity in range(loads.shape[1]):
            forces = -part.faces[place].T @ loads[:, parity]
            if volts is not None:
                forces += inertia_left_out(part.squares[place], motion.grid.nodes, along_wall(motion.wavenumber)) * (
                    driven_at(wall, motion, order).T @ volts[:, parity, order]
                )
            total += _of_parity(motion, part, place, forces)
        return np.asarray(weight * total)

    with one_blas_thread():
        total = np.sum(list(map_on_threads(of_order, pairs)), axis=0)
    found = WallEnergy(*total)
    return found if volts is None else found._replace(piezoelectric=found.piezoelectric + open_fields(motion, shell, volts))


def _of_parity(motion: Motion, part: OrdersBasis, place: int, forces: ComplexArray) -> FloatArray:
    """Return sums of squares of one parity of an order, shape (3, kept instants): kinetic, strain, piezoelectric.

    ``forces`` act on the shapes, (shapes, nodes).
    """
    grid, s = motion.grid, motion.grid.nodes
    amplitude = forces / (part.squares[place][:, None] + s * s)
    rate = grid.invert(amplitude * s)[:, motion.kept]
    amplitude_kept = grid.invert(amplitude)[:, motion.kept]
    whole = part.squares[place] @ amplitude_kept**2
    electric = np.zeros_like(whole)
    for rows in part.electric_rows:
        electric += np.sum((rows[place] @ amplitude_kept) ** 2, axis=0)
    return np.stack([np.sum(rate**2, axis=0), whole - electric, electric])
