"""Claims about where one absorber sits: Fig. 8."""

from __future__ import annotations

import numpy as np

from coaxshell.apps.paper import cases
from coaxshell.apps.paper.absorbers import SHOWN
from coaxshell.apps.paper.claims import systems
from coaxshell.apps.paper.claims.claim import Finding, claim, graded
from coaxshell.apps.paper.claims.measures import named, sentence, sentence_case
from coaxshell.apps.paper.claims.stiffness import displacement_change
from coaxshell.apps.paper.known_runs import Runs
from coaxshell.apps.paper.observed import Observed

_PLACE = "Attachment position, Fig. 8"
_MEASURE = f"relative L2 change of the heads' displacement up to t = {SHOWN:g}; "
_SLACK = 0.02


def _offsets(runs: Runs) -> tuple[Observed, dict[float, Observed]]:
    found = dict(runs.each(cases.offset(systems.preset("bare")), resolution=runs.resolution.up_to(SHOWN)))
    return found["bare"], {angle: found[f"{angle:g}"] for angle in cases.OFFSETS}


@claim(
    _PLACE,
    "An offset of 3° changes the response noticeably.",
    _MEASURE + "from the absorber at the head; holds: at least 1 % on both shells; in part: on one",
)
def three_degrees_matter(runs: Runs) -> Finding:
    """Measure the change by an offset of 3 degrees."""
    _, found = _offsets(runs)
    changes = displacement_change(found[3.0], found[0.0])
    clear = [value >= 0.01 for value in changes.values()]
    return Finding(named(changes, "change by 3° (%)"), graded(all(clear), any(clear)), f"The displacement changes by {sentence(changes)}.")


@claim(
    _PLACE,
    "The difference from the absorber at the head grows with the offset.",
    _MEASURE + "from the absorber at the head; holds: never falls by more than 2 points from one offset to the next on either shell; "
    "in part: is larger at 60° than at 3° on both",
)
def difference_widens(runs: Runs) -> Finding:
    """Measure the differences from the absorber at the head."""
    _, found = _offsets(runs)
    away = {s: np.array([displacement_change(found[a], found[0.0])[s, "head"] for a in cases.OFFSETS]) for s in ("inner", "outer")}
    falls = {shell: float(np.max(-np.diff(values), initial=0.0)) for shell, values in away.items()}
    grows = all(values[-1] > values[1] for values in away.values())
    why = "; ".join(
        f"{shell} head: {100 * v[1]:.1f} % at 3°, {100 * v[10]:.1f} % at 30°, {100 * v[20]:.1f} % at 60°, largest fall between neighbours "
        f"{100 * falls[shell]:.1f} points"
        for shell, v in away.items()
    )
    measured = {
        f"{s} head, difference at {a:g}° (%)": 100 * float(v[i])
        for s, v in away.items()
        for i, a in enumerate(cases.OFFSETS)
        if a in (3, 30, 60)
    }
    return Finding(measured, graded(all(f <= _SLACK for f in falls.values()), grows), sentence_case(why))


def _fades(runs: Runs, angles: tuple[float, ...], limit: float, weaker: float) -> Finding:
    bare, found = _offsets(runs)
    effects = {angle: displacement_change(found[angle], bare) for angle in (0.0, *angles)}
    worst = max(max(effects[angle].values()) for angle in angles)
    why = "The absorber changes the displacement by " + "; ".join(f"{sentence(e)} at {a:g}°" for a, e in effects.items()) + "."
    measured = {f"{a:g}°, {name}": v for a, e in effects.items() for name, v in named(e, "effect (%)").items()}
    return Finding(measured, graded(worst <= limit, worst <= weaker), why)


@claim(
    _PLACE,
    "Beyond 30° the absorber's effect on the heads is marginal.",
    _MEASURE + "from bare, at 33° and 45°; holds: at most 5 % on both shells; in part: at most 10 %",
)
def marginal_beyond_30_degrees(runs: Runs) -> Finding:
    """Measure the effect beyond 30 degrees."""
    return _fades(runs, (33.0, 45.0), 0.05, 0.1)


@claim(
    _PLACE,
    "At 60° the heads move almost as in the bare system.",
    _MEASURE + "from bare; holds: at most 1 % on both shells; in part: at most 5 %",
)
def gone_at_60_degrees(runs: Runs) -> Finding:
    """Measure the effect at 60 degrees."""
    return _fades(runs, (60.0,), 0.01, 0.05)
