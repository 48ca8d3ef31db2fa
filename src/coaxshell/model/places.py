"""The shells and the fluids of a system by name, from the inside out: index to name, to the words of a sentence, and back.

Shells are counted from 0 inside, and so are fluids: fluid 0 is the interior, fluid n lies outside shell n - 1, the last is the exterior.
All that tells a user of a shell or a fluid asks here; the studio's page holds the same names in ``words.js``.
"""

from __future__ import annotations

from coaxshell.model.naming import LONGEST


def shell_name(index: int, count: int) -> str:
    """Return the name of a shell among *count*: "inner", "middle" of three, "outer", "shell 2 of 4"; "shell" of a single one."""
    if count == 1:
        return "shell"
    return {0: "inner", count - 1: "outer"}.get(index, "middle" if count == 3 else f"shell {index + 1} of {count}")


def shell_phrase(index: int, count: int) -> str:
    """Return the name of a shell within a sentence: "inner shell", "shell 2 of 4", "shell"."""
    name = shell_name(index, count)
    return name if name.startswith("shell") else f"{name} shell"


def shell_place(index: int, count: int) -> str:
    """Return what a shell is called in a dotted path: its name where that is a word, else "shells[1]"."""
    name = shell_name(index, count)
    return f"shells[{index}]" if " " in name else name


def shell_words(count: int) -> dict[str, int]:
    """Return the words that stand for a shell in paths and arguments, and its number: "inner", "outer", "middle" of three."""
    return {"inner": 0, "outer": count - 1} | ({"middle": 1} if count == 3 else {})


def shell_number(name: str, count: int) -> int | None:
    """Return the number of a shell from one of its names; None when it is none.

    Names are those of :func:`shell_name`, digits, and "shell 1" (counted from 0), as files of earlier versions have it.
    """
    if len(name) > LONGEST:
        return None
    wanted = " ".join(name.split()).lower()
    if wanted.isdecimal() and len(wanted) < 9:
        return int(wanted) if int(wanted) < count else None
    for index in range(count):
        if wanted in (shell_name(index, count), shell_phrase(index, count), f"shell {index}"):
            return index
    return shell_words(count).get(wanted)


def region_name(index: int, shells: int) -> str:
    """Return the name of a fluid among those of so many shells: "interior", "gap" of two, "gap 2" (fluid 2) of more, "exterior"."""
    return {0: "interior", shells: "exterior"}.get(index, "gap" if shells == 2 else f"gap {index}")


def region_side(index: int, shells: int) -> str:
    """Return where a fluid lies as seen from the shells: "inside", "gap", "gap 2", "outside"."""
    return {0: "inside", shells: "outside"}.get(index, region_name(index, shells))


def region_phrase(index: int, shells: int) -> str:
    """Return a fluid within a sentence: "the fluid inside", "the fluid in the gap", "the fluid in gap 2", "the fluid outside"."""
    side = region_side(index, shells)
    return f"the fluid in the {side}" if side == "gap" else f"the fluid in {side}" if side.startswith("gap") else f"the fluid {side}"


def region_place(index: int, shells: int) -> str:
    """Return what a fluid is called in a dotted path: its name where that is a word, else "fluids[1]"."""
    name = region_name(index, shells)
    return f"fluids[{index}]" if " " in name else name


def region_number(name: str, shells: int) -> int | None:
    """Return the number of a fluid from its name; None when it is none, as "gap" of other than two shells."""
    return next((index for index in range(shells + 1) if region_name(index, shells) == name), None)


def item_words(listing: str, count: int) -> dict[str, int]:
    """Return the words that stand for the items of a list of a system that runs from the inside out: its shells, fluids or layers."""
    if listing != "fluids":
        return {**shell_words(count), "interior": 0, "exterior": count - 1}
    return {"interior": 0, **({"gap": 1} if count == 3 else {}), "exterior": count - 1, **shell_words(count)}
