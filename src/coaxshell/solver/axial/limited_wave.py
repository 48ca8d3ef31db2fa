"""One wave along the axis whose amplifiers stop at a limit: what sources ask for, and what walls do under sources and what is lacking."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from coaxshell.model.gains import limits_currents
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.blocks import Found
from coaxshell.solver.axial.faced import FacedWave
from coaxshell.solver.axial.families import Family, WaveSet, wave_sets
from coaxshell.solver.axial.lack import Channels, VoltageLack, wave_patterns
from coaxshell.solver.axial.limited_charges import WaveCharges
from coaxshell.solver.axial.normals import shown_of, stacked_normals
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.axial.tied_faces import Closed, TiedFaces
from coaxshell.solver.axial.tied_wave import TiedWave, motion_parities
from coaxshell.solver.electrode_loops import ElectrodeLoops, times
from coaxshell.solver.scaling import Problem
from coaxshell.solver.voltage_response import controlled, of_all


def limited_motions(problem: Problem, waves: WaveSet, j: int, grid: LaplaceGrid, block: slice) -> list[ComplexArray]:
    """Return what thin walls are read for in wave j under each family, (3 + layers, shells, parities, orders, nodes).

    Walls that show what they give show what their law asks for, and where currents stop what that leaves.
    """
    wave = TiedWave(problem, grid.nodes[block], waves.modes[j], motion_parities(problem))
    patterns, found = wave.loops.patterns, []
    for family in waves.families:
        normal = read = None
        if not isinstance(family.forces, VoltageLack):
            normal = stacked_normals(problem, wave.bare, family, grid, block)
            read, normal = patterns.readings(wave.readings(normal)), _widened(normal, motion_parities(problem))
        asked, given = limited_voltages(wave.loops, family, waves.modes[j], read)
        moved = wave.moved(patterns.in_orders(given), normal)
        if not limits_currents(problem.system):
            moved = moved._replace(voltage=of_all(problem, wave.response, patterns.in_orders(asked)))
        found.append(shown_of(problem, wave, moved))
    return found


def limited_faces(wave: FacedWave, waves: WaveSet, grid: LaplaceGrid, block: slice) -> Iterator[Closed]:
    """Yield what the faces of all walls do under each family.

    ``wave`` is without feedback, where some walls have two faces.
    """
    tied = TiedFaces(wave, motion_parities(wave.problem))
    patterns = tied.loops.patterns
    for family in waves.families:
        free = None if isinstance(family.forces, VoltageLack) else wave.faces(family, grid, block)
        read = None if free is None else patterns.readings(tied.readings(free))
        _, given = limited_voltages(tied.loops, family, wave.modes, read)
        yield tied.moved(patterns.in_orders(given), free)


def lacking(problem: Problem, family: Family, modes: Modes) -> ComplexArray | float:
    """Return what actuators lack of what stations show, (shells, parities, orders, nodes), in a wave of a family; 0 of others.

    Where currents stop these show what is given.
    """
    if not isinstance(family.forces, VoltageLack) or limits_currents(problem.system):
        return 0.0
    volts = wave_patterns(problem, modes).in_orders(family.forces.of(modes, odd=family.odd_forces))
    found = np.zeros((len(problem.shells), *volts.shape[1:]), np.complex128)
    found[list(controlled(problem))] = volts
    return found


def _widened(normal: ComplexArray, parities: int) -> ComplexArray:
    """Return W with so many parities, 0 in those that sources do not excite."""
    missing = parities - normal.shape[1]
    return np.concatenate([normal, np.zeros((len(normal), missing, *normal.shape[2:]))], axis=1) if missing else normal


def _loops(problem: Problem, s: ComplexArray, modes: Modes) -> TiedWave | TiedFaces:
    """Return the loops of a wave, which nothing but them feeds back."""
    parities = motion_parities(problem)
    if problem.two_faced:
        return TiedFaces(FacedWave(problem, s, modes, reads=False, opened=True), parities)
    return TiedWave(problem, s, modes, parities)


def _readings(
    problem: Problem, wave: TiedWave | TiedFaces, family: Family, grid: LaplaceGrid, block: slice, charges: WaveCharges | None
) -> tuple[ComplexArray, ComplexArray | float]:
    """Return what patterns read of a family of sources without voltages, (walls, patterns, nodes), and m/C, 0 without charges."""
    if isinstance(wave, TiedFaces):
        free = wave.wave.faces(family, grid, block)
        return wave.loops.patterns.readings(wave.readings(free)), 0.0 if charges is None else charges.of_faces(free)
    normal = stacked_normals(problem, wave.bare, family, grid, block)
    return wave.loops.patterns.readings(wave.readings(normal)), 0.0 if charges is None else charges.of_normal(normal)


def limited_voltages(loops: ElectrodeLoops, family: Family, modes: Modes, read: ComplexArray | None) -> tuple[ComplexArray, ComplexArray]:
    """Return what loops ask for and give in a wave, (walls, patterns, nodes), by what patterns *read* of sources or by what is lacking."""
    if isinstance(family.forces, VoltageLack):
        lack = family.forces.of(modes, odd=family.odd_forces)
        given = times(loops.inverse, lack)
        return given - lack, given
    assert read is not None
    asked = loops.asked(read)
    return asked, asked


def voltages_asked(
    problem: Problem, grid: LaplaceGrid, sampling: AxialSampling, channels: Channels, origin: float, lack: VoltageLack | None, block: slice
) -> Found:
    """Return what the loops ask for under the sources, and with what is lacking, at a slice of the nodes.

    "asked", (walls, axial parities, channels, nodes): amplitudes along cos k(z - z_0) and sin k(z - z_0); dead segments as if alive. Where
    there are some, "linear" has what is asked for with them at ground. Where currents stop it is the charge asked for over C, alpha.
    """
    s, forces = grid.nodes[block], None if lack is None else lack.at(block)
    sets = wave_sets(problem, sampling, np.array([origin]), s, forces)
    along = axial_parities(problem, origin)
    found: Found = {}
    for waves in sets:
        for j, modes in enumerate(waves.modes):
            wave = _loops(problem, s, modes)
            charges = WaveCharges(problem, wave) if limits_currents(problem.system) else None
            for family in waves.families:
                read: ComplexArray | None = None
                held: ComplexArray | float = 0.0
                if not isinstance(family.forces, VoltageLack):
                    read, held = _readings(problem, wave, family, grid, block, charges)
                asked, given = limited_voltages(wave.loops, family, modes, read)
                each = {"asked": asked if charges is None else asked + held + charges.strained(given)}
                if wave.loops.patterns.dead and read is not None:
                    each["linear"] = wave.loops.voltages(read)
                for name, values in each.items():
                    shape = (len(values), along, channels.count, s.size)
                    total = found.setdefault(name, np.zeros(shape, np.complex128))
                    for parity, share in enumerate((family.even[0, j], -family.odd[0, j])[:along]):
                        total[:, parity, channels.of_wave(j)] += share * values
    return found


def axial_parities(problem: Problem, origin: float) -> int:
    """Return 1 where all sources are even about a z, else 2."""
    return 2 if any(getattr(source, "z", 0.0) / problem.scales.length != origin for source in problem.emitters) else 1


def loop_kernel(problem: Problem, sampling: AxialSampling, s: ComplexArray, channels: Channels, block: slice) -> Found:
    """Return K = T - 1 at a slice of some nodes, T = (1 - H K C)^-1, "kernel": (walls, walls, channels, nodes).

    Where currents stop it is T - 1 + Q T/C.
    """
    nodes: ComplexArray = s[block]
    found = None
    for j, modes in enumerate(sampling.modes):
        wave = _loops(problem, nodes, modes)
        inverse = np.moveaxis(wave.loops.inverse, (2, 3), (0, 1))
        if limits_currents(problem.system):
            inverse = inverse + np.einsum("ijqk,jlqk->ilqk", WaveCharges(problem, wave).per_volt, inverse)
        if found is None:
            found = np.empty((*inverse.shape[:2], channels.count, nodes.size), np.complex128)
        found[:, :, channels.of_wave(j)] = inverse
    assert found is not None
    for wall in range(len(found)):
        found[wall, wall] -= 1.0
    return {"kernel": found}


def even_about(problem: Problem) -> float:
    """Return z about which the waves of a run are even or odd, in a: that of all spherical sources where it is one."""
    places: FloatArray = np.unique([getattr(source, "z", 0.0) for source in problem.emitters])
    return float(places[0]) / problem.scales.length if places.size == 1 else 0.0
