"""The motion of the walls at stations along the axis: the sum of all waves, at a block of Laplace nodes.

Blocks of nodes are independent of each other and small enough for a processor's cache; within a block all wavenumbers are solved and
added up, so that a run keeps what is at its stations alone, however many wavenumbers there are.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.progress import tell_share
from coaxshell.solver.axial.belts import driven_sets
from coaxshell.solver.axial.blocks import Found
from coaxshell.solver.axial.faced import READ
from coaxshell.solver.axial.faced_motion import faced_amplitudes
from coaxshell.solver.axial.families import Family, WaveSet
from coaxshell.solver.axial.forces import WallForces
from coaxshell.solver.axial.limited_wave import limited_motions
from coaxshell.solver.axial.normals import motions_of, piezoelectric_layers, shown_of, stacked_normals
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.axial.tied_wave import TiedWave, motion_parities
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.scaling import Problem

TOGETHER = 4
"""Wavenumbers whose amplitudes are added up at once, by a matrix product."""


SQUARES = "squares"
_ODD = ("u", "shear", "radial_axial")
"""What goes along the axis as the odd function o."""


def station_sums(
    problem: Problem,
    grid: LaplaceGrid,
    sampling: AxialSampling,
    stations: FloatArray,
    forces: WallForces | None,
    block: slice,
) -> Found:
    """Return the motion at stations (z in a) at a slice of the grid's nodes, under the sources and forces of absorbers.

    Arrays (stations, shells, parities, M + 1, nodes) by the names of :data:`coaxshell.structure.shell_model.FIELDS` and "potential 0", ...,
    those left out that are zero at all stations; and "squares", (2, shells, 2, M + 1): mean squares along the axis of W and of the
    strains, |m V - W|^2 + |k U|^2, parities and nodes added up, under the sources [0] and under the forces of absorbers [1].
    """
    s, parities = grid.nodes[block], motion_parities(problem)
    parities = parities if forces is None else max(parities, forces.parities)
    shape = (stations.size, len(problem.shells), parities, sampling.max_order + 1, s.size)
    fields: dict[str, ComplexArray] = {}
    squares = np.zeros((2, shape[1], 2, shape[3]))
    names = amplitude_names(problem)
    sets = driven_sets(problem, sampling, stations, grid, block, None if forces is None else forces.at(block))
    done, whole, bends = 0, pair_count(sets), any(wall.faces_move_alike and wall.moves for wall in problem.shells)
    for waves in sets:
        for first in range(0, len(waves.modes), TOGETHER):
            some = waves.order[first : first + TOGETHER]
            amplitudes = [np.zeros((len(names), len(some), *shape[1:]), np.complex128) for _ in waves.families]
            for place, j in enumerate(some):
                for one, solved in zip(amplitudes, amplitudes_of(problem, waves, j, grid, block), strict=True):
                    one[:, place, :, : solved.shape[2], : waves.modes[j].count] = solved
                done += waves.modes[j].count
                tell_share(done / whole)
            for number, (family, found) in enumerate(zip(waves.families, amplitudes, strict=True)):
                named = dict(zip(names, found, strict=True))
                if waves.belts is not None:
                    waves.belts.take_under(fields, shape, number, some, named)
                _add(fields, shape, family, waves.wavenumber, some, named, derivatives=bends)
                if waves.belts is None:
                    squares[int(family.forces is not None)] += mean_squares(family.mean[some], waves.wavenumber[some], *found[:3])
            for mean, moved in [] if waves.belts is None else waves.belts.together([found[:3] for found in amplitudes], some):
                squares[0] += mean_squares(mean, waves.wavenumber[some], *moved)
        if waves.belts is not None:
            waves.belts.add_given(fields, shape)
    return {**fields, SQUARES: squares}


def of_odd(name: str) -> bool:
    """Return whether what a wall is read for goes along the axis as the odd function o: u and the shears with the axis."""
    return name in _ODD


def pair_count(sets: list[WaveSet]) -> int:
    """Return how many pairs of an order and a wavenumber some waves have, which is how long they take."""
    return sum(modes.count for waves in sets for modes in waves.modes)


def amplitudes_of(problem: Problem, waves: WaveSet, j: int, grid: LaplaceGrid, block: slice) -> list[ComplexArray]:
    """Return what walls are read for in wave j under each family's loads: W, V, U first, see :func:`amplitude_names`.

    One array a family, (names, shells, parities, orders, nodes).
    """
    if waves.belts is not None:
        return waves.belts.amplitudes(j)
    if problem.two_faced:
        return faced_amplitudes(problem, waves, j, grid, block, piezoelectric_layers(problem))
    if waves.limited:
        return limited_motions(problem, waves, j, grid, block)
    if problem.tied:
        tied = TiedWave(problem, grid.nodes[block], waves.modes[j], max(family.parities for family in waves.families))
        free = (stacked_normals(problem, tied.bare, family, grid, block) for family in waves.families)
        return [shown_of(problem, tied, tied.driven(normal)) for normal in free]
    system = ModalSystem(problem, grid.nodes[block], waves.modes[j], shared=waves.fluids)
    return [motions_of(problem, system, family, grid, block) for family in waves.families]


def given_voltages(problem: Problem, modes: Modes, s: ComplexArray, amplitudes: ComplexArray) -> ComplexArray:
    """Return the voltages of all actuators, (shells, parities, orders, nodes), from what walls are read for; 0 of walls without."""
    w, v, u = amplitudes[:3]
    found: ComplexArray = np.zeros_like(w)
    for i, wall in enumerate(problem.shells):
        if wall.shows_control:
            found[i] = amplitudes[2 + wall.shown_potentials, i]
        elif wall.gains is not None:
            read = wall.sensor_gain(modes).columns
            found[i] = wall.gains.at(s, modes) * (read.v * v[i] + read.w * w[i] + (0.0 if read.u is None else read.u * u[i]))
    return found


def amplitude_names(problem: Problem) -> list[str]:
    """Return what walls are read for: W, V, U, stresses where some are elastic solids, potentials of piezoelectric layers."""
    potentials = [f"potential {number}" for number in range(piezoelectric_layers(problem))]
    return [*(READ if problem.two_faced else READ[:3]), *potentials]


def _add(
    fields: dict[str, ComplexArray],
    shape: tuple[int, ...],
    family: Family,
    wavenumber: npt.NDArray[np.number],
    some: list[int],
    amplitudes: dict[str, ComplexArray],
    *,
    derivatives: bool,
) -> None:
    """Add some waves of a family to the fields, by e and o and, if the stresses of thin walls need them, their derivatives."""
    even, odd, k = family.even[:, some], family.odd[:, some], wavenumber[some]
    shares = {name: (odd if of_odd(name) else even, amplitude) for name, amplitude in amplitudes.items()}
    if derivatives:
        w, v, u = (amplitudes[name] for name in ("w", "v", "u"))
        shares |= {"w_z": (-k * odd, w), "w_zz": (-k * k * even, w), "v_z": (-k * odd, v), "u_z": (k * even, u)}
    for name, (share, amplitude) in shares.items():
        if not np.any(share):
            continue
        total = fields.setdefault(name, np.zeros(shape, np.complex128))
        if np.iscomplexobj(share):
            total += share.reshape(shape[0], 1, 1, 1, -1) * amplitude[0]
        else:
            columns = amplitude.reshape(len(some), -1).view(np.float64)
            total += (share @ columns).view(np.complex128).reshape(shape)


def mean_squares(mean: FloatArray, wavenumber: npt.NDArray[np.number], w: ComplexArray, v: ComplexArray, u: ComplexArray) -> FloatArray:
    """Return the mean squares along the axis of W and of the strains, (shells, 2, M + 1).

    W, V, U of some waves have the shape (waves, shells, parities, M + 1, nodes).
    """
    m, k = np.arange(w.shape[3], dtype=np.float64)[:, None], wavenumber.reshape(len(mean), 1, 1, 1, -1)
    found = np.zeros((w.shape[1], 2, w.shape[3]))
    for which, x in ((0, w), (1, m * v - w), (1, k * u)):
        parts = np.ascontiguousarray(x).view(np.float64)
        found[:, which] += np.einsum("j,jipmn,jipmn->im", mean, parts, parts)
    return found
