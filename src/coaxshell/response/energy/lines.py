"""Energy of line absorbers over an axial period, and what their dampers turn into heat (unit rho_e c_e^2 a^3).

Springs of third order have no energy of single axial wavenumbers: it is taken point by point, and integrated along the period. So is that
of links of any law, which are followed step by step through the stretches that the run found.
"""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.late import integrate
from coaxshell.response.energy.absorbers import AbsorberEnergy
from coaxshell.solver.axial.line_laws import laws_along, of_means
from coaxshell.solver.axial.line_solve import LineSolution
from coaxshell.solver.axial.lines import LineLayout
from coaxshell.solver.axial.motion import WaveMotion
from coaxshell.solver.interface.absorbers import link_impedance
from coaxshell.solver.interface.link_motion import LinkMotion, motion_by_law


class WallsAtLines:
    """Histories of the walls at the lines of absorbers, gathered wave by wave as sums along the axis.

    Parameters
    ----------
    solution : LineSolution
    grid : LaplaceGrid
    """

    def __init__(self, solution: LineSolution, grid: LaplaceGrid) -> None:
        self.solution, self.layout, self._grid = solution, solution.forces.layout, grid
        self.displacement, self.velocity = np.zeros((2, *solution.force.shape))

    def add(self, wave: WaveMotion, j: int) -> None:
        """Take over what a wave does at the lines: A cos kz - B sin kz, in terms of z - z_0."""
        layout, felt = self.layout, self.layout.felt(wave.modes)
        around = min(len(felt), wave.around)
        turn = float(wave.modes.wavenumber) * layout.origin
        moved = wave.of_surfaces
        parts = moved.reshape(moved.shape[0], -1, wave.around, *moved.shape[2:])
        surface, at = layout.points.surface, np.empty((felt.shape[1], parts.shape[1], moved.shape[-1]), np.complex128)
        for i in np.unique(surface):
            at[surface == i] = np.einsum("pnm,apmk->nak", felt[:around, surface == i], parts[i, :, :around], optimize=True)
        even, odd = at[:, 0], at[:, 1] if at.shape[1] == 2 else np.zeros_like(at[:, 0])
        both = [np.cos(turn) * even - np.sin(turn) * odd, -np.sin(turn) * even - np.cos(turn) * odd]
        for parity in range(layout.axial_parities):
            self.displacement[j, :, parity] = self._grid.invert(both[parity])
            self.velocity[j, :, parity] = self._grid.invert(both[parity] * self._grid.nodes)


def lines_energy(walls: WallsAtLines, kept: slice, length: float) -> AbsorberEnergy:
    """Return the energies of all absorbers over a length of the axis; see :func:`coaxshell.response.energy.absorbers.absorber_energy`.

    Parameters
    ----------
    walls : WallsAtLines
        All waves taken over.
    kept : slice
        Instants at which stores are taken.
    length : float
        In a: the period, or 1 where nothing changes along it.
    """
    layout, grid, series = walls.layout, walls.solution.grid, walls.layout.series
    absorbers, count = layout.absorbers, layout.absorbers.count
    if absorbers.elements is not None:
        return _energy_of_laws(walls, kept, length)
    instants = grid.time.size
    powers, energies = np.zeros((2, instants)), np.zeros((2, np.arange(instants)[kept].size))

    def along(coefficients: FloatArray) -> FloatArray:
        return series.values(np.ascontiguousarray(coefficients.swapaxes(1, 2)))

    for n in range(count):
        sides, share = [n, n + count], length * float(absorbers.multiplicity[n]) * series.weights
        damping, linear, cubic, mass = (float(x[n]) for x in (absorbers.damping, absorbers.linear, absorbers.cubic, absorbers.mass))
        links = _links(walls, n)
        energies[0] += share @ (0.5 * mass * links.velocity[:, kept] ** 2)
        for side, point in enumerate(sides):
            stretch = links.displacement - along(walls.displacement[:, point])
            parting = links.velocity - along(walls.velocity[:, point])
            spring = (linear + cubic * stretch**2) * stretch
            energies[1] += share @ (0.5 * linear * stretch[:, kept] ** 2 + 0.25 * cubic * stretch[:, kept] ** 4)
            if damping > 0.0:
                weaker = damping / (damping + _impedance(layout, grid, point))
                rate = parting + weaker * (links.stretch_rate[:, side] - parting)
                powers[0] += share @ (damping * rate**2)
                powers[1] += share @ ((links.force[:, side] - spring) * parting)
    taken = integrate.cumulative_simpson(powers, dx=grid.time_step, initial=0.0, axis=-1)[:, kept]
    return AbsorberEnergy(energies[0], energies[1], taken[0], taken[1] - taken[0])


def _energy_of_laws(walls: WallsAtLines, kept: slice, length: float) -> AbsorberEnergy:
    """Return the energies of links that have laws, or differ, followed step by step; the defect is that of the work on the moving ends."""
    layout, step, instants = walls.layout, walls.solution.grid.time_step, walls.solution.grid.time.size
    absorbers, told = layout.absorbers, walls.solution.laws
    assert absorbers.elements is not None
    stretch, velocity = _stretches(walls)
    each = length * np.multiply.outer(layout.series.weights, absorbers.multiplicity)  # share of every absorber at every point
    share = np.tile(each, (1, 2))
    damping, stiffness = (np.tile(x, 2) * absorbers.elements.present for x in (absorbers.damping, absorbers.linear))
    laws = laws_along(layout.series, absorbers, step, None if told is None else told.compliance)
    state, before = laws.at_rest(), np.zeros_like(share)
    kinetic, stored, by_laws, damped, done, power = np.zeros((6, instants))
    for n in range(1, instants):
        parts = stretch, velocity, walls.solution.force, walls.velocity
        after, speed, force, moving = (layout.series.values(np.ascontiguousarray(x[..., n])) for x in parts)
        done[n] = np.sum(share.ravel() * laws.force(after.ravel(), state).value * (after - before).ravel())
        state = laws.advance(after.ravel(), state)
        by_laws[n] = share.ravel() @ laws.stored(state)
        stored[n] = by_laws[n] + 0.5 * np.sum(share * stiffness * after**2)
        damped[n] = np.sum(share * damping * (after - before) ** 2) / step
        kinetic[n] = 0.5 * np.sum(each * absorbers.mass * speed**2)
        power[n] = -np.sum(share * absorbers.held.ravel() * force * moving)
        before = after
    lost, damped = np.cumsum(done) - by_laws, np.cumsum(damped)
    work = integrate.cumulative_simpson(power, dx=step, initial=0.0)
    defect = work - kinetic - stored - damped - lost
    return AbsorberEnergy(*(history[kept] for history in (kinetic, stored, damped, defect, lost)))


def _stretches(walls: WallsAtLines) -> tuple[FloatArray, FloatArray]:
    """Return the amplitudes of D (waves, 2N, axial parities, T) and of dq/dt (waves, N, axial parities, T), of links that have laws."""
    solution, grid = walls.solution, walls.solution.grid
    if solution.laws is not None:
        return solution.laws.stretch, of_means(np.diff(solution.displacement, axis=-1, prepend=0.0) / grid.time_step)
    assert solution.exact is not None
    force, mass = solution.exact
    z = link_impedance(walls.layout.absorbers, grid.nodes).T[:, None]
    return grid.invert(np.divide(force, z, out=np.zeros_like(force), where=z != 0.0)), grid.invert(mass * grid.nodes)


def _impedance(layout: LineLayout, grid: LaplaceGrid, point: int) -> float:
    """Return Z, by which a force at a line, or over its arc, moves the wall's own mass within half a step."""
    surface, modes = layout.problem.surfaces[layout.points.surface[point]], layout.sampling.modes[0]
    wall = layout.problem.shells[surface.shell]
    means = layout.absorbers.means(layout.problem, modes).reshape(-1, modes.count)[point]
    softness = float(np.sum(means**2 / np.where(modes.orders == 0, 2.0 * np.pi, np.pi))) / wall.radius
    return float(2.0 * wall.mass / (grid.time_step * softness))


def _links(walls: WallsAtLines, n: int) -> LinkMotion:
    """Return the motion of an absorber at every point of the period, as if each were an absorber of its own."""
    solution, layout, grid = walls.solution, walls.layout, walls.solution.grid
    absorbers, series = layout.absorbers, layout.series
    sides = [n, n + absorbers.count]

    def along(coefficients: FloatArray) -> FloatArray:
        return series.values(np.ascontiguousarray(coefficients.swapaxes(1, 2)))

    force = np.stack([along(solution.force[:, point]) for point in sides], axis=1)
    displacement = along(solution.displacement[:, n])
    law = tuple(np.full((1, 1), float(x[n])) for x in (absorbers.damping, absorbers.linear, absorbers.cubic))
    if solution.exact is None:
        return motion_by_law((law[0], law[1], law[2]), grid.time_step, force, displacement)
    of_force, of_mass = solution.exact
    slope = absorbers.damping[n] * grid.nodes + absorbers.linear[n]
    rates = np.stack([along(grid.invert(of_force[:, point] * (grid.nodes / slope))) for point in sides], axis=1)
    return LinkMotion(force, displacement, along(grid.invert(of_mass[:, n] * grid.nodes)), rates)
