"""Coupling of walls whose two faces move differently: from the inside out, face by face (theory manual, section "Coupled system").

Each wall answers inward loads q on its faces, at the radii r_i and r_o that the fluids wet, by its receptances H
(:class:`coaxshell.structure.shell_model.FaceReceptance`), and moves by d when no load is on them,

    w_i = H_ii r_i q_i + H_io r_o q_o + d_i,      w_o = H_oi r_i q_i + H_oo r_o q_o + d_o.

Seen from its inner face all that lies within is an impedance, p_i = zeta w_i + P, and seen from its outer face wall and inside together are
a receptance, w_o = y r_o q_o + e,

    y = H_oo - H_oi H_io r_i zeta/(1 + H_ii r_i zeta),      e = d_o - H_oi r_i [P + zeta (d_i - H_ii r_i P)/(1 + H_ii r_i zeta)].

A gap between this face (a) and the next wall's inner one (b), p = g (aa w_a + ab w_b), (ba w_a + bb w_b), g = rho s^2, makes of it the next

    zeta = g bb + g^2 ba ab y r_o/(1 - g aa y r_o),      P = g ba e/(1 - g aa y r_o).

H is nearly of rank one where a wall is thin; it is never inverted. Where both faces move by one W it is of rank one, h, and with d_i = d_o

    y = h/(1 + h r_i zeta),      e = (d - h r_i P)/(1 + h r_i zeta),

without the differences, which would leave nothing of a wall so light that h zeta is large. A thin wall, a rigid one and one of any other
theory stand side by side.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.acoustics.operators import annulus
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.solver.scaling import FluidRegion, Problem
from coaxshell.structure.shell_model import FaceReceptance

Entry = ComplexArray | float


class FaceMotion(NamedTuple):
    """Displacements of the faces of one wall and the loads on them, all positive inward, each (orders, nodes).

    Attributes
    ----------
    inner, outer : ndarray
        w_i and w_o.
    load_inner, load_outer : ndarray
        q_i and q_o: of the fluids, and what is given on a face.
    """

    inner: ComplexArray
    outer: ComplexArray
    load_inner: ComplexArray
    load_outer: ComplexArray


class FluidOperator(NamedTuple):
    """Pressures of one fluid per displacement of its faces, g aa and so on; 0 where there is none, or no such face."""

    aa: Entry = 0.0
    ab: Entry = 0.0
    ba: Entry = 0.0
    bb: Entry = 0.0


class GapAnswers(NamedTuple):
    """What inward pressures on the two faces of the one gap of two walls do, each (orders, nodes).

    Attributes
    ----------
    loads : tuple of tuple
        q_a and q_b, on the outer face of the inner wall and on the inner face of the outer one, by the face that is pressed on.
    receptances : tuple
        y_a and y_b, displacements of these faces per load on them with all behind.
    behind : tuple
        Loads on the inner face of the inner wall and on the outer face of the outer one, per q_a and per q_b.
    """

    loads: tuple[tuple[ComplexArray, ComplexArray], tuple[ComplexArray, ComplexArray]]
    receptances: tuple[ComplexArray, ComplexArray]
    behind: tuple[Entry, Entry]


def fluid_operators(problem: Problem, radial: RadialBasis, s: ComplexArray) -> list[FluidOperator]:
    """Return the operators of all fluids on their faces, from the inside out."""
    wetted = [wall.wetted for wall in problem.shells]
    return [fluid_operator(fluid, region, wetted, radial, s) for region, fluid in enumerate(problem.fluids)]


def fluid_operator(
    fluid: FluidRegion | None, region: int, wetted: Sequence[tuple[float, float]], radial: RadialBasis, s: ComplexArray
) -> FluidOperator:
    """Return the operator of one fluid on its faces; ``wetted`` are the radii of the inner and the outer faces of all walls."""
    count = len(wetted)
    if fluid is None:
        return FluidOperator()
    sides = [j for j in (region - 1, region) if 0 <= j < count]
    faces = [radial(fluid.slowness, wetted[j][int(j < region)]) for j in sides]
    per = [fluid.density * fluid.wall_motion_factor(j, radial) * (s * s) for j in sides]
    if region == 0:
        return FluidOperator(bb=per[0] * faces[0].disc)
    if region == count:
        return FluidOperator(aa=per[0] * faces[0].exterior)
    gap = annulus(*faces)
    return FluidOperator(per[0] * gap.aa, per[1] * gap.ab, per[0] * gap.ba, per[1] * gap.bb)


class CascadeSystem:
    """All walls and fluids at some orders and a block of Laplace nodes, each wall by the receptances of its faces.

    Parameters
    ----------
    problem : Problem
    s : ndarray, shape (nodes,)
    modes : Modes
    radial : RadialBasis, optional
        Bessel ratios at these nodes, if known.
    walls : sequence of FaceReceptance, optional
        Their receptances, if known.
    fluids : sequence of FluidOperator, optional
        Their operators, if known: they know nothing of feedback.

    Attributes
    ----------
    radial : RadialBasis
        Bessel ratios of the fluids, reused by the incident wave.
    walls : list of FaceReceptance
    fluids : list of FluidOperator
    """

    def __init__(
        self,
        problem: Problem,
        s: ComplexArray,
        modes: Modes,
        radial: RadialBasis | None = None,
        walls: Sequence[FaceReceptance] | None = None,
        fluids: Sequence[FluidOperator] | None = None,
    ) -> None:
        self.problem, self.s, self.modes = problem, s, modes
        self.radial = RadialBasis(modes, s) if radial is None else radial
        self.walls = [wall.receptance(modes, s) for wall in problem.shells] if walls is None else list(walls)
        self._radii = [wall.wetted for wall in problem.shells]
        self._alike = [wall.faces_move_alike for wall in problem.shells]
        self.fluids = fluid_operators(problem, self.radial, s) if fluids is None else list(fluids)
        self._factor()

    def _factor(self) -> None:
        """Keep zeta within each wall, y outside it, and the divisors of both."""
        self._within: list[Entry] = [self.fluids[0].bb]
        self._wall_divisor: list[Entry] = []
        self._seen: list[ComplexArray] = []
        self._gap_divisor: list[ComplexArray] = []
        for i, (h, (inner, outer)) in enumerate(zip(self.walls, self._radii, strict=True)):
            zeta, fluid = self._within[i], self.fluids[i + 1]
            divisor = 1.0 + h.inner * (inner * zeta)
            y = (h.outer / divisor if self._alike[i] else h.outer - h.back * h.across * (inner * zeta) / divisor) * outer
            gap = 1.0 - fluid.aa * y
            self._wall_divisor.append(divisor)
            self._seen.append(y)
            self._gap_divisor.append(gap)
            self._within.append(fluid.bb + fluid.ba * fluid.ab * y / gap)

    def solve(self, shell: int, load: ComplexArray | float, side: int | None = None) -> list[FaceMotion]:
        """Return the motion of the faces of every wall under an inward pressure on one of them.

        Parameters
        ----------
        shell : int
        load : ndarray, shape (orders, nodes), or float
        side : 0, 1 or None
            On its inner or its outer face; None is on the reference surface of a wall whose faces move alike, as actuators press on it.
        """
        h, radius = self.walls[shell], self.problem.shells[shell].radius
        if side is None:
            return self.solve_free(shell, h.inner * (radius * load), h.outer * (radius * load))
        own = h.inner if side == 0 else h.outer
        at_inner, at_outer = (own, h.back) if side == 0 else (h.across, own)
        pressed = self._radii[shell][side] * load
        found = self.solve_free(shell, at_inner * pressed, at_outer * pressed)
        given = found[shell]
        if side == 0:
            found[shell] = given._replace(load_inner=given.load_inner + load)
        else:
            found[shell] = given._replace(load_outer=given.load_outer + load)
        return found

    def solve_outside(self, pressure: ComplexArray) -> list[FaceMotion]:
        """Return the motion of all faces under a pressure on the surface that the exterior fluid wets."""
        return self.solve(len(self.walls) - 1, pressure, side=1)

    def solve_free(self, shell: int, inner: ComplexArray, outer: ComplexArray) -> list[FaceMotion]:
        """Return the motion of all faces where one wall would move by d_i and d_o if no fluid held it, as an actuator within it does."""
        count = len(self.walls)
        free_inner: list[Entry] = [0.0] * count  # as all within the wall that is pressed on
        driven: list[Entry] = [0.0] * count
        pressures: list[Entry] = [0.0] * count
        free_inner[shell], driven[shell] = inner, self._driven(shell, inner, outer, 0.0)
        for i in range(shell, count):
            if i > shell:
                h, radius = self.walls[i], self._radii[i][0]
                free_inner[i] = -h.inner * (radius * pressures[i])
                driven[i] = self._driven(i, free_inner[i], 0.0, pressures[i])
            if i + 1 < count:
                pressures[i + 1] = self.fluids[i + 1].ba * driven[i] / self._gap_divisor[i]
        found: list[FaceMotion] = []
        beyond: Entry = 0.0  # the next wall's inner face
        for i in reversed(range(count)):
            h, fluid = self.walls[i], self.fluids[i + 1]
            pushed = fluid.ab * beyond if i < shell else fluid.aa * driven[i] + fluid.ab * beyond
            load = pushed / self._gap_divisor[i]
            w_outer = self._seen[i] * load if i < shell else driven[i] + self._seen[i] * load
            through = h.across * (self._radii[i][1] * load)
            w_inner = (through if i < shell else through + free_inner[i]) / self._wall_divisor[i]
            held = self._within[i] * w_inner if i <= shell else self._within[i] * w_inner + pressures[i]
            found.append(FaceMotion(w_inner, w_outer, -held, load))
            beyond = w_inner
        return found[::-1]

    def gap_compliance(self) -> tuple[tuple[ComplexArray, ComplexArray], tuple[ComplexArray, ComplexArray]]:
        """Return the displacements of both faces of the one gap of two walls per inward pressure on either, first on the inner wall.

        Each face seen with all behind it is a receptance, w_a = y_a q_a and w_b = y_b q_b, and the gap ties both to each other,
        q_a = p_a + g (aa w_a + ab w_b), q_b = p_b - g (ba w_a + bb w_b): two equations instead of two ways through all walls.
        """
        gap, y_a, (y_b, _) = self.fluids[1], self._seen[0], self._seen_from_gap()
        alone_a, alone_b = self._gap_divisor[0], 1.0 + y_b * gap.bb
        across = y_a * y_b
        inverse = 1.0 / (alone_a * alone_b + across * gap.ab * gap.ba)
        across *= inverse
        return (y_a * alone_b * inverse, across * gap.ab), (-across * gap.ba, y_b * alone_a * inverse)

    def gap_answers(self) -> GapAnswers:
        """Return what these pressures do by the loads on both faces, which tell the loads on the faces behind."""
        (h, _), (_, outer), gap, y_a = self.walls, self._radii[0], self.fluids[1], self._seen[0]
        y_b, onto_outer = self._seen_from_gap()
        alone_a, alone_b = self._gap_divisor[0], 1.0 + y_b * gap.bb
        inverse = 1.0 / (alone_a * alone_b + (y_a * y_b) * gap.ab * gap.ba)
        alone_a, alone_b = alone_a * inverse, alone_b * inverse
        loads = (alone_b, -gap.ba * y_a * inverse), (gap.ab * y_b * inverse, alone_a)
        return GapAnswers(loads, (y_a, y_b), (-self._within[0] * h.across * outer / self._wall_divisor[0], onto_outer))

    def _seen_from_gap(self) -> tuple[ComplexArray, Entry]:
        """Return y_b of the outer of two walls with the sea behind it, and the load on its outer face per load on its inner one."""
        h, sea, (r_i, r_o) = self.walls[1], self.fluids[2], self._radii[1]
        through = h.back * (r_i * sea.aa) / (1.0 - h.outer * (r_o * sea.aa))
        return h.inner * r_i + h.across * r_o * through, through

    def _driven(self, wall: int, inner: Entry, outer: Entry, pressure: Entry) -> Entry:
        """Return e of a wall: its faces would move by *inner* under P of what lies within, and by *outer* under all else; P: *pressure*."""
        if self._alike[wall]:
            return inner / self._wall_divisor[wall]
        held = self._within[wall] * inner / self._wall_divisor[wall]
        return outer - self.walls[wall].back * (self._radii[wall][0] * (pressure + held))

    def determinant(self) -> ComplexArray:
        """Return what vanishes at the poles of the response, shape (orders, nodes): of thin walls the tridiagonal system's determinant."""
        total: ComplexArray = np.ones((self.modes.count, self.s.size), np.complex128)
        for h, wall, gap in zip(self.walls, self._wall_divisor, self._gap_divisor, strict=True):
            total = total * h.characteristic * wall * gap
        return total
