"""Energy of the absorbers and what their dampers turn into heat, dimensionless (unit rho_e c_e^2 a^2 per length)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.acoustics.operators import FloatArray
from coaxshell.numerics.late import integrate
from coaxshell.response.energy.motion import Motion
from coaxshell.response.synthesis import angle_basis, at_angles
from coaxshell.response.voltages import time_derivative


class AbsorberEnergy(NamedTuple):
    """Of all absorbers together, at the kept instants.

    ``defect`` is what the forces recorded by the run make of the dissipation, less ``dissipated``: an error of the time step.
    """

    kinetic: FloatArray
    spring: FloatArray
    dissipated: FloatArray
    defect: FloatArray


def absorber_energy(motion: Motion) -> AbsorberEnergy:
    """Return m (dq/dt)^2/2, the springs' k_l D^2/2 + k_nl D^4/4, D = q - w_i(theta_n) on either side, and what the dampers take.

    A damper takes c (dD/dt)^2, from the motion alone, so that the balance tests the force law too. The same from the recorded forces,
    (force on the shell less the springs') times dD/dt, differs by the error of the time step: the defect (hybrid preset at
    dt = 1e-3: 9e-5 of the work).
    """
    fitted = motion.problem.system.absorber_list
    time, kept = motion.grid.time, motion.kept
    q, force = motion.solution.absorber_displacement, motion.solution.absorber_force
    powers, energies = np.zeros((2, time.size)), np.zeros((2, time[kept].size))
    if fitted and q is not None and force is not None:
        scales = motion.problem.scales
        units = {
            "mass": scales.pressure * (scales.length / scales.velocity) ** 2,
            "damping": scales.pressure * scales.length / scales.velocity,
            "linear_stiffness": scales.pressure,
            "cubic_stiffness": scales.pressure / scales.length**2,
        }
        column = {name: np.array([getattr(a, name) for a in fitted])[:, None] / unit for name, unit in units.items()}
        dq = time_derivative(q, motion.grid.time_step)
        energies[0] = np.sum(0.5 * column["mass"] * dq[:, kept] ** 2, axis=0)
        for shell in range(len(motion.problem.shells)):
            ends = [(n, shell - a.inner_shell) for n, a in enumerate(fitted) if shell - a.inner_shell in (0, 1)]
            if not ends:
                continue
            here, side = (list(part) for part in zip(*ends, strict=True))
            w, dw = _at_absorbers(motion, shell, np.array([fitted[n].angle for n in here]))
            stretch, rate = q[here] - w, dq[here] - dw
            damping, linear, cubic = (column[name][here] for name in ("damping", "linear_stiffness", "cubic_stiffness"))
            spring = linear * stretch + cubic * stretch**3
            energies[1] += np.sum(0.5 * linear * stretch[:, kept] ** 2 + 0.25 * cubic * stretch[:, kept] ** 4, axis=0)
            powers[0] += np.sum(damping * rate**2, axis=0)
            powers[1] += np.sum(np.where(damping > 0.0, (force[here, side] - spring) * rate, 0.0), axis=0)
    taken = integrate.cumulative_simpson(powers, dx=motion.grid.time_step, initial=0.0, axis=-1)[:, kept]
    return AbsorberEnergy(energies[0], energies[1], taken[0], taken[1] - taken[0])


def _at_absorbers(motion: Motion, shell: int, angle: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return w and dw/dt of a shell at angles, shape (A, T)."""
    w, _, dw, _ = motion.histories(shell)
    basis = angle_basis(angle, w.shape[1], w.shape[0])
    return at_angles(w, basis).T, at_angles(dw, basis).T
