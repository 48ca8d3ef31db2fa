"""Claims about the stress under hybrid control: Figs. 12 and 13."""

from __future__ import annotations

import numpy as np

from coaxshell.apps.paper.claims import systems
from coaxshell.apps.paper.claims.active import falls_of
from coaxshell.apps.paper.claims.claim import Finding, claim, graded
from coaxshell.apps.paper.claims.measures import named, onset, reduction, rms, sentence, sentence_case
from coaxshell.apps.paper.known_runs import Runs

SHELLS = ("inner", "outer")


@claim(
    "Hybrid control, Fig. 12",
    "Hybrid control attenuates the stress at head and tail of both shells.",
    "holds: the peak falls by at least 5 % at all four points; in part: at two or more",
)
def hybrid_attenuates_everywhere(runs: Runs) -> Finding:
    """Measure the reduction of the peaks by hybrid control."""
    falls = falls_of(runs(systems.preset("hybrid")), systems.bare(runs))
    down = sum(fall >= 5.0 for fall in falls.values())
    return Finding(
        named(falls, "reduction of the peak (%)", 1.0),
        graded(down == 4, down >= 2),
        f"The peak falls by {sentence(falls, '{:.1f} %', 1.0)}.",
    )


@claim(
    "Hybrid control, Fig. 12",
    "Absorbers and feedback together do more than either of them alone.",
    "RMS over surface and time; holds: lower than with absorbers alone and with feedback alone, on both shells; in part: on one",
)
def hybrid_beats_its_parts(runs: Runs) -> Finding:
    """Compare the RMS with that of each part alone."""
    bare = systems.bare(runs)
    falls = {
        name: {shell: reduction(runs(systems.preset(name)).shells[shell].stress_rms, bare.shells[shell].stress_rms) for shell in SHELLS}
        for name in ("absorbers", "active", "hybrid")
    }
    best = [falls["hybrid"][s] > max(falls["absorbers"][s], falls["active"][s]) for s in SHELLS]
    why = "RMS below bare: " + "; ".join(f"{name} {of['inner']:.1f} % inner, {of['outer']:.1f} % outer" for name, of in falls.items()) + "."
    measured = {f"{name}, {s} shell, reduction of the RMS (%)": v for name, of in falls.items() for s, v in of.items()}
    return Finding(measured, graded(all(best), any(best)), why)


@claim(
    "Hybrid control, Fig. 13",
    "With absorbers the inner shell is stressed from t = 0.1 on, before the wave reaches it.",
    "RMS of the inner stress over the surface at t = 0.1, over its largest; holds: at least 0.5 % with, and less than "
    "0.1 % without; in part: larger than bare",
)
def inner_stress_from_0_1(runs: Runs) -> Finding:
    """Compare the inner stress at t = 0.1 with and without control."""
    controlled, bare = runs(systems.preset("hybrid")), systems.bare(runs)
    k = int(np.argmin(np.abs(bare.time - 0.1)))
    shares = {
        name: 100.0 * float(run.circle["inner"][k] / run.circle["inner"].max()) for name, run in (("hybrid", controlled), ("bare", bare))
    }
    first = onset(controlled.time, controlled.circle["inner"])
    why = (
        f"At t = 0.1 it has {shares['hybrid']:.2g} % of its largest value, {shares['bare']:.2g} % without; with "
        f"control it passes 1 % at t = {first:.3f}."
    )
    measured = {f"{n}, RMS at t = 0.1 over its largest (%)": v for n, v in shares.items()}
    return Finding(measured, graded(shares["hybrid"] >= 0.5 and shares["bare"] < 0.1, shares["hybrid"] > shares["bare"]), why)


@claim(
    "Hybrid control, Fig. 13",
    "At t = 1.0 and t = 3.0 the stress is visibly lower than in the bare system.",
    "RMS over the surface at the instant; holds: at least 5 % lower on the inner shell at both; in part: at one",
)
def stress_is_lower_at_1_and_3(runs: Runs) -> Finding:
    """Compare the stress over the surface at two instants."""
    controlled, bare = runs(systems.preset("hybrid")), systems.bare(runs)
    falls = {}
    for instant in (1.0, 3.0):
        k = int(np.argmin(np.abs(bare.time - instant)))
        falls[instant] = {s: reduction(float(controlled.circle[s][k]), float(bare.circle[s][k])) for s in SHELLS}
    down = [of["inner"] >= 5.0 for of in falls.values()]
    why = "; ".join(f"t = {t:g}: {of['inner']:.1f} % lower on the inner shell, {of['outer']:.1f} % on the outer" for t, of in falls.items())
    measured = {f"{s} shell, reduction at t = {t:g} (%)": v for t, of in falls.items() for s, v in of.items()}
    return Finding(measured, graded(all(down), any(down)), sentence_case(why))


@claim(
    "Hybrid control, Fig. 13",
    "The effect grows with time: from t = 4 on the stress of both shells is reduced most.",
    "RMS over surface and time; holds: on both shells reduced by more per cent for t >= 4 than before; in part: on one",
)
def effect_grows_with_time(runs: Runs) -> Finding:
    """Compare the reductions before and after t = 4."""
    controlled, bare = runs(systems.preset("hybrid")), systems.bare(runs)
    late = bare.time >= min(4.0, 0.8 * float(bare.time[-1]))
    falls = {s: [reduction(rms(controlled.circle[s][part]), rms(bare.circle[s][part])) for part in (~late, late)] for s in SHELLS}
    grows = [after > before for before, after in falls.values()]
    why = "; ".join(f"{s} shell: {before:.1f} % before, {after:.1f} % from t = 4 on" for s, (before, after) in falls.items())
    measured = {f"{s} shell, reduction {n} t = 4 (%)": v for s, of in falls.items() for n, v in zip(("before", "after"), of, strict=True)}
    return Finding(measured, graded(all(grows), any(grows)), sentence_case(why))
