"""Units as figures print them, with the prefix that makes the numbers short."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.model.prefixes import PREFIXES, exponent_of

_PREFIXED = ("Pa", "m", "V", "V/m", "N/m", "J/m", "s")
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def pretty(unit: str) -> str:
    """Return a unit with raised powers and without stars: ``N*s/m^2`` is ``N s/m²``."""
    for plain, drawn in (("*", " "), ("^2", "²"), ("^3", "³"), ("^4", "⁴")):
        unit = unit.replace(plain, drawn)
    return unit


def raised(value: float) -> str:
    """Return a number with three digits and raised powers of ten: ``10⁴``, ``2.5×10⁻⁷``, ``350``."""
    mantissa, _, exponent = f"{value:.3g}".partition("e")
    if not exponent:
        return mantissa
    power = "10" + str(int(exponent)).translate(_RAISED)
    return {"1": power, "-1": f"-{power}"}.get(mantissa, f"{mantissa}×{power}")


def scale(values: npt.ArrayLike, unit: str) -> tuple[float, str]:
    """Return the factor and the unit with an SI prefix that suit the largest finite magnitude of *values*."""
    array = np.asarray(values, float)
    finite = np.abs(array[np.isfinite(array)])
    largest = float(finite.max()) if finite.size else 0.0
    if unit not in _PREFIXED or not largest:
        return 1.0, "" if unit == "1" else pretty(unit)
    exponent = exponent_of(largest)
    return 10.0**-exponent, f"{PREFIXES[exponent]}{unit}"
