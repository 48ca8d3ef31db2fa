"""Claims about the bare system's acoustic field: Fig. 4."""

from __future__ import annotations

import numpy as np

from coaxshell.apps.paper.claims import systems
from coaxshell.apps.paper.claims.claim import Finding, claim, graded
from coaxshell.apps.paper.claims.measures import change, sentence_case
from coaxshell.apps.paper.fields import Fields
from coaxshell.apps.paper.known_runs import Runs
from coaxshell.numerics.arrays import FloatArray

_PLACE = "Bare system, Fig. 4"
MACH_INSTANTS = (2.0, 3.1)
STEM = 0.5
"""Pressure of a front, over the incident peak, from which it counts as comparable to the incident wave."""


def at(fields: Fields, name: str, instant: float, clock: str) -> FloatArray:
    """Return the kept picture that is nearest to an instant."""
    return np.asarray(fields[name][int(np.argmin(np.abs(fields[clock] - instant)))], dtype=np.float64)


@claim(
    "Bare system, Fig. 3 and Fig. 4",
    "The outer shell barely weakens the incident wave.",
    "largest pressure on the inside of the outer shell's head over that of the incident wave at the head, 1; "
    "holds: at least 0.8; in part: at least 0.5",
)
def outer_shell_barely_weakens_the_wave(runs: Runs) -> Finding:
    """Compare the pressure behind the outer shell with the incident one."""
    fields = runs.fields(systems.preset("bare"))
    radius = fields["gap radius"]
    found = float(np.abs(fields["gap peak"]).max())
    why = f"On the head's ray in the gap the pressure reaches {found:.2f} of the incident peak (r = {radius[0]:.2f} to {radius[-1]:.2f})."
    return Finding({"peak pressure in the gap over the incident peak": found}, graded(found >= 0.8, found >= 0.5), why)


def _stem(runs: Runs, instant: float) -> Finding:
    """Look for a front of compression inside that is comparable to the incident wave and passes into the gap."""
    fields = runs.fields(systems.preset("bare"))
    inside = at(fields, "interior snapshot", instant, "snapshot time")
    wall = at(fields, "inner wall", instant, "wall time")
    r, a = np.unravel_index(int(inside.argmax()), inside.shape)
    largest, radius, angle = float(inside[r, a]), float(fields["interior radius"][r]), float(fields["angle"][a])
    k = int(wall[0].argmax())
    before, behind = float(wall[0, k]), float(wall[1, k])
    passes = behind >= 0.5 * before
    why = (
        f"The largest pressure inside is {largest:.2f} of the incident peak (r = {radius:.2f}, {angle:.0f}°); on "
        f"the wall it is {before:.2f} "
        f"at {fields['angle'][k]:.0f}° on the inside and {behind:.2f} on the gap's side."
    )
    measured = {
        f"largest interior pressure at t = {instant:g} over the incident peak": largest,
        "its angle (degrees)": angle,
        "largest pressure on the inside of the inner wall": before,
        "pressure on the gap's side there": behind,
    }
    return Finding(measured, graded(largest >= STEM and passes, largest >= 0.5 * STEM and passes), why)


_STEM = (
    "holds: the largest interior pressure is at least half the incident peak, and the gap's side of the inner "
    "wall has at least half of the "
    "largest pressure on its inside; in part: a quarter of the incident peak instead"
)


@claim(_PLACE, "At t = 2.0 a front as strong as the incident wave (a Mach stem) passes from the interior into the gap.", _STEM)
def mach_stem_at_2(runs: Runs) -> Finding:
    """Look for the front at t = 2.0."""
    return _stem(runs, 2.0)


@claim(_PLACE, "At t = 3.1 a front as strong as the incident wave (a Mach stem) passes from the interior into the gap.", _STEM)
def mach_stem_at_3_1(runs: Runs) -> Finding:
    """Look for the front at t = 3.1."""
    return _stem(runs, 3.1)


@claim(
    _PLACE,
    "At t = 3.1 the fronts inside, in the gap and outside lie on one line: each shell's two faces show them at the same points.",
    "angle of the largest pressure on both faces of each shell; holds: within 4° on both shells; in part: on one",
)
def fronts_are_aligned_at_3_1(runs: Runs) -> Finding:
    """Compare the angles of the largest pressure on the two faces of each shell."""
    fields = runs.fields(systems.preset("bare"))
    angles = {shell: fields["angle"][at(fields, f"{shell} wall", 3.1, "wall time").argmax(axis=1)] for shell in ("inner", "outer")}
    close = [abs(float(pair[1] - pair[0])) <= 4.0 for pair in angles.values()]
    why = "; ".join(
        f"{shell} shell: largest at {pair[0]:.0f}° on the inside, {pair[1]:.0f}° on the outside" for shell, pair in angles.items()
    )
    measured = {
        f"{s} shell, angle of the largest pressure {f} (degrees)": float(p[i])
        for s, p in angles.items()
        for i, f in enumerate(("inside", "outside"))
    }
    return Finding(measured, graded(all(close), any(close)), sentence_case(why))


@claim(
    _PLACE,
    "With the same fluid on both sides a shell is transparent: the pressure on one face continues that on the other.",
    "relative L2 difference of the pressures on the two faces, all angles, t = 0.5 to the end; holds: at most 25 % "
    "on both shells; in part: 60 %",
)
def shells_are_transparent(runs: Runs) -> Finding:
    """Compare the pressures on the two faces of each shell."""
    fields = runs.fields(systems.preset("bare"))
    jumps = {shell: change(fields[f"{shell} wall"][:, 0], fields[f"{shell} wall"][:, 1]) for shell in ("inner", "outer")}
    worst = max(jumps.values())
    why = f"The faces differ by {100 * jumps['inner']:.0f} % on the inner shell and {100 * jumps['outer']:.0f} % on the outer one."
    return Finding({f"{s} shell, difference of its faces (%)": 100 * j for s, j in jumps.items()}, graded(worst <= 0.25, worst <= 0.6), why)


@claim(
    _PLACE,
    "What the shells and the fluids within them hold is radiated away, so that the system goes to rest.",
    "holds: at the end less than half of the largest stored energy is left; in part: less than that maximum by 20 % or more",
)
def energy_is_radiated_away(runs: Runs) -> Finding:
    """Compare the energy stored at the end with its maximum."""
    fields = runs.fields(systems.preset("bare"))
    stored, clock = fields["stored"], fields["energy time"]
    most, left = float(stored.max()), float(stored[-1])
    share = left / most
    why = (
        f"The stored energy is largest, {most:.3g} J/m, at t = {clock[int(stored.argmax())]:.2f} and {100 * share:.0f} % of that at "
        f"t = {clock[-1]:g}."
    )
    return Finding({"energy left at the end, of its maximum (%)": 100 * share}, graded(share < 0.5, share < 0.8), why)
