"""The motion of the walls in one wave along the axis, under the loads of a family of sources or of forces on the walls."""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.axial.families import Family, outside_loads
from coaxshell.solver.axial.tied_wave import Driven, OpenWave
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.scaling import Problem


def motions_of(problem: Problem, system: ModalSystem, family: Family, grid: LaplaceGrid, block: slice) -> ComplexArray:
    """Return W, V, U and potentials of a wave under the loads of a family, (3 + layers, shells, parities, orders, nodes)."""
    layers, motions = piezoelectric_layers(problem), []
    for normal in normals_of(problem, system, family, grid, block):
        motion = [normal, system.tangential(normal), system.axial(normal)]
        motions.append(np.array([*motion, *potentials_of(problem, system, layers, *motion)]))
    return np.stack(motions, axis=2)


def normals_of(problem: Problem, system: ModalSystem, family: Family, grid: LaplaceGrid, block: slice) -> list[list[ComplexArray]]:
    """Return W of every shell, (orders, nodes), under the loads of a family, for each parity around."""
    modes, found = system.modes, []
    on_outermost = outside_loads(family, system.radial, grid, block)
    forces = {} if family.forces is None else family.forces.loads(problem, modes, odd=family.odd_forces)
    for parity in range(family.parities):
        each = [system.solve_outside(on_outermost[parity])] if on_outermost else []
        each += [system.solve(surface, pressures[parity]) for surface, pressures in forces.items()]
        found.append([np.sum(moved, axis=0) if len(each) > 1 else moved[0] for moved in zip(*each, strict=True)])
    return found


def stacked_normals(problem: Problem, system: ModalSystem, family: Family, grid: LaplaceGrid, block: slice) -> ComplexArray:
    """Return the same as :func:`normals_of`, (shells, parities, orders, nodes)."""
    return np.stack([np.stack(each) for each in normals_of(problem, system, family, grid, block)], axis=1)


def shown_of(problem: Problem, wave: OpenWave, moved: Driven) -> ComplexArray:
    """Return what walls are read for that move so, as :func:`motions_of` does; of those that show what they give its voltage."""
    motion = [list(each) for each in (moved.normal, moved.tangential, moved.axial)]
    potentials = np.array(potentials_of(problem, wave.bare, piezoelectric_layers(problem), *motion))
    for i, wall in enumerate(problem.shells):
        if wall.shows_control:
            potentials[wall.shown_potentials - 1, i] = moved.voltage[i]
    return np.concatenate([np.stack(moved[:3]), potentials])


def piezoelectric_layers(problem: Problem) -> int:
    """Return the largest number of voltages that a wall shows: of piezoelectric layers, and what some laws read and give."""
    return max(wall.shown_potentials for wall in problem.shells)


def potentials_of(
    problem: Problem,
    system: ModalSystem,
    layers: int,
    normal: list[ComplexArray],
    tangential: list[ComplexArray],
    axial: list[ComplexArray],
) -> list[list[ComplexArray]]:
    """Return the voltages that each wall shows (:meth:`ShellModel.shown_voltages`), by voltage and wall; 0 of a wall with fewer."""
    found = [[np.zeros_like(w) for w in normal] for _ in range(layers)]
    for i, (wall, w, v, u) in enumerate(zip(problem.shells, normal, tangential, axial, strict=True)):
        for number, per in enumerate(wall.shown_voltages(system.modes, system.s)):
            found[number][i] = per.v * v + per.w * w + (0.0 if per.u is None else per.u * u)
    return found
