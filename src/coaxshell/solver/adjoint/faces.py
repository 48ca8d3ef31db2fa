"""What loads on the faces of walls change in a number: transposed answers of structures some of whose walls have two faces.

Walls answer the loads q on their faces by w = H q and show y = T q; fluids press on them by F w, so that q = p + F w for given loads p.
If Re sum(X dy + Y dw) is what a number changes by, then with a what a unit of each load changes, b = F'a + Y and the answers as they are

    d(number) = Re sum(a dp + a dF w + b dH q + X dT q),        a = T'X + H'b,

and a is read from the answers to unit loads, one on each face: X and Y times what they move.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.solver.faced_forces import surfaces_of
from coaxshell.solver.scaling import Problem, Surface
from coaxshell.solver.solid_spectra import FacedSystem, WallAnswer, make_shapes
from coaxshell.solver.spectral import map_node_blocks
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.shell_model import ShellModel

Rows = dict[tuple[int, int], ComplexArray]
"""What a unit of what a wall shows changes, (parities, orders, nodes), by shell and row of its port: W, V, hoop stress, potentials."""


def places_of(problem: Problem) -> list[Surface]:
    """Return all faces of all walls, and the reference surfaces of those whose faces move alike, from the inside out."""
    found: list[Surface] = []
    for i, wall in enumerate(problem.shells):
        if wall.faces_move_alike:
            found.append(Surface(i, None, wall.radius))
        else:
            found += [Surface(i, side, wall.wetted[side]) for side in (0, 1)]
    return found


def shown_row(answer: WallAnswer, row: int) -> ComplexArray | float:
    """Return one row of what a wall shows: 0 W, 1 V, 2 the hoop stress at its design depth, from 3 on its potentials."""
    return (answer.normal, answer.tangential, answer.hoop, *answer.potentials)[row]


def per_load(answers: list[WallAnswer], rows: Rows, moved: ComplexArray | None, problem: Problem, block: slice) -> ComplexArray:
    """Return what a load changes whose answers are given, (parities, orders, nodes of the block); ``moved`` is Y of the surfaces."""
    total: ComplexArray = np.zeros((1, 1, 1), np.complex128)
    for (shell, row), per_row in rows.items():
        total = total + per_row[..., block] * shown_row(answers[shell], row)
    if moved is not None:
        total = total + np.einsum("ihmk,imk->hmk", moved[..., block], surfaces_of(problem, answers))
    return total


def per_surface_load(problem: Problem, blocks: list[slice], s: ComplexArray, modes: Modes, rows: Rows) -> ComplexArray:
    """Return what a unit of pressure on each surface changes, shape (surfaces, parities, orders, nodes)."""
    parities = max(x.shape[0] for x in rows.values())
    found = np.zeros((len(problem.surfaces), parities, modes.count, s.size), np.complex128)
    make_shapes(problem, modes, s)

    def work(block: slice) -> None:
        system = FacedSystem(problem, s[block], modes)
        for j, surface in enumerate(problem.surfaces):
            found[j, ..., block] = per_load(system.under_force(surface, 1.0), rows, None, problem, block)

    with one_blas_thread():
        map_node_blocks(blocks, work, None, "loads backwards")
    return found


class Moving(NamedTuple):
    """A motion of a structure and what a number changes by along it, at a block of nodes, all (.., parities, orders, nodes).

    Attributes
    ----------
    faces, loads : ndarray, shape (2, shells, ..)
        Displacements of the inner and the outer faces, and the loads on them.
    pressure : ndarray, shape (surfaces, ..), or None
        Given loads of the surfaces: those on reference surfaces are not among ``loads``.
    rows : dict
        X.
    moved : ndarray, shape (surfaces, ..), or None
        Y.
    """

    faces: ComplexArray
    loads: ComplexArray
    pressure: ComplexArray | None
    rows: Rows
    moved: ComplexArray | None


@dataclass(frozen=True)
class FaceBars:
    """What a number changes by per unit of what walls and fluids are to the faces at some nodes, (.., orders, nodes), by wall or fluid.

    Attributes
    ----------
    walls : list of ndarray
        Per unit of :func:`answers_of`, their first part.
    shown : list of ndarray
        Per unit of the second part of :func:`answers_of`.
    fluids : list of ndarray, shape (4, ..)
        Per unit of aa, ab, ba and bb of each fluid.
    load : ndarray, shape (parities, ..)
        Per unit of pressure on the surface that the exterior fluid wets.
    """

    walls: list[ComplexArray]
    shown: list[ComplexArray]
    fluids: list[ComplexArray]
    load: ComplexArray
    places: list[Surface] = field(default_factory=list)

    @classmethod
    def none(cls, problem: Problem, modes: Modes, nodes: int, parities: int) -> FaceBars:
        """Return zeros."""
        each = (modes.count, nodes)
        counts = [(3, 1) if wall.faces_move_alike else (4, 2) for wall in problem.shells]
        shown = [
            np.zeros((2 * (3 + wall.shown_potentials) if isinstance(wall, ElasticWall) else 1, *each), np.complex128)
            for wall in problem.shells
        ]
        walls = [np.zeros((count, *each), np.complex128) for count, _ in counts]
        fluids = [np.zeros((4, *each), np.complex128) for _ in problem.fluids]
        return cls(walls, shown, fluids, np.zeros((parities, *each), np.complex128), places_of(problem))

    def add(self, problem: Problem, system: FacedSystem, units: list[list[WallAnswer]], moving: Moving, block: slice) -> None:
        """Add a motion; ``units`` are the answers to a unit load at every place, and *moving* holds the block alone."""
        each = [per_load(answers, moving.rows, moving.moved, problem, slice(None)) for answers in units]
        inner, outer = _on_faces(problem, self.places, each)
        self.load[: outer[-1].shape[0], :, block] += outer[-1]
        back: list[list[ComplexArray]] = [[np.zeros((1, 1, 1), np.complex128)] * 2 for _ in problem.shells]  # F'a of every face
        for i, fluid in enumerate(system.cascade.fluids):
            bars = self.fluids[i][..., block]
            if i > 0:
                w = moving.faces[1, i - 1]
                back[i - 1][1] = fluid.aa * outer[i - 1]
                bars[0] += _both(outer[i - 1], w)
            if i < len(problem.shells):
                v = moving.faces[0, i]
                back[i][0] = -fluid.bb * inner[i]
                bars[3] -= _both(inner[i], v)
            if 0 < i < len(problem.shells):
                back[i - 1][1] = back[i - 1][1] - fluid.ba * inner[i]
                back[i][0] = back[i][0] + fluid.ab * outer[i - 1]
                bars[1] += _both(outer[i - 1], v)
                bars[2] -= _both(inner[i], w)
        for i, wall in enumerate(problem.shells):
            if wall.moves:
                self._of_wall(problem, system, i, back[i], moving, block)

    def _of_wall(self, problem: Problem, system: FacedSystem, i: int, back: list[ComplexArray], moving: Moving, block: slice) -> None:
        loads, alike, bars = moving.loads[:, i], problem.shells[i].faces_move_alike, self.walls[i][..., block]
        for n, surface in enumerate(problem.surfaces):
            if surface.shell == i and moving.moved is not None:
                side = surface.side or 0
                back[side] = back[side] + moving.moved[n]
        if not alike:
            for x in (0, 1):
                for y in (0, 1):
                    bars[2 * x + y] += _both(back[x], loads[y])
            shown = self.shown[i][..., block]
            for (shell, row), per_row in moving.rows.items():
                if shell == i:
                    for y in (0, 1):
                        shown[2 * row + y] += _both(per_row, loads[y])
            return
        whole = back[0] + back[1]
        motion = moving.faces[1, i]
        for (shell, row), per_row in moving.rows.items():
            if shell == i:
                whole = whole + (per_row if row == 0 else system.ratio(i) * per_row)
                if row == 1:
                    self.shown[i][0, :, block] += _both(per_row, motion)
        bars[0] += _both(whole, loads[0])
        bars[1] += _both(whole, loads[1])
        if moving.pressure is not None:
            number = next((n for n, surface in enumerate(problem.surfaces) if surface.shell == i), None)
            if number is not None:
                bars[2] += _both(whole, moving.pressure[number])


def _on_faces(problem: Problem, places: list[Surface], each: list[ComplexArray]) -> tuple[list[ComplexArray], list[ComplexArray]]:
    """Return a of the inner and of the outer face of every wall from that of all places: of one W in proportion to the radii."""
    sides: tuple[list[ComplexArray], list[ComplexArray]] = ([], [])
    for i, wall in enumerate(problem.shells):
        for side in (0, 1):
            number = next(n for n, place in enumerate(places) if place.shell == i and place.side in (None, side))
            sides[side].append(each[number] * (wall.wetted[side] / wall.radius if wall.faces_move_alike else 1.0))
    return sides


def _both(one: ComplexArray, other: ComplexArray) -> ComplexArray:
    """Return the sum over the parities that both have of their product."""
    shared = min(one.shape[0], other.shape[0])
    return np.asarray((one[:shared] * other[:shared]).sum(axis=0))


def answers_of(wall: ShellModel, modes: Modes, s: ComplexArray, *, shown: bool = True) -> tuple[ComplexArray, ComplexArray]:
    """Return what a wall is to its faces and what it shows, in the order of :class:`FaceBars`.

    Of two faces H_ii r_i, H_io r_o, H_oi r_i and H_oo r_o, and every row of its port per load on the inner and the outer face; of one W
    what loads on the inner and the outer face and on the reference surface move, and V/W.
    """
    inner, outer = wall.wetted
    if not wall.faces_move_alike:
        if shown and isinstance(wall, ElasticWall):
            h, rows = wall.two_port(modes, s)
            port = rows.reshape(-1, *rows.shape[2:])
        else:
            h, port = wall.receptance(modes, s), np.zeros((0, modes.count, s.size), np.complex128)
        return np.stack([h.inner * inner, h.across * outer, h.back * inner, h.outer * outer]), port
    answer = wall.receptance(modes, s).inner
    return np.stack([answer * inner, answer * outer, answer * wall.radius]), wall.operator(modes, s).tangential[None]
