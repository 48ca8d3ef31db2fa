"""Numbers as people have them: NumPy's scalars, arrays without dimensions, fractions and decimals stand for the number that they are."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from typing import Any


def plain(value: Any) -> Any:
    """Return the Python number that a scalar of any kind is, and anything else as it is.

    ``np.int64(8)``, ``np.float32(0.5)``, an array or a labelled array of shape ``()``; ``Fraction(1, 2)`` and ``Decimal("0.5")`` as
    floats, as whole numbers where they are. A boolean of NumPy is a boolean.
    """
    if getattr(value, "shape", None) == () and hasattr(value, "item"):
        value = value.item()
    if isinstance(value, Fraction):
        return value.numerator if value.denominator == 1 else float(value)
    if isinstance(value, Decimal):
        return int(value) if value.is_finite() and value == value.to_integral_value() and abs(value) < 10**18 else float(value)
    return value
