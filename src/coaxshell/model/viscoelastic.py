"""Isotropic viscoelastic material, a rubber: shear relaxes, volume does not."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any, Literal

from pydantic import Field

from coaxshell.model.base import UNSTATED, Described, stated
from coaxshell.model.units import Density, Modulus, Time, quantity

Arm = tuple[Modulus, Time]
MOST_ARMS = 50


class Viscoelastic(Described):
    """Describe an isotropic material whose shear modulus relaxes while its bulk modulus stays elastic, by a Prony series.

    After a step of strain its Young's modulus, at the long-term Poisson's ratio, is E_long + sum_i E_i exp(-t/tau_i): the shear modulus
    is that over 2 (1 + nu), the bulk modulus stays E_long/(3 (1 - 2 nu)).
    """

    type: Literal["viscoelastic"] = "viscoelastic"
    name: str = "viscoelastic"
    """What the material is called; in a file the name of its table."""
    density: Density
    """Mass per volume (kg/m^3)."""
    long_term_modulus: Modulus
    """Young's modulus that is left when all has relaxed (Pa)."""
    poisson_ratio: Annotated[float, quantity("number", above=-1, below=0.5)]
    """Poisson's ratio when all has relaxed, between -1 and 0.5."""
    prony: Annotated[tuple[Arm, ...], Field(min_length=1, max_length=MOST_ARMS)]
    """Pairs of a Young's modulus that relaxes (Pa) and the time in which it does (s)."""
    strength: Modulus | None = None
    """Stress that it stands (Pa): yield strength of a metal, tensile strength of a ceramic; margins are told against it."""
    reference: str = ""
    """Where the constants come from."""

    def __init__(
        self,
        *,
        density: float | str = UNSTATED,
        long_term_modulus: float | str = UNSTATED,
        poisson_ratio: float | str = UNSTATED,
        prony: Sequence[tuple[float | str, float | str]] = UNSTATED,
        **others: Any,
    ) -> None:
        given = {"density": density, "long_term_modulus": long_term_modulus, "poisson_ratio": poisson_ratio, "prony": prony}
        super().__init__(**stated(given), **others)

    @property
    def youngs_modulus(self) -> float:
        """The long-term modulus (Pa)."""
        return self.long_term_modulus
