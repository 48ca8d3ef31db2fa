"""What physics says of any run, whatever the system: each oracle returns a relative mismatch, None where it says nothing.

Systems are changed by their descriptions alone (rotated, mirrored, scaled, split, ...), run afresh and compared with what that change does
to the modal amplitudes.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from random_systems import Case

import coaxshell as cx
from coaxshell.model.absorbers import gaps_of

Oracle = Callable[[Case, cx.Response], float | None]
ROTATION, SCALE, SHIFT, LOUDER = 77.0, 3.0, 24, 2.0
ANGLES = 1440
SPREAD = 4
"""Steps before an arrival by which the band limit spreads what moves afterwards."""

LIMITS = {
    "finite": 0.0,
    "rotation": 1e-9,
    "mirror": 1e-9,
    "scaling": 1e-9,
    "amplitude": 1e-9,
    "superposition": 1e-9,
    "delay": 1e-4,
    "causality": 1e-5,
    "split layers": 1e-9,
    "ghost shell": 1e-6,
    "prepared": 1e-9,
    "saved": 0.0,
    "peaks": 1e-3,
    "highest": 1e-5,
    "parseval": 1e-9,
    "energy": 1e-2,
    "engines": 0.5,
}
"""Largest mismatch allowed; marched interfaces, whose Newton iterations stop at 1e-10 of a step, may have MARCHED instead of 1e-9."""
MARCHED = 1e-4


OF_THE_RESULT = {"highest", "parseval"}
"""Those that run nothing again."""
OF_THE_STEP = {"delay", "causality", "energy"}
"""Those that a step too long breaks by itself: the error that a run prints of its step is allowed too."""


def limit(name: str, case: Case, response: cx.Response) -> float:
    """Return the mismatch allowed for a case."""
    allowed = LIMITS[name]
    if ("cubic" in case.kind or "saturated" in case.kind) and 0.0 < allowed < MARCHED and name not in OF_THE_RESULT:
        allowed = MARCHED
    if name in OF_THE_STEP:
        printed = response.errors().sel(cause=["time step", "march"]).sum("cause")
        told = printed.sel(quantity="displacement").values
        size = np.linalg.norm(response.solution.normal.reshape(told.size, -1), axis=1)
        of_the_largest = (told * size).max() / max(size.max(), 1e-300)
        allowed = max(allowed, float(printed.max() if name == "energy" else of_the_largest))
    return allowed


def mismatch(found: np.ndarray, expected: np.ndarray) -> float:
    """Return |found - expected|/|expected|, modal amplitudes (shells, parities, M + 1, T), all shells in one; a missing parity is zero."""
    parities = max(found.shape[1], expected.shape[1])
    found, expected = (np.pad(x, [(0, 0), (0, parities - x.shape[1]), (0, 0), (0, 0)]) for x in (found, expected))
    size = float(np.linalg.norm(expected))
    return float(np.linalg.norm(found - expected)) / size if size else float(np.linalg.norm(found))


def run(case: Case, system: cx.System) -> np.ndarray:
    return cx.simulate(system, **case.settings).solution.normal


def several(value: Any) -> list[Any]:
    return list(value) if isinstance(value, tuple | list) else [value]


def with_absorbers(system: cx.System, change: Callable[[Any, str], Any]) -> Any:
    """Return the absorbers, each changed; ``change`` also learns the name of the angle's field."""
    if isinstance(system.absorbers, cx.AbsorberRing):
        return change(system.absorbers, "offset")
    return [change(one, "angle") for one in system.absorbers]


def finite(case: Case, response: cx.Response) -> float:
    solution = response.solution
    arrays = [solution.normal, solution.tangential, solution.absorber_force, solution.absorber_displacement, solution.estimates.by_cause()]
    return float(sum(np.count_nonzero(~np.isfinite(x)) for x in arrays if x is not None))


def rotation(case: Case, response: cx.Response) -> float:
    def by(angle: float) -> float:
        return (angle + ROTATION + 180.0) % 360.0 - 180.0

    system = case.system
    turned = system.replace(
        source=[one.replace(angle=by(one.angle)) for one in system.sources],
        absorbers=with_absorbers(system, lambda one, angle: one.replace(**{angle: by(getattr(one, angle))})),
    )
    cosine, sine = (np.pad(response.solution.normal, [(0, 0), (0, 1), (0, 0), (0, 0)])[:, half] for half in (0, 1))
    phase = np.radians(ROTATION * np.arange(cosine.shape[1]))[:, None]
    expected = [cosine * np.cos(phase) - sine * np.sin(phase), cosine * np.sin(phase) + sine * np.cos(phase)]
    return mismatch(run(case, turned), np.stack(expected, axis=1))


def mirror(case: Case, response: cx.Response) -> float:
    system = case.system
    mirrored = system.replace(
        source=[one.replace(angle=-one.angle) for one in system.sources],
        absorbers=with_absorbers(system, lambda one, angle: one.replace(**{angle: -getattr(one, angle)})),
    )
    expected = response.solution.normal.copy()
    expected[:, 1:] *= -1.0
    return mismatch(run(case, mirrored), expected)


def scaling(case: Case, response: cx.Response) -> float:
    """All lengths and times grow alike, pressures stay."""
    system = case.system

    def shell(one: Any) -> Any:
        layers = {} if one.thickness == 0 else {"layers": [x.replace(thickness=x.thickness * SCALE) for x in one.layers]}
        return one.replace(radius=one.radius * SCALE, **layers)

    def source(one: Any) -> Any:
        far = {} if one.distance is None else {"distance": one.distance * SCALE}
        return one.replace(delay=one.delay * SCALE, pulse=slower(one.pulse), **far)

    def absorber(one: Any, _: str) -> Any:
        return one.replace(mass=one.mass * SCALE**2, damping=one.damping * SCALE, cubic_stiffness=one.cubic_stiffness / SCALE**2)

    larger = system.replace(
        shells=[shell(one) for one in system.shells],
        source=[source(one) for one in system.sources],
        absorbers=with_absorbers(system, absorber),
    )
    return mismatch(run(case, larger), response.solution.normal)


def slower(pulse: Any) -> Any:
    names = {"decay_time", "rise_time", "width", "centre"} & set(type(pulse).model_fields)
    if isinstance(pulse, cx.Sampled):
        return pulse.replace(time=[t * SCALE for t in pulse.time])
    return pulse.replace(**{name: getattr(pulse, name) * SCALE for name in names})


def louder(pulse: Any, factor: float) -> Any:
    if isinstance(pulse, cx.Sampled):
        return pulse.replace(pressure=[p * factor for p in pulse.pressure])
    name = "pressure" if isinstance(pulse, cx.Step) else "peak_pressure"
    return pulse.replace(**{name: getattr(pulse, name) * factor})


def amplitude(case: Case, response: cx.Response) -> float:
    """Twice the pressure makes twice the answer, if cubic springs are a quarter and field limits twice as high."""
    system = case.system
    control = system.control
    if control is not None and control.saturation:
        control = control.replace(field_limit=control.field_limit * LOUDER)
    changed = system.replace(
        source=[one.replace(pulse=louder(one.pulse, LOUDER)) for one in system.sources],
        absorbers=with_absorbers(system, lambda one, _: one.replace(cubic_stiffness=one.cubic_stiffness / LOUDER**2)),
        control=control,
    )
    return mismatch(run(case, changed) / LOUDER, response.solution.normal)


def superposition(case: Case, response: cx.Response) -> float | None:
    if len(case.system.sources) < 2 or "cubic" in case.kind or "saturated" in case.kind:
        return None
    parts = [run(case, case.system.replace(source=one)) for one in case.system.sources]
    parities = max(part.shape[1] for part in parts)
    return mismatch(sum(np.pad(x, [(0, 0), (0, parities - x.shape[1]), (0, 0), (0, 0)]) for x in parts), response.solution.normal)


@lru_cache(maxsize=1)
def delayed(case: Case) -> np.ndarray:
    """Return the motion with all sources SHIFT steps later."""
    system = case.system
    later = SHIFT * case.settings["time_step"] * system.transit_time
    return run(case, system.replace(source=[one.replace(delay=one.delay + later) for one in system.sources]))


def delay(case: Case, response: cx.Response) -> float:
    """A delay of all sources by some steps shifts the answer."""
    expected = np.zeros_like(response.solution.normal)
    expected[..., SHIFT:] = response.solution.normal[..., :-SHIFT]
    return mismatch(delayed(case), expected)


def causality(case: Case, response: cx.Response) -> float:
    """Nothing moves before the first front: at the outermost shell with the source, at the next one a gap's transit later or, through an
    absorber's springs, at once; behind a vacuum never. Relative to the largest motion of all."""
    system, motion = case.system, delayed(case)
    step, transit = case.settings["time_step"], system.transit_time
    linked = {gap for absorber in system.absorber_list for gap in gaps_of(absorber)}
    arrival = min(one.delay for one in system.sources) + SHIFT * step * transit
    largest, early = float(np.abs(motion).max()), 0.0
    for i in reversed(range(len(system.shells))):
        if i < len(system.shells) - 1 and i not in linked:
            gap, fluid = system.shells[i + 1].radius - system.shells[i].radius, system.fluids[i + 1]
            arrival += gap / fluid.sound_speed if isinstance(fluid, cx.Fluid) else np.inf
        before = response.time < arrival / transit - SPREAD * step
        early = max(early, float(np.abs(motion[i][..., before]).max(initial=0.0)))
    return early / largest if largest else early


def split_layers(case: Case, response: cx.Response) -> float:
    def shell(one: Any) -> Any:
        if one.thickness == 0:
            return one
        layers = []
        for layer in one.layers:
            whole = layer.role in ("sensor", "actuator")
            layers += [layer] if whole else [layer.replace(thickness=part * layer.thickness) for part in (0.3, 0.7)]
        return one.replace(layers=layers)

    return mismatch(run(case, case.system.replace(shells=[shell(one) for one in case.system.shells])), response.solution.normal)


def ghost_shell(case: Case, response: cx.Response) -> float | None:
    """A wall of hardly any mass or stiffness in the middle of a fluid changes nothing."""
    system = case.system
    if system.absorber_list or system.control is not None:
        return None
    regions = [i for i in range(len(system.shells)) if isinstance(system.fluids[i], cx.Fluid)]
    regions = [i for i in regions if not isinstance(system.shells[i], cx.RigidShell)]
    if not regions:
        return None
    i = regions[-1]
    radius = 0.5 * (system.shells[i].radius + (system.shells[i - 1].radius if i else 0.0))
    nothing = cx.Elastic(name="nothing", density=1e-3, youngs_modulus=1e-3, poisson_ratio=0.0)
    ghost = cx.Shell(radius=radius, layers=[cx.Layer(nothing, 1e-5 * radius)])
    shells = [*system.shells[:i], ghost, *system.shells[i:]]
    fluids = [*system.fluids[: i + 1], *system.fluids[i:]]
    found = run(case, system.replace(shells=shells, fluids=fluids))
    return mismatch(np.delete(found, i, axis=0), response.solution.normal)


def prepared(case: Case, response: cx.Response) -> float:
    structure = cx.prepare(case.system.replace(absorbers=()), **case.settings)
    found = structure.simulate(case.system.absorbers)
    errors = np.nan_to_num(found.estimates.by_cause() - response.estimates.by_cause())
    return max(mismatch(found.solution.normal, response.solution.normal), float(np.abs(errors).max()))


def saved(case: Case, response: cx.Response) -> float:
    with tempfile.TemporaryDirectory() as folder:
        loaded = cx.load_response(response.save(Path(folder) / "run.nc"))
    pairs = [(loaded.solution.normal, response.solution.normal), (loaded.estimates.by_cause(), response.estimates.by_cause())]
    return float(max(np.nanmax(np.abs(a - b)) for a, b in pairs))


def peaks(case: Case, response: cx.Response) -> float:
    """The summary's peaks are those of histories at many angles, not above them."""
    return max((value / max(dense, 1e-300) - 1.0 for value, dense in _peaks(case, response)), default=0.0)


def highest(case: Case, response: cx.Response) -> float:
    """Nor below them."""
    return max((1.0 - value / dense for value, dense in _peaks(case, response) if dense > 0), default=0.0)


def _peaks(case: Case, response: cx.Response) -> list[tuple[float, float]]:
    elastic = [i for i, shell in enumerate(case.system.shells) if shell.thickness > 0]
    dense = [float(np.abs(response.stress(i, np.arange(ANGLES) * 360.0 / ANGLES)).max()) for i in elastic]
    return [(shell.stress.value, one) for shell, one in zip(response.summary().shells, dense, strict=True)]


def parseval(case: Case, response: cx.Response) -> float:
    summary, worst = response.summary(), 0.0
    elastic = [i for i, shell in enumerate(case.system.shells) if shell.thickness > 0]
    for i, shell in zip(elastic, summary.shells, strict=True):
        dense = np.asarray(response.stress(i, np.arange(ANGLES) * 360.0 / ANGLES))
        square = np.trapezoid((dense**2).mean(axis=1), response.time) / float(np.ptp(response.time))
        worst = max(worst, abs(shell.stress_rms - np.sqrt(square)) / max(np.sqrt(square), 1e-300))
    return worst


def energy(case: Case, response: cx.Response) -> float:
    return float(np.abs(response.energy()["closure_relative"]).max())


def engines(case: Case, response: cx.Response) -> float | None:
    """The direct engine tells the same to its own error; None where its step is unstable."""
    try:
        found = cx.simulate(case.system, **case.settings, engine="direct", refinement=2)
    except cx.InputError:
        return None
    return mismatch(found.solution.normal, response.solution.normal)


ORACLES: dict[str, Oracle] = {
    "finite": finite,
    "rotation": rotation,
    "mirror": mirror,
    "scaling": scaling,
    "amplitude": amplitude,
    "superposition": superposition,
    "delay": delay,
    "causality": causality,
    "split layers": split_layers,
    "ghost shell": ghost_shell,
    "prepared": prepared,
    "saved": saved,
    "peaks": peaks,
    "highest": highest,
    "parseval": parseval,
    "energy": energy,
    "engines": engines,
}
