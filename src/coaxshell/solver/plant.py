"""What the controlled shells of a system answer to voltages without feedback: the plant of its control laws.

A volt on the actuators of shell j loads it by P_j on V and W (:meth:`coaxshell.structure.shell_model.ShellModel.drive`). With V eliminated
that is a normal load P_w + P_v V/W on W and V = (V/W) W + P_v/A_vv besides, so that with the compliance C of all shells in their fluids a
quantity g_v V + g_w W of shell i is, per volt,

    T_ij = (g_w + g_v V/W) C_ij (P_w + P_v V/W)_j + delta_ij g_v P_v/A_vv .

G is that of the sensors' readings. With laws u = H y, y = y_0 + G u: det(1 - G H) is D_m/D0_m of :mod:`coaxshell.solver.stability`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.modes import Modes
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.scaling import Problem
from coaxshell.structure.shell_model import Gain

_BLOCK = 256


@dataclass(frozen=True)
class Plant:
    """The system without feedback at some nodes, driven by voltages and by a pressure outside.

    Attributes
    ----------
    problem : Problem
        With its feedback, which only tells which shells are controlled.
    modes : Modes
    nodes : ndarray, shape (nodes,)
    shells : tuple of int
        Those under control.
    compliance : ndarray, shape (shells, shells, orders, nodes)
        W of each per normal load on each.
    ratio : ndarray, shape (shells, orders, nodes)
        V/W of each under normal loads.
    """

    problem: Problem
    modes: Modes
    nodes: ComplexArray
    shells: tuple[int, ...]
    compliance: ComplexArray
    ratio: ComplexArray

    @classmethod
    def of(cls, problem: Problem, modes: Modes, nodes: ComplexArray) -> Plant:
        """Return it for a problem of thin walls; InputError where a wall has two faces, or nothing is controlled."""
        shells = tuple(i for i, wall in enumerate(problem.shells) if wall.gains is not None)
        if not shells:
            raise InputError("control", "no shell is under control", "give the system a PDControl or a Feedback, of any gain")
        if problem.two_faced:
            remedy = 'use theory = "thin" to find the law, and stability_margins and simulate to judge it on exact walls'
            raise InputError("shells", "a wall of elastic solids has no plant of V and W", remedy)
        count, passive = len(problem.shells), problem.open_loop
        compliance = np.empty((count, count, modes.count, nodes.size), np.complex128)
        ratio = np.empty((count, modes.count, nodes.size), np.complex128)
        for start in range(0, nodes.size, _BLOCK):
            block = slice(start, start + _BLOCK)
            system = ModalSystem(passive, nodes[block], modes)
            for j in range(count):
                for i, moved in enumerate(system.solve(j, 1.0)):
                    compliance[i, j, :, block] = moved
            for i, operator in enumerate(system.shells):
                ratio[i, :, block] = operator.tangential
        return cls(problem, modes, nodes, shells, compliance, ratio)

    @property
    def nbytes(self) -> int:
        """Bytes of all arrays."""
        return self.compliance.nbytes + self.ratio.nbytes

    def up_to(self, order: int) -> Plant:
        """Return the plant of the orders up to one of them."""
        count = int(np.searchsorted(self.modes.orders, order, side="right"))
        modes = Modes(self.modes.orders[:count], self.modes.wavenumber, self.modes.sparse)
        return Plant(self.problem, modes, self.nodes, self.shells, self.compliance[:, :, :count], self.ratio[:, :count])

    def per_load(self, shell: int, gain: Gain, loaded: int) -> ComplexArray:
        """Return g_v V + g_w W of a shell per normal load on another, (orders, nodes)."""
        return np.asarray(gain.columns.recovered(self.ratio[shell]) * self.compliance[shell, loaded])

    def per_volt(self, shell: int, gain: Gain) -> ComplexArray:
        """Return g_v V + g_w W of a shell per volt on each shell under control, (controlled, orders, nodes)."""
        walls, found = self.problem.shells, []
        for j in self.shells:
            pushed = walls[j].drive(self.modes).columns.recovered(self.ratio[j])
            moved = self.per_load(shell, gain, j) * pushed
            if j == shell:
                moved = moved + gain.columns.v * walls[j].driven_along(self.modes, self.nodes)
            found.append(moved)
        return np.stack(found)

    @cached_property
    def transfer(self) -> ComplexArray:
        """G, volts that each controlled shell's sensors read per volt on the actuators of each, (controlled, controlled, orders, nodes)."""
        walls = self.problem.shells
        return np.stack([self.per_volt(i, walls[i].sensor_gain(self.modes)) for i in self.shells])


def solved_loop(transfer: ComplexArray, law: ComplexArray, reading: ComplexArray) -> ComplexArray:
    """Return the voltages u = H (1 - G H)^-1 y_0.

    Parameters
    ----------
    transfer : ndarray, shape (n, n, orders, nodes)
        G.
    law : ndarray, shape (n, n, orders, nodes)
        H, from readings to voltages.
    reading : ndarray, shape (n, parities, orders, nodes)
        y_0, what the sensors read while no voltage acts.

    Returns
    -------
    ndarray, shape (n, parities, orders, nodes)
    """
    looped = np.einsum("ijmk,jlmk->mkil", transfer, law)
    read = np.linalg.solve(np.eye(len(law)) - looped, np.moveaxis(reading, (0, 1), (2, 3)))
    return np.asarray(np.einsum("ijmk,mkjh->ihmk", law, read))


def loci(transfer: ComplexArray, law: ComplexArray) -> ComplexArray:
    """Return the eigenvalues of G H, (n, orders, nodes); 1 is where an order would grow."""
    looped = np.einsum("ijmk,jlmk->ilmk", transfer, law)
    if len(looped) == 1:
        return np.asarray(looped[0])
    if len(looped) == 2:
        half, determinant = 0.5 * (looped[0, 0] + looped[1, 1]), looped[0, 0] * looped[1, 1] - looped[0, 1] * looped[1, 0]
        root = np.sqrt(half * half - determinant)
        return np.stack([half + root, half - root])
    return np.asarray(np.moveaxis(np.linalg.eigvals(np.moveaxis(looped, (0, 1), (-2, -1))), -1, 0))


def diagonal(law: ComplexArray, count: int) -> ComplexArray:
    """Return the laws of shells that each feed themselves alone, (n, n, orders, nodes), from one law, (orders, nodes)."""
    return np.asarray(np.eye(count)[:, :, None, None] * law)
