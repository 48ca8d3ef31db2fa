"""Systems as TOML: materials in tables of their own, everything else where a person would look for it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from coaxshell.errors import InputError
from coaxshell.limits import TOML_BYTES
from coaxshell.model.absorbers import Absorber, PointAbsorber, linked_shells
from coaxshell.model.control import PDControl
from coaxshell.model.feedback import Feedback
from coaxshell.model.gains import gains_of, reads_of
from coaxshell.model.materials import Material, as_material, get, names
from coaxshell.model.naming import slug, suggestion
from coaxshell.model.parts import SystemParts, laws_of, shells_under
from coaxshell.model.paths import within
from coaxshell.model.pulses import Sampled
from coaxshell.model.sources import OFF_THE_PLANE, LineWave, PlaneWave, Source, SphericalWave
from coaxshell.model.toml_text import parsed
from coaxshell.numerics.reading import decoded, regular_bytes

_PAIR = re.compile(r"\[\n\s+([-+.\w]+),\n\s+([-+.\w]+),\n\s+\]")
"""A list of two numbers, such as a modulus and the time in which it relaxes: on one line a person can read it."""


def read(path: Path) -> str:
    """Return the text of a file; InputError when it cannot be read."""
    return text_of(regular_bytes(path, TOML_BYTES, "give the path of a TOML file"), str(path))


def text_of(content: bytes, name: str) -> str:
    """Return the bytes of a TOML file as text, with or without a byte order mark; InputError naming *name* when they are none."""
    try:
        return decoded(content)
    except UnicodeError:
        raise InputError(name, "is not text in UTF-8", "give the path of a TOML file") from None


def loads(text: str, folder: Path | None = None, name: str = "TOML") -> dict[str, Any]:
    """Parse TOML text into the fields of a system, with the names of materials and files resolved; errors of syntax name *name*."""
    return resolved(parsed(text, name), folder)


def resolved(data: dict[str, Any], folder: Path | None = None) -> dict[str, Any]:
    """Turn the tables of a TOML text into the fields of a system, in place: names of materials and files as in :func:`loads`."""
    known = _materials(data.pop("materials", {}))
    shells = data.get("shells")
    for i, shell in enumerate(shells if isinstance(shells, list) else []):
        layers = shell.get("layers") if isinstance(shell, dict) else None
        for j, layer in enumerate(layers if isinstance(layers, list) else []):
            if isinstance(layer, dict) and isinstance(layer.get("material"), str):
                layer["material"] = _found(layer["material"], known, f"shells[{i}].layers[{j}].material")
    if folder is not None:
        source = data.get("source")
        for item in source if isinstance(source, list) else [source]:
            pulse = item.get("pulse") if isinstance(item, dict) else None
            if isinstance(pulse, dict) and isinstance(pulse.get("file"), str):
                pulse["file"] = str(folder / pulse["file"])
    return data


def dumps(system: SystemParts, beside: Path | None = None) -> str:
    """Return TOML text from which an equal system can be read; numbers are plain SI, floats exact.

    The samples of a long record are packed into one text, or, with *beside*, the path of the TOML file to be, written to a file in its
    folder that the text names with its checksum.
    """
    import tomli_w

    data = tables(system, beside)
    packed: dict[str, str] = {}
    for source in data["source"] if isinstance(data["source"], list) else [data["source"]]:
        pulse = source.get("pulse", {})
        if "samples" in pulse:  # put in afterwards, between marks that spare writer and reader the look at every letter
            mark = f"samples of {pulse['sha256']}"
            packed[mark], pulse["samples"] = pulse["samples"], mark
    text = _PAIR.sub(r"[\1, \2]", tomli_w.dumps(data))
    for mark, samples in packed.items():
        text = text.replace(f'samples = "{mark}"', f"samples = '{samples}'")
    return text


def tables(system: SystemParts, beside: Path | None = None) -> dict[str, Any]:
    """Return what :func:`dumps` writes, as nested tables."""
    data = _plain(system)
    written = [_source(source, beside) for source in system.sources]
    data["source"] = written if isinstance(system.source, tuple) else written[0]
    keys: dict[str, Material] = {}
    for shell, written in zip(system.shells, data["shells"], strict=True):
        for layer, entry in zip(getattr(shell, "layers", ()), written.get("layers", ()), strict=True):
            entry["material"] = _key(layer.material, keys)
    ordered: dict[str, Any] = {"name": data.pop("name", ""), "fluids": data.pop("fluids")}
    if keys:
        ordered["materials"] = {key: _plain(material) for key, material in keys.items()}
    return {**ordered, **data}


def canonical(system: SystemParts) -> dict[str, Any]:
    """Return the physics of a system as plain data: no names, references or strengths, a ring written out as its absorbers."""
    data = _plain(system)
    data["source"] = [_source(source, None, hashed=True) for source in system.sources]
    data["absorbers"] = [*map(_absorber, system.absorber_list), *map(_absorber, system.point_absorbers)]
    if system.control is not None:
        several = isinstance(system.control, tuple)
        for law, written in zip(laws_of(system), data["control"] if several else [data["control"]], strict=True):
            numbers = shells_under(system, law)
            if isinstance(law, PDControl):
                gains = [gains_of(system, number) for number in numbers]
                each = zip(("proportional", "derivative"), zip(*gains, strict=True), strict=True)
                written |= {name: x[0] if len(set(x)) == 1 else list(x) for name, x in each}
            rows = [reads_of(system, number) for number in numbers]
            if isinstance(law, Feedback) and law.matrix is not None:
                written["matrix"] = [[row[number] for number in numbers] for row in rows if row is not None]
            written["shells"] = list(numbers)
    return _nameless(data)  # type: ignore[no-any-return]


def _absorber(one: Absorber | PointAbsorber) -> dict[str, Any]:
    """Return an absorber as plain data; that its outer shell is the next one out goes without saying."""
    inner, outer = linked_shells(one)
    return _plain(one if outer > inner + 1 else one.replace(outer_shell=None))


def _plain(model: SystemParts | Material | Any) -> dict[str, Any]:
    """Return a model as plain data without what is unset or empty; ``type`` stays, since it tells the kind."""
    if isinstance(model, SystemParts):  # sources are written by themselves: their records may be long
        return _pruned({**model.model_dump(mode="json", exclude={"source"}), "source": {}})  # type: ignore[no-any-return]
    return _pruned(model.model_dump(mode="json"))  # type: ignore[no-any-return]


def _source(source: Source, beside: Path | None, *, hashed: bool = False) -> dict[str, Any]:
    """Return a source as plain data, its record as a table of its own: for a hash no more than what it means.

    A source in the cross-section's plane is written as before there were others.
    """
    in_plane = {name for name in OFF_THE_PLANE if getattr(source, name, None) == 0.0}
    if not (isinstance(source, SphericalWave | PlaneWave | LineWave) and isinstance(source.pulse, Sampled)):
        return _pruned(source.model_dump(mode="json", exclude=in_plane))  # type: ignore[no-any-return]
    data: dict[str, Any] = _pruned(source.model_dump(mode="json", exclude={"pulse", *in_plane}))
    if hashed:
        return {**data, "pulse": {"type": "sampled", "curve": source.pulse.digest}}
    from coaxshell.model.records import storing

    return {**data, "pulse": storing.table(source.pulse, *(storing.write(source.pulse, beside) if beside is not None else ()))}


_USUAL: dict[str, Any] = {
    "absorbers": [],
    "wetted": "mid-surface",
    "theory": "thin",
    "transducers": "paper",
    "bubble_pulses": 0,
    "links": "both",
    "grounded": False,
    "inertance": 0.0,
}
"""What descriptions leave out where it is as usual, so that they are written as before there was anything else."""


def _pruned(value: Any) -> Any:
    if isinstance(value, dict):
        kept = {key: _pruned(item) for key, item in value.items() if item is not None and not (key in _USUAL and item == _USUAL[key])}
        return {"type": kept["type"], **kept} if "type" in kept else kept  # the kind reads best in front
    return [_pruned(item) for item in value] if isinstance(value, list) else value


def _nameless(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _nameless(item) for key, item in value.items() if key not in ("name", "reference", "strength")}
    return [_nameless(item) for item in value] if isinstance(value, list) else value


def _key(material: Material, keys: dict[str, Material]) -> str:
    """Return the table key of a material, adding it under a new one when the name is already another material's."""
    base = slug(material.name) or "material"
    key, number = base, 1
    while key in keys and keys[key] != material:
        number += 1
        key = f"{base}-{number}"
    keys[key] = material
    return key


def _materials(tables: Any) -> dict[str, Material]:
    if not isinstance(tables, Mapping):
        raise InputError("materials", f"{tables!r} is not a table", "write [materials.NAME] tables")
    known: dict[str, Material] = {}
    for key, table in tables.items():
        try:
            known[key] = as_material({"name": key, **table} if isinstance(table, Mapping) else table)
        except InputError as error:
            raise within(f"materials.{key}", error) from None
    return known


def _found(name: str, known: dict[str, Material], where: str) -> Material:
    if name in known:
        return known[name]
    try:
        return get(name)
    except InputError as error:
        raise InputError(where, error.problem, suggestion(name, [*known, *names()])) from None
