"""Claims about the bare system's histories: Fig. 3."""

from __future__ import annotations

from coaxshell.apps.paper.claims import systems
from coaxshell.apps.paper.claims.claim import Finding, claim, graded
from coaxshell.apps.paper.claims.measures import POINTS, extremum_near, named, onset, peak, rms, sentence, sentence_case, variation
from coaxshell.apps.paper.known_runs import Runs

PEAK_INSTANTS = (1.2, 1.7, 3.1, 3.6)
_PLACE = "Bare system, Fig. 3"


def _arrival(runs: Runs, shell: str, due: float) -> Finding:
    run = systems.bare(runs)
    found = onset(run.time, run.stress(shell, "head"))
    away = round(abs(found - due), 9)  # of instants that are printed numbers themselves
    why = f"The stress at the {shell} head passes 1 % of its peak at t = {found:.3f}; the wave arrives at {due:g}."
    return Finding({f"onset at the {shell} head (transits)": found}, graded(away <= 0.02, away <= 0.1), why)


_ARRIVES = "onset: the stress passes 1 % of its peak; holds: within 0.02 transits of the printed instant; in part: within 0.1"


@claim("Bare system, Fig. 3-a, c", "The head of the outer shell begins to move at t = 0, when the wave arrives.", _ARRIVES)
def outer_head_begins_at_0(runs: Runs) -> Finding:
    """Find the onset at the outer head."""
    return _arrival(runs, "outer", 0.0)


@claim("Bare system, Fig. 3-a, c", "The head of the inner shell begins to move at t = 0.5, when the wave arrives.", _ARRIVES)
def inner_head_begins_at_0_5(runs: Runs) -> Finding:
    """Find the onset at the inner head."""
    return _arrival(runs, "inner", 0.5)


@claim(
    "Bare system, Fig. 3-b, d",
    "The tails begin to move before the front in the water reaches them, because waves travel faster in the walls.",
    "holds: both tails pass 1 % of their peak before the direct front would arrive (t = 1.5 and 2); in part: one of them",
)
def tails_begin_before_the_front(runs: Runs) -> Finding:
    """Find the onsets at the tails."""
    run = systems.bare(runs)
    first = {shell: onset(run.time, run.stress(shell, "tail")) for shell in ("inner", "outer")}
    early = [first["inner"] < 1.5, first["outer"] < 2.0]
    why = (
        f"The stress begins at t = {first['inner']:.3f} at the inner tail and {first['outer']:.3f} at the outer; "
        f"the front is due at 1.5 and 2."
    )
    return Finding({f"onset at the {s} tail (transits)": t for s, t in first.items()}, graded(all(early), any(early)), why)


@claim(
    _PLACE,
    "The stress fluctuates more than the displacement.",
    "total variation over range; holds: larger for the stress at all four points; in part: at two or more",
)
def stress_fluctuates_more(runs: Runs) -> Finding:
    """Compare the total variation over the range."""
    run = systems.bare(runs)
    ratios = {point: variation(run.stress(*point)) / variation(run.displacement(*point)) for point in POINTS}
    more = sum(ratio > 1.0 for ratio in ratios.values())
    why = f"Total variation over range is {sentence(ratios, '{:.1f} times', 1.0)} that of the displacement."
    return Finding(named(ratios, "variation, stress over displacement", 1.0), graded(more == 4, more >= 2), why)


def _inner_over_outer(runs: Runs, quantity: str, what: str) -> Finding:
    run = systems.bare(runs)

    def largest(shell: str) -> float:
        return max(peak(run.histories[quantity, shell, side]) for side in ("head", "tail"))

    def mean(shell: str) -> float:
        return rms([run.histories[quantity, shell, side] for side in ("head", "tail")])

    peaks, means = largest("inner") / largest("outer"), mean("inner") / mean("outer")
    why = (
        f"The largest {what} at head or tail of the inner shell is {peaks:.2f} times that of the outer, the RMS at both {means:.2f} times."
    )
    measured = {f"peak {what}, inner over outer": peaks, f"RMS {what}, inner over outer": means}
    return Finding(measured, graded(peaks >= 1.05 and means >= 1.05, peaks >= 1.05 or means >= 1.05), why)


_MORE = "holds: peak and RMS over head and tail at least 5 % larger than on the outer shell; in part: one of the two"


@claim(_PLACE, "The inner shell is stressed more than the outer one.", _MORE)
def inner_shell_is_stressed_more(runs: Runs) -> Finding:
    """Compare the stress of the shells."""
    return _inner_over_outer(runs, "stress", "stress")


@claim(_PLACE, "The inner shell is displaced more than the outer one.", _MORE)
def inner_shell_is_displaced_more(runs: Runs) -> Finding:
    """Compare the displacement of the shells."""
    return _inner_over_outer(runs, "displacement", "displacement")


@claim(
    _PLACE,
    "The largest stress of each shell occurs at its tail.",
    "holds: on both shells the tail's peak exceeds the head's and is at least 95 % of the peak anywhere; in part: on one",
)
def tail_bears_the_peak(runs: Runs) -> Finding:
    """Compare peaks at the tail with those at the head and anywhere."""
    shells = systems.bare(runs).shells
    met: list[bool] = []
    parts: list[str] = []
    measured: dict[str, float] = {}
    for name, shell in shells.items():
        tail, head, anywhere = (p.value / 1e6 for p in (shell.stress_tail, shell.stress_head, shell.stress))
        met.append(tail > head and tail >= 0.95 * anywhere)
        measured |= {f"{name} tail, peak stress (MPa)": tail, f"{name} head, peak stress (MPa)": head}
        measured[f"{name} shell, peak stress anywhere (MPa)"] = anywhere
        parts.append(f"{name}: tail {tail:.3f}, head {head:.3f}, anywhere {anywhere:.3f} MPa (at {abs(shell.stress.angle):.0f}°)")
    return Finding(measured, graded(all(met), any(met)), sentence_case("; ".join(parts)))


@claim(
    "Bare system, Fig. 3-a, b and Fig. 4",
    "The stress at the inner head or tail is at an extremum at t = 1.2, 1.7, 3.1 and 3.6.",
    "extrema of at least half the peak at that point; holds: one within 0.05 transits of each of the four "
    "instants; in part: of two or more",
)
def inner_extrema_at_the_printed_instants(runs: Runs) -> Finding:
    """Find the extremum of the inner head or tail next to each printed instant."""
    run = systems.bare(runs)
    near: dict[float, float] = {}
    parts: list[str] = []
    for instant in PEAK_INSTANTS:
        found = {side: extremum_near(run.time, run.stress("inner", side), instant) for side in ("head", "tail")}
        side = min(found, key=lambda name: abs(found[name][0] - instant))
        near[instant] = found[side][0]
        parts.append(f"{instant}: {found[side][0]:.2f} ({side}, {100 * found[side][1]:.0f} % of its peak)")
    hits = sum(abs(found - instant) <= 0.05 for instant, found in near.items())
    measured = {f"extremum next to t = {instant} (transits)": found for instant, found in near.items()}
    return Finding(measured, graded(hits == 4, hits >= 2), f"Nearest extrema: {', '.join(parts)}.")
