"""The units of most descriptions with their factors to SI, so that reading one need not import pint, which takes half a second.

Any other unit goes through pint, and a test holds each factor here against it.
"""

from __future__ import annotations

USUAL: dict[str, dict[str, float]] = {
    "m": {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "km": 1000.0, "in": 0.0254, "ft": 0.3048},
    "s": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6},
    "kg": {"kg": 1.0, "g": 1e-3, "t": 1000.0},
    "kg/m": {"kg/m": 1.0},
    "kg/m^3": {"kg/m^3": 1.0, "kg/m3": 1.0, "g/cm^3": 1000.0, "g/cm3": 1000.0},
    "m/s": {"m/s": 1.0, "km/s": 1000.0},
    "m/s^2": {"m/s^2": 1.0, "m/s2": 1.0},
    "Pa": {"Pa": 1.0, "kPa": 1000.0, "MPa": 1e6, "GPa": 1e9, "bar": 1e5},
    "C/m^2": {"C/m^2": 1.0, "C/m2": 1.0},
    "F/m": {"F/m": 1.0, "nF/m": 1e-9},
    "V/m": {"V/m": 1.0, "V/mm": 1000.0, "kV/mm": 1e6},
    "deg": {"deg": 1.0, "°": 1.0},
    "N*s/m^2": {"N*s/m^2": 1.0},
    "N*s/m": {"N*s/m": 1.0},
    "N/m^2": {"N/m^2": 1.0},
    "N/m": {"N/m": 1.0},
    "N/m^4": {"N/m^4": 1.0},
    "N/m^3": {"N/m^3": 1.0},
}
"""Unit in SI: factors of units as they are typed."""
