"""Energy of the absorbers and what their dampers turn into heat, dimensionless: in units of rho_e c_e^2 a^2 per length, of points a^3."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.late import integrate
from coaxshell.numerics.modes import Modes
from coaxshell.response.energy.motion import Motion
from coaxshell.response.synthesis import angle_basis, at_angles
from coaxshell.solver.faced_forces import surface_motion
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints, Properties, absorber_set, properties
from coaxshell.solver.interface.link_motion import LinkMotion
from coaxshell.solver.links.described import shells_between
from coaxshell.structure.shell_model import ShellModel


class AbsorberEnergy(NamedTuple):
    """Energies of all absorbers together, at the kept instants.

    ``defect`` is what the forces on the moving ends make of the dissipation, less ``dissipated``: an error of the time step.
    ``lost`` is what friction, stops and viscoelastic branches turned into heat, None without laws.
    """

    kinetic: FloatArray
    spring: FloatArray
    dissipated: FloatArray
    defect: FloatArray
    lost: FloatArray | None = None


Walls = Callable[[int, list[int], list[int]], tuple[FloatArray, FloatArray, "FloatArray | float"]]
"""From a shell and the numbers and sides of the absorbers' ends on it: w and dw/dt there, (ends, T), and the impedance Z of the wall."""


def absorber_energy(motion: Motion) -> AbsorberEnergy:
    """Return the energy of the line absorbers of a motion in two dimensions; zeros without any."""
    fitted, scales = motion.problem.system.absorber_list, motion.problem.scales

    def on_lines(shell: int, here: list[int], side: list[int]) -> tuple[FloatArray, FloatArray, float]:
        return *_at_absorbers(motion, shell, np.array([fitted[n].angle for n in here])), _impedance(motion, shell)

    every = absorber_set(motion.problem, fitted, 2)
    at: Walls = on_lines if every.footprint is None else _on_footprints(motion, every)
    linked = [shells_between(one, len(motion.problem.shells)) for one in fitted]
    return held_energy(properties(fitted, scales), linked, motion.links, at, motion.grid, motion.kept)


def held_energy(
    law: Properties, linked: Sequence[tuple[int, int]], links: LinkMotion | None, at: Walls, grid: LaplaceGrid, kept: slice
) -> AbsorberEnergy:
    """Return m (dq/dt)^2/2, the springs' k_l D^2/2 + k_nl D^4/4, D = q - w_i on either side, and what the dampers take.

    A damper takes c r^2, r = (Z (dq/dt - dw/dt) + c dD/dt)/(Z + c): the rate from the motion of its ends where it is weaker than the
    wall, and what its link's law makes of its force (:mod:`coaxshell.solver.interface.link_motion`) where it is stiffer, for then the
    motion of the ends errs by more than their difference. (Force on the shell less the springs') times dq/dt - dw/dt differs from it by the
    error of the time step: the defect.

    Parameters
    ----------
    law : Properties
        Dimensionless, of every absorber.
    linked : sequence of (int, int)
        The two shells that each links, the inner one first; -1 for none.
    links : LinkMotion or None
        None without absorbers.
    at : callable
        The walls where they are held.
    grid : LaplaceGrid
    kept : slice
        The grid's instants at which energies are taken.
    """
    powers, energies = np.zeros((2, grid.time.size)), np.zeros((2, grid.time[kept].size))
    if links is not None and links.laws is not None:
        return _energy_of_laws(law, linked, links, at, grid, kept)
    if links is not None:
        q, dq, force = links.displacement, links.velocity, links.force
        energies[0] = np.sum(0.5 * law.mass[:, None] * dq[:, kept] ** 2, axis=0)
        for shell, here, side in _ends(linked):
            w, dw, impedance = at(shell, here, side)
            stretch, parting = q[here] - w, dq[here] - dw
            damping, linear, cubic = (column[here, None] for column in (law.damping, law.linear, law.cubic))
            spring = linear * stretch + cubic * stretch**3
            share = damping / (damping + impedance)
            rate = parting + share * (links.stretch_rate[here, side] - parting)
            energies[1] += np.sum(0.5 * linear * stretch[:, kept] ** 2 + 0.25 * cubic * stretch[:, kept] ** 4, axis=0)
            powers[0] += np.sum(damping * rate**2, axis=0)
            powers[1] += np.sum(np.where(damping > 0.0, (force[here, side] - spring) * parting, 0.0), axis=0)
    taken = integrate.cumulative_simpson(powers, dx=grid.time_step, initial=0.0, axis=-1)[:, kept]
    return AbsorberEnergy(energies[0], energies[1], taken[0], taken[1] - taken[0])


def _on_footprints(motion: Motion, links: AbsorberSet) -> Walls:
    """Return the walls where absorbers hold them over arcs: the mean motion there, by the orders' h_m, of the faces that they hold."""
    problem, grid = motion.problem, motion.grid
    spectra = motion.normal if motion.solid is None else surface_motion(problem, motion.normal, motion.solid.faces)
    points = InterfacePoints(problem, links, motion.modes)
    w, dw = (points.evaluate(grid.invert(x)) for x in (spectra, spectra * grid.nodes))
    means = links.means(problem, motion.modes) ** 2 / motion.circle

    def at(shell: int, here: list[int], side: list[int]) -> tuple[FloatArray, FloatArray, FloatArray]:
        ends, wall = np.array(side) * links.count + here, problem.shells[shell]
        softness = means[side, here].sum(axis=-1) / wall.radius
        return w[ends], dw[ends], (2.0 * wall.mass / grid.time_step / softness)[:, None]

    return at


def _ends(linked: Sequence[tuple[int, int]]) -> Iterator[tuple[int, list[int], list[int]]]:
    """Yield the shells that absorbers hold, and on each the numbers and sides of their ends."""
    for shell in sorted({shell for pair in linked for shell in pair if shell >= 0}):
        ends = [(n, pair.index(shell)) for n, pair in enumerate(linked) if shell in pair]
        yield shell, [n for n, _ in ends], [side for _, side in ends]


def _energy_of_laws(
    law: Properties, linked: Sequence[tuple[int, int]], links: LinkMotion, at: Walls, grid: LaplaceGrid, kept: slice
) -> AbsorberEnergy:
    """Return the energies of links of any law, as their march kept them; the defect is that of the work on the moving ends."""
    assert links.laws is not None
    stored, damped, lost, held = links.laws
    power = np.zeros(grid.time.size)
    for shell, every, sides in _ends(linked):
        ends = [(n, side) for n, side in zip(every, sides, strict=True) if held[n, side]]
        if ends:
            here, side = (list(part) for part in zip(*ends, strict=True))
            power -= np.sum(links.force[here, side] * at(shell, here, side)[1], axis=0)
    work = integrate.cumulative_simpson(power, dx=grid.time_step, initial=0.0)
    kinetic = np.sum(0.5 * law.mass[:, None] * links.velocity**2, axis=0)
    defect = work - kinetic - stored - damped - lost
    return AbsorberEnergy(kinetic[kept], stored[kept], damped[kept], defect[kept], lost[kept])


def _at_absorbers(motion: Motion, shell: int, angle: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return w and dw/dt of a shell at angles, shape (A, T)."""
    w, _, dw, _ = motion.histories(shell)
    basis = angle_basis(angle, w.shape[1], w.shape[0])
    return at_angles(w, basis).T, at_angles(dw, basis).T


def _impedance(motion: Motion, shell: int) -> float:
    return line_impedance(motion.problem.shells[shell], motion.modes, motion.grid)


def line_impedance(wall: ShellModel, modes: Modes, grid: LaplaceGrid) -> float:
    """Return Z, by which a line force moves the wall's own mass within half a step of the run, spread over the orders -M..M."""
    return 4.0 * np.pi * wall.radius * wall.mass / (grid.time_step * (2 * modes.max_order + 1))
