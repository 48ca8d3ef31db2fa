"""What a form is generated from: the description's own schema, presets, libraries, limits."""

from __future__ import annotations

from functools import cache
from importlib.util import find_spec
from typing import Any

from coaxshell._version import __version__
from coaxshell.apps.studio import limits
from coaxshell.apps.studio.curves import quantities, rates
from coaxshell.apps.studio.descriptions import normalised
from coaxshell.model import EXPLOSIVES, System, fluids, materials, presets
from coaxshell.studies.metrics import ABSORBER_QUANTITIES, FLUID_QUANTITIES, SYSTEM_QUANTITIES, WITHOUT_SHELL, shell_quantities

# The limit that JSON Schema has no word for.
_NOT_ZERO = {("peak_pressure", "Pa"), ("pressure", "Pa")}


@cache
def schema() -> dict[str, Any]:
    """Return all of ``/api/schema``."""
    return {
        "version": __version__,
        "schema": _with_nonzero(System.model_json_schema()),
        "presets": [
            {"name": name, "title": presets.description(name), "system": normalised(presets.load(name)), "toml": presets.text(name)}
            for name in presets.names()
        ],
        "materials": [_material(name) for name in materials.names()],
        "fluids": [
            {"name": name, "fluid": fluids.get(name).model_dump(mode="json"), "reference": fluids.REFERENCES[name]}
            for name in fluids.names()
        ],
        "explosives": list(EXPLOSIVES),
        "metric_units": _metric_units(),
        "quantities": [
            {"name": name, "label": label, "unit": unit, "rate": name in rates()} for name, (label, unit) in quantities().items()
        ],
        "resolutions": {
            "preview": limits.table_of(limits.PREVIEW),
            "full": limits.table_of(limits.FULL),
            "preview_spatial": limits.table_of(limits.PREVIEW_SPATIAL),
            "full_spatial": limits.table_of(limits.FULL_SPATIAL),
        },
        "films": ["mp4", "webp"] if find_spec("imageio_ffmpeg") else ["webp"],
        "limits": limits.table(),
    }


def _metric_units() -> dict[str, str]:
    """Return the unit of each metric by its name, or by its quantity where the place does not matter."""
    units = {name: entry.units for name, entry in {**shell_quantities(3), **FLUID_QUANTITIES}.items()}
    for place, names in WITHOUT_SHELL.items():
        units |= {f"{place}.{name}": {**ABSORBER_QUANTITIES, **SYSTEM_QUANTITIES}[key].units for name, key in names.items()}
    return units


def _material(name: str) -> dict[str, Any]:
    material = materials.get(name)
    return {"name": name, "kind": material.type, "material": material.model_dump(mode="json"), "reference": material.reference}


def _with_nonzero(full: dict[str, Any]) -> dict[str, Any]:
    for part in full["$defs"].values():
        for name, field in part.get("properties", {}).items():
            if (name, field.get("unit")) in _NOT_ZERO:
                field["nonzero"] = True
    return full
