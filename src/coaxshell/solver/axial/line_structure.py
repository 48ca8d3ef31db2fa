"""What the walls do along the lines of absorbers, one axial wavenumber at a time: under the sources, and under forces there.

Wavenumbers are independent of each other. Of each only what happens at the lines is kept: histories and step weights for a march, or the
exact answer of linear absorbers.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.progress import tell_share
from coaxshell.solver.axial.blocks import Found
from coaxshell.solver.axial.blocks import node_blocks as shared_blocks
from coaxshell.solver.axial.families import Family, WaveSet, wave_sets
from coaxshell.solver.axial.lines import LineLayout
from coaxshell.solver.axial.surfaces import SurfaceWave
from coaxshell.solver.faced_forces import step_weights, trapezoidal_nodes
from coaxshell.solver.interface.absorbers import point_law, side_admittance
from coaxshell.solver.kernels import velocity_weights
from coaxshell.solver.quadrature import trapezoidal_weights, unresolved_orders
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solid_spectra import band
from coaxshell.solver.spectral import node_blocks

WAVES_TOGETHER = 4
"""Axial wavenumbers of a piece of work that is shared out."""


def wave_blocks(layout: LineLayout) -> list[slice]:
    """Return consecutive slices of the axial wavenumbers."""
    count = len(layout.sampling.modes)
    return [slice(first, min(first + WAVES_TOGETHER, count)) for first in range(0, count, WAVES_TOGETHER)]


def line_kernels(layout: LineLayout, grid: LaplaceGrid, waves: slice) -> Found:
    """Return what a march needs of some axial wavenumbers.

    Returns
    -------
    dict
        "displacement" and "velocity" of the walls at the lines without absorbers, (waves, 2N, axial parities, T), and "weights", those of
        the classes' pressures in their velocities (:mod:`coaxshell.solver.kernels`; of walls whose faces move differently
        :mod:`coaxshell.solver.faced_forces`), (surfaces, surfaces, waves, classes, T).
    """
    found: dict[str, list[np.ndarray[tuple[int, ...], np.dtype[np.float64]]]] = {"displacement": [], "velocity": [], "weights": []}
    for j in range(waves.start, waves.stop):
        motion, compliance = wave_answers(layout, grid, j)
        modes = layout.sampling.modes[j]
        weights = _weights(layout.problem, grid, compliance, modes)
        found["displacement"].append(grid.invert(motion))
        found["velocity"].append(grid.invert(motion * grid.nodes))
        found["weights"].append(layout.folded(weights))
        tell_share((j + 1 - waves.start) / (waves.stop - waves.start))
    return {name: np.stack(each, axis=2 if name == "weights" else 0) for name, each in found.items()}


def _weights(problem: Problem, grid: LaplaceGrid, compliance: ComplexArray, modes: Modes) -> FloatArray:
    """Return the step weights of the pressures on surfaces, (surfaces, surfaces, orders, T)."""
    if problem.two_faced:
        return _by_trapezoidal_rule(problem, grid, modes)
    late = unresolved_orders(problem, grid, modes)
    if problem.tied and late.any():
        return _by_trapezoidal_rule(problem, grid, modes)
    weights = velocity_weights(problem, grid, compliance, modes)
    if late.any():
        weights[:, :, late] = trapezoidal_weights(problem, grid, Modes(modes.orders[late], modes.wavenumber), [])[0]
    return weights


def _by_trapezoidal_rule(problem: Problem, grid: LaplaceGrid, modes: Modes) -> FloatArray:
    """Return those of walls whose faces move differently, or that feedback ties to each other."""
    fine, s = trapezoidal_nodes(grid)
    resolving, own = problem.resolving(band(fine)), Modes(modes.orders, modes.wavenumber)  # whose shapes end with them
    parts = [SurfaceWave(resolving, s[block], own).compliance for block in node_blocks(fine, modes.max_order)]
    return step_weights(np.concatenate(parts, axis=-1), fine, s, grid)


def line_answers(layout: LineLayout, grid: LaplaceGrid, waves: slice) -> Found:
    """Return the exact answer of linear absorbers at some axial wavenumbers.

    Returns
    -------
    dict
        Transforms of "force", (waves, 2N, axial parities, nodes), and of the masses' "displacement", (waves, N, axial parities, nodes).
    """
    absorbers, count = layout.absorbers, layout.absorbers.count
    sides, law = side_admittance(absorbers, grid.nodes), point_law(absorbers, grid.nodes)
    forces, displacements = [], []
    for j in range(waves.start, waves.stop):
        motion, receptance = receptances(layout, grid, j)
        walls = np.linalg.solve(np.eye(2 * count) + receptance @ law, np.moveaxis(motion, -1, 0))
        forces.append(np.moveaxis(-(law @ walls), 0, -1))
        masses = sides.inner_share[:, :, None] * walls[:, :count] + sides.outer_share[:, :, None] * walls[:, count:]
        displacements.append(np.moveaxis(masses, 0, -1))
        tell_share((j + 1 - waves.start) / (waves.stop - waves.start))
    return {"force": np.stack(forces), "displacement": np.stack(displacements)}


def wave_answers(layout: LineLayout, grid: LaplaceGrid, j: int) -> tuple[ComplexArray, ComplexArray]:
    """Return w at the lines under the sources, (2N, axial parities, nodes), and C_ij, (surfaces, surfaces, orders, nodes), of a wave."""
    problem, modes = layout.problem, layout.sampling.modes[j]
    count = len(problem.surfaces)
    motion = np.zeros((layout.points.surface.size, layout.axial_parities, grid.nodes.size), np.complex128)
    compliance = np.empty((count, count, modes.count, grid.nodes.size), np.complex128)
    for block in shared_blocks(grid):  # those of all other work on these waves, which find the same fluids
        system = SurfaceWave(problem, grid.nodes[block], modes, layout.sampling.fluids)
        for pressed in range(count):
            for moved, w in enumerate(system.under_pressure(pressed)):
                compliance[moved, pressed, :, block] = w
        motion[..., block] = _moved_by_sources(layout, grid, j, block, system)
    return motion, compliance


def receptances(layout: LineLayout, grid: LaplaceGrid, j: int) -> tuple[ComplexArray, ComplexArray]:
    """Return w at the lines under the sources, as :func:`wave_answers`, and per force at every other one, (nodes, 2N, 2N), of a wave.

    Where electrodes are cut a line moves all orders that they tie, wherever it stands: its forces are taken one by one.
    """
    if not layout.problem.cut:
        motion, compliance = wave_answers(layout, grid, j)
        return motion, layout.points.receptance(layout.folded(compliance))
    points, modes = layout.points, layout.sampling.modes[j]
    motion = np.zeros((points.count, layout.axial_parities, grid.nodes.size), np.complex128)
    found = np.empty((grid.nodes.size, points.count, points.count), np.complex128)
    shape, groups = (points.parities, points.modes), [points.on_surface(i) for i in range(points.surfaces)]
    maps = [[one.reshape(-1, *shape)[..., : modes.count] for one in points.maps_of(i)] for i in range(points.surfaces)]
    for block in node_blocks(grid, modes.max_order):
        system = SurfaceWave(layout.problem, grid.nodes[block], modes, parities=points.parities)
        motion[..., block] = _moved_by_sources(layout, grid, j, block, system)
        for pressed, sources in enumerate(groups):
            for force, pressures in zip(sources, maps[pressed][1], strict=True):
                moved = system.under_forces(pressed, pressures)
                for i, here in enumerate(groups):
                    found[block, here, force] = sum(e @ each[i] for e, each in zip(np.moveaxis(maps[i][0], 1, 0), moved, strict=True)).T
    return motion, found


def _moved_by_sources(layout: LineLayout, grid: LaplaceGrid, j: int, block: slice, system: SurfaceWave) -> ComplexArray:
    """Return w at the lines under the sources at a block of nodes, (2N, axial parities, nodes)."""
    surface, felt, s = layout.points.surface, layout.felt(system.modes), grid.nodes[block]
    motion = np.zeros((surface.size, layout.axial_parities, s.size), np.complex128)
    for family, share in families_at(layout, wave_sets(layout.problem, layout.sampling, np.array([layout.origin]), s), j):
        for shapes, each in zip(felt, system.under(family, grid, block), strict=False):
            here = np.empty((surface.size, s.size), np.complex128)
            for i in np.unique(surface):
                here[surface == i] = shapes[surface == i] @ each[i]
            for along, part in enumerate(share[: layout.axial_parities]):
                motion[:, along] += part * here
    return motion


def families_at(layout: LineLayout, sets: list[WaveSet], j: int) -> Iterator[tuple[Family, tuple[float, float]]]:
    """Yield the families of sources that make waves of a wavenumber, and how much of cos k(z - z_0) and of sin k(z - z_0) they make.

    Parameters
    ----------
    layout : LineLayout
    sets : list of WaveSet
        Of all sources, at the station z_0.
    j : int
        Number of the wavenumber.
    """
    for waves in sets:
        if waves.modes is layout.sampling.modes or j == 0:
            for family in waves.families:
                yield family, (float(family.even[0, j]), -float(family.odd[0, j]))
