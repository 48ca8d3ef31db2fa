"""Three dimensions added up at stations: integrals along the axis, sources far away, images kept out, causality along the wall."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.independent.sphere import along_axis
from coaxshell.apps.verification.independent.walls import Wall
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Curve, Finding, Panel, Sheet, close, distance, within
from coaxshell.apps.verification.systems import BROAD, SMOOTH_SPHERE
from coaxshell.model import presets
from coaxshell.model.pulses import Sampled
from coaxshell.model.shells import Shell
from coaxshell.model.sources import LineWave, PlaneWave
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray

ANGLES = (0.0, 60.0, 180.0)
START = SMOOTH_SPHERE.distance - 1.0
THEORY = "theory 4"
FAR = "plane wave in two dimensions; the rest falls as 1/R0"
EARLY = "Fermat's principle: front, or membrane wave from where it passed"


@check("stations", "Three dimensions, added up at stations")
def stations(bench: Bench) -> Iterator[Finding]:
    """Compare what stations along the axis tell with two dimensions and with causality, under a true spherical wave and a smooth pulse.

    Integrals along the axis are the answer to a line source; a source far away is a plane wave; a longer axial period changes nothing;
    and no point of a wall moves before the front, or a wave of the walls that has left it behind, is there.
    """
    bare = presets.load("bare").replace(source=SMOOTH_SPHERE)
    yield from integral(bench, bare)
    bench.done(0.2)
    yield from far_sources(bench, bare)
    bench.done(0.5)
    yield from period(bench, bare)
    bench.done(0.7)
    yield from causality(bench, bare)


def integral(bench: Bench, bare: System) -> Iterator[Finding]:
    """Compare integrals along the axis, by the trapezoidal rule at stations over a period, with the answer to a line source.

    The line source's pressure at the head is the integral of the spherical wave's along the axis.
    """
    modes, duration, axial_period = 8, 2.0, 18.0
    half = 12  # more than k_max L/(4 pi): the rule is exact
    z = np.arange(half + 1) * axial_period / (2 * half)
    weights = np.where((z == 0) | (z == z[-1]), 1.0, 2.0) * z[1]
    time, scales = np.linspace(0, duration + 0.01, 20101), (1 / 1400, 1.0)
    head = 2 * START * along_axis(BROAD, START, 0.0, time + START, np.polynomial.legendre.leggauss(100), *scales)[0]
    line = bare.replace(source=LineWave(distance=SMOOTH_SPHERE.distance, pulse=Sampled(time=time * scales[0], pressure=head)))
    common = {"duration": duration, "time_step": 4e-3, "modes": modes}
    sphere = bench.simulate(bare, **common, dimensions=3, stations=z, axial_period=axial_period)
    plane = bench.simulate(line, **common)
    for shell in ("inner", "outer"):
        for quantity in ("displacement", "stress"):
            added = np.einsum("tza,z->ta", np.asarray(getattr(sphere, quantity)(shell, ANGLES)), weights)
            error = distance(added, getattr(plane, quantity)(shell, ANGLES))
            yield within(
                f"integral of {quantity} along the {shell} shell", f"{THEORY}; line source in two dimensions", "the same", error, 1e-7
            )


def far_sources(bench: Bench, bare: System) -> Iterator[Finding]:
    """Compare sources at 50 and 200 radii with a plane wave: the difference falls as 1/R0."""
    common = {"duration": bench.choose(1.0, 1.6), "time_step": 1e-2, "modes": 20}
    plane = bench.simulate(bare.replace(source=PlaneWave(pulse=BROAD)), **common)
    errors = {}
    for far in (50.0, 200.0):
        sphere = bench.simulate(bare.replace(source=SMOOTH_SPHERE.replace(distance=far)), **common, dimensions=3, stations=[0.0])
        errors[far] = [distance(sphere.stress(shell, ANGLES, station=0.0), plane.stress(shell, ANGLES)) for shell in ("inner", "outer")]
    yield within("source at 200 a: stress against the plane wave's", FAR, "the same", max(errors[200.0]), 0.02)
    for shell, near, far in zip(("inner", "outer"), errors[50.0], errors[200.0], strict=True):
        yield close(f"{shell} shell: distance to the plane wave, 50 a over 200 a", FAR, 4.0, near / far, 0.1)


def period(bench: Bench, bare: System) -> Iterator[Finding]:
    """Compare the axial period that causality asks for with one half as long again."""
    common = {"duration": bench.choose(1.2, 2.0), "time_step": 1e-2, "modes": bench.choose(40, 60), "dimensions": 3, "stations": [0.0, 1.0]}
    least = bench.simulate(bare, **common)
    longer = bench.simulate(bare, **common, axial_period=1.5 * float(least.settings.axial_period or 0.0))
    for shell in ("inner", "outer"):
        error = distance(least.stress(shell, ANGLES), longer.stress(shell, ANGLES))
        yield within(f"{shell} shell, stress: axial period by causality, and one 1.5 times as long", THEORY, "the same", error, 1e-7)


def causality(bench: Bench, bare: System) -> Iterator[Finding]:
    """Hold every point of the walls at a station at rest until the first arrival there."""
    places, duration = bench.choose(([1.0, 2.0], 2.0), ([1.0, 2.0, 3.0, 4.0], 3.0))
    response = bench.simulate(bare, duration=duration, time_step=1e-2, modes=60, dimensions=3, stations=places)
    angles, curves = np.arange(0.0, 181.0, 10.0), []
    for shell in ("outer", "inner"):
        moved: FloatArray = np.abs(np.asarray(response.displacement(shell, angles))).max(axis=-1)
        for station, history in zip(places, moved.T, strict=True):
            arrival = first_arrival(bare, station)
            early = float(history[response.time < arrival].max() / history.max())
            what = f"{shell} shell at z = {station:g} m before its first arrival at t = {arrival:.4f}"
            yield within(what, EARLY, "0", early, 1e-8, found=f"{early:.2g}", measure="relative, largest")
            if shell == "outer":
                began = float(history[response.time < arrival + 0.5].max() / history.max())
                what = f"outer shell at z = {station:g} m has begun 0.5 later"
                yield within(what, EARLY, "> 1e-5", max(0.0, 1e-5 - began), 0.0, found=f"{began:.2g}", measure="lacking")
                curves.append(Curve(f"z = {station:g} m", response.time - arrival, np.log10(np.maximum(history / history.max(), 1e-12))))
    yield Sheet(
        "First motion along the outer shell",
        "Largest normal motion around the shell over the largest of all, against the time since the first arrival at that station.",
        [Panel("outer shell", "time since first arrival (a/c)", "log10 of |w| / largest", curves)],
    )


def first_arrival(system: System, z: float) -> float:
    """Return when a shock is first felt at z, in transits, all lengths in m with a = 1 m: by the front, or by a membrane wave that left it.

    The front reaches z' at sqrt(S^2 + z'^2) - S, and from any z' a wave of the speed c runs on along the wall: the least over z'.
    """
    walls = [Wall.of(shell) for shell in system.shells if isinstance(shell, Shell)]
    fastest = max(float(np.sqrt(wall.a11 / wall.inertia)) for wall in walls) / system.exterior.sound_speed
    left = np.linspace(0.0, z, 2001)
    return float((np.hypot(START, left) - START + (z - left) / fastest).min())
