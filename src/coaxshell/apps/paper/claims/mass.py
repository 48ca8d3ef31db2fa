"""Claims about an absorber's mass: Fig. 6."""

from __future__ import annotations

import numpy as np

from coaxshell.apps.paper import cases
from coaxshell.apps.paper.claims import systems
from coaxshell.apps.paper.claims.claim import Finding, claim, graded
from coaxshell.apps.paper.claims.measures import named, rms, sentence, stress_changes
from coaxshell.apps.paper.known_runs import Runs
from coaxshell.apps.paper.observed import Observed
from coaxshell.model import Shell

_PLACE = "Mass, Fig. 6"
SHORT = 1.0
"""What counts as a short time, transits."""

_STIFFNESS = cases.LINEAR["linear_stiffness"]


def _masses(runs: Runs) -> dict[float, Observed]:
    return systems.varied(runs, cases.mass, cases.MASSES)


def shell_mass() -> float:
    """Return the mass of both shells of the bare system, kg per metre of length: sum of 2 pi R rho t over layers."""
    return float(
        sum(
            2.0 * np.pi * shell.radius * layer.material.density * layer.thickness
            for shell in systems.preset("bare").shells
            if isinstance(shell, Shell)
            for layer in shell.layers
        )
    )


@claim(
    _PLACE,
    "Absorbers of different masses change the stress only slightly.",
    "holds: at most 15 % relative L2 change of the inner stress at head and tail for every mass; in part: at most 30 %",
)
def every_mass_changes_little(runs: Runs) -> Finding:
    """Measure the change for every mass."""
    bare = systems.bare(runs)
    worst = {m: max(stress_changes(run, bare).values()) for m, run in _masses(runs).items()}
    why = "The stress changes by " + ", ".join(f"{100 * v:.1f} % ({m:g} kg)" for m, v in worst.items()) + ", the larger of head and tail."
    measured = {f"m = {m:g} kg, larger change (%)": 100 * v for m, v in worst.items()}
    return Finding(measured, graded(max(worst.values()) <= 0.15, max(worst.values()) <= 0.3), why)


@claim(
    _PLACE,
    "A vanishing mass does not bring the bare response back.",
    "holds: with m = 0 the inner stress at head or tail still differs from bare by at least half of what it "
    "does with 10 kg; in part: by 1 %",
)
def vanishing_mass_is_not_bare(runs: Runs) -> Finding:
    """Measure the effect of a massless absorber."""
    bare, found = systems.bare(runs), _masses(runs)
    none, adopted = (max(stress_changes(found[m], bare).values()) for m in (0.0, 10.0))
    why = f"A massless absorber changes the stress by {100 * none:.1f} %, one of 10 kg by {100 * adopted:.1f} %."
    measured = {"change with m = 0 (%)": 100 * none, "change with m = 10 kg (%)": 100 * adopted}
    return Finding(measured, graded(none >= 0.5 * adopted, none >= 0.01), why)


@claim(
    _PLACE,
    "A light absorber is two springs in series, of stiffness k_l/2 between the shells.",
    "stiffness: least-squares slope of the force on the outer shell against the heads' approach, m = 1 kg; "
    "holds: within 5 % of k_l/2; in part: within 20 %",
)
def light_absorber_is_springs_in_series(runs: Runs) -> Finding:
    """Fit the stiffness between the shells."""
    run = _masses(runs)[1.0]
    approach = run.displacement("inner", "head") - run.displacement("outer", "head")
    slope = float(run.absorber[2] @ approach / (approach @ approach)) / _STIFFNESS
    away = abs(slope / 0.5 - 1.0)
    why = f"With 1 kg the force follows the approach with {slope:.3f} k_l."
    return Finding({"stiffness between the shells over k_l": slope}, graded(away <= 0.05, away <= 0.2), why)


@claim(
    _PLACE,
    "From 50 kg on the mass is an anchor: it hardly moves, and each shell is held to it by a spring k_l.",
    "RMS of the mass's displacement over the larger RMS of the two heads, up to t = 1 (the text says short time "
    "scales); holds: at most 20 % for 50 and 100 kg; in part: at most 50 %",
)
def heavy_mass_is_an_anchor(runs: Runs) -> Finding:
    """Compare the motion of heavy masses with that of the heads."""
    ratios = {}
    for m, run in _masses(runs).items():
        if m >= cases.LINEAR["mass"]:
            short = run.time <= SHORT
            heads = max(rms(run.displacement(shell, "head")[short]) for shell in ("inner", "outer"))
            ratios[m] = rms(run.absorber[0][short]) / heads
    worst = max(ratios[50.0], ratios[100.0])
    moves = ", ".join(f"{100 * v:.0f} % ({m:g} kg)" for m, v in ratios.items())
    why = f"Up to t = {SHORT:g} the mass moves {moves} of what the heads do, in the RMS."
    measured = {f"m = {m:g} kg, RMS of the mass over that of the heads (%)": 100 * v for m, v in ratios.items()}
    return Finding(measured, graded(worst <= 0.2, worst <= 0.5), why)


@claim(
    _PLACE,
    "The two shells weigh about 577 kg per metre of length.",
    "holds: rounds to 577 kg; in part: within 1 %",
)
def shells_weigh_577_kg(runs: Runs) -> Finding:
    """Add up the layers."""
    found = shell_mass()
    why = f"The layers of Table 1 weigh {found:.1f} kg per metre."
    return Finding({"mass of both shells (kg/m)": found}, graded(round(found) == 577, abs(found / 577.0 - 1.0) <= 0.01), why)


@claim(
    _PLACE,
    "One absorber of 10 kg adds not more than 1.7 % of mass.",
    "holds: at most 1.7 % to the digits printed; in part: at most 2 %",
)
def absorber_adds_1_7_per_cent(runs: Runs) -> Finding:
    """Compare 10 kg with the mass of the shells."""
    found = 100.0 * cases.LINEAR["mass"] / shell_mass()
    why = f"10 kg are {found:.2f} % of the shells' mass; with the adopted 25 absorbers it is {cases.ADOPTED_COUNT * found:.0f} %."
    return Finding({"added mass (%)": found}, graded(round(found, 1) <= 1.7, found <= 2.0), why)


@claim(
    _PLACE,
    "A mass of 10 kg performs acceptably: it lowers the extrema of the inner stress.",
    "holds: the peak falls at the inner head and tail; in part: at one of them",
)
def adopted_mass_lowers_the_extrema(runs: Runs) -> Finding:
    """Compare peaks with the adopted mass and without."""
    from coaxshell.apps.paper.claims.measures import reduction

    found, bare = _masses(runs)[10.0].shells["inner"], systems.bare(runs).shells["inner"]
    falls = {
        ("inner", "head"): reduction(found.stress_head.value, bare.stress_head.value),
        ("inner", "tail"): reduction(found.stress_tail.value, bare.stress_tail.value),
    }
    down = [fall > 0.0 for fall in falls.values()]
    why = f"The peak falls by {sentence(falls, '{:.1f} %', 1.0)}."
    return Finding(named(falls, "reduction of the peak (%)", 1.0), graded(all(down), any(down)), why)
