"""Claims about the damping of 25 absorbers: Fig. 10."""

from __future__ import annotations

from coaxshell.apps.paper import cases
from coaxshell.apps.paper.claims import systems
from coaxshell.apps.paper.claims.claim import Finding, claim, graded
from coaxshell.apps.paper.claims.measures import named, reduction, sentence, stress_changes
from coaxshell.apps.paper.known_runs import Runs
from coaxshell.apps.paper.observed import Observed

_PLACE = "Damping, Fig. 10"


def _damped(runs: Runs) -> dict[float, Observed]:
    return systems.varied(runs, cases.damping, cases.DAMPINGS)


@claim(
    _PLACE,
    "Damping up to c = 1e5 N s/m has a negligible influence.",
    "holds: at most 5 % relative L2 change of the inner stress at head and tail from the undamped ring, for 1e4 "
    "and 1e5; in part: at most 15 %",
)
def little_damping_does_nothing(runs: Runs) -> Finding:
    """Compare weak damping with none."""
    found = _damped(runs)
    changes = {c: stress_changes(found[c], found[0.0]) for c in (1e4, 1e5)}
    worst = max(max(of.values()) for of in changes.values())
    measured = {f"c = {c:g}, {name}": v for c, of in changes.items() for name, v in named(of, "change (%)").items()}
    why = "The stress changes by " + "; ".join(f"{sentence(of)} with {c:.0e} N s/m" for c, of in changes.items()) + "."
    return Finding(measured, graded(worst <= 0.05, worst <= 0.15), why)


def _falls(runs: Runs) -> dict[tuple[str, str], float]:
    found = _damped(runs)
    damped, plain = found[1e6].shells["inner"], found[0.0].shells["inner"]
    return {
        ("inner", "head"): reduction(damped.stress_head.value, plain.stress_head.value),
        ("inner", "tail"): reduction(damped.stress_tail.value, plain.stress_tail.value),
    }


@claim(
    _PLACE,
    "c = 1e6 N s/m suppresses the inner stress markedly.",
    "peak against the undamped ring; holds: at least 10 % lower at the inner head or tail and lower at the other; in part: lower at one",
)
def adopted_damping_suppresses(runs: Runs) -> Finding:
    """Measure the reduction of the peaks by damping."""
    falls = _falls(runs)
    most, least = max(falls.values()), min(falls.values())
    why = f"Against the undamped ring the peak falls by {sentence(falls, '{:.1f} %', 1.0)}."
    return Finding(named(falls, "reduction of the peak (%)", 1.0), graded(most >= 10.0 and least > 0.0, most > 0.0), why)


@claim(
    _PLACE,
    "It does so above all at the inner tail.",
    "holds: the peak falls by more at the tail than at the head; in part: the RMS in time does",
)
def damping_helps_the_tail_most(runs: Runs) -> Finding:
    """Compare the reductions at head and tail."""
    from coaxshell.apps.paper.claims.measures import rms

    found, falls = _damped(runs), _falls(runs)
    means = {
        ("inner", side): reduction(rms(found[1e6].stress("inner", side)), rms(found[0.0].stress("inner", side)))
        for side in ("head", "tail")
    }
    more = [of["inner", "tail"] > of["inner", "head"] for of in (falls, means)]
    why = f"The peak falls by {sentence(falls, '{:.1f} %', 1.0)}, the RMS in time by {sentence(means, '{:.1f} %', 1.0)}."
    measured = {**named(falls, "reduction of the peak (%)", 1.0), **named(means, "reduction of the RMS (%)", 1.0)}
    return Finding(measured, graded(more[0], more[1]), why)
