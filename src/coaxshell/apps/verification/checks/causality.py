"""Nothing moves before the first arrival, through solid or fluid."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.independent.walls import Wall
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Curve, Finding, Panel, Sheet, within
from coaxshell.model import presets
from coaxshell.model.system import System

QUIET = {0.0: 1e-8, 90.0: 1e-5, 180.0: 1e-5}
"""Largest motion of the inner shell before its first arrival, over the largest of all: truncation at M and dispersion show first."""

SOURCE = "theory 10; Fermat's principle"


@check("causality", "Causality")
def causality(bench: Bench) -> Iterator[Finding]:
    """Nothing moves before the first arrival: front outside, membrane wave in the outer shell, ray across the gap, membrane wave inside."""
    bare = presets.load("bare")
    response = bench.simulate(bare, duration=2.0, time_step=1e-3, modes=150)
    w = np.abs(response.solution.normal[0])
    early = float(w[..., response.time < 0.49].max() / w.max())
    yield _quiet("every order of the inner shell before t = 0.49 (the gap's width is 0.5)", early, 1e-9)
    largest = float(np.abs(np.asarray(response.displacement("inner"))).max())
    curves = []
    for angle, limit in QUIET.items():
        arrival = first_arrival(bare, angle)
        history = np.abs(np.asarray(response.displacement("inner", [angle]))[:, 0]) / largest
        early = float(history[response.time < arrival - 0.02].max())
        yield _quiet(f"inner shell at {angle:g}° before its first arrival at t = {arrival:.4f}", early, limit)
        started = float(history[response.time < arrival + 0.1].max())
        yield within(
            f"inner shell at {angle:g}° has begun 0.1 later",
            SOURCE,
            "> 1e-4",
            max(0.0, 1e-4 - started),
            0.0,
            found=f"{started:.2g}",
            measure="lacking",
        )
        curves.append(Curve(f"{angle:g}°", response.time, np.maximum(history, 1e-14)))
    yield Sheet(
        "First motion of the inner shell",
        "Magnitude of the displacement over the largest. The head is reached at t = 0.5, the sides and the tail through the shells.",
        [Panel("", "time (a/c)", "|w| / largest", curves, logarithmic=False), _log(curves)],
    )
    late = bare.replace(source=bare.source.replace(delay=1.5 / 1400))  # type: ignore[union-attr]
    w = np.abs((delayed := bench.simulate(late, duration=2.5, time_step=2e-3, modes=60)).solution.normal)
    yield _quiet("everything before a source that is 1.5 transits late", float(w[..., delayed.time < 1.48].max() / w.max()), 5e-8)


def _log(curves: list[Curve]) -> Panel:
    powers = [Curve(c.label, c.x, np.log10(c.y)) for c in curves]
    return Panel("", "time (a/c)", "log10 of it", powers)


def _quiet(what: str, found: float, limit: float) -> Finding:
    return within(what, SOURCE, "0", found, limit, found=f"{found:.2g}", measure="relative, largest")


def first_arrival(system: System, angle: float) -> float:
    """Return the least time from the front's touch at the head to the inner shell at an angle, in transits.

    The front runs outside, a membrane wave may run along the outer shell, a straight ray crosses the gap, another membrane wave
    runs along the inner shell; membrane speeds sqrt(a22/I)/c.
    """
    walls = [Wall.of(shell) for shell in system.shells]  # type: ignore[arg-type]
    inner, membrane = walls[0].radius, float(np.sqrt(walls[0].a22 / walls[0].inertia)) / system.exterior.sound_speed
    distance = system.source_distances[0] or 1e9
    x = np.radians(np.linspace(0, angle, 91))
    hit = np.sqrt(1 + distance**2 - 2 * distance * np.cos(x)) - (distance - 1)
    ahead = x - x[:, None]
    outer = np.min(hit[:, None] + np.where(ahead >= 0, ahead / membrane, np.inf), axis=0)
    ray = np.sqrt(1 + inner**2 - 2 * inner * np.cos(np.maximum(0, ahead)))
    crossed = np.min(np.where(ahead >= 0, outer[:, None] + ray, np.inf), axis=0)
    return float(np.min(crossed + (x[-1] - x) * inner / membrane))
