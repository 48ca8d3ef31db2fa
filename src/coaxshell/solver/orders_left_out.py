"""What the orders above M would add, and what they would change in the orders kept.

Sources excite the orders above M themselves. Absorbers add two things. Their forces f excite every order; and they feel a wall that is
softer by the compliance dG of the orders left out, and that moves by dw more than it should: with f = -Y w, w = w_linear + G f in the run,

    (1 + (G + dG) Y) dw_all = dw + dG f,      df = -Y dw_all,

and df moves the orders kept. Cubic springs count with their mean tangent.

Norms along the contour weigh early times, e^{-2 sigma t}. How long a mode goes on is taken from the run itself: each order's norm over all
times is known, and those above M go on as the highest kept do.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints, side_admittance
from coaxshell.solver.limited_orders import actuators_of, asked_above, moved_above, moved_below, softened
from coaxshell.solver.sampled_orders import NODES, SampledOrders, each_alone, mobility_at
from coaxshell.solver.structure_spectra import StructureSpectra

REST = 1e-7
"""A shell that moves less than this times the one that moves most has not been reached: what it shows is rounding."""
LEAST_TRUE = 0.3
COUPLED_POINTS = 64
"""Points up to which absorbers are solved together; more of them each alone with its two walls."""
_CACHED = 512 * 1024
"""Bytes of a few orders that stay in the processor's cache."""
_BLOCK_BYTES = 4 * 1024 * 1024
"""Of the matrices between all points, at a few nodes at a time."""


@dataclass(frozen=True)
class Interface:
    """What an interface did in a run.

    Attributes
    ----------
    links : AbsorberSet
    force : ndarray, shape (2N, T)
        Line forces at every instant of the grid.
    stretch : ndarray, shape (2, N, instants)
        D at the instants of the run; where absorbers are linear it is not needed, and may be empty.
    actuation : ndarray, shape (shells, parities, M + 1, T), or None
        Modal pressures that saturating actuators gave.
    marched : bool
        Whether steps were taken, or the interface solved exactly.
    saturating : StructureSpectra or None
        With its feedback, where actuators acted as forces on the structure without.
    asked : ndarray, shape (shells, parities, M + 1, instants), or None
        Modal pressures that the control law asked for, at the instants of the run, where actuators saturated.
    linear : AbsorberSet or None
        Springs and dampers that stand for laws in the estimates; None where cubic springs alone are nonlinear.
    seen : StructureSpectra or None
        What marched.
    """

    links: AbsorberSet
    force: FloatArray
    stretch: FloatArray
    actuation: FloatArray | None
    marched: bool
    saturating: StructureSpectra | None = None
    asked: FloatArray | None = None
    linear: AbsorberSet | None = None
    seen: StructureSpectra | None = None

    def linear_links(self) -> AbsorberSet:
        """Return linear absorbers that do about the same in this run."""
        return mean_tangent(self.links, self.stretch) if self.linear is None else self.linear


def surface_norms(normal: npt.NDArray[np.number], tangential: npt.NDArray[np.number]) -> FloatArray:
    """Return the mean squares over the surface of displacement W and strain m V - W, summed over the last axis: (shells, 2, M + 1).

    The arguments have the shape (shells, parities, M + 1, instants or nodes).
    """
    m = np.arange(normal.shape[2])
    squares = np.empty((normal.shape[0], 2, m.size))
    width = max(1, _CACHED // (16 * normal[:, :, 0].size))
    for start in range(0, m.size, width):
        some = slice(start, start + width)
        displacement = np.ascontiguousarray(normal[:, :, some])
        strain = m[some, None] * tangential[:, :, some] - displacement
        for quantity, motion in enumerate((displacement, strain)):
            x = motion.view(np.float64)
            squares[:, quantity, some] = (x[..., None, :] @ x[..., :, None]).sum(axis=(1, 3, 4))
    return squares * np.where(m == 0, 1.0, 0.5)


def relative(part: FloatArray, whole: FloatArray) -> FloatArray:
    """Return sqrt(part/whole) of mean squares, shape (shells, 2); a shell at rest beside the others counts with what rest means to them."""
    whole = np.maximum(whole, REST**2 * whole.max(axis=0))
    return np.asarray(np.sqrt(np.divide(part, whole, out=np.zeros_like(part), where=whole > 0)))


def of_the_truth(added: FloatArray, changed: FloatArray, whole: FloatArray) -> FloatArray:
    """Return the error relative to the true answer, shape (shells, 2), from the squares of its parts and of the run's own answer.

    What the orders above M add is orthogonal to the run, what they change in its orders may be all of it or against it: the true answer
    is at least sqrt(added + (whole^(1/2) - changed^(1/2))^2), of which we take at least 0.3 of the run's.
    """
    change, addition = relative(changed, whole), relative(added, whole)
    truth = np.hypot(np.maximum(1.0 - change, LEAST_TRUE), addition)
    return np.asarray(np.hypot(change, addition) / truth)


def persistence(grid: LaplaceGrid, whole: FloatArray, along: FloatArray) -> FloatArray:
    """Return norms over all times of the run per norm along the contour's sampled nodes; of something brief where nothing moves."""
    brief = NODES.step * grid.frequency_step / np.pi  # Parseval
    return np.asarray(np.divide(whole, along, out=np.full_like(whole, brief), where=along > 1e-280))


def mean_tangent(links: AbsorberSet, stretch: FloatArray) -> AbsorberSet:
    """Return the absorbers with their mean tangent stiffness k_l + 3 k_nl <D^4>/<D^2> for linear springs; D of shape (2, N, T)."""
    if links.is_linear:
        return links
    square = stretch * stretch
    return with_tangent(links, square.sum(axis=(0, 2)), (square * square).sum(axis=(0, 2)))


def with_tangent(links: AbsorberSet, squares: FloatArray, fourth: FloatArray) -> AbsorberSet:
    """Return the absorbers with the tangent stiffness of :func:`mean_tangent`, of means D^2 and D^4, each (N,)."""
    spread = np.divide(fourth, squares, out=np.zeros_like(squares), where=squares > 0)
    return replace(links, linear=links.linear + 3.0 * links.cubic * spread, cubic=np.zeros_like(links.cubic))


def forces_changed(structure: StructureSpectra, links: AbsorberSet, above: SampledOrders, force: ComplexArray) -> ComplexArray:
    """Return df, shape (2, N, nodes), at the sampled nodes; ``force`` are the run's own, ``links`` linear.

    The phases of dw, known by their mean squares alone, are drawn at random, the same in every run.
    """
    soft = above.mobility(links)
    moved = np.einsum("abnk,bnk->ank", soft, force)
    phase = np.exp(2j * np.pi * np.random.default_rng(0).random(moved.shape))
    moved = moved + phase * np.sqrt(above.motion(links))
    return forces_against(structure, links, moved, soft)


def forces_against(
    structure: StructureSpectra, links: AbsorberSet, moved: ComplexArray, soft: ComplexArray | None = None, which: slice = NODES
) -> ComplexArray:
    """Return what walls that would move by ``moved`` (2, N, nodes) more change in the forces, of the same shape, at some nodes.

    -Y (1 + (G + dG) Y)^-1 moved, ``soft`` the mobility dG of the orders left out, shape (2, 2, N, nodes).
    """
    nodes, count = structure.grid.nodes[which], links.count
    if 2 * count > COUPLED_POINTS:
        share = np.where(np.arange(structure.modes.count) == 0, 0.5, 1.0)
        mobility = mobility_at(structure.problem, links, structure.modes, structure.compliance[..., which], share)
        return each_alone(links, nodes, mobility if soft is None else soft + mobility, moved)
    found = np.empty((2, count, nodes.size), np.complex128)
    points = InterfacePoints(structure.problem, links, structure.modes)
    every, width = range(structure.grid.nodes.size)[which], max(1, _BLOCK_BYTES // (16 * (2 * count) ** 2))
    for start in range(0, nodes.size, width):
        part, here = slice(start, start + width), every[start : start + width]
        compliance = structure.compliance[..., here.start : here.stop : here.step]
        found[..., part] = against(points, links, compliance, nodes[part], moved[..., part], None if soft is None else soft[..., part])
    return found


def against(
    points: InterfacePoints,
    links: AbsorberSet,
    compliance: ComplexArray,
    nodes: ComplexArray,
    moved: ComplexArray,
    soft: ComplexArray | None,
) -> ComplexArray:
    """Return what :func:`forces_against` does at a few nodes, where the orders of the points have a compliance."""
    count = links.count
    receptance = np.ascontiguousarray(np.moveaxis(points.between(compliance), -1, 0))
    index = np.arange(count)
    for a in (0, 1):
        for b in (0, 1):
            if soft is not None:
                receptance[:, a * count + index, b * count + index] += soft[a, b].T
    law = side_admittance(links, nodes)
    own, other = np.stack([law.inner, law.outer], axis=1), law.other
    by_side = receptance.reshape(nodes.size, 2 * count, 2, count)
    followed = by_side * own[:, None] + by_side[:, :, ::-1] * other[:, None, None]  # of the walls, through the forces
    followed = followed.reshape(receptance.shape)
    followed[:, np.arange(2 * count), np.arange(2 * count)] += 1.0
    wall = np.linalg.solve(followed, moved.reshape(2 * count, -1).T[:, :, None]).reshape(nodes.size, 2, count)
    return np.asarray(-(wall * own + wall[:, ::-1] * other[:, None]).transpose(1, 2, 0))


def moved_by(structure: StructureSpectra, links: AbsorberSet, force: ComplexArray) -> FloatArray:
    """Return the norms (shells, 2, M + 1) of what line forces (2, N, nodes) at the sampled nodes move in the orders kept."""
    pressure = InterfacePoints(structure.problem, links, structure.modes).project(force.reshape(2 * links.count, -1))
    moved = structure.moved_by(pressure, NODES)
    return surface_norms(moved.normal, moved.tangential)


def left_out(
    structure: StructureSpectra,
    spectra: tuple[ComplexArray, ComplexArray],
    whole: FloatArray,
    interface: Interface | None = None,
) -> FloatArray:
    """Return what the orders left out would change in displacement and stress of each shell, shape (shells, 2), relative.

    Parameters
    ----------
    structure : StructureSpectra
        Without feedback where saturating actuators acted as forces.
    spectra : pair of ndarray
        W and V of the run.
    whole : ndarray, shape (shells, 2, M + 1)
        Norms of the run over all times.
    interface : Interface, optional
    """
    grid = structure.grid
    above = structure.orders_above if interface is None or interface.saturating is None else interface.saturating.orders_above
    along = surface_norms(*(x[..., NODES] for x in spectra))
    lasting = persistence(grid, whole, along)
    high = slice(-max(1, whole.shape[-1] // 3), None)
    beyond = persistence(grid, whole[..., high].sum(axis=-1), along[..., high].sum(axis=-1))
    changed = np.zeros_like(along)
    links = force = None
    if interface is not None and interface.links.count:
        links = interface.linear_links()
        force = grid.transform_linear(interface.force)[:, NODES].reshape(2, links.count, -1)

    def moving(above: SampledOrders) -> tuple[FloatArray, ComplexArray | None]:
        """Return |W|^2 of the orders above M, and by how much the absorbers' forces change."""
        if links is None or force is None:
            return above.excited, None
        change = forces_changed(structure, links, above, force)
        return above.excited + above.forced(links, force + change), change

    squares, change = moving(above)
    if interface is not None and interface.asked is not None:
        problem, lasts = (interface.saturating or structure).problem, beyond[:, 0] / grid.time[-1]
        actuators = actuators_of(problem, interface.asked, above, asked_above(problem, above, squares), lasts)
        if actuators:
            above = SampledOrders.of(softened(problem, actuators), grid, above.orders, structure.shared)
            squares, change = moving(above)
            further = asked_above(problem, above, squares)
            actuators = actuators_of(problem, interface.asked, above, further, lasts) or actuators
            squares = squares + moved_above(above, grid, actuators)
            changed = moved_below(structure, further, actuators)
    if links is not None and change is not None:
        changed = changed + moved_by(structure, links, change)
    return of_the_truth(above.norms(squares) @ above.weight * beyond, (changed * lasting).sum(axis=-1), whole.sum(axis=-1))
