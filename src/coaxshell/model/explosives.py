"""Underwater-explosion similitude: constants of the shock's peak pressure and decay time, explosive by explosive."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Explosive:
    """Hold the similitude constants of an explosive.

    p = peak_factor (W^(1/3)/S)^peak_exponent and theta = decay_factor W^(1/3) (W^(1/3)/S)^decay_exponent, with the
    charge mass W in kg and the stand-off S in m; *lowest* and *highest* bound the peak pressures (Pa) that the fit covers.
    Of the bubble, with Z = depth + 10 m, the period is bubble_period W^(1/3)/Z^(5/6) (s), the largest radius bubble_radius (W/Z)^(1/3)
    (m); None where no sourced constants are at hand.
    """

    name: str
    peak_factor: float
    peak_exponent: float
    decay_factor: float
    decay_exponent: float
    lowest: float
    highest: float
    reference: str
    bubble_period: float | None = None
    bubble_radius: float | None = None


_SWISDAK = "Swisdak, Explosion Effects and Properties, Part II: Explosion Effects in Water, NSWC/WOL TR 76-116 (1978)"
# Cole's fit is in pounds, feet and psi: 21600 psi (W^(1/3)/S)^1.13 and 0.058 ms W^(1/3) (W^(1/3)/S)^-0.22; below, in kg, m, Pa and s.
_COLE = "Cole, Underwater Explosions, Princeton University Press (1948), ch. 7, converted from lb, ft and psi"
# Reid's table is that of US design data in lb, ft and psi: of PETN 24589 psi, 1.194, 0.052 ms, -0.257, K5 = 4.339 and K6 = 12.88, of HBX-1
# K5 = 4.761 and K6 = 14.14. It holds from 10 to 100 radii of the charge, which for PETN of 1770 kg/m^3 are the peaks below.
_REID = "Reid, The Response of Surface Ships to Underwater Explosions, DSTO-GD-0109 (1996)"

EXPLOSIVES: dict[str, Explosive] = {
    explosive.name: explosive
    for explosive in (
        Explosive("TNT", 52.4e6, 1.13, 0.084e-3, -0.23, 3.4e6, 138e6, _SWISDAK, 2.11, 3.50),
        Explosive("pentolite", 56.5e6, 1.14, 0.084e-3, -0.23, 3.4e6, 138e6, _SWISDAK),
        Explosive("HBX-1", 56.7e6, 1.15, 0.083e-3, -0.29, 3.4e6, 60e6, f"{_SWISDAK}; bubble: {_REID}", 2.302, 3.775),
        Explosive("PETN", 56.21e6, 1.194, 0.086e-3, -0.257, 8.0e6, 125e6, _REID, 2.098, 3.439),
        Explosive("TNT-Cole", 52.4e6, 1.13, 0.0925e-3, -0.22, 3.4e6, 138e6, _COLE, 2.11, 3.36),
    )
}
