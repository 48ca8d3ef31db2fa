"""The mutations: small wrong changes in central places, each of which some test must notice.

One row a mistake that a person could make: a sign, a factor, an index, a power of the radius.
"""

from __future__ import annotations

from typing import NamedTuple


class Mutation(NamedTuple):
    """One wrong change.

    Attributes
    ----------
    name : str
    file : str
        Inside src/coaxshell.
    original, mutated : str
        Text that stands there exactly once, and what to put in its place.
    breaks : str
        What is then wrong.
    nearest : str
        Tests beside it, inside tests/, asked first; several with spaces between.
    """

    name: str
    file: str
    original: str
    mutated: str
    breaks: str
    nearest: str


MUTATIONS = (
    # structure
    Mutation("ring-bending-w", "structure/thin.py", "-(m**2) / radius**2", "-m / radius**2", "bending of a ring by w: m^2", "structure"),
    Mutation("ring-cross", "structure/thin.py", "2 * b * ev * kv", "b * ev * kv", "coupling of stretch and bending in K_vv", "structure"),
    Mutation(
        "bending-integral",
        "structure/section.py",
        "(top**3 - bottom**3) / 3.0",
        "(top**3 - bottom**3) / 2.0",
        "bending stiffness d22",
        "structure",
    ),
    Mutation(
        "open-circuit-radius",
        "structure/thin.py",
        "(layer.zeta33 + m**2 * layer.zeta22 / radius**2)",
        "(layer.zeta33 + m**2 * layer.zeta22 / radius**4)",
        "open-circuit stiffening: 1/R^2 once, not twice",
        "structure",
    ),
    Mutation(
        "sensor-gain", "structure/thin.py", "-gain * m**2", "gain * m**2", "sensor voltage per W: sign", "structure solver/test_scaling.py"
    ),
    Mutation(
        "reduced-coupling",
        "structure/section.py",
        "material.e32 - material.c23",
        "material.e32 + material.c23",
        "plane-stress coupling e32~",
        "structure",
    ),
    Mutation(
        "stress-sign",
        "structure/stress.py",
        "np.full_like(m, -scale)",
        "np.full_like(m, scale)",
        "hoop stress per W: inward displacement compresses",
        "response/test_histories.py",
    ),
    Mutation(
        "stress-depth",
        "structure/stress.py",
        "m / radius + z * m / radius**2",
        "m / radius - z * m / radius**2",
        "strain away from the mid-surface",
        "response/test_stress_at_depth.py",
    ),
    # acoustics
    Mutation(
        "bessel-i-recurrence",
        "numerics/bessel_ratios.py",
        "np.add(work, ratios[m], out=work)",
        "np.subtract(work, ratios[m], out=work)",
        "downward recurrence of I_{m+1}/I_m",
        "numerics/test_bessel_ratios.py",
    ),
    Mutation(
        "bessel-k-index",
        "numerics/bessel_ratios.py",
        "np.multiply(two_over_z, m, out=work)\n        np.add(ratios[m], work, out=ratios[m])",
        "np.multiply(two_over_z, m - 1, out=work)\n        np.add(ratios[m], work, out=ratios[m])",
        "upward recurrence of K_{m+1}/K_m: its order",
        "numerics/test_bessel_ratios.py",
    ),
    Mutation(
        "annulus-coupling",
        "acoustics/operators.py",
        "ab=eps_i * (inner.disc - inner.exterior)",
        "ab=eps_i * (outer.disc - outer.exterior)",
        "pressure on the inner wall of a gap by its outer one",
        "acoustics/test_operators.py",
    ),
    Mutation(
        "annulus-echo",
        "acoustics/operators.py",
        "1.0 - epsilon_i * epsilon_k",
        "1.0 + epsilon_i * epsilon_k",
        "echoes between the walls of a gap",
        "acoustics/test_operators.py",
    ),
    Mutation(
        "incident-beta",
        "numerics/modes.py",
        "np.where(self.orders == 0, 1.0, 2.0)",
        "np.where(self.orders == 0, 2.0, 2.0)",
        "projection of the incident wave: beta of order 0",
        "acoustics/test_incident.py",
    ),
    Mutation(
        "afterflow",
        "acoustics/sources/spherical.py",
        "front * s + afterflow",
        "front * s - afterflow",
        "afterflow of the spherical wave",
        "acoustics/test_incident.py",
    ),
    Mutation(
        "rigid-scattering",
        "acoustics/sources/spherical.py",
        "pressure[:, nodes] + acceleration[:, nodes]",
        "pressure[:, nodes] - acceleration[:, nodes]",
        "wave scattered by the rigid cylinder: sign",
        "acoustics/test_incident.py",
    ),
    Mutation(
        "free-field-afterflow",
        "acoustics/sources/spherical.py",
        "self._pulse.impulse(since) / self._range",
        "self._pulse.impulse(since)",
        "afterflow in the free field: 1/R",
        "acoustics/test_free_field.py",
    ),
    Mutation(
        "spherical-front-phase",
        "acoustics/sources/spherical_front.py",
        "/ (surface.kappa + basis.s)",
        "/ (2.0 * surface.kappa)",
        "phase of the spherical source at an axial wavenumber",
        "acoustics/test_spherical_front.py",
    ),
    Mutation(
        "axial-reach",
        "solver/axial/causality.py",
        "return speed * time + start / (speed + _faster(speed))",
        "return speed * time + start / (2.0 * speed)",
        "how far a head wave gets along the axis, and with it the axial period",
        "solver/test_axial_sampling.py",
    ),
    Mutation(
        "axial-shares",
        "solver/axial/sampling.py",
        "np.where(self.wavenumbers == 0.0, 2.0, 4.0)",
        "np.where(self.wavenumbers == 0.0, 4.0, 4.0)",
        "sum over axial wavenumbers: that of k = 0 counts once",
        "solver/test_axial_sampling.py",
    ),
    Mutation(
        "laplace-window",
        "numerics/laplace_grid.py",
        "np.exp(self.shift * self.time) / self.time_step",
        "np.exp(0.999 * self.shift * self.time) / self.time_step",
        "exponential window of the inverse transform",
        "numerics/test_laplace_grid.py",
    ),
    Mutation(
        "hat-power",
        "numerics/laplace_grid.py",
        "(np.sinh(half) / half) ** 2, dtype",
        "(np.sinh(half) / half), dtype",
        "forces linear between steps",
        "numerics/test_laplace_grid.py solver/test_march.py",
    ),
    # solver
    Mutation(
        "time-scale", "solver/scaling.py", "time=a / c", "time=2 * a / c", "transit time: radius, not diameter", "solver/test_scaling.py"
    ),
    Mutation(
        "pressure-scale", "solver/scaling.py", "pressure=rho * c**2", "pressure=rho * c", "unit of pressure", "solver/test_scaling.py"
    ),
    Mutation(
        "slowness",
        "solver/scaling.py",
        "c / fluid.sound_speed",
        "fluid.sound_speed / c",
        "sound speed of inner fluids, inverted",
        "solver/test_scaling.py",
    ),
    Mutation(
        "actuator-sign",
        "structure/thin_wall.py",
        "else -actuator.actuator_coupling",
        "else actuator.actuator_coupling",
        "pressure of the actuator per volt: sign",
        "solver/test_feedback.py",
    ),
    Mutation(
        "feedback-sign",
        "structure/shell_model.py",
        "found.impedance -= self.gains",
        "found.impedance += self.gains",
        "feedback in the shell's dynamic stiffness: sign",
        "solver/test_feedback.py",
    ),
    Mutation(
        "stability-feedback-sign",
        "solver/stability.py",
        "diagonal[i] - gains.at(nodes)",
        "diagonal[i] + gains.at(nodes)",
        "feedback in the determinant of the closed loop: sign",
        "solver/test_stability.py",
    ),
    Mutation(
        "stability-whole-turns",
        "numerics/winding.py",
        "2 * np.pi * np.bincount",
        "np.pi * np.bincount",
        "turns of the determinant around zero: a whole turn a crossing",
        "numerics/test_winding.py solver/test_stability.py",
    ),
    Mutation(
        "determinant-coupling",
        "solver/coupling.py",
        "entry * present - product * before",
        "entry * present + product * before",
        "determinant of coupled shells: sign of their coupling",
        "solver/test_stability.py solver/test_coupling.py",
    ),
    Mutation(
        "relaxation-answer",
        "solver/interface/relaxation.py",
        "new = known + (rows @",
        "new = known - (rows @",
        "several steps at once: what the springs' own forces move",
        "solver/test_relaxation.py",
    ),
    Mutation(
        "gap-coupling",
        "solver/coupling.py",
        "-density[1] * gap.ab, density[0] * gap.ba",
        "density[1] * gap.ab, density[0] * gap.ba",
        "coupling of neighbouring shells through the gap: sign",
        "solver/test_coupling.py",
    ),
    Mutation(
        "absorber-cubic",
        "solver/interface/absorbers.py",
        "cubic * length**2 / pressure",
        "cubic * length / pressure",
        "dimensionless cubic stiffness",
        "solver/test_absorbers.py",
    ),
    Mutation(
        "absorber-mass",
        "solver/interface/absorbers.py",
        "mass = mass * velocity**2",
        "mass = mass * velocity",
        "dimensionless mass of an absorber",
        "solver/test_absorbers.py",
    ),
    Mutation(
        "absorber-radius",
        "solver/interface/absorbers.py",
        "max(absorbers.count, 1)] / problem.shells[i].radius)",
        "max(absorbers.count, 1)])",
        "line force to pressure: 1/R of the shell it acts on",
        "solver/test_absorbers.py",
    ),
    Mutation(
        "absorber-projection",
        "solver/point_forces.py",
        "np.where(modes.orders == 0, 2.0, 1.0)",
        "np.where(modes.orders == 0, 1.0, 1.0)",
        "projection of absorbers' forces: beta of order 0",
        "solver/test_absorbers.py",
    ),
    Mutation(
        "kernel-damping",
        "structure/shell_model.py",
        "self.damping - self.actuator_pressure",
        "self.damping + self.actuator_pressure",
        "initial decay of the kernels under derivative feedback",
        "solver/test_march.py solver/test_prepared.py",
    ),
    Mutation(
        "kernel-weights",
        "solver/kernels.py",
        "exponential_weights(decay, grid) / mass",
        "exponential_weights(decay, grid) / mass**2",
        "velocity kernel just after an impulse",
        "solver/test_march.py",
    ),
    Mutation(
        "force-law",
        "solver/interface/laws.py",
        "beyond = self._cubic * z",
        "beyond = 3.0 * self._cubic * z",
        "cubic force of a spring: D^3, not its derivative",
        "solver/test_march.py",
    ),
    Mutation(
        "mass-balance",
        "solver/interface/block_response.py",
        "balance = links.inertia[:, None] * u - carry",
        "balance = links.inertia[:, None] * u + carry",
        "equation of motion of an absorber's mass: trapezoidal rule",
        "solver/test_march.py",
    ),
    Mutation(
        "mass-mobility",
        "solver/interface/block_response.py",
        "np.divide(0.5 * time_step, absorbers.mass",
        "np.divide(time_step, absorbers.mass",
        "motion of an absorber's mass from one block to the next",
        "solver/test_march.py",
    ),
    Mutation(
        "history-blocks",
        "numerics/convolution.py",
        "inputs[-(blocks & -blocks) :]",
        "inputs[-1:]",
        "history sum: dyadic blocks of the past",
        "numerics/test_convolution.py",
    ),
    Mutation(
        "saturation-clip",
        "solver/interface/saturation.py",
        "np.clip(amplitudes @ self._around, -1.0, 1.0)",
        "np.clip(amplitudes @ self._around, -1.0, 2.0)",
        "saturation of positive voltages",
        "solver/test_saturation.py",
    ),
    Mutation(
        "saturation-beta",
        "solver/interface/saturation.py",
        "np.tile(np.where(orders == 0, 2.0, 1.0), parities)",
        "np.tile(np.where(orders == 0, 1.0, 1.0), parities)",
        "projection of what saturated actuators give: beta of order 0",
        "solver/test_saturation.py",
    ),
    Mutation(
        "saturation-trapezoid",
        "solver/kernels.py",
        "return np.asarray((sums - 0.5 * rate) * time_step)",
        "return np.asarray(sums * time_step)",
        "voltage from the sensor's rate by the trapezoidal rule",
        "solver/test_strong_feedback.py",
    ),
    Mutation(
        "unresolved-orders",
        "solver/quadrature.py",
        "> RESOLVED * grid.nyquist",
        "> 1e9 * grid.nyquist",
        "orders that no step resolves: weights that keep the positive real part",
        "solver/test_strong_feedback.py",
    ),
    Mutation(
        "saturation-limit",
        "structure/thin_wall.py",
        "else field) * actuator.thickness",
        "else field) * 2.0 * actuator.thickness",
        "voltage at which the actuator stops",
        "solver/test_saturation.py",
    ),
    Mutation(
        "reported-limit",
        "response/voltages.py",
        "ActuatorLimit(voltage_limit(solution",
        "ActuatorLimit(2.0 * voltage_limit(solution",
        "voltage limit that a response reports",
        "response/test_voltages.py",
    ),
    # response
    Mutation(
        "peak-instant",
        "response/peaks.py",
        "block.start + found.instant",
        "found.instant",
        "instant of the peak when the search takes several blocks",
        "response/test_summary.py",
    ),
    Mutation(
        "parseval",
        "response/synthesis.py",
        "weight[0, 0], weight[1:, 0] = 1.0, 0.0",
        "weight[0, 0], weight[1:, 0] = 0.5, 0.0",
        "mean square over the circle: order 0",
        "response/test_synthesis.py",
    ),
    Mutation(
        "damper-power",
        "response/energy/absorbers.py",
        "np.sum(damping * rate**2, axis=0)",
        "np.sum(0.5 * damping * rate**2, axis=0)",
        "power that the dampers take",
        "response/test_energy_parts.py response/test_energy.py",
    ),
    Mutation(
        "spring-energy",
        "response/energy/absorbers.py",
        "0.25 * cubic * stretch[:, kept] ** 4",
        "0.5 * cubic * stretch[:, kept] ** 4",
        "energy of a cubic spring",
        "response/test_spring_energy.py",
    ),
    Mutation(
        "gap-transfer",
        "response/fields/modal_field.py",
        "(slopes.outer - eps_k * slopes.inner)",
        "(slopes.outer + eps_k * slopes.inner)",
        "pressure inside the gap from the walls' motion",
        "response/test_pressure_physics.py response/test_pressure_grids.py",
    ),
    Mutation(
        "field-recurrence",
        "response/fields/modal_field.py",
        "((m + 1) / self.kappa * step)",
        "(m / self.kappa * step)",
        "recurrence of outgoing waves over the orders",
        "response/test_pressure_physics.py response/test_pressure_grids.py",
    ),
    Mutation(
        "incident-cross-term",
        "response/fields/rms.py",
        "* (2.0 / points)",
        "* (1.0 / points)",
        "RMS of the exterior pressure: product of incident wave and field",
        "response/test_pressure_physics.py response/test_pressure_grids.py",
    ),
    Mutation(
        "arc-corners",
        "solver/direct/loads.py",
        "np.append(pulse_corners(source.pulse, scales.time), np.inf)",
        "np.append(pulse_corners(source.pulse, scales.time)[:0], np.inf)",
        "the direct engine's loads of pulses with corners",
        "acoustics/test_far_sources.py",
    ),
    Mutation(
        "limited-share",
        "solver/limited_orders.py",
        "work / square if square > 0 else 1.0",
        "1.0",
        "share of saturating feedback that the orders above M get",
        "solver/test_limited_orders.py",
    ),
    Mutation(
        "unresolved-membranes",
        "solver/estimates.py",
        "STEP_FACTOR * membrane_error(",
        "0.0 * membrane_error(",
        "printed error of a march whose membranes the step does not resolve",
        "solver/test_estimates.py",
    ),
    # studies, paper, command line
    Mutation(
        "shared-structure",
        "studies/structures.py",
        "if self._prepared is None or self._structure != structure:",
        "if self._prepared is None:",
        "kernels of another structure for a case of a study",
        "studies/test_evaluation.py",
    ),
    Mutation(
        "shell-mass",
        "studies/reading.py",
        "math.pi * (outside**2 - inside**2)",
        "math.pi * (outside - inside) ** 2",
        "mass of a shell",
        "studies/test_metrics.py",
    ),
    Mutation(
        "metric-rms",
        "studies/reading.py",
        "np.trapezoid(values**2, time)",
        "np.trapezoid(values, time)",
        "RMS pressure over time in a study",
        "studies/test_metrics.py",
    ),
    Mutation(
        "reduction",
        "model/prefixes.py",
        "ratio = value / reference",
        "ratio = reference / value",
        "smaller or larger than which run",
        "model/test_prefixes.py",
    ),
)
