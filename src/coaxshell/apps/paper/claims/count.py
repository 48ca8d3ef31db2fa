"""Claims about the number of absorbers: Fig. 9."""

from __future__ import annotations

import numpy as np

from coaxshell.apps.paper import cases
from coaxshell.apps.paper.claims import systems
from coaxshell.apps.paper.claims.claim import Finding, claim, graded
from coaxshell.apps.paper.claims.measures import reduction, sentence_case
from coaxshell.apps.paper.known_runs import Runs
from coaxshell.apps.paper.observed import Observed
from coaxshell.numerics.arrays import FloatArray

_PLACE = "Multiple absorbers, Fig. 9"
SHELLS = ("inner", "outer")
LOW, HIGH = (1, 20), (31, 50)
"""Counts called low, and those that they are compared with."""


def _counted(runs: Runs, counts: tuple[int, ...]) -> dict[int, Observed]:
    return {int(n): run for n, run in runs.each(cases.count(systems.preset("bare"), counts), peaks_only=True)}


def _all(runs: Runs) -> dict[int, Observed]:
    return _counted(runs, tuple(sorted({*cases.COUNTS, *cases.COARSE_COUNTS})))


def _rms(found: dict[int, Observed], shell: str) -> FloatArray:
    return np.array([run.shells[shell].stress_rms for run in found.values()])


@claim(
    _PLACE,
    "More absorbers first lower the RMS stress of both shells noticeably.",
    "RMS over surface and time; holds: at some N up to 50 at least 5 % below bare on both shells; in part: on one",
)
def more_absorbers_lower_the_rms(runs: Runs) -> Finding:
    """Find the largest reduction of the RMS up to N = 50."""
    found = _counted(runs, cases.COUNTS)
    falls = {shell: reduction(float(_rms(found, shell).min()), found[0].shells[shell].stress_rms) for shell in SHELLS}
    down = [fall >= 5.0 for fall in falls.values()]
    why = f"Up to N = 50 the RMS falls by at most {falls['inner']:.1f} % on the inner shell and {falls['outer']:.1f} % on the outer one."
    return Finding({f"{s} shell, largest reduction (%)": v for s, v in falls.items()}, graded(all(down), any(down)), why)


@claim(
    _PLACE,
    "Beyond some number further absorbers only add mass and lower the stress no more.",
    "threshold: least N from which the RMS stays within a band of 2 % of bare up to N = 300; holds: 200 or less on "
    "both shells; in part: on one",
)
def more_absorbers_stop_helping(runs: Runs) -> Finding:
    """Find the number from which the RMS stays the same."""
    found = _counted(runs, cases.COARSE_COUNTS)
    thresholds: dict[str, float] = {}
    parts: list[str] = []
    for shell in SHELLS:
        values = _rms(found, shell) / found[0].shells[shell].stress_rms
        steady = [k for k in range(len(values)) if np.ptp(values[k:]) <= 0.02]
        thresholds[shell] = float(cases.COARSE_COUNTS[steady[0]])
        late = values[list(cases.COARSE_COUNTS).index(100) :]
        parts.append(
            f"{shell} shell: from N = {thresholds[shell]:.0f} (from N = 100 to 300 it goes from {100 * late[0]:.0f} to "
            f"{100 * late[-1]:.0f} % of bare)"
        )
    met = [value <= 200 for value in thresholds.values()]
    return Finding(
        {f"{s} shell, threshold (absorbers)": v for s, v in thresholds.items()}, graded(all(met), any(met)), sentence_case("; ".join(parts))
    )


@claim(
    _PLACE,
    "The tail is the most stressed point whatever the number of absorbers, with rare exceptions.",
    "share of the numbers of Fig. 9 for which the tail's peak is at least 95 % of the peak anywhere; holds: 90 % "
    "on both shells; in part: 50 %",
)
def tail_is_the_worst_point(runs: Runs) -> Finding:
    """Count the numbers of absorbers for which the tail has the largest peak."""
    found = _all(runs)
    shares = {
        shell: 100.0
        * float(np.mean([run.shells[shell].stress_tail.value >= 0.95 * run.shells[shell].stress.value for run in found.values()]))
        for shell in SHELLS
    }
    worst = min(shares.values())
    why = (
        f"So it is for {shares['inner']:.0f} % of the {len(found)} numbers on the inner shell and {shares['outer']:.0f} % on the outer one."
    )
    return Finding({f"{s} shell, share (%)": v for s, v in shares.items()}, graded(worst >= 90.0, worst >= 50.0), why)


@claim(
    _PLACE,
    "Where the head is stressed more than the tail, it is so by a marginal difference.",
    "largest excess of the head's peak over the tail's for any N; holds: at most 10 % on both shells; in part: on one",
)
def head_exceeds_the_tail_marginally(runs: Runs) -> Finding:
    """Find the largest excess of the head over the tail."""
    found = _all(runs)
    excess = {
        shell: {n: 100.0 * (run.shells[shell].stress_head.value / run.shells[shell].stress_tail.value - 1.0) for n, run in found.items()}
        for shell in SHELLS
    }
    most = {shell: max(of, key=lambda n: of[n]) for shell, of in excess.items()}
    largest = {shell: excess[shell][n] for shell, n in most.items()}
    small = [value <= 10.0 for value in largest.values()]
    why = "; ".join(
        f"{s} shell: head over tail in {sum(v > 0 for v in excess[s].values())} of {len(found)}, at most by "
        f"{largest[s]:+.0f} % (N = {most[s]})"
        for s in SHELLS
    )
    return Finding({f"{s} shell, largest excess (%)": v for s, v in largest.items()}, graded(all(small), any(small)), sentence_case(why))


@claim(
    _PLACE,
    "The RMS stress of both shells has a pronounced minimum at some N up to 50.",
    "holds: on both shells the least RMS up to N = 50 lies inside that range and is at least 2 % of bare below "
    "its largest value from there "
    "to N = 300; in part: on one",
)
def rms_has_a_minimum_below_50(runs: Runs) -> Finding:
    """Find the minimum of the RMS up to N = 50."""
    found = _all(runs)
    counts = np.array(list(found))
    measured: dict[str, float] = {}
    met: list[bool] = []
    parts: list[str] = []
    for shell in SHELLS:
        values = 100.0 * _rms(found, shell) / found[0].shells[shell].stress_rms
        low = int(counts[counts <= 50][int(np.argmin(values[counts <= 50]))])
        rise = float(values[counts >= low].max() - values[counts == low][0])
        met.append(0 < low < 50 and rise >= 2.0)
        measured |= {f"{shell} shell, N of the least RMS": float(low), f"{shell} shell, rise after it (% of bare)": rise}
        parts.append(f"{shell} shell: least at N = {low}, {values[counts == low][0]:.1f} % of bare, rising by {rise:.1f} points afterwards")
    return Finding(measured, graded(all(met), any(met)), sentence_case("; ".join(parts)))


@claim(
    _PLACE,
    "At N = 25 the RMS stress of the inner shell drops sharply.",
    "holds: N = 25 has the least RMS of all N up to 50; in part: less than at N = 24 and at N = 26",
)
def sharp_drop_at_25(runs: Runs) -> Finding:
    """Compare the RMS at N = 25 with the others."""
    found = _counted(runs, cases.COUNTS)
    values = 100.0 * _rms(found, "inner") / found[0].shells["inner"].stress_rms
    best = int(np.argmin(values))
    why = (
        f"RMS over bare: {values[24]:.1f}, {values[25]:.1f}, {values[26]:.1f} % at N = 24, 25, 26; the least, "
        f"{values[best]:.1f} %, is at N = {best}."
    )
    measured = {
        "N of the least RMS": float(best),
        "RMS at N = 25 over bare (%)": float(values[25]),
        "least RMS over bare (%)": float(values[best]),
    }
    return Finding(measured, graded(best == 25, bool(values[25] < min(values[24], values[26]))), why)


@claim(
    _PLACE,
    "With N = 25 both the RMS and the peak stress of the inner shell are about 20 % below bare.",
    "holds: both reductions between 15 and 25 %; in part: one of them",
)
def twenty_per_cent_at_25(runs: Runs) -> Finding:
    """Measure the reductions at N = 25."""
    found = _counted(runs, (0, cases.ADOPTED_COUNT))
    bare, ring = (found[n].shells["inner"] for n in (0, cases.ADOPTED_COUNT))
    falls = {"RMS": reduction(ring.stress_rms, bare.stress_rms), "peak": reduction(ring.stress.value, bare.stress.value)}
    near = [15.0 <= fall <= 25.0 for fall in falls.values()]
    why = f"The RMS falls by {falls['RMS']:.1f} % and the peak by {falls['peak']:.1f} %."
    return Finding({f"inner shell, reduction of the {n} (%)": v for n, v in falls.items()}, graded(all(near), any(near)), why)


def _tail_steps(runs: Runs, span: tuple[int, int]) -> FloatArray:
    """Return the steps of the inner tail's peak from each number to the next, % of bare."""
    found = _counted(runs, cases.COUNTS)
    values = np.array([found[n].shells["inner"].stress_tail.value for n in range(span[0], span[1] + 1)])
    return np.asarray(100.0 * np.diff(values) / found[0].shells["inner"].stress_tail.value)


@claim(
    _PLACE,
    "For few absorbers the inner stress goes up and down with the parity of N; even numbers have one at the tail.",
    f"steps of the inner tail's peak from N to N + 1, N = {LOW[0]} to {LOW[1]}; holds: at least 75 % of neighbouring steps have opposite "
    "signs and even numbers are lower on average; in part: one of the two",
)
def parity_zigzag(runs: Runs) -> Finding:
    """Look for alternating steps at low numbers."""
    steps = _tail_steps(runs, LOW)
    share = float(np.mean(steps[1:] * steps[:-1] < 0.0))
    to_even = float(np.mean(steps[(np.arange(LOW[0], LOW[1]) + 1) % 2 == 0]))
    why = (
        f"{100 * share:.0f} % of the steps reverse the one before; a step to an even number changes the tail's peak "
        f"by {to_even:+.1f} % of bare on average."
    )
    measured = {"steps that reverse (%)": 100 * share, "mean step to an even number (% of bare)": to_even}
    return Finding(measured, graded(share >= 0.75 and to_even < 0.0, share >= 0.75 or to_even < 0.0), why)


@claim(
    _PLACE,
    "With more absorbers the response depends less on the parity of N.",
    f"mean step of the inner tail's peak from N to N + 1; holds: for N = {HIGH[0]} to {HIGH[1]} at most half of that "
    f"for N = {LOW[0]} to {LOW[1]}; "
    "in part: smaller",
)
def parity_fades(runs: Runs) -> Finding:
    """Compare steps at low and at high numbers."""
    low, high = (float(np.mean(np.abs(_tail_steps(runs, span)))) for span in (LOW, HIGH))
    why = f"From one N to the next the tail's peak changes by {low:.2f} % of bare for few absorbers and {high:.2f} % for many."
    return Finding({"mean step, few (% of bare)": low, "mean step, many (% of bare)": high}, graded(high <= 0.5 * low, high < low), why)


@claim(
    _PLACE,
    "The inner shell reacts more sharply to the arrangement of the absorbers than the outer one.",
    "mean step of RMS and of peak from N to N + 1, N = 1 to 50, % of bare; holds: both larger on the inner shell; in part: one",
)
def inner_shell_is_more_sensitive(runs: Runs) -> Finding:
    """Compare the steps of both shells."""
    found = _counted(runs, cases.COUNTS)
    measured: dict[str, float] = {}
    for shell in SHELLS:
        bare = found[0].shells[shell]
        for name, values, unit in (
            ("RMS", _rms(found, shell)[1:], bare.stress_rms),
            ("peak", np.array([run.shells[shell].stress.value for n, run in found.items() if n]), bare.stress.value),
        ):
            measured[f"{shell} shell, mean step of the {name} (% of bare)"] = 100.0 * float(np.mean(np.abs(np.diff(values)))) / unit
    inner_rms, inner_peak, outer_rms, outer_peak = measured.values()
    larger = [inner_rms > outer_rms, inner_peak > outer_peak]
    why = f"Mean steps: RMS {inner_rms:.2f} against {outer_rms:.2f} % (outer), peak {inner_peak:.2f} against {outer_peak:.2f} %."
    return Finding(measured, graded(all(larger), any(larger)), why)
