"""The systems that the paper compares in its Figures 5 to 11, by their names in the legends.

Where the paper prints no number, the values are ours: its text names 1e8, 1e9 and 1e10 N/m for the linear stiffness, 10 and 50 kg for
the mass, 1e19 to 1e21 N/m^3 for the cubic one, 1e5 and 1e6 N s/m for the damping.
"""

from __future__ import annotations

from typing import Any

from coaxshell.model import Absorber, PDControl, System, absorber_ring

Cases = dict[str, System]

LINEAR_STIFFNESSES = (1e7, 1e8, 1e9, 1e10, 1e11)
MASSES = (0.0, 1.0, 10.0, 50.0, 100.0)
CUBIC_STIFFNESSES = (0.0, 1e19, 1e20, 1e21, 1e22)
DAMPINGS = (0.0, 1e4, 1e5, 1e6)
GAINS = ((0.0, -150.0), (-1e4, 0.0), (-2e4, 0.0), (-2e4, -150.0))
OFFSETS = tuple(float(angle) for angle in range(0, 61, 3))
COUNTS = tuple(range(51))
COARSE_COUNTS = tuple(range(0, 301, 10))
ADOPTED_COUNT = 25

LINEAR: dict[str, float] = {"mass": 10.0, "linear_stiffness": 1e9}
CUBIC: dict[str, float] = {**LINEAR, "cubic_stiffness": 1e20}


def bare(system: System) -> System:
    """Return a system without absorbers and control."""
    return system.replace(absorbers=(), control=None)


def head_of(system: System) -> float:
    """Return the angle (degrees) that the first source reaches first."""
    return float(system.sources[0].angle)


def linear_stiffness(system: System) -> Cases:
    """Return the cases of Figure 5: one undamped linear absorber of 10 kg at the head."""
    return _single(system, {f"$k_\\mathrm{{l}}$ = {power(k)} N/m": {**LINEAR, "linear_stiffness": k} for k in LINEAR_STIFFNESSES})


def mass(system: System) -> Cases:
    """Return the cases of Figure 6: one undamped linear absorber of 1e9 N/m at the head."""
    return _single(system, {f"$m$ = {m:g} kg": {**LINEAR, "mass": m} for m in MASSES})


def cubic_stiffness(system: System) -> Cases:
    """Return the cases of Figure 7: one undamped absorber of 10 kg and 1e9 N/m at the head."""
    return _single(system, {_cubic_name(k): {**LINEAR, "cubic_stiffness": k} for k in CUBIC_STIFFNESSES})


def offset(system: System) -> Cases:
    """Return the cases of Figure 8: one undamped cubic absorber beside the head; names are the offsets in degrees."""
    plain, head = bare(system), head_of(system)
    moved = {f"{angle:g}": plain.replace(absorbers=[Absorber(angle=head + angle, **CUBIC)]) for angle in OFFSETS}
    return {"bare": plain, **moved}


def count(system: System, counts: tuple[int, ...]) -> Cases:
    """Return cases of Figure 9: rings of undamped cubic absorbers, the first one at the head; names are their numbers."""
    plain, head = bare(system), head_of(system)
    return {str(n): plain.replace(absorbers=absorber_ring(n, offset=head, **CUBIC) if n else ()) for n in counts}


def damping(system: System) -> Cases:
    """Return the cases of Figure 10: the ring of 25 cubic absorbers."""
    plain, head = bare(system), head_of(system)
    rings = {
        f"$c$ = {power(c)} N s/m" if c else "undamped": absorber_ring(ADOPTED_COUNT, offset=head, damping=c, **CUBIC) for c in DAMPINGS
    }
    return {"bare": plain, **{name: plain.replace(absorbers=ring) for name, ring in rings.items()}}


def gains(system: System) -> Cases:
    """Return the cases of Figure 11: proportional and derivative feedback on all shells."""
    plain = bare(system)
    controlled = {
        f"$k_\\mathrm{{p}}$ = {power(p)}, $k_\\mathrm{{d}}$ = {power(d)}": plain.replace(control=PDControl(proportional=p, derivative=d))
        for p, d in GAINS
    }
    return {"bare": plain, **controlled}


def power(value: float) -> str:
    """Return a number as mathematical text, powers of ten from 1000 up."""
    if value == 0 or abs(value) < 1000:
        return f"{value:g}".replace("-", "\N{MINUS SIGN}")
    factor, exponent = f"{value:.0e}".split("e")
    sign = "-" if factor.startswith("-") else ""
    digits = factor.lstrip("-")
    times = "" if digits == "1" else digits + r" \times "
    return f"${sign}{times}10^{{{int(exponent)}}}$"


def _single(system: System, laws: dict[str, dict[str, Any]]) -> Cases:
    plain, head = bare(system), head_of(system)
    return {"bare": plain, **{name: plain.replace(absorbers=[Absorber(angle=head, **law)]) for name, law in laws.items()}}


def _cubic_name(stiffness: float) -> str:
    return f"$k_\\mathrm{{nl}}$ = {power(stiffness)} N/m³" if stiffness else "linear, $k_\\mathrm{nl}$ = 0"
