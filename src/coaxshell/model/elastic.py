"""Isotropic elastic material."""

from __future__ import annotations

from typing import Annotated, Literal

from coaxshell.model.base import Described
from coaxshell.model.units import Density, Modulus, quantity


class Elastic(Described):
    """Describe an isotropic, linearly elastic material; in plane strain its modulus is E/(1 - nu^2)."""

    type: Literal["elastic"] = "elastic"
    name: str = "elastic"
    """What the material is called; in a file the name of its table."""
    density: Density
    """Mass per volume (kg/m^3)."""
    youngs_modulus: Modulus
    """Young's modulus E (Pa)."""
    poisson_ratio: Annotated[float, quantity("number", above=-1, below=0.5)]
    """Poisson's ratio nu, between -1 and 0.5."""
    reference: str = ""
    """Where the constants come from."""
