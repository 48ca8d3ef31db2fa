"""Claims about an absorber's cubic stiffness: Fig. 7."""

from __future__ import annotations

from coaxshell.apps.paper import cases
from coaxshell.apps.paper.claims import systems
from coaxshell.apps.paper.claims.claim import Finding, claim, graded
from coaxshell.apps.paper.claims.measures import named, peak, sentence, sentence_case, stress_changes
from coaxshell.apps.paper.claims.stiffness import towards_rigid
from coaxshell.apps.paper.known_runs import Runs
from coaxshell.apps.paper.observed import Observed

_PLACE = "Nonlinear stiffness, Fig. 7"


def _cubic(runs: Runs) -> dict[float, Observed]:
    return systems.varied(runs, cases.cubic_stiffness, cases.CUBIC_STIFFNESSES)


def _peaks(run: Observed) -> dict[str, float]:
    inner = run.shells["inner"]
    return {"head": inner.stress_head.value / 1e6, "tail": inner.stress_tail.value / 1e6}


@claim(
    _PLACE,
    "Up to k_nl = 1e19 N/m³ the response is nearly that of a linear absorber.",
    "holds: at most 1 % relative L2 change of the inner stress at head and tail; in part: at most 5 %",
)
def weak_cubic_spring_is_linear(runs: Runs) -> Finding:
    """Compare a weak cubic spring with none."""
    found = _cubic(runs)
    changes = stress_changes(found[1e19], found[0.0])
    worst = max(changes.values())
    return Finding(named(changes, "change (%)"), graded(worst <= 0.01, worst <= 0.05), f"The stress changes by {sentence(changes)}.")


@claim(
    _PLACE,
    "At k_nl = 1e20 N/m³ the absorber works better than a linear one.",
    "holds: lower peak of the inner stress at head and tail than with the linear absorber; in part: at one of them",
)
def adopted_cubic_spring_works_better(runs: Runs) -> Finding:
    """Compare the peaks with the adopted cubic spring and with the linear one."""
    found = _cubic(runs)
    linear, adopted = _peaks(found[0.0]), _peaks(found[1e20])
    lower = [adopted[side] < linear[side] for side in adopted]
    why = "; ".join(f"{side}: {adopted[side]:.4f} MPa against {linear[side]:.4f} linear" for side in adopted)
    measured = {f"inner {s}, peak with {n} (MPa)": p[s] for n, p in (("1e20", adopted), ("linear", linear)) for s in p}
    return Finding(measured, graded(all(lower), any(lower)), sentence_case(why))


@claim(
    _PLACE,
    "At k_nl = 1e20 N/m³ the linear and the cubic part of the spring contribute comparable forces.",
    "largest cubic over largest linear force of the links, k_nl x^2/k_l at the largest stretch x; holds: 1/3 to 3; in part: 1/10 to 10",
)
def adopted_cubic_force_is_comparable(runs: Runs) -> Finding:
    """Compare the two parts of the force at the largest stretch."""
    run = _cubic(runs)[1e20]
    stretch = max(peak(run.absorber[0] - run.displacement(shell, "head")) for shell in ("inner", "outer"))
    ratio = cases.CUBIC["cubic_stiffness"] * stretch**2 / cases.CUBIC["linear_stiffness"]
    why = f"The links stretch by up to {1e6 * stretch:.2f} µm, where the cubic force is {ratio:.2f} of the linear one."
    measured = {"largest stretch (µm)": 1e6 * stretch, "cubic over linear force": ratio}
    return Finding(measured, graded(1 / 3 <= ratio <= 3, 0.1 <= ratio <= 10), why)


@claim(
    _PLACE,
    "From k_nl = 1e21 N/m³ on the absorber nears a rigid link.",
    "distance of the inner stress from that with a rigid link, relative to the whole effect of the rigid link (L2), the worse of head and "
    "tail; holds: falls from 1e20 to 1e21 and to 1e22, and is at most 50 % at 1e21; in part: falls",
)
def strong_cubic_spring_nears_a_rigid_link(runs: Runs) -> Finding:
    """Compare strong cubic springs with a rigid link."""
    found = _cubic(runs)
    left: dict[float, float] = {}
    measured: dict[str, float] = {}
    for k in (1e20, 1e21, 1e22):
        numbers, left[k] = towards_rigid(runs, found, k)
        measured |= numbers
    falls = left[1e20] > left[1e21] > left[1e22]
    why = "Of the rigid link's effect " + ", ".join(f"{100 * v:.0f} % is missing at {k:g}" for k, v in left.items()) + "."
    return Finding(measured, graded(falls and left[1e21] <= 0.5, falls), why)


@claim(
    _PLACE,
    "Nearing the rigid link spoils the mitigation.",
    "holds: with 1e22 N/m³ the peak of the inner stress is higher than with 1e20 at head and tail; in part: at one of them",
)
def rigid_link_spoils_the_mitigation(runs: Runs) -> Finding:
    """Compare peaks with the strongest cubic spring and with the adopted one."""
    found = _cubic(runs)
    adopted, strong = _peaks(found[1e20]), _peaks(found[1e22])
    worse = [strong[side] > adopted[side] for side in strong]
    why = "; ".join(f"{side}: {strong[side]:.4f} MPa with 1e22 against {adopted[side]:.4f} with 1e20" for side in strong)
    measured = {f"inner {s}, peak with {n} (MPa)": p[s] for n, p in (("1e20", adopted), ("1e22", strong)) for s in p}
    return Finding(measured, graded(all(worse), any(worse)), sentence_case(why))
