"""Claims about the pressure and the energy under hybrid control: Figs. 13 and 14."""

from __future__ import annotations

import numpy as np

from coaxshell.apps.paper.claims import systems
from coaxshell.apps.paper.claims.claim import Finding, claim, graded
from coaxshell.apps.paper.claims.measures import change, reduction, rms
from coaxshell.apps.paper.claims.waves import at
from coaxshell.apps.paper.fields import Fields
from coaxshell.apps.paper.known_runs import Runs

REGIONS = ("exterior", "gap", "interior")


def _both(runs: Runs) -> tuple[Fields, Fields]:
    return runs.fields(systems.preset("bare")), runs.fields(systems.preset("hybrid"))


def _changes(runs: Runs, instant: float) -> dict[str, float]:
    """Return the area-weighted relative L2 change of the field of each region."""
    bare, hybrid = _both(runs)
    found = {}
    for region in REGIONS:
        weight = np.sqrt(bare[f"{region} radius"])[:, None]
        found[region] = change(*(weight * at(fields, f"{region} snapshot", instant, "snapshot time") for fields in (hybrid, bare)))
    return found


@claim(
    "Hybrid control, Fig. 13",
    "At t = 1.0 the field outside is much alike with and without control, in the gap and above all inside it is significantly different.",
    "relative L2 change over the area; holds: inside and in the gap at least 30 %, and at least twice that outside; "
    "in part: larger than outside",
)
def inner_fields_differ_most_at_1(runs: Runs) -> Finding:
    """Compare the fields at t = 1.0 region by region."""
    found = _changes(runs, 1.0)
    inner = min(found["interior"], found["gap"])
    why = "The field changes by " + ", ".join(f"{100 * v:.0f} % ({region})" for region, v in found.items()) + "."
    measured = {f"{region}, change at t = 1 (%)": 100 * v for region, v in found.items()}
    return Finding(measured, graded(inner >= 0.3 and inner >= 2 * found["exterior"], inner > found["exterior"]), why)


def _falls(runs: Runs) -> dict[str, float]:
    bare, hybrid = _both(runs)
    return {region: reduction(rms(hybrid[f"{region} rms"]), rms(bare[f"{region} rms"])) for region in REGIONS}


@claim(
    "Hybrid control, Fig. 14",
    "The RMS of the pressure inside is reduced markedly.",
    "mean square over area and time; holds: at least 10 % lower; in part: at least 3 %",
)
def interior_pressure_is_reduced(runs: Runs) -> Finding:
    """Measure the reduction of the RMS pressure inside."""
    bare, hybrid = _both(runs)
    fall = _falls(runs)["interior"]
    late = bare["rms time"] >= 0.6 * bare["rms time"][-1]
    later = reduction(rms(hybrid["interior rms"][late]), rms(bare["interior rms"][late]))
    why = f"It falls by {fall:.1f} % over the whole run and by {later:.1f} % over its last two fifths."
    return Finding({"interior, reduction (%)": fall, "interior, late reduction (%)": later}, graded(fall >= 10.0, fall >= 3.0), why)


@claim(
    "Hybrid control, Fig. 14",
    "The RMS of the pressure outside stays almost the same.",
    "within three radii, over area and time; holds: changed by at most 3 %; in part: by at most 10 %",
)
def exterior_pressure_is_unchanged(runs: Runs) -> Finding:
    """Measure the change of the RMS pressure outside."""
    bare, hybrid = _both(runs)
    fall = _falls(runs)["exterior"]
    most = 100.0 * float(np.max(np.abs(hybrid["exterior rms"] / bare["exterior rms"] - 1.0)))
    why = f"It changes by {-fall:+.1f} %, at no instant by more than {most:.1f} %."
    return Finding(
        {"exterior, change (%)": -fall, "exterior, largest change at an instant (%)": most},
        graded(abs(fall) <= 3.0, abs(fall) <= 10.0),
        why,
    )


@claim(
    "Hybrid control, Fig. 14",
    "The energy taken from the interior is not sent outward.",
    "at the end of the run; holds: the outer shell has given the exterior no more energy (2 % allowed) and the RMS "
    "outside is not larger (1 % allowed); "
    "in part: one of the two",
)
def energy_is_not_sent_outward(runs: Runs) -> Finding:
    """Compare the energy radiated with and without control."""
    bare, hybrid = _both(runs)
    radiated = [float(fields["radiated"][-1]) for fields in (bare, hybrid)]
    more, louder = 100.0 * (radiated[1] / radiated[0] - 1.0), -_falls(runs)["exterior"]
    quiet = [more <= 2.0, louder <= 1.0]
    why = (
        f"The outer shell has given the exterior {radiated[1]:.3g} J/m against {radiated[0]:.3g} bare ({more:+.1f} "
        f"%); the RMS outside changes by {louder:+.1f} %."
    )
    return Finding({"radiated energy, change (%)": more, "exterior RMS, change (%)": louder}, graded(all(quiet), any(quiet)), why)


@claim(
    "Hybrid control, Fig. 14",
    "The reduction is explained by energy lost within, in the dampers and the actuators.",
    "dissipated and taken by the actuators until the end, over what less is stored then; holds: both positive and "
    "together at least half; in part: together "
    "positive",
)
def energy_is_lost_within(runs: Runs) -> Finding:
    """Compare what is lost in dampers and actuators with what less is stored."""
    bare, hybrid = _both(runs)
    dampers, actuators = float(hybrid["dissipated"][-1]), float(hybrid["actuators"][-1])
    less = float(bare["stored"][-1] - hybrid["stored"][-1])
    entered = [float(fields["worked"][-1]) for fields in (bare, hybrid)]
    ratio = (dampers + actuators) / less if less else 0.0
    why = (
        f"Dampers take {dampers:.3g} and actuators {actuators:.3g} J/m, {less:.3g} J/m less is stored at the end; the exterior has put in "
        f"{entered[1]:.3g} J/m against {entered[0]:.3g} bare."
    )
    measured = {
        "dissipated in dampers (J/m)": dampers,
        "taken by actuators (J/m)": actuators,
        "less stored (J/m)": less,
        "lost over less stored": ratio,
    }
    return Finding(measured, graded(dampers > 0 and actuators > 0 and less > 0 and ratio >= 0.5, dampers + actuators > 0), why)
