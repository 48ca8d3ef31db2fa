"""One wave along the axis whose amplifiers stop at a limit: what sources ask for, and what walls do under sources and what is lacking."""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.blocks import Found
from coaxshell.solver.axial.families import Family, WaveSet, wave_sets
from coaxshell.solver.axial.lack import Channels, VoltageLack, wave_patterns
from coaxshell.solver.axial.normals import normals_of, piezoelectric_layers, potentials_of
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.axial.tied_wave import TiedWave, motion_parities
from coaxshell.solver.electrode_loops import times
from coaxshell.solver.scaling import Problem
from coaxshell.solver.voltage_response import controlled


def limited_motions(problem: Problem, waves: WaveSet, j: int, grid: LaplaceGrid, block: slice) -> list[ComplexArray]:
    """Return what walls are read for in wave j under each family, (3 + layers, shells, parities, orders, nodes).

    Walls that show what they give show what their law asks for.
    """
    wave = TiedWave(problem, grid.nodes[block], waves.modes[j], motion_parities(problem))
    patterns, found = wave.loops.patterns, []
    for family in waves.families:
        normal, asked, lack = _asked(problem, wave, family, grid, block)
        moved = wave.moved(patterns.in_orders(asked + lack), None if normal is None else _widened(normal, motion_parities(problem)))
        shown = patterns.in_orders(asked)
        motion = [list(moved.normal), list(moved.tangential), list(moved.axial)]
        potentials = np.array(potentials_of(problem, wave.bare, piezoelectric_layers(problem), *motion))
        for volts, i in zip(shown, wave.response.shells, strict=True):
            if problem.shells[i].shows_control:
                potentials[problem.shells[i].shown_potentials - 1, i] = volts
        found.append(np.concatenate([np.stack(moved[:3]), potentials]) if len(potentials) else np.stack(moved[:3]))
    return found


def lacking(problem: Problem, family: Family, modes: Modes) -> ComplexArray | float:
    """Return what actuators lack of what is asked for, (shells, parities, orders, nodes), in a wave of a family; 0 of others."""
    if not isinstance(family.forces, VoltageLack):
        return 0.0
    volts = wave_patterns(problem, modes).in_orders(family.forces.of(modes, odd=family.odd_forces))
    found = np.zeros((len(problem.shells), *volts.shape[1:]), np.complex128)
    found[list(controlled(problem))] = volts
    return found


def _widened(normal: ComplexArray, parities: int) -> ComplexArray:
    """Return W with so many parities, 0 in those that sources do not excite."""
    missing = parities - normal.shape[1]
    return np.concatenate([normal, np.zeros((len(normal), missing, *normal.shape[2:]))], axis=1) if missing else normal


def _asked(
    problem: Problem, wave: TiedWave, family: Family, grid: LaplaceGrid, block: slice
) -> tuple[ComplexArray | None, ComplexArray, ComplexArray | float]:
    """Return W of a family without voltages, what the loops ask for and what is lacking, (walls, patterns, nodes) each."""
    if isinstance(family.forces, VoltageLack):
        lack = family.forces.of(wave.bare.modes, odd=family.odd_forces)
        return None, times(wave.loops.inverse, lack) - lack, lack
    normal = np.stack([np.stack(each) for each in normals_of(problem, wave.bare, family, grid, block)], axis=1)
    return normal, wave.loops.asked(wave.loops.patterns.readings(wave.readings(normal))), 0.0


def voltages_asked(
    problem: Problem, grid: LaplaceGrid, sampling: AxialSampling, channels: Channels, origin: float, lack: VoltageLack | None, block: slice
) -> Found:
    """Return what the loops ask for under the sources, and with what is lacking, at a slice of the nodes.

    "asked", (walls, axial parities, channels, nodes): amplitudes along cos k(z - z_0) and sin k(z - z_0); dead segments as if alive. Where
    there are some, "linear" has what is asked for with them at ground.
    """
    s, forces = grid.nodes[block], None if lack is None else lack.at(block)
    sets = wave_sets(problem, sampling, np.array([origin]), s, forces)
    along = axial_parities(problem, origin)
    found: Found = {}
    for waves in sets:
        for j, modes in enumerate(waves.modes):
            wave = TiedWave(problem, s, modes, motion_parities(problem))
            for family in waves.families:
                normal, asked, _ = _asked(problem, wave, family, grid, block)
                each = {"asked": asked}
                if wave.loops.patterns.dead and normal is not None:
                    each["linear"] = wave.loops.voltages(wave.loops.patterns.readings(wave.readings(normal)))
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
    """Return K = (1 - H K C)^-1 - 1 at a slice of some nodes, "kernel": (walls, walls, channels, nodes)."""
    nodes: ComplexArray = s[block]
    found = None
    for j, modes in enumerate(sampling.modes):
        inverse = np.moveaxis(TiedWave(problem, nodes, modes, motion_parities(problem)).loops.inverse, (2, 3), (0, 1))
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
