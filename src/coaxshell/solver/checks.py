"""Physics warnings: runs that are well formed but outside the range of the model or of the resolution.

Each is one sentence with both numbers and the remedy.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from coaxshell.acoustics.pulse_band import largest_after, pulse_end
from coaxshell.model.bubble import first_pulse
from coaxshell.model.feedback import Feedback
from coaxshell.model.gains import law_of, limits_currents, saturates, segments_of, ties_shells, wired
from coaxshell.model.parts import laws_of
from coaxshell.model.places import region_phrase, shell_phrase
from coaxshell.model.plausibility import remarks
from coaxshell.model.prefixes import engineering
from coaxshell.model.pulses import Sampled
from coaxshell.model.records.measures import energy_above, share_below
from coaxshell.model.sea import VAPOUR_PRESSURE
from coaxshell.model.sources import UnderwaterExplosion
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import ROLL_OFF, LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver import soft_layers, wetted_surfaces
from coaxshell.solver.cavitation import AMBIENT
from coaxshell.solver.delay_margin import delay_margin
from coaxshell.solver.electrodes import largest_demand
from coaxshell.solver.interface.absorbers import InterfacePoints, PointsAlone
from coaxshell.solver.interface.saturation import voltage_limit
from coaxshell.solver.limited_voltages import may_stop
from coaxshell.solver.rounds import rounds
from coaxshell.solver.scaling import Problem
from coaxshell.solver.settings import MAX_MODES, Settings
from coaxshell.solver.slice_error import slice_error
from coaxshell.solver.solid_spectra import band
from coaxshell.solver.solution import QUANTITIES, Estimates, ModalSolution
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.solver.tension import Tension
from coaxshell.solver.thin_error import thin_errors

TRUNCATION_LIMIT = 1e-2
STEP_LIMIT = 1e-3
MARCH_LIMIT = 1e-2
LINEAR_ACOUSTICS_LIMIT = 1e-2
VOLTAGE_LIMIT = 0.05
BUBBLE_LIMIT = 0.05
CUT_LIMIT = 0.1
"""Share of a pulse's peak that may come after the run."""
UNRESOLVED_LIMIT = 0.05
"""Share of a record's energy that may lie above what a run resolves; a sharp front with a decay of 0.13 ms has 0.02 at the defaults."""
THIN_LIMIT = 0.05
"""Estimated error of the hoop stress from which thin walls are told to be thin."""
SLICE_LIMIT = 0.05
"""Estimated error of the stress from which a slice through a spherical front is told to be one."""
USUAL_DELAY = 1e-5
"""Delay of a fast digital loop, s: one period of sampling at 100 kHz."""
FACES_HELP = 0.8
"""Share of the error below which wetted faces are worth naming."""
RESOLVED_ANGLE = 0.5
"""Radians a step up to which the trapezoidal rule is good to about 2 per cent of an oscillation's phase."""


def before(problem: Problem, grid: LaplaceGrid, max_order: int) -> list[str]:
    """Return the warnings that need no solution."""
    return (
        cut(problem, float(grid.time[-1]))
        + [f"{shell_phrase(i, len(problem.shells))}: {one}" for i, wall in enumerate(problem.shells) for one in wall.remarks()]
        + wetted_surfaces.remarks(problem)
        + soft_layers.remarks(problem, band(grid))
        + _resolved_membrane(problem, grid, max_order)
        + _linear_acoustics(problem)
        + _similitude(problem)
        + _bubbles(problem)
        + slice_of_sphere(problem, float(grid.time[-1]))
        + sea(problem, float(grid.time[-1]))
        + thin_walls(problem, float(grid.time[-1]))
        + _unresolved_records(problem, grid, max_order)
        + remarks(problem.system)
    )


def after(problem: Problem, estimates: Estimates, settings: Settings) -> list[str]:
    """Return the warnings about the error estimates, one a cause and shell: of displacement or stress, whichever is worse."""
    order = settings.modes
    assert isinstance(order, int)
    saturating = saturates(problem.system)  # of which "auto" does not know
    step, more = settings.time_step, f"modes={min(2 * order, MAX_MODES)}" + ("" if saturating else ' or modes="auto"')
    causes = [
        (f"orders above {order} would change", estimates.orders, TRUNCATION_LIMIT, more),
        (f"the band limit of time_step = {step:g} changes", estimates.time_step, STEP_LIMIT, f"time_step = {step / 2:g}"),
        (f"steps of {step / settings.refinement:g} of the interface's march change", estimates.march, MARCH_LIMIT, _finer(settings)),
    ]
    if estimates.axial is not None and settings.axial_modes is not None:
        highest = f"axial wavenumbers above {settings.axial_modes:g} (times a) would change"
        causes.append(
            (highest, estimates.axial, TRUNCATION_LIMIT, f'axial_modes={min(2 * settings.axial_modes, MAX_MODES):g} or modes="auto"')
        )
    warnings = []
    for what, errors, limit, remedy in causes:
        for i, pair in enumerate(errors):
            worst = int(np.nan_to_num(pair).argmax())
            if pair[worst] > limit:
                warnings.append(
                    f"{shell_phrase(i, len(problem.shells))}: {what} the {QUANTITIES[worst]} by {pair[worst]:.2g} (relative RMS), "
                    f"more than {limit:g}; use {remedy}"
                )
    return warnings


def _finer(settings: Settings) -> str:
    return f"time_step = {settings.time_step / 2:g} or refinement = {2 * settings.refinement}"


def absorbers(solved: SolvedSpectra, refinement: int) -> list[str]:
    """Return the warning about absorbers that vibrate faster than the step, time_step/*refinement*, resolves.

    The fastest motions are those of a shell's own points (their mobility over one step is the kernel's weight at lag 0, about
    dt/2 over the local mass) and of the absorber's mass on the tangent stiffness reached, k_l + 3 k_nl max D^2.
    """
    links, step = solved.absorbers, solved.grid.time_step
    if not solved.marched or links.count == 0:
        return []  # solved exactly, or none
    if solved.laws is not None:
        return swinging_on_laws(solved.laws.angle, step, refinement)
    points: InterfacePoints | PointsAlone
    if solved.problem.two_faced:
        points, present = InterfacePoints(solved.problem, links, solved.modes), _masses(solved.problem, step, solved.modes)
    else:
        seen = solved.passive if solved.actuation is not None or solved.seen is None else solved.seen
        points, present = seen.points(links), seen.kernels.present
    local = 2.0 / step * np.diag(points.immediate(present)).reshape(2, links.count).max(axis=0)
    force = np.abs(solved.force).max(axis=(1, 2))
    peak = np.zeros(links.count)
    np.maximum.at(peak, links.member, force)
    stretch = np.array([_stretch(f, k, c) for f, k, c in zip(peak, links.linear, links.cubic, strict=True)])
    tangent = links.linear + 3.0 * links.cubic * stretch**2
    inertia = np.divide(2.0, links.mass, out=np.zeros_like(links.mass), where=links.mass > 2.0 / local)
    fastest = float(np.sqrt(tangent * (local + inertia)).max())
    if fastest * step <= RESOLVED_ANGLE:
        return []
    factor = refinement * int(np.ceil(fastest * step / RESOLVED_ANGLE))
    return [
        f"absorbers: the stiffest vibrates at {fastest:.3g} per transit on the shell's own mass, {fastest * step:.2g} radians a step, "
        f"more than {RESOLVED_ANGLE:g}; use time_step = {refinement * RESOLVED_ANGLE / fastest:.2g} or refinement = {factor}"
    ]


def _masses(problem: Problem, step: float, modes: Modes) -> FloatArray:
    """Return the weights at lag 0 of surfaces that bear the mass of their walls alone: what a face yields at once does not vibrate."""
    mobility = [0.5 * step / problem.shells[surface.shell].mass for surface in problem.surfaces]
    return np.asarray(np.diag(mobility)[:, :, None] * np.ones(modes.count))


def swinging_on_laws(angle: float, step: float, refinement: int) -> list[str]:
    """Return the warning about laws of links on which something swings by more than the step resolves; *angle* in radians a step."""
    if angle <= RESOLVED_ANGLE:
        return []
    factor = refinement * int(np.ceil(angle / RESOLVED_ANGLE))
    return [
        f"absorbers: on the stiffest law of a link something swings by {angle:.2g} radians a step, more than {RESOLVED_ANGLE:g}; "
        f"use time_step = {refinement * step * RESOLVED_ANGLE / angle:.2g} or refinement = {factor}"
    ]


def actuators(*motions: ModalSolution) -> list[str]:
    """Return the warnings about actuators asked for more than their field limit, with the factor.

    The voltage is the mean over a segment (:mod:`coaxshell.solver.electrodes`), which converges with the orders; the largest of all
    stations in three dimensions.
    """
    warnings, problem = [], motions[0].problem
    for i, shell in enumerate(problem.shells):
        control = law_of(problem.system, i)
        if control is None or shell.gains is None or not wired(problem.system, i, "actuator"):
            continue
        limit = voltage_limit(problem, i)
        found = [one for one in (largest_demand(motion, i, limit) for motion in motions) if one is not None]
        if not found:
            continue
        asked = max(found, key=lambda one: one.value)
        label = shell_phrase(i, len(problem.shells))
        fewer = abs(asked.lower_half / asked.value - 1.0) > VOLTAGE_LIMIT
        half = f"; {engineering(asked.lower_half, 'V')} with half the orders: use more" if fewer else ""
        voltage = f"{engineering(asked.value, 'V')} (mean over {engineering(asked.segment, 'm')} of the wall{half})"
        stands, factor = engineering(limit, "V"), f"{asked.value / limit:.3g} times"
        if control.saturation:
            outcome = f"the voltage was held at {stands}, where the law asked for {voltage} ({factor} as much)"
            remedy = "lower the gains to stay within what the actuator can do"
        else:
            outcome = f"the control law asks for {voltage}, {factor} the {stands} its actuator stands"
            known = may_stop(problem) and not limits_currents(problem.system)
            see = "set control.saturation = true to see what it can really do, or " if known else ""
            remedy = f"{see}lower the gains"
        warnings.append(f"{label}: {outcome}; {remedy}")
    return warnings


def ideal_loop(problem: Problem, settings: Settings) -> list[str]:
    """Return the warning that feedback by electrodes is computed without any delay, with that which it would stand."""
    laws = [law for law in laws_of(problem.system) if law.transducers == "electrodes"]
    if not laws:
        return []
    assert isinstance(settings.modes, int)
    margin = delay_margin(problem, settings.modes, settings.duration)
    if margin is None or margin.delay > USUAL_DELAY:
        return []
    known = max(law.delay if isinstance(law, Feedback) else 0.0 for law in laws)
    if known:
        return [
            f"control: {engineering(margin.delay, 's')} more than the loop's delay of {engineering(known, 's')} would make "
            f"{margin.grows} grow, and electronics take about {engineering(USUAL_DELAY, 's')}; lower the gains, or feed fewer orders back"
        ]
    return [
        f"control: the loop is ideal, without delay: {engineering(margin.delay, 's')} of it would make {margin.grows} grow, "
        f"and electronics take about {engineering(USUAL_DELAY, 's')}; read the run as the limit of what feedback can do, or lower the gains"
    ]


def _stretch(force: float, linear: float, cubic: float) -> float:
    """Return the real D >= 0 of k_l D + k_nl D^3 = f."""
    if cubic == 0.0:
        return force / linear if linear > 0 else 0.0
    roots = np.roots([cubic, 0.0, linear, -force])
    return float(roots[np.abs(roots.imag) <= 1e-9 * np.abs(roots).max() + 1e-300].real.max(initial=0.0))


def _resolved_membrane(problem: Problem, grid: LaplaceGrid, max_order: int) -> list[str]:
    warnings = []
    for i, wall in enumerate(problem.shells):
        highest = float(wall.highest_frequency(Modes(np.array([float(max_order)])))[0])
        if highest > grid.nyquist:
            warnings.append(
                f"{shell_phrase(i, len(problem.shells))}: the membrane frequency of order {max_order} is {highest:.4g} per transit, above "
                f"the {grid.nyquist:.4g} that time_step = {grid.time_step:g} resolves; use time_step = {np.pi / highest:.2g} or fewer modes"
            )
    return warnings


def _linear_acoustics(problem: Problem) -> list[str]:
    warnings = []
    for source in problem.system.sources:
        ratio = abs(source.pulse.peak) / problem.scales.pressure
        if ratio > LINEAR_ACOUSTICS_LIMIT:
            warnings.append(
                f"source: peak pressure/(density sound_speed^2) = {ratio:.2g} is above {LINEAR_ACOUSTICS_LIMIT:g}, where the pressure "
                "wave is no longer linear; use a lower peak or a greater stand-off"
            )
    return warnings


def cut(problem: Problem, duration: float) -> list[str]:
    """Return a warning for each source whose pulse goes on at the head when the run of *duration* transits ends."""
    warnings, transit = [], problem.scales.time
    for source in problem.system.sources:
        left = (duration * transit) - source.delay
        end, going_on = pulse_end(source.pulse), largest_after(source.pulse, left)
        if going_on <= CUT_LIMIT * abs(source.pulse.peak):
            continue
        whole = end + source.delay
        warnings.append(
            f"source: the run ends after {duration:.4g} transits ({engineering(duration * transit, 's')}), but the pressure goes on until "
            f"{whole / transit:.4g} ({engineering(whole, 's')}), with up to {going_on / abs(source.pulse.peak):.2g} of its peak still to "
            f"come; use duration={_above(whole / transit)} or cut the pulse"
        )
    return warnings


def slice_of_sphere(problem: Problem, duration: float) -> list[str]:
    """Return the warning that a run of *duration* transits in two dimensions solves a slice through spherical fronts."""
    error = slice_error(problem, duration)
    if error.value <= SLICE_LIMIT:
        return []
    about, low, high, limit = (f"{100.0 * value:.0f}" for value in (error.value, error.low, error.high, SLICE_LIMIT))
    changed = " without saturation" if saturates(problem.system) and problem.system.absorber_list else ""
    if problem.system.absorber_list and (segments_of(problem.system) is not None or ties_shells(problem.system)):
        changed = " without absorbers"  # beside which segments and matrices are refused there
    return [
        f"source: two dimensions solve a slice through a spherical front, whose hoop stress differs from the sphere's by about "
        f"{about} % (relative RMS; {low} to {high} % as systems differ), more than {limit} %; use dimensions=3{changed}"
    ]


def sea(problem: Problem, duration: float) -> list[str]:
    """Return the warning that a run of *duration* transits goes on after a scattered wave is back that it leaves out, and from when."""
    planned = rounds(problem, duration)
    until = planned.exact_until(planned.done if problem.dimensions == 2 else 0)
    if duration <= until:
        return []
    when = f"t = {until:.4g} ({engineering(until * problem.scales.time, 's')})"
    if problem.dimensions == 3:
        return [
            f"sea: three dimensions reflect the sources alone, which is exact until {when}, when what the shells scatter is back; this run "
            f"lasts until {duration:.4g}: use duration={until:.4g}, or dimensions=2, which goes on"
        ]
    nearest = (problem.planes.nearest if problem.planes is not None else 0.0) * problem.scales.length
    return [
        f"sea: {planned.needed} reflections of the scattered wave come within the run, more than the {planned.done} that are added up; "
        f"it is exact until {when}: use duration={until:.4g}, or a plane further away than {nearest:.4g} m"
    ]


def thin_walls(problem: Problem, duration: float) -> list[str]:
    """Return a warning for each thin wall that is far from an exact one in a run of *duration* transits."""
    found = []
    for error in thin_errors(problem, duration):
        if error.value <= THIN_LIMIT:
            continue
        about, low, high, faces, limit = (
            f"{100.0 * value:.0f}" for value in (error.value, error.low, error.high, error.at_faces, THIN_LIMIT)
        )
        remedies = [f'wetted = "faces" (about {faces} %)'] if error.at_faces < FACES_HELP * error.value else []
        remedies.append('theory = "elastic"')
        where = "faces" if error.wetted == "faces" else "mid-surface"
        found.append(
            f"{shell_phrase(error.shell, len(problem.shells))}: thin-wall theory with fluids at its {where} leaves its hoop stress about "
            f"{about} % from an exact wall's (relative RMS; {low} to {high} % as systems differ), more than {limit} %; "
            f"use {' or '.join(remedies)}"
        )
    return found


def _above(value: float) -> str:
    """Return a number of two digits that is not below a value."""
    step = 10.0 ** (np.floor(np.log10(value)) - 1)
    return f"{np.ceil(value / step * (1 - 1e-12)) * step:.12g}"


def _unresolved_records(problem: Problem, grid: LaplaceGrid, max_order: int) -> list[str]:
    """Return a warning for each measured record with much of its energy above what orders or time step resolve.

    A wave of omega meets the outermost wall with the orders up to k a = omega a/c_e, in transits omega itself, so that order M resolves
    omega = M there; a time step resolves what its roll-off leaves of pi/dt.
    """
    hertz = 1.0 / (2.0 * np.pi * problem.scales.time)
    orders, step = max_order * hertz, (1.0 - ROLL_OFF) * grid.nyquist * hertz
    lowest, warnings = min(orders, step), []
    for pulse in (source.pulse for source in problem.system.sources if not isinstance(source, UnderwaterExplosion)):
        if not isinstance(pulse, Sampled) or (share := energy_above(*pulse.spectrum, lowest)) <= UNRESOLVED_LIMIT:
            continue
        needed = share_below(*pulse.spectrum, 1.0 - UNRESOLVED_LIMIT) / hertz
        remedies = [f"modes={int(np.ceil(needed))}"] if max_order < needed <= MAX_MODES else []
        remedies += [f"time_step = {(1.0 - ROLL_OFF) * np.pi / needed:.2g}"] if step / hertz < needed else []
        warnings.append(
            f"source: {100 * share:.2g} % of the record's energy, more than {100 * UNRESOLVED_LIMIT:g} %, lies above "
            f"{engineering(lowest, 'Hz')}: order {max_order} resolves up to {engineering(orders, 'Hz')} at the wall, time_step = "
            f"{grid.time_step:g} up to {engineering(step, 'Hz')}; use {' and '.join(remedies)}{', or ' if remedies else ''}resample the "
            "record, if what lies above is noise"
        )
    return warnings


def _similitude(problem: Problem) -> list[str]:
    """Return a warning for each charge whose peak lies outside the range that its similitude was fitted to."""
    warnings = []
    for source in problem.system.sources:
        if isinstance(source, UnderwaterExplosion) and not source.within_fit:
            fit = source.constants
            low, high, peak = (engineering(value, "Pa") for value in (fit.lowest, fit.highest, source.peak_pressure))
            nearer = source.peak_pressure < fit.lowest
            warnings.append(
                f"source: the similitude of {fit.name} was fitted to peaks from {low} to {high}, but this charge gives {peak} at the head; "
                f"{'lessen' if nearer else 'increase'} the stand-off, or give the pressure itself as a spherical-shock"
            )
    return warnings


def _bubbles(problem: Problem) -> list[str]:
    """Return a warning for each charge of whose bubble the model and the similitude disagree about the time of the first pulse."""
    warnings = []
    for number, source in enumerate(problem.system.sources):
        if not isinstance(source, UnderwaterExplosion) or source.bubble is None or source.charge_depth is None:
            continue
        factor, period = source.constants.bubble_radius, source.bubble.period
        assert factor is not None
        found = first_pulse(source.charge_mass, source.charge_depth, factor)
        if abs(found / period - 1.0) > BUBBLE_LIMIT:
            warnings.append(
                f"sources[{number}]: the first bubble pulse comes {engineering(found, 's')} after the shock wave, "
                f"{engineering(period, 's')} by the similitude of {source.explosive}, more than {100 * BUBBLE_LIMIT:g} % apart: the charge "
                "lies outside what its model was checked for, 1 to 500 kg and 10 to 100 m deep; give the pressure itself as a "
                "spherical-wave with a sampled pulse"
            )
    return warnings


def tension(problem: Problem, found: Iterable[Tension]) -> list[str]:
    """Return a warning for each wetted surface on which the water would be torn."""
    count = len(problem.shells)
    warnings = []
    for low in found:
        fluid = region_phrase(low.region, count)
        when = f"t = {low.time:.3g} ({engineering(low.time * problem.scales.time, 's')}), {low.angle:.0f} degrees"
        if low.region == count and problem.system.sea is not None:
            warnings.append(_cavitation(problem, low, fluid))
            continue
        stands = "water at the surface of the sea would cavitate there, which a depth might prevent: a system with a sea has one"
        if problem.system.sea is not None:
            stands = "water under the atmosphere alone would cavitate there, and what shells enclose may be sealed from the sea's pressure"
        extent = f"over up to {low.width:.0f} degrees at once, for {engineering(low.lasting * problem.scales.time, 's')} in all"
        warnings.append(
            f"{shell_phrase(low.shell, count)}: the total pressure of {fluid} on it falls to {engineering(low.pressure, 'Pa')} at {when}, "
            f"and below {engineering(-AMBIENT, 'Pa')} {extent}: {stands}; lower the source's pressure, or take what follows with care"
        )
    return warnings


def _cavitation(problem: Problem, low: Tension, fluid: str) -> str:
    """Return the warning that water at a known depth cavitates on a wall."""
    transit, count = problem.scales.time, len(problem.shells)
    absolute, vapour = low.pressure - low.least + VAPOUR_PRESSURE, engineering(VAPOUR_PRESSURE, "Pa")
    first = f"t = {low.first:.3g} ({engineering(low.first * transit, 's')}) at {low.first_angle:.0f} degrees"
    worst = f"{engineering(absolute, 'Pa')} at t = {low.time:.3g}, {low.angle:.0f} degrees"
    extent = f"up to {low.width:.0f} degrees at once, for {engineering(low.lasting * transit, 's')} in all"
    return (
        f"{shell_phrase(low.shell, count)}: the absolute pressure of {fluid} on it falls below that of vapour, {vapour}, first at {first}, "
        f"over {extent}; it would be {worst}. Water cavitates there, which no run knows: read what follows as linear acoustics, lower the "
        "source's pressure or lay the axis deeper; response.cavitation() maps it"
    )
