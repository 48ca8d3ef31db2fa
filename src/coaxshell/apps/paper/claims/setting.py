"""Claims about the numerical setting and the limiting cases: section "Numerical simulation", Table 1, Fig. 2."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from coaxshell.apps.paper.claims import systems
from coaxshell.apps.paper.claims.claim import Finding, claim, graded
from coaxshell.apps.paper.claims.measures import change, named, sentence, stress_changes
from coaxshell.apps.paper.known_runs import Runs

if TYPE_CHECKING:
    from coaxshell.model import System

_PLACE = "Numerical simulation"
_LIMITS = "holds: at most 1 % relative L2 change of the stress at head and tail of both shells; in part: at most 5 %"


def _refined(runs: Runs, coarse: str, changed: dict[str, float | int], what: str) -> Finding:
    fine = runs(systems.preset("bare"), replace(runs.resolution, **changed))  # type: ignore[arg-type]
    step = (len(fine.time) - 1) // (len(systems.bare(runs).time) - 1)
    changes = {
        (shell, side): change(values, fine.stress(shell, side)[::step])
        for (quantity, shell, side), values in systems.bare(runs).histories.items()
        if quantity == "stress"
    }
    worst = max(changes.values())
    why = f"{what} changes the stress by {sentence(changes)} against {coarse}."
    return Finding(named(changes, "change (%)"), graded(worst <= 0.01, worst <= 0.05), why)


@claim(_PLACE, "A time step of 0.001 transits makes the solution converge.", _LIMITS + ", on halving the step")
def time_step(runs: Runs) -> Finding:
    """Judge the time step by halving it."""
    coarse = runs.resolution.time_step
    return _refined(runs, f"{coarse:g}", {"time_step": coarse / 2.0}, f"A time step of {coarse / 2.0:g}")


@claim(_PLACE, "150 orders represent the motion of the shells reliably.", _LIMITS + ", on doubling the number of orders")
def number_of_orders(runs: Runs) -> Finding:
    """Judge the number of orders by doubling it."""
    coarse = systems.bare(runs).modes
    return _refined(runs, str(coarse), {"modes": 2 * coarse}, f"M = {2 * coarse}")


def _emulated(runs: Runs, exact: str, thin: System, shells: tuple[str, ...]) -> Finding:
    """Judge a thin fluid by the displacements that it gives against those with a vacuum."""
    reference, found = runs(systems.preset(exact)), runs(thin)
    changes = {
        (shell, side): change(found.displacement(shell, side), reference.displacement(shell, side))
        for shell in shells
        for side in ("head", "tail")
    }
    worst = max(changes.values())
    fluid = f"{systems.THIN_FLUID.density:g} kg/m^3 and {systems.THIN_FLUID.sound_speed:g} m/s"
    why = f"With {fluid} where the exact case has none, the displacement differs by {sentence(changes)}."
    return Finding(named(changes, "change of the displacement (%)"), graded(worst <= 0.01, worst <= 0.05), why)


_EMULATED = "holds: displacement within 1 % (relative L2) of that with an exact vacuum; in part: within 5 %"


@claim(
    "Model verification, Fig. 2-a, b",
    "A gap fluid of negligible density and sound speed isolates the outer shell, so that it answers like one without fluid inside.",
    _EMULATED,
)
def empty_gap(runs: Runs) -> Finding:
    """Compare a thin gap fluid with a vacuum."""
    return _emulated(runs, "iakovlev-evacuated", systems.emptied_by_thin_fluid(), ("outer",))


@claim(
    "Model verification, Fig. 2-c",
    "An inner shell of negligible radius leaves the outer one as if it were filled with the gap fluid alone.",
    "holds: displacement of the outer shell within 1 % (relative L2) of that of the filled shell; in part: within 5 %",
)
def shrunk_core(runs: Runs) -> Finding:
    """Compare a thin core with none."""
    reference, found = runs(systems.preset("iakovlev-filled")), runs(systems.filled_by_shrinking())
    changes = {
        ("outer", side): change(found.displacement("outer", side), reference.displacement("outer", side)) for side in ("head", "tail")
    }
    worst = max(changes.values())
    why = f"With an inner shell of {100 * systems.CORE:g} % of the radius the displacement differs by {sentence(changes)}."
    return Finding(named(changes, "change of the displacement (%)"), graded(worst <= 0.01, worst <= 0.05), why)


@claim(
    "Model verification, Fig. 2-d, e",
    "An interior medium of extremely low density and sound speed has a minimal effect: the inner shell answers as if it were hollow.",
    _EMULATED,
)
def hollow_inner_shell(runs: Runs) -> Finding:
    """Compare a thin interior fluid with a vacuum."""
    return _emulated(runs, "iakovlev-double", systems.double_hollow_by_thin_fluid(), ("inner", "outer"))


@claim(
    "Bare system, Fig. 3-a, b against 2-e",
    "The fluid inside the inner shell brings rapid oscillations of small amplitude into its stress; without it there are none.",
    "rapid: above 4 cycles in a transit; holds: their RMS at the inner head and tail is at least twice that of the same shells hollow, and "
    "below 30 % of the RMS of the whole stress; in part: larger than hollow",
)
def interior_fluid_brings_rapid_oscillations(runs: Runs) -> Finding:
    """Compare the rapid part of the inner stress with and without water inside."""
    from coaxshell.apps.paper.claims.measures import rapid_part, rms

    filled, hollow = systems.bare(runs), runs(systems.hollow_inside())
    ratios, shares = {}, {}
    for side in ("head", "tail"):
        wet, dry = (rms(rapid_part(run.time, run.stress("inner", side))) for run in (filled, hollow))
        ratios["inner", side] = wet / dry
        shares["inner", side] = wet / rms(filled.stress("inner", side))
    strong, small = min(ratios.values()), max(shares.values())
    why = (
        f"Their RMS is {sentence(ratios, '{:.2f} times', 1.0)} what it is in the hollow shell, and {sentence(shares)} of the whole; "
        f"changes of all stress by the water: {sentence(stress_changes(hollow, filled))}."
    )
    measured = {**named(ratios, "rapid RMS, filled over hollow", 1.0), **named(shares, "rapid share of the RMS (%)")}
    return Finding(measured, graded(strong >= 2.0 and small <= 0.3, strong > 1.0), why)
