"""Claims about an absorber's linear stiffness: Fig. 5."""

from __future__ import annotations

import numpy as np

from coaxshell.apps.paper import cases
from coaxshell.apps.paper.claims import systems
from coaxshell.apps.paper.claims.claim import Finding, claim, graded
from coaxshell.apps.paper.claims.measures import change, named, onset, reduction, sentence, stress_changes
from coaxshell.apps.paper.known_runs import Runs
from coaxshell.apps.paper.observed import SIDES, Observed

_PLACE = "Linear stiffness, Fig. 5"
STEEL = 200e9
"""Young's modulus of structural steel, Pa (EN 1993-1-1 gives 210 GPa, design handbooks 200)."""


def _linear(runs: Runs) -> dict[float, Observed]:
    return systems.varied(runs, cases.linear_stiffness, cases.LINEAR_STIFFNESSES)


def effect(found: Observed, reference: Observed, values: tuple[float, ...], what: str) -> tuple[dict[str, float], float]:
    """Return measured numbers and the largest relative L2 change of the inner stress at head and tail."""
    changes = stress_changes(found, reference)
    return {f"{what} {value:g}, {name}": number for value in values for name, number in named(changes, "change (%)").items()}, max(
        changes.values()
    )


def towards_rigid(runs: Runs, found: dict[float, Observed], stiff: float) -> tuple[dict[str, float], float]:
    """Return how far from the rigid link the inner stress is, at each point relative to what the rigid link does to the bare system."""
    rigid, bare = runs(systems.with_rigid_link()), systems.bare(runs)
    left = {
        ("inner", side): float(
            np.linalg.norm(found[stiff].stress("inner", side) - rigid.stress("inner", side))
            / np.linalg.norm(rigid.stress("inner", side) - bare.stress("inner", side))
        )
        for side in SIDES
    }
    return named(left, f"{stiff:g}, distance from the rigid link over its whole effect (%)"), max(left.values())


@claim(
    _PLACE,
    "With a link at the heads the inner shell begins to move at t = 0, long before the wave reaches it.",
    "onset: the stress at the inner head passes 1 % of its peak; k_l = 1e9 N/m; holds: before t = 0.1; in part: before 0.4",
)
def link_starts_the_inner_shell_at_once(runs: Runs) -> Finding:
    """Find the onset at the inner head with and without a link."""
    linked, bare = _linear(runs)[1e9], systems.bare(runs)
    first, without = (onset(run.time, run.stress("inner", "head")) for run in (linked, bare))
    why = f"The stress at the inner head begins at t = {first:.3f} with the absorber and at {without:.3f} without."
    return Finding({"onset with absorber": first, "onset without": without}, graded(first < 0.1, first < 0.4), why)


@claim(
    _PLACE,
    "A single absorber changes the response only marginally.",
    "k_l = 1e9 N/m; holds: at most 15 % relative L2 change of the inner stress at head and tail; in part: at most 30 %",
)
def single_absorber_is_marginal(runs: Runs) -> Finding:
    """Measure the change by one absorber."""
    changes = stress_changes(_linear(runs)[1e9], systems.bare(runs))
    worst = max(changes.values())
    why = f"It changes the stress by {sentence(changes)}."
    return Finding(named(changes, "change (%)"), graded(worst <= 0.15, worst <= 0.3), why)


@claim(
    _PLACE,
    "Up to k_l = 1e8 N/m an absorber has practically no effect.",
    "holds: at most 1 % relative L2 change of the inner stress at head and tail for 1e7 and 1e8; in part: at most 5 %",
)
def soft_link_has_no_effect(runs: Runs) -> Finding:
    """Measure the change by soft absorbers."""
    bare, found = systems.bare(runs), _linear(runs)
    changes = {k: stress_changes(found[k], bare) for k in (1e7, 1e8)}
    worst = max(max(of.values()) for of in changes.values())
    measured = {f"k_l = {k:g}, {name}": v for k, of in changes.items() for name, v in named(of, "change (%)").items()}
    why = "The stress changes by " + "; ".join(f"{sentence(of)} with {k:g} N/m" for k, of in changes.items()) + "."
    return Finding(measured, graded(worst <= 0.01, worst <= 0.05), why)


@claim(
    _PLACE,
    "k_l = 1e9 N/m mitigates the fluctuations of the inner stress noticeably.",
    "holds: the peak falls by 1 % or more at the inner head and tail; in part: at one of them",
)
def adopted_stiffness_mitigates(runs: Runs) -> Finding:
    """Compare peaks with and without the absorber."""
    found, bare = _linear(runs)[1e9].shells["inner"], systems.bare(runs).shells["inner"]
    falls = {
        ("inner", "head"): reduction(found.stress_head.value, bare.stress_head.value),
        ("inner", "tail"): reduction(found.stress_tail.value, bare.stress_tail.value),
    }
    down = [fall >= 1.0 for fall in falls.values()]
    why = f"The peak falls by {sentence(falls, '{:.1f} %', 1.0)}."
    return Finding(named(falls, "reduction of the peak (%)", 1.0), graded(all(down), any(down)), why)


@claim(
    _PLACE,
    "From k_l = 1e10 N/m on the absorber is close to a rigid link.",
    "distance of the inner stress from that with a rigid link, relative to the whole effect of the rigid link (L2); "
    "holds: at most 10 % at head and tail for 1e10; in part: at most 50 %, and at most 10 % for 1e11",
)
def stiff_link_is_rigid(runs: Runs) -> Finding:
    """Compare stiff links with a rigid one."""
    found = _linear(runs)
    (first, near), (second, nearest) = (towards_rigid(runs, found, k) for k in (1e10, 1e11))
    why = (
        f"{100 * near:.0f} % of the rigid link's effect is still missing at 1e10 N/m and {100 * nearest:.1f} % at "
        f"1e11 (the worse of head and tail)."
    )
    return Finding({**first, **second}, graded(near <= 0.1, near <= 0.5 and nearest <= 0.1), why)


@claim(
    _PLACE,
    "1e9 N/m is about the tensile stiffness of a steel rod of 2 cm radius and 25 cm length.",
    f"E A/L with E = {STEEL / 1e9:g} GPa; holds: within 10 %; in part: within 50 %",
)
def steel_rod_has_the_adopted_stiffness(runs: Runs) -> Finding:
    """Compute the stiffness of the rod."""
    found = STEEL * np.pi * 0.02**2 / 0.25
    away = abs(found / 1e9 - 1.0)
    why = f"E A/L = {found:.3g} N/m, {100 * away:.1f} % from 1e9."
    return Finding({"stiffness of the rod (N/m)": float(found)}, graded(away <= 0.1, away <= 0.5), why)


def displacement_change(found: Observed, reference: Observed, last: float = np.inf) -> dict[tuple[str, str], float]:
    """Return the relative L2 change of the displacement of both heads up to an instant."""
    span = found.time <= last
    return {
        (shell, "head"): change(found.displacement(shell, "head")[span], reference.displacement(shell, "head")[span])
        for shell in ("inner", "outer")
    }
