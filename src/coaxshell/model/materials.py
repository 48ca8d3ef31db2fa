"""The materials room: the two kinds of material and the library, as ``coaxshell.materials``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import BeforeValidator

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.catalogue import (
    ALIASES,
    ALUMINIUM,
    ALUMINIUM_STRUCTURAL,
    BRASS,
    COPPER,
    PZT4,
    PZT4_STANDARD,
    PZT5A,
    PZT5H,
    STAINLESS_STEEL_316L,
    STEEL_IAKOVLEV_2008,
    STEEL_IAKOVLEV_2014,
    STEEL_IAKOVLEV_2015,
    STRUCTURAL_STEEL,
    TITANIUM_TI6AL4V,
    get,
    names,
)
from coaxshell.model.elastic import Elastic
from coaxshell.model.naming import lookup
from coaxshell.model.piezoelectric import Piezoelectric

__all__ = [
    "ALIASES",
    "ALUMINIUM",
    "ALUMINIUM_STRUCTURAL",
    "BRASS",
    "COPPER",
    "PZT4",
    "PZT4_STANDARD",
    "PZT5A",
    "PZT5H",
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
    "as_material",
    "get",
    "names",
]

Material = Elastic | Piezoelectric

KINDS: dict[str, type[Material]] = {"elastic": Elastic, "piezoelectric": Piezoelectric}


def as_material(value: Any) -> Material:
    """Return a material from an instance, a library name, or a mapping of constants (kind told by ``type`` or by ``c22``)."""
    if isinstance(value, Elastic | Piezoelectric):
        return value
    if isinstance(value, str):
        return get(value)
    if isinstance(value, Mapping):
        guess = "piezoelectric" if "c22" in value or "c33" in value else "elastic"
        return lookup(KINDS, str(value.get("type", guess)), "kind of material", "type").model_validate(dict(value))
    raise InputError("", f"{shown(value)} is not a material", "give an Elastic, a Piezoelectric, or the name of one: " + ", ".join(names()))


AnyMaterial = Annotated[Elastic | Piezoelectric, BeforeValidator(as_material)]
