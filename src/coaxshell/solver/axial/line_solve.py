"""Line absorbers in three dimensions solved: exactly where they are linear, by the march where they are not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.convolution import summed_weights
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.progress import Progress, of_stage
from coaxshell.solver.axial.blocks import BlockMap, Found
from coaxshell.solver.axial.line_forces import LineForces, line_forces
from coaxshell.solver.axial.line_laws import LineLawHistories
from coaxshell.solver.axial.line_march import LineMarch, LineMotion, march_lines
from coaxshell.solver.axial.line_structure import line_answers, line_kernels, wave_blocks
from coaxshell.solver.axial.lines import LineLayout
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.interface.absorbers import AbsorberSet
from coaxshell.solver.links.histories import middles_transform
from coaxshell.solver.orders_left_out import with_tangent
from coaxshell.solver.step_error import SHARES

_INSTANTS = 64
"""Of stretches that are taken to the points of a period together."""


@dataclass(frozen=True)
class LineSolution:
    """What the line absorbers of a run did.

    Attributes
    ----------
    forces : LineForces
        As loads on all waves.
    grid : LaplaceGrid
    force : ndarray, shape (waves, 2N, axial parities, T)
        Their amplitudes along the axis, of the absorbers carried.
    displacement : ndarray, shape (waves, N, axial parities, T)
        Amplitudes of q.
    exact : tuple of ndarray, or None
        Transforms of force and displacement, where they were not marched.
    marched : tuple of LineMotion and LineMarch, or None
        What was marched, and what was found.
    """

    forces: LineForces
    grid: LaplaceGrid
    force: FloatArray
    displacement: FloatArray
    marched: tuple[LineMotion, LineMarch] | None = None
    exact: tuple[ComplexArray, ComplexArray] | None = None

    @property
    def laws(self) -> LineLawHistories | None:
        """What links of any law did in the march."""
        return None if self.marched is None else self.marched[1].laws

    @cached_property
    def error(self) -> float:
        """Relative error of what the forces do to the walls by the steps of the march, 0 where nothing was marched: longer than the run."""
        return 0.0 if self.marched is None else _march_error(self.forces.layout, self.marched[0], self.marched[1].moved)

    @cached_property
    def tangent(self) -> AbsorberSet:
        """The absorbers carried, cubic springs by their mean tangent over all times and the whole axis, other laws by what fits them."""
        absorbers = self.forces.layout.absorbers
        if self.marched is None:
            return absorbers
        if self.laws is not None:
            return self.laws.best_springs(absorbers, self.grid.time_step)
        return _mean_tangent(self.forces.layout, *self.marched)

    def with_waves(self, sampling: AxialSampling) -> LineSolution:
        """Return the same by a sampling of the same waves, whose modes keep nothing."""
        return replace(self, forces=replace(self.forces, layout=replace(self.forces.layout, sampling=sampling)))

    def at(self, z: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return forces (z, N, 2, T) and displacements (z, N, T) of every absorber of the description at some z (in a)."""
        layout = self.forces.layout
        along, member = layout.along(z), layout.absorbers.member
        force, displacement = (np.einsum("zkp,kipt->zit", along, x, optimize=True) for x in (self.force, self.displacement))
        sides = force.reshape(z.size, 2, layout.absorbers.count, -1).swapaxes(1, 2)
        return sides[:, member], displacement[:, member]


def solve_lines(layout: LineLayout, grid: LaplaceGrid, on: BlockMap, progress: Progress | None = None) -> LineSolution:
    """Return what the line absorbers do.

    Raises
    ------
    InputError
        If a step of the march does not converge.
    """
    if layout.absorbers.is_linear:
        found = _mapped(layout, grid, line_answers, on, progress)
        force, displacement = found["force"], found["displacement"]
        forces = line_forces(layout, force)
        return LineSolution(forces, grid, grid.invert(force), grid.invert(displacement), exact=(force, displacement))
    found = _mapped(layout, grid, line_kernels, on, progress)
    motion = LineMotion(found["displacement"], found["velocity"], found["weights"], grid.time_step)
    result = march_lines(layout, motion, progress)
    spectra = grid.transform_linear(result.force) if result.laws is None else middles_transform(grid, result.laws.force)
    return LineSolution(line_forces(layout, spectra), grid, result.force, result.displacement, (motion, result))


def _mean_tangent(layout: LineLayout, motion: LineMotion, result: LineMarch) -> AbsorberSet:
    """Return the absorbers carried, cubic springs by k_l + 3 k_nl <D^4>/<D^2>, means over all times and the whole axis."""
    count = layout.absorbers.count
    squares, fourth = np.zeros((2, count))
    for first in range(0, motion.steps, _INSTANTS):
        some = slice(first, first + _INSTANTS)
        stretch = np.tile(result.displacement[..., some], (1, 2, 1, 1)) - motion.displacement[..., some] - result.moved[..., some]
        values = layout.series.values(np.moveaxis(stretch, 2, 3).reshape(len(stretch), -1, stretch.shape[2]))
        square = values * values
        for total, power in ((squares, square), (fourth, square * square)):
            total += (layout.series.weights @ power).reshape(2, count, -1).sum(axis=(0, 2))
    return with_tangent(layout.absorbers, squares, fourth)


def _mapped(
    layout: LineLayout, grid: LaplaceGrid, work: Callable[[LineLayout, LaplaceGrid, slice], Found], on: BlockMap, progress: Progress | None
) -> Found:
    """Return what is found at all axial wavenumbers, from slices of them in turn."""
    blocks = wave_blocks(layout)
    whole: Found = {}
    results = on(partial(work, layout, grid), blocks, of_stage(progress, "lines of the absorbers"))
    for block, part in zip(blocks, results, strict=True):
        for name, values in part.items():
            axis = 2 if name == "weights" else 0
            if name not in whole:
                shape = list(values.shape)
                shape[axis] = len(layout.sampling.modes)
                whole[name] = np.empty(shape, values.dtype)
            whole[name][(slice(None),) * axis + (block,)] = values
    return whole


def _march_error(layout: LineLayout, motion: LineMotion, moved: FloatArray) -> float:
    """Return a share of what changes at steps eight times longer, or four times or twice; 1 if all of them fail.

    In the displacement that forces give to the walls at the lines: forces themselves err more, in what is too fast to move a wall.
    """
    found = 1.0
    for every, (share, telling) in SHARES.items():
        steps = (motion.steps - 1) // every + 1
        kept = slice(0, steps * every, every)
        weights = summed_weights(motion.weights, every, steps)
        coarser = LineMotion(motion.displacement[..., kept], motion.velocity[..., kept], weights, every * motion.time_step)
        try:
            with np.errstate(all="ignore"):
                coarse = march_lines(layout, coarser).moved
        except (InputError, np.linalg.LinAlgError, FloatingPointError):
            continue
        change, whole = moved[..., kept] - coarse, np.linalg.norm(moved[..., kept])
        if np.isfinite(change).all() and whole > 0:
            found = min(found, share * float(np.linalg.norm(change) / whole))
        if found < telling:
            break
    return found
