"""The materials room, as ``coaxshell.materials``: the three kinds of material, and a library of known constants, each with its source."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, NamedTuple

from pydantic import BeforeValidator

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.elastic import Elastic
from coaxshell.model.naming import lookup
from coaxshell.model.piezoelectric import Piezoelectric
from coaxshell.model.viscoelastic import Viscoelastic

__all__ = [
    "ALIASES",
    "ALUMINIUM",
    "ALUMINIUM_STRUCTURAL",
    "BRASS",
    "COPPER",
    "LOSS_FACTORS",
    "PZT4",
    "PZT4_STANDARD",
    "PZT5A",
    "PZT5H",
    "RUBBERS",
    "STAINLESS_STEEL_316L",
    "STEEL_IAKOVLEV_2008",
    "STEEL_IAKOVLEV_2014",
    "STEEL_IAKOVLEV_2015",
    "STRUCTURAL_STEEL",
    "TITANIUM_TI6AL4V",
    "AnyMaterial",
    "Elastic",
    "Material",
    "Piezoelectric",
    "Viscoelastic",
    "as_material",
    "get",
    "names",
]

VESAL = "Vesal, Hasheminejad, Lissek"  # the paper that this package starts from
BERLINCOURT = (
    "Jaffe and Berlincourt, Piezoelectric transducer materials, Proc. IEEE 53 (1965) 1372-1386; field_limit is PZT-4's, ask the maker"
)
ERTURK = "c44, c66 and e15 as the compliances and d15 of Erturk and Inman, Piezoelectric Energy Harvesting (2011), Table E.1, give them"
LIU = "Liu, Wang, Quek, Int. J. Solids Struct. 39 (2002) 2129-2151, whose other constants are the same"
VACUUM_PERMITTIVITY = 8.8541878128e-12  # F/m, CODATA 2018

ALUMINIUM = Elastic(name="aluminium", density=2700, youngs_modulus=70e9, poisson_ratio=0.33, reference=f"{VESAL}, Table 1")
ALUMINIUM_STRUCTURAL = Elastic(
    name="aluminium-structural", density=2700, youngs_modulus=70e9, poisson_ratio=0.3, reference="EN 1999-1-1:2007, 3.2.5 (design values)"
)
STEEL_IAKOVLEV_2008 = Elastic(
    name="steel-iakovlev-2008",
    density=7800,
    youngs_modulus=177.45e9,
    poisson_ratio=0.3,
    reference=f"{VESAL}, Model verification, first case, after Iakovlev (2008)",
)
STEEL_IAKOVLEV_2014 = Elastic(
    name="steel-iakovlev-2014",
    density=7900,
    youngs_modulus=241.0e9,
    poisson_ratio=0.3,
    reference=f"{VESAL}, Model verification, second case, after Iakovlev (2014)",
)
STEEL_IAKOVLEV_2015 = Elastic(
    name="steel-iakovlev-2015",
    density=7800,
    youngs_modulus=177.45e9,
    poisson_ratio=0.3,
    reference=f"{VESAL}, Model verification, third case, after Iakovlev (2015)",
)
STRUCTURAL_STEEL = Elastic(
    name="structural-steel",
    density=7850,
    youngs_modulus=210e9,
    poisson_ratio=0.3,
    strength=235e6,
    reference="EN 1993-1-1:2005, 3.2.6 (E, nu), Table 3.1 (strength: yield of S235); EN 1991-1-1:2002, Table A.4 (density)",
)
STAINLESS_STEEL_316L = Elastic(
    name="stainless-steel-316l",
    density=8000,
    youngs_modulus=200e9,
    poisson_ratio=0.3,
    strength=220e6,
    reference="EN 10088-1:2014, 1.4404 (density, E); EN 1993-1-4:2006, 2.1.3 (nu), Table 2.1 (strength: yield of hot rolled plate)",
)
TITANIUM_TI6AL4V = Elastic(
    name="titanium-ti6al4v",
    density=4430,
    youngs_modulus=113.8e9,
    poisson_ratio=0.342,
    strength=880e6,
    reference="ASM material data sheet MTP641, Ti-6Al-4V (Grade 5), annealed; Boyer, Welsch, Collings (eds), Materials Properties "
    "Handbook: Titanium Alloys, ASM International (1994)",
)
BRASS = Elastic(
    name="brass",
    density=8530,
    youngs_modulus=110e9,
    poisson_ratio=0.375,
    reference="ASM Handbook vol. 2 (1990), C26000 cartridge brass, 70 Cu 30 Zn",
)
COPPER = Elastic(
    name="copper",
    density=8960,
    youngs_modulus=129.8e9,
    poisson_ratio=0.343,
    reference="Kaye and Laby, Tables of Physical and Chemical Constants, 16th ed. (1995), 2.2.2 (E, nu); CRC Handbook (density)",
)
PZT4 = Piezoelectric(
    name="PZT-4",
    density=7500,
    c22=132e9,
    c23=73e9,
    c33=115e9,
    e32=-4.1,
    e33=14.1,
    permittivity_22=7.124e-9,
    permittivity_33=5.841e-9,
    c11=132e9,
    c12=71e9,
    c13=73e9,
    c66=30.5e9,
    c44=26e9,
    e31=-4.1,
    e15=10.5,
    permittivity_11=7.124e-9,
    permittivity_reduction="printed",
    actuator_coupling="printed",
    field_limit=590e3,
    reference=f"{VESAL}, Table 1, with its printed reductions (Eqs. A.11 and 4); c44 and e15: {LIU}",
)
PZT4_STANDARD = PZT4.replace(
    name="PZT-4-standard",
    permittivity_reduction="standard",
    actuator_coupling="plane-stress",
    reference=f"{VESAL}, Table 1, with the standard plane-stress reductions; c44 and e15: {LIU}",
)
PZT5A = Piezoelectric(
    name="PZT-5A",
    density=7750,
    c22=121e9,
    c23=75.2e9,
    c33=111e9,
    e32=-5.4,
    e33=15.8,
    permittivity_22=916 * VACUUM_PERMITTIVITY,
    permittivity_33=830 * VACUUM_PERMITTIVITY,
    c11=121e9,
    c12=75.4e9,
    c13=75.2e9,
    c66=22.6e9,
    c44=21.1e9,
    e31=-5.4,
    e15=12.3,
    permittivity_11=916 * VACUUM_PERMITTIVITY,
    reference=f"{BERLINCOURT}; {ERTURK}",
)
PZT5H = Piezoelectric(
    name="PZT-5H",
    density=7500,
    c22=126e9,
    c23=84.1e9,
    c33=117e9,
    e32=-6.5,
    e33=23.3,
    permittivity_22=1700 * VACUUM_PERMITTIVITY,
    permittivity_33=1470 * VACUUM_PERMITTIVITY,
    c11=126e9,
    c12=79.5e9,
    c13=84.1e9,
    c66=23.5e9,
    c44=23.0e9,
    e31=-6.5,
    e15=17.0,
    permittivity_11=1700 * VACUUM_PERMITTIVITY,
    reference=f"{BERLINCOURT}; {ERTURK}",
)

CREMER = "Cremer, Heckl, Structure-Borne Sound, 2nd ed. (1988), table of bending loss factors at about 20 degrees C"
LOSS_FACTORS: dict[str, tuple[float, float, str]] = {
    "aluminium": (1e-4, 1e-4, CREMER),
    "steel": (2e-4, 6e-4, f"{CREMER} (iron)"),
    "copper": (2e-3, 2e-3, f"{CREMER} (polycrystalline)"),
    "brass": (0.0, 1e-3, f"{CREMER} (an upper bound)"),
}
"""Least and largest loss factor of metals by themselves, and where it comes from; structures with joints lose far more."""

ASHBY = "Ashby, Materials Selection in Mechanical Design, 3rd ed. (2005), Appendix C (typical: not checked against the book)"


class RubberRange(NamedTuple):
    """Least and largest values of one kind of rubber: density (kg/m^3), Young's modulus at rest (Pa), and where they come from."""

    density: tuple[float, float]
    youngs_modulus: tuple[float, float]
    reference: str


RUBBERS: dict[str, RubberRange] = {
    "butyl rubber": RubberRange((900.0, 920.0), (1.0e6, 2.0e6), ASHBY),
    "natural rubber": RubberRange((920.0, 930.0), (1.5e6, 2.5e6), ASHBY),
    "neoprene": RubberRange((1230.0, 1250.0), (0.7e6, 2.0e6), ASHBY),
    "silicone": RubberRange((1300.0, 1800.0), (5.0e6, 20.0e6), ASHBY),
}
"""Ranges of rubbers at rest. What relaxes, and how fast, is a matter of the compound: no table has it, a test does."""

_LIBRARY: dict[str, Elastic | Viscoelastic | Piezoelectric] = {
    material.name.lower(): material
    for material in (
        ALUMINIUM, ALUMINIUM_STRUCTURAL, STEEL_IAKOVLEV_2008, STEEL_IAKOVLEV_2014, STEEL_IAKOVLEV_2015, STRUCTURAL_STEEL,
        STAINLESS_STEEL_316L, TITANIUM_TI6AL4V, BRASS, COPPER, PZT4, PZT4_STANDARD, PZT5A, PZT5H,
    )
}  # fmt: skip


ALIASES: dict[str, str] = {
    "steel": "structural-steel",
    "stainless steel": "stainless-steel-316l",
    "316L": "stainless-steel-316l",
    "titanium": "titanium-ti6al4v",
}
"""Names that people type, and what they stand for."""


def names() -> tuple[str, ...]:
    """Return the names of the library's materials."""
    return tuple(_LIBRARY)


def get(name: str) -> Elastic | Viscoelastic | Piezoelectric:
    """Return the library's material of that name (case and punctuation ignored); InputError with a suggestion otherwise."""
    return lookup({**_LIBRARY, **{alias: _LIBRARY[meant] for alias, meant in ALIASES.items()}}, name, "material")


Material = Elastic | Viscoelastic | Piezoelectric

KINDS: dict[str, type[Material]] = {"elastic": Elastic, "viscoelastic": Viscoelastic, "piezoelectric": Piezoelectric}


def as_material(value: Any) -> Material:
    """Return a material from an instance, a library name, or a mapping of constants (kind told by ``type``, ``c22`` or ``prony``)."""
    if isinstance(value, Elastic | Viscoelastic | Piezoelectric):
        return value
    if isinstance(value, str):
        return get(value)
    if isinstance(value, Mapping):
        guess = "piezoelectric" if "c22" in value or "c33" in value else "elastic"
        if "prony" in value or "long_term_modulus" in value:
            guess = "viscoelastic"
        return lookup(KINDS, str(value.get("type", guess)), "kind of material", "type").model_validate(dict(value))
    raise InputError(
        "",
        f"{shown(value)} is not a material",
        "give an Elastic, a Viscoelastic, a Piezoelectric, or the name of one: " + ", ".join(names()),
    )


AnyMaterial = Annotated[Elastic | Viscoelastic | Piezoelectric, BeforeValidator(as_material)]
