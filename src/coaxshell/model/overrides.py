"""Change fields of a system by dotted path, all at once, so that only the result need be consistent."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypeVar

from coaxshell.errors import InputError
from coaxshell.limits import PATH
from coaxshell.model.base import Described, joined, shown, within
from coaxshell.model.layers import Layer
from coaxshell.model.naming import plain, slug, suggestion
from coaxshell.model.places import item_words
from coaxshell.model.shells import Shell

if TYPE_CHECKING:
    from coaxshell.model.system import System

S = TypeVar("S", bound="System")
Tree = dict[str, Any]


class _Leaf:
    """A new value at the end of a path; a class of its own so that a mapping can be a value."""

    def __init__(self, value: Any) -> None:
        self.value = value


def apply(system: S, changes: Mapping[str, Any]) -> S:
    """Return *system* with the fields at the given paths changed; InputError names the path and what is allowed there."""
    tree: Tree = {}
    for path, value in changes.items():
        _plant(tree, path, value)
    materials = tree.pop("materials", None)
    changed = system
    if materials is not None:
        changed = _with_materials(system, materials)
    return _grown(changed, tree, "") if tree else changed


def _plant(tree: Tree, path: str, value: Any) -> None:
    if not isinstance(path, str):
        raise InputError("", f"{shown(path)} is not a path", "write it as source.peak_pressure or shells[0].radius")
    PATH.check(len(path), "", "write it as source.peak_pressure or shells[0].radius")
    tokens = [token for token in re.split(r"[.\[\]]+", path.strip()) if token]
    if not tokens:
        raise InputError("", f"{path!r} is not a path", "write it as source.peak_pressure or shells[0].radius")
    node = tree
    for token in tokens[:-1]:
        node = node.setdefault(token, {})
        if isinstance(node, _Leaf):
            raise InputError(path, "is inside another path that is changed as a whole", "change one or the other")
    if tokens[-1] in node:
        raise InputError(path, "is changed twice", "give each path once")
    node[tokens[-1]] = _Leaf(value)


def _grown(thing: Any, tree: Tree, where: str) -> Any:
    """Return *thing* rebuilt with every change under it."""
    if isinstance(thing, tuple):
        items = list(thing)
        for token, branch in tree.items():
            number = _index(token, len(items), where)
            items[number] = branch.value if isinstance(branch, _Leaf) else _grown(items[number], branch, f"{where}[{number}]")
        return tuple(items)
    if isinstance(thing, Described):
        fresh: Tree = {}
        allowed = [name for name in type(thing).model_fields if name not in ("type", "rigid")]
        for token, branch in tree.items():
            if token not in allowed:
                raise InputError(joined(where, token), f"is not an entry of {type(thing).__name__}", suggestion(token, allowed))
            inner = joined(where, token)
            fresh[token] = branch.value if isinstance(branch, _Leaf) else _grown(getattr(thing, token), branch, inner)
        try:
            return thing.replace(**fresh)
        except InputError as error:
            raise within(where, error) from None
    first = next(iter(tree))
    state = "is not set in this system" if thing is None else "has no entries of its own"
    raise InputError(joined(where, first), f"{where} {state}", f"change {where} as a whole, or describe it first")


def _index(token: str, count: int, where: str) -> int:
    if count == 0:
        raise InputError(joined(where, token), f"this system has no {where}", f"describe {where} first")
    places = item_words(count)
    if token in places:
        return places[token]
    if token.isdecimal() and int(token) < count:
        return int(token)
    listing = ", ".join(str(i) for i in range(count)) if count <= 10 else f"0 to {count - 1}"
    raise InputError(f"{where}[{token}]", f"{token!r} is not an item of {where}", f"allowed: {listing}, inner, outer")


def _with_materials(system: S, tree: Tree | _Leaf) -> S:
    """Change a material in every layer made of it."""
    layers = [layer for shell in system.shells if isinstance(shell, Shell) for layer in shell.layers]
    found = {slug(layer.material.name): layer.material for layer in layers}
    if isinstance(tree, _Leaf):
        raise InputError(
            "materials", "cannot be replaced as a whole", suggestion("materials", [f"materials.{key}.density" for key in found])
        )
    fresh = {}
    for token, branch in tree.items():
        key = next((key for key in found if plain(key) == plain(token)), None)
        if key is None:
            raise InputError(f"materials.{token}", "is not a material of this system", suggestion(token, found))
        if len({layer.material for layer in layers if slug(layer.material.name) == key}) > 1:
            raise InputError(f"materials.{token}", "is the name of two different materials", "give each a name of its own")
        fresh[key] = branch.value if isinstance(branch, _Leaf) else _grown(found[key], branch, f"materials.{key}")

    def changed(layer: Layer) -> Layer:
        key = slug(layer.material.name)
        return layer.replace(material=fresh[key]) if key in fresh else layer

    shells = [
        shell.replace(layers=tuple(changed(layer) for layer in shell.layers)) if isinstance(shell, Shell) else shell
        for shell in system.shells
    ]
    return system.replace(shells=shells)
