"""How points of walls move each other where feedback ties walls or orders: what absorbers beside it see.

A unit force at a point moves the walls without feedback; pattern q of wall a then reads A, the loops answer with voltages
(1 - H K C)^-1 H K A, and a volt of pattern q on wall b moves the points by B,

    A_aq = sum_m R_qm sigma_a C_aj P_jm,      B_bq = sum_m E_im C_ib f_b L_mq,

sigma what the sensors read per W, f the normal load per volt (:mod:`coaxshell.solver.voltage_response`), E and P the maps of the points
and R and L those of the patterns; faces of elastic walls are heard and moved otherwise (:mod:`coaxshell.solver.tied_ports`). Kernels in
time are those of the whole receptance, so that its positive real part stays: by product integration, or, where the step does not resolve
the membrane of some order, which all orders are tied to, or a wall has two faces, by the trapezoidal rule.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray, real_product
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.convolution import KernelTable
from coaxshell.numerics.modes import Modes
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.electrode_loops import ElectrodeLoops
from coaxshell.solver.electrode_patterns import Patterns
from coaxshell.solver.faced_forces import step_weights, surface_motion, trapezoidal_nodes
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints
from coaxshell.solver.interface.seen import StructureOfPoints
from coaxshell.solver.quadrature import unresolved_orders
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solid_spectra import band, make_shapes
from coaxshell.solver.spectral import map_node_blocks
from coaxshell.solver.structure_spectra import Moved, StructureSpectra
from coaxshell.solver.tied_ports import TiedPorts
from coaxshell.solver.voltage_response import controlled

_BLOCK = 64
"""Nodes at a time."""
_BYTES = 32 * 1024 * 1024
"""Of what patterns read and points move, of a wall."""


class StructureOfTies(StructureOfPoints):
    """A structure whose feedback ties walls or orders, as its absorbers see it: one kernel for each pair of their points.

    Parameters
    ----------
    structure : StructureSpectra
        With its feedback.
    absorbers : AbsorberSet
    alone : Moved
        Its motion without absorbers.
    patterns : Patterns
        Of the voltages.
    """

    def __init__(self, structure: StructureSpectra, absorbers: AbsorberSet, alone: Moved, patterns: Patterns) -> None:
        super().__init__(structure.open_loop, absorbers)
        self._fed, self._alone, self._patterns = structure, alone, patterns

    @cached_property
    def _motion(self) -> tuple[FloatArray, FloatArray]:
        return self._histories(self.of_orders.evaluate(surfaces_moved(self.problem, self._alone)))

    def _histories(self, moved: ComplexArray) -> tuple[FloatArray, FloatArray]:
        return self.grid.invert(moved), self.grid.invert(moved * self.grid.nodes)

    def stand(self, moved: ComplexArray) -> None:
        """Let the points move otherwise without absorbers, transforms (points, nodes)."""
        self._motion = self._histories(moved)

    @cached_property
    def kernels(self) -> KernelTable:
        """Step weights of the velocities of the points, (points, points, 1, T)."""
        grid, two_faced = self.grid, self.problem.two_faced
        if two_faced or unresolved_orders(self.problem, grid, self.modes).any():
            fine, s = trapezoidal_nodes(grid)
            if two_faced:
                passive = self.problem.resolving(band(fine))
                whole = faced_receptance(self._fed.problem, passive, self.modes, self.of_orders, self._patterns, s)
                return KernelTable(step_weights(whole, fine, s, grid)[:, :, None])
            return KernelTable(step_weights(self._receptance(s), fine, s, grid)[:, :, None])
        back = self._fed_back(grid.nodes, self.whole.compliance, self.whole.tangential_ratio)
        return KernelTable(super().kernels.kernels + grid.invert(back * (grid.nodes * grid.hat * grid.time_step))[:, :, None])

    def _receptance(self, nodes: ComplexArray) -> ComplexArray:
        """Return the receptance with feedback at any nodes, (points, points, nodes)."""
        count, orders = len(self.problem.shells), self.modes.count
        compliance, ratio = (
            np.empty((count, count, orders, nodes.size), np.complex128),
            np.empty((count, orders, nodes.size), np.complex128),
        )

        def work(block: slice) -> None:
            modal = ModalSystem(self.problem, np.asarray(nodes[block], dtype=np.complex128), self.modes)
            for j in range(count):
                for i, w in enumerate(modal.solve(j, 1.0)):
                    compliance[i, j, :, block] = w
            for i, operator in enumerate(modal.shells):
                ratio[i, :, block] = operator.tangential

        map_node_blocks([slice(a, a + _BLOCK) for a in range(0, nodes.size, _BLOCK)], work, None, "kernels")
        alone = np.moveaxis(self.of_orders.receptance(compliance), 0, -1)
        return np.asarray(alone + self._fed_back(nodes, compliance, ratio))

    def _fed_back(self, nodes: ComplexArray, compliance: ComplexArray, ratio: ComplexArray) -> ComplexArray:
        return fed_back(self._fed, self.of_orders, self._patterns, nodes, compliance, ratio)


def surfaces_moved(problem: Problem, moved: Moved) -> ComplexArray:
    """Return the displacements of the surfaces in a motion, (surfaces, parities, M + 1, nodes)."""
    return moved.normal if moved.solid is None else surface_motion(problem, moved.normal, moved.solid.faces)


def whole_receptance(structure: StructureSpectra, points: InterfacePoints, patterns: Patterns) -> ComplexArray:
    """Return the receptance of points with feedback at the nodes of a run, (points, points, nodes)."""
    bare, nodes = structure.open_loop, structure.grid.nodes
    if bare.problem.two_faced:
        return faced_receptance(structure.problem, bare.problem, bare.modes, points, patterns, nodes)
    found = fed_back(structure, points, patterns, nodes, bare.compliance, bare.tangential_ratio)
    width = max(8, _BYTES // (16 * points.count**2))
    for start in range(0, nodes.size, width):
        some = slice(start, start + width)
        found[..., some] += np.moveaxis(points.receptance(bare.compliance[..., some]), 0, -1)
    return found


def faced_receptance(
    problem: Problem, passive: Problem, modes: Modes, points: InterfacePoints, patterns: Patterns, nodes: ComplexArray
) -> ComplexArray:
    """Return the receptance of points with feedback, (points, points, nodes), where walls have two faces.

    Parameters
    ----------
    problem, passive : Problem
        With its feedback and without; the walls of *passive* resolve the waves of the nodes.
    modes : Modes
    points : InterfacePoints
    patterns : Patterns
    nodes : ndarray, shape (nodes,)
    """
    found, maps = np.empty((points.count, points.count, nodes.size), np.complex128), _maps(patterns, len(controlled(problem)), points)
    make_shapes(passive, modes, nodes)

    def work(block: slice) -> None:
        ports = TiedPorts.of_faces(problem, passive, modes, nodes[block])
        found[..., block] = np.moveaxis(points.receptance(ports.compliance), 0, -1)
        found[..., block] += _fed_through(problem, points, patterns, maps, nodes[block], ports)

    with one_blas_thread():
        map_node_blocks([slice(a, a + _BLOCK) for a in range(0, nodes.size, _BLOCK)], work, None, "kernels")
    return found


def fed_back(
    structure: StructureSpectra,
    points: InterfacePoints,
    patterns: Patterns,
    nodes: ComplexArray,
    compliance: ComplexArray,
    ratio: ComplexArray,
) -> ComplexArray:
    """Return what feedback adds to the receptance of points, B (1 - H K C)^-1 H K A, shape (points, points, nodes).

    Parameters
    ----------
    structure : StructureSpectra
        With its feedback.
    points : InterfacePoints
    patterns : Patterns
    nodes : ndarray
    compliance, ratio : ndarray
        C_ij, (shells, shells, M + 1, nodes), and V/W, (shells, M + 1, nodes), without feedback.
    """
    found = np.empty((points.count, points.count, nodes.size), np.complex128)
    maps = _maps(patterns, len(controlled(structure.problem)), points)
    width = max(8, _BYTES // (32 * points.count * patterns.numbers.count))
    for start in range(0, nodes.size, width):
        some = slice(start, start + width)
        ports = TiedPorts.of_thin(structure.problem, structure.modes, nodes[some], compliance[..., some], ratio[..., some])
        found[..., some] = _fed_through(structure.problem, points, patterns, maps, nodes[some], ports)
    return found


def _fed_through(
    problem: Problem, points: InterfacePoints, patterns: Patterns, maps: tuple[FloatArray, FloatArray], s: ComplexArray, ports: TiedPorts
) -> ComplexArray:
    """Return B (1 - H K C)^-1 H K A at some nodes, (points, points, nodes)."""
    found = np.empty((points.count, points.count, s.size), np.complex128)
    loops = ElectrodeLoops.of(problem, ports.response, patterns, s)
    read, moved = _read_and_moved(points, maps, ports)
    for force in range(points.count):
        found[:, force] = np.einsum("paqk,aqk->pk", moved, loops.voltages(read[:, :, force]), optimize=True)
    return found


def _read_and_moved(points: InterfacePoints, maps: tuple[FloatArray, FloatArray], ports: TiedPorts) -> tuple[ComplexArray, ComplexArray]:
    """Return A, (walls, patterns, points, nodes), and B, (points, walls, patterns, nodes)."""
    (orders, nodes), (reads, pushes) = ports.heard.shape[-2:], maps
    read = np.zeros((len(reads), reads.shape[1], points.count, nodes), np.complex128)
    moved = np.zeros((points.count, len(reads), reads.shape[1], nodes), np.complex128)
    for j in range(points.surfaces):
        here = points.on_surface(j)
        if not here.size:
            continue
        evaluate, project = (one.reshape(here.size, points.parities, orders) for one in points.maps_of(j))
        for a in range(len(reads)):
            shares = np.einsum("qhm,phm->qpm", reads[a], project).reshape(-1, orders)
            read[a][:, here] = real_product(shares, ports.heard[a, j]).reshape(-1, here.size, nodes)
            shares = np.einsum("phm,hmq->pqm", evaluate, pushes[a]).reshape(-1, orders)
            moved[here, a] = real_product(shares, ports.moved[j, a]).reshape(here.size, -1, nodes)
    return read, moved


def _maps(patterns: Patterns, walls: int, points: InterfacePoints) -> tuple[FloatArray, FloatArray]:
    """Return R, (walls, patterns, parities, orders), and L, (walls, parities, orders, patterns), of the parities of points."""
    size, count = points.parities * points.modes, patterns.numbers.count
    each = np.broadcast_to(
        np.eye(size, dtype=np.complex128).reshape(points.parities, points.modes, size), (walls, points.parities, points.modes, size)
    )
    reads = patterns.readings(each).real.reshape(walls, count, points.parities, points.modes)
    pushes = patterns.in_orders(np.broadcast_to(np.eye(count, dtype=np.complex128), (walls, count, count))).real
    return reads, np.ascontiguousarray(pushes[:, : points.parities])
