"""Energy of the shells and work of their actuators, dimensionless (unit rho_e c_e^2 a^2 per length)."""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import integrate
from coaxshell.response.energy.lossy_solids import lossy_solid_energy
from coaxshell.response.energy.motion import Motion
from coaxshell.response.energy.solid_transducers import solid_actuator_work
from coaxshell.response.energy.solids import solid_energy
from coaxshell.response.energy.work import SurfaceWork
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.lossy_solid import LossySolidWall
from coaxshell.structure.shell_model import WallEnergy, WallMotion


def shell_energy(motion: Motion, shell: int) -> tuple[WallEnergy, FloatArray | None]:
    """Return the energies of one shell and what has turned into heat in it by the kept instants; None if nothing ever does.

    Each arm of its losses holds a part of the strain energy, its spring's, and turns 2/tau of it per time into heat.
    """
    wall, kept, step = motion.problem.shells[shell], motion.kept, motion.grid.time_step
    if not wall.faces_move_alike:
        return lossy_solid_energy(motion, shell) if isinstance(wall, LossySolidWall) else (solid_energy(motion, shell), None)
    energy = wall.energy(_of_wall(motion, shell, kept))
    if not wall.dissipates:
        return energy, None
    power, strain = wall.dissipated_power(_of_wall(motion, shell, slice(None))), energy.strain
    for arm in wall.arms():
        stored = arm.stored(_held(motion, shell, arm.time))
        strain = strain + stored[kept]
        power = power + 2.0 / arm.time * stored
    heat = integrate.cumulative_simpson(power, dx=step, initial=0.0)[kept]
    return energy._replace(strain=strain), np.asarray(heat)


def _held(motion: Motion, shell: int, time: float) -> WallMotion:
    """Return what the spring of an arm keeps of the motion of a shell at all instants, without rates."""
    grid = motion.grid
    share = grid.nodes * time / (1.0 + grid.nodes * time)
    w, v = (grid.invert(x[shell] * share) for x in (motion.normal, motion.tangential))
    u = None if motion.axial is None else grid.invert(motion.axial[shell] * share)
    return WallMotion(motion.modes.orders, motion.circle, w, v, w, v, u, u, motion.wavenumber)


def _of_wall(motion: Motion, shell: int, instants: slice) -> WallMotion:
    w, v, w_rate, v_rate = (x[..., instants] for x in motion.histories(shell))
    u, u_rate = (None if x is None else x[..., instants] for x in motion.axial_histories(shell))
    return WallMotion(motion.modes.orders, motion.circle, w, v, w_rate, v_rate, u, u_rate, motion.wavenumber)


def actuator_work(motion: Motion) -> FloatArray:
    """Return the work that the actuators of all shells have taken from them, shape (T,).

    Minus the integral of the actuators' pressure times dw/dt over the surfaces, and of electrodes of their tractions times dv/dt and du/dt:
    the linear law's (Eqs. 4, 17) or, where the voltage saturates, what was given.
    """
    problem, grid, s = motion.problem, motion.grid, motion.grid.nodes
    given = motion.actuation
    total = np.zeros(grid.time.size)
    for i, wall in enumerate(problem.shells):
        if wall.gains is None:
            continue
        if isinstance(wall, ElasticWall):
            total += solid_actuator_work(motion, i)
            continue
        if given is not None:
            pressure = grid.transform_linear(given[i])
        else:
            sensor = wall.sensor_gain(motion.modes).columns
            if motion.voltage is None:
                volts = sensor.v * motion.tangential[i] + sensor.w * motion.normal[i]
                if sensor.u is not None and motion.axial is not None:
                    volts += sensor.u * motion.axial[i]
                law = wall.gains.at(s, motion.modes)
            else:
                volts, law = motion.voltage[i], np.ones_like(s)
            drive = wall.drive(motion.modes).columns
            pressure = drive.w * law * volts
            if np.any(drive.v):
                traction = drive.v * law * volts
                total -= SurfaceWork(grid, wall.radius * motion.circle, motion.tangential[i] * s)(traction)
            if drive.u is not None and motion.axial is not None:
                traction = drive.u * law * volts
                total -= SurfaceWork(grid, wall.radius * motion.circle, motion.axial[i] * s)(traction)
        total -= SurfaceWork(grid, wall.radius * motion.circle, motion.normal_velocity[i])(pressure)
    return total
