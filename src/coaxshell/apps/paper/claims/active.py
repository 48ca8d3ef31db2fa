"""Claims about the feedback gains: Fig. 11."""

from __future__ import annotations

from coaxshell.apps.paper import cases
from coaxshell.apps.paper.claims import systems
from coaxshell.apps.paper.claims.claim import Finding, claim, graded
from coaxshell.apps.paper.claims.measures import POINTS, named, peak, rapid_part, reduction, rms, sentence, sentence_case
from coaxshell.apps.paper.known_runs import Runs
from coaxshell.apps.paper.observed import Observed

_PLACE = "Active control, Fig. 11"
Falls = dict[tuple[str, str], float]


def _gained(runs: Runs) -> dict[tuple[float, float], Observed]:
    named_cases = cases.gains(systems.preset("bare"))
    found = dict(runs.each(named_cases))
    return dict(zip(cases.GAINS, [found[name] for name in named_cases if name != "bare"], strict=True))


def falls_of(run: Observed, reference: Observed) -> Falls:
    """Return by how many per cent the peak stress falls at each point."""
    return {point: reduction(peak(run.stress(*point)), peak(reference.stress(*point))) for point in POINTS}


def _falls(runs: Runs) -> tuple[Falls, Falls, Falls]:
    """Return the reductions by the derivative gain alone, the proportional one alone, and both."""
    found, bare = _gained(runs), systems.bare(runs)
    derivative, proportional, both = (falls_of(found[gains], bare) for gains in ((0.0, -150.0), (-2e4, 0.0), (-2e4, -150.0)))
    return derivative, proportional, both


@claim(
    _PLACE,
    "The actuators' field stays within 590 V/mm.",
    "largest voltage that the adopted gains ask for, over the limit, on either shell; holds: at most 1; in part: on one shell",
)
def voltage_is_within_the_limit(runs: Runs) -> Finding:
    """Compare the voltages with the limit."""
    run = _gained(runs)[-2e4, -150.0]
    asked = {name: s.actuator_voltage.value for name, s in run.summaries.items() if s.actuator_voltage}
    limits = {name: s.actuator_limit for name, s in run.summaries.items() if s.actuator_limit}
    over = {name: volts / limits[name] for name, volts in asked.items()}
    within = [ratio <= 1.0 for ratio in over.values()]
    why = "; ".join(
        f"{name} shell: {asked[name] / 1e3:.2f} kV against {limits[name] / 1e3:.2f} kV, {over[name]:.1f} times" for name in over
    )
    return Finding({f"{n} shell, voltage over its limit": v for n, v in over.items()}, graded(all(within), any(within)), sentence_case(why))


@claim(
    _PLACE,
    "The proportional gain matters most for the reduction of the stress.",
    "peaks at the four points; holds: k_p = −2e4 alone lowers each by more than k_d = −150 alone; in part: on average",
)
def proportional_gain_matters_most(runs: Runs) -> Finding:
    """Compare the two gains alone."""
    derivative, proportional, _ = _falls(runs)
    more = [proportional[p] > derivative[p] for p in POINTS]
    why = f"k_p alone: {sentence(proportional, '{:.1f} %', 1.0)}; k_d alone: {sentence(derivative, '{:.1f} %', 1.0)}."
    measured = {**named(proportional, "reduction by k_p alone (%)", 1.0), **named(derivative, "reduction by k_d alone (%)", 1.0)}
    return Finding(measured, graded(all(more), sum(proportional.values()) > sum(derivative.values())), why)


@claim(
    _PLACE,
    "k_p = −2e4 alone lowers the stress of the inner shell noticeably.",
    "holds: the peak falls by at least 5 % at the inner head and tail; in part: at one of them",
)
def proportional_gain_lowers_the_inner_stress(runs: Runs) -> Finding:
    """Measure the reduction by the proportional gain alone."""
    falls = {point: fall for point, fall in _falls(runs)[1].items() if point[0] == "inner"}
    down = [fall >= 5.0 for fall in falls.values()]
    return Finding(
        named(falls, "reduction of the peak (%)", 1.0),
        graded(all(down), any(down)),
        f"The peak falls by {sentence(falls, '{:.1f} %', 1.0)}.",
    )


@claim(
    _PLACE,
    "k_d alone lowers the stress only marginally.",
    "holds: the peak falls by 0 to 5 % at the inner head and tail; in part: at one of them",
)
def derivative_gain_alone_is_marginal(runs: Runs) -> Finding:
    """Measure the reduction by the derivative gain alone."""
    falls = {point: fall for point, fall in _falls(runs)[0].items() if point[0] == "inner"}
    small = [0.0 <= fall <= 5.0 for fall in falls.values()]
    return Finding(
        named(falls, "reduction of the peak (%)", 1.0),
        graded(all(small), any(small)),
        f"The peak falls by {sentence(falls, '{:.1f} %', 1.0)}.",
    )


@claim(
    _PLACE,
    "The derivative gain mainly suppresses rapid oscillations.",
    "rapid: above 4 cycles in a transit; k_d added to k_p; holds: lowers the RMS of the rapid part by more per cent "
    "than that of the whole stress at all "
    "four points; in part: at two or more",
)
def derivative_gain_suppresses_rapid_oscillations(runs: Runs) -> Finding:
    """Compare what the derivative gain does to the rapid part and to the whole."""
    found = _gained(runs)
    plain, damped = found[-2e4, 0.0], found[-2e4, -150.0]
    rapid = {p: reduction(rms(rapid_part(damped.time, damped.stress(*p))), rms(rapid_part(plain.time, plain.stress(*p)))) for p in POINTS}
    whole = {p: reduction(rms(damped.stress(*p)), rms(plain.stress(*p))) for p in POINTS}
    more = sum(rapid[p] > whole[p] and rapid[p] > 0.0 for p in POINTS)
    why = f"Added to k_p it lowers the rapid part by {sentence(rapid, '{:.1f} %', 1.0)}, the whole by {sentence(whole, '{:.1f} %', 1.0)}."
    measured = {**named(rapid, "reduction of the rapid RMS (%)", 1.0), **named(whole, "reduction of the RMS (%)", 1.0)}
    return Finding(measured, graded(more == len(POINTS), more >= 2), why)


@claim(
    _PLACE,
    "Both gains together reduce the stress markedly more than either alone.",
    "peaks at the four points; holds: both together lower each by at least 2 points more than the better single "
    "gain; in part: on average more",
)
def both_gains_do_more(runs: Runs) -> Finding:
    """Compare both gains with either alone."""
    derivative, proportional, both = _falls(runs)
    gained = {p: both[p] - max(derivative[p], proportional[p]) for p in POINTS}
    why = f"Both: {sentence(both, '{:.1f} %', 1.0)}; more than the better single one by {sentence(gained, '{:+.1f} points', 1.0)}."
    measured = {**named(both, "reduction by both (%)", 1.0), **named(gained, "more than the better single gain (points)", 1.0)}
    return Finding(measured, graded(all(g >= 2.0 for g in gained.values()), sum(gained.values()) > 0.0), why)
