"""Fluids, the vacuum, and a library of common ones with their sources."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import BeforeValidator, model_serializer

from coaxshell.errors import InputError
from coaxshell.model.base import Described, shown
from coaxshell.model.naming import lookup
from coaxshell.model.units import Density, Speed


class Fluid(Described):
    """Describe an inviscid compressible fluid at rest; its characteristic impedance is density times sound speed."""

    density: Density
    """Mass per volume (kg/m^3)."""
    sound_speed: Speed
    """Speed of sound (m/s)."""
    name: str = ""
    """What the fluid is called."""


class Vacuum(Described):
    """Describe the absence of a fluid: no pressure at all, exactly. Written as the text ``"vacuum"``."""

    @model_serializer(mode="plain")
    def _as_text(self) -> str:
        return "vacuum"


VACUUM = Vacuum()

WATER_1400 = Fluid(density=1000, sound_speed=1400, name="water-1400")
WATER_1470 = Fluid(density=1000, sound_speed=1470, name="water-1470")
FRESHWATER = Fluid(density=998.2, sound_speed=1482.3, name="freshwater")
SEAWATER = Fluid(density=1026.95, sound_speed=1489.8, name="seawater")
AIR = Fluid(density=1.204, sound_speed=343.2, name="air")
OIL = Fluid(density=950, sound_speed=1540, name="oil")
GLYCERIN = Fluid(density=1260, sound_speed=1980, name="glycerin")

_LIBRARY: dict[str, Fluid | Vacuum] = {
    "vacuum": VACUUM,
    **{fluid.name: fluid for fluid in (WATER_1400, WATER_1470, FRESHWATER, SEAWATER, AIR, OIL, GLYCERIN)},
}

ALIASES: dict[str, str] = {"water": "freshwater", "sea water": "seawater", "castor oil": "oil", "glycerol": "glycerin", "none": "vacuum"}
"""Names that people type, and what they stand for."""

_KINSLER = "Kinsler, Frey, Coppens, Sanders, Fundamentals of Acoustics, App. A10"
# Kept beside the fluids, so that a file naming three fluids stays short.
REFERENCES: dict[str, str] = {
    "vacuum": "exact: no pressure",
    "water-1400": "Vesal, Hasheminejad, Lissek, Table 1",
    "water-1470": "Vesal, Hasheminejad, Lissek, Model verification, after Iakovlev (2014)",
    "freshwater": "20 C, 1 atm: IAPWS-95 (density); Del Grosso and Mader, J. Acoust. Soc. Am. 52 (1972) 1442 (speed)",
    "seawater": "10 C, salinity 35, surface: UNESCO EOS-80 (density); Mackenzie, J. Acoust. Soc. Am. 70 (1981) 807 (speed)",
    "air": "dry, 20 C, 1 atm: ideal gas, R = 287.05 J/(kg K), gamma = 1.4",
    "oil": f"castor oil, 20 C: {_KINSLER}",
    "glycerin": f"20 C: {_KINSLER}",
}


def names() -> tuple[str, ...]:
    """Return the names of the library's fluids, the vacuum included."""
    return tuple(_LIBRARY)


def get(name: str) -> Fluid | Vacuum:
    """Return the library's fluid of that name (case and punctuation ignored); InputError with a suggestion otherwise."""
    return lookup({**_LIBRARY, **{alias: _LIBRARY[meant] for alias, meant in ALIASES.items()}}, name, "fluid")


def as_fluid(value: Any) -> Fluid | Vacuum:
    """Return a fluid from an instance, a library name, or a mapping of its constants."""
    if isinstance(value, Fluid | Vacuum):
        return value
    if isinstance(value, str):
        return get(value)
    if isinstance(value, Mapping):
        return Fluid.model_validate(dict(value))
    raise InputError("", f"{shown(value)} is not a fluid", "give a Fluid, VACUUM, or the name of one: " + ", ".join(names()))


AnyFluid = Annotated[Fluid | Vacuum, BeforeValidator(as_fluid)]
