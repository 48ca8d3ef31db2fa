"""Entries of a system by dotted path: found, and changed all at once, so that only the result need be consistent.

``materials.aluminium.density`` stands for every layer of that material.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypeVar

from coaxshell.errors import InputError
from coaxshell.model.base import Described
from coaxshell.model.layers import Layer
from coaxshell.model.naming import plain, slug, suggestion
from coaxshell.model.parts import SystemParts
from coaxshell.model.paths import joined, parsed, within
from coaxshell.model.places import item_words
from coaxshell.model.shells import Shell

S = TypeVar("S", bound=SystemParts)
Tree = dict[str, Any]


def entry(system: SystemParts, way: Sequence[str]) -> Any:
    """Return what the parts of a path lead to in a system, a mapping by name for ``materials``; None if to nothing."""
    node: Any = system
    for number, part in enumerate(way):
        if number == 0 and part == "materials":
            node = {plain(key): material for key, material in _materials(system).items()}
        elif isinstance(node, dict):
            node = node.get(plain(part))
        elif isinstance(node, tuple):
            index = _number(part, way[number - 1], len(node))
            node = None if index is None else node[index]
        else:
            node = getattr(node, part, None) if isinstance(node, Described) and part in type(node).model_fields else None
    return node


def apply(system: S, changes: Mapping[str, Any]) -> S:
    """Return a system with the entries at the given paths changed, all at once, so that only the result need be consistent.

    Raises
    ------
    InputError
        With the path, and what is allowed there.
    """
    tree: Tree = {}
    for path, value in changes.items():
        _plant(tree, path, value)
    materials = tree.pop("materials", None)
    if materials is not None:
        system = _with_materials(system, materials)
    return _grown(system, tree, "") if tree else system


class _Leaf:
    """A new value at the end of a path; a class of its own so that a mapping can be a value."""

    def __init__(self, value: Any) -> None:
        self.value = value


def _plant(tree: Tree, path: str, value: Any) -> None:
    *way, last = parsed(path)
    node = tree
    for part in way:
        node = node.setdefault(part, {})
        if isinstance(node, _Leaf):
            raise InputError(path, "is inside another path that is changed as a whole", "change one or the other")
    if last in node:
        raise InputError(path, "is changed twice", "give each path once")
    node[last] = _Leaf(value)


def _grown(thing: Any, tree: Tree, where: str) -> Any:
    """Return *thing* rebuilt with every change under it."""
    if isinstance(thing, tuple):
        items = list(thing)
        for part, branch in tree.items():
            number = _index(part, len(items), where)
            items[number] = _new(items[number], branch, f"{where}[{number}]")
        return tuple(items)
    if isinstance(thing, Described):
        fresh: Tree = {}
        allowed = [name for name in type(thing).model_fields if name not in ("type", "rigid")]
        for part, branch in tree.items():
            inner = joined(where, part)
            if part not in allowed:
                raise InputError(inner, f"is not an entry of {type(thing).__name__}", suggestion(part, allowed))
            fresh[part] = _new(getattr(thing, part), branch, inner)
        try:
            return thing.replace(**fresh)
        except InputError as error:
            raise within(where, error) from None
    first = next(iter(tree))
    state = "is not set in this system" if thing is None else "has no entries of its own"
    raise InputError(joined(where, first), f"{where} {state}", f"change {where} as a whole, or describe it first")


def _new(thing: Any, branch: Tree | _Leaf, where: str) -> Any:
    return branch.value if isinstance(branch, _Leaf) else _grown(thing, branch, where)


def _number(part: str, listing: str, count: int) -> int | None:
    """Return the number of an item of a list of the system, from its number or its name; None if it is none of them."""
    number = item_words(listing, count).get(part, int(part) if part.isdecimal() else count)
    return number if 0 <= number < count else None


def _index(part: str, count: int, where: str) -> int:
    if count == 0:
        raise InputError(joined(where, part), f"this system has no {where}", f"describe {where} first")
    number = _number(part, where, count)
    if number is None:
        numbers = ", ".join(str(i) for i in range(count)) if count <= 10 else f"0 to {count - 1}"
        words = item_words(where, count)
        first = {number: word for word, number in reversed(words.items())}  # of several words for one item, the first
        allowed = ", ".join([numbers, *(word for word in words if word in first.values())])
        raise InputError(f"{where}[{part}]", f"{part!r} is not an item of {where}", f"allowed: {allowed}")
    return number


def _layers(system: SystemParts) -> list[Layer]:
    return [layer for shell in system.shells if isinstance(shell, Shell) for layer in shell.layers]


def _materials(system: SystemParts) -> dict[str, Any]:
    """Return the materials of all layers by their names as keys."""
    return {slug(layer.material.name): layer.material for layer in _layers(system)}


def _with_materials(system: S, tree: Tree | _Leaf) -> S:
    """Change a material in every layer made of it."""
    found = _materials(system)
    if isinstance(tree, _Leaf):
        raise InputError(
            "materials", "cannot be replaced as a whole", suggestion("materials", [f"materials.{key}.density" for key in found])
        )
    fresh = {}
    for part, branch in tree.items():
        key = next((key for key in found if plain(key) == plain(part)), None)
        if key is None:
            raise InputError(f"materials.{part}", "is not a material of this system", suggestion(part, found))
        if len({layer.material for layer in _layers(system) if slug(layer.material.name) == key}) > 1:
            raise InputError(f"materials.{part}", "is the name of two different materials", "give each a name of its own")
        fresh[key] = _new(found[key], branch, f"materials.{key}")

    def renewed(layer: Layer) -> Layer:
        key = slug(layer.material.name)
        return layer.replace(material=fresh[key]) if key in fresh else layer

    shells = [
        shell.replace(layers=tuple(renewed(layer) for layer in shell.layers)) if isinstance(shell, Shell) else shell
        for shell in system.shells
    ]
    return system.replace(shells=shells)
