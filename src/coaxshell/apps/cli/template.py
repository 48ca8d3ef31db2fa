"""The text of a scenario file: a preset, and below it every entry that a file may have, from the description itself."""

from __future__ import annotations

from collections.abc import Iterator

from coaxshell.model import (
    AbsorberRing,
    Described,
    Elastic,
    Exponential,
    Feedback,
    Fluid,
    Gaussian,
    Layer,
    LineShock,
    LineWave,
    PDControl,
    Piezoelectric,
    PlaneShock,
    PlaneWave,
    PointAbsorber,
    Sampled,
    Sea,
    Shell,
    SphericalShock,
    SphericalWave,
    Step,
    UnderwaterExplosion,
    Viscoelastic,
    fluids,
    laws,
    materials,
    presets,
)
from coaxshell.model.explanations import explanations

_SOURCES: tuple[type[Described], ...] = (SphericalShock, PlaneShock, LineShock, UnderwaterExplosion, SphericalWave, PlaneWave, LineWave)
_PULSES: tuple[type[Described], ...] = (Exponential, Step, Gaussian, Sampled)

_OF_A_RECORD = {
    "file": "A measured record beside this file: CSV or other text, .mat, .wav; see coaxshell record FILE.",
    "(time_column)": "Its heading, or its number from 1 on.",
    "(pressure_column)": "The same; needed where there are several.",
    "(time_unit)": "Instead of the one in the heading.",
    "(pressure_unit)": "The same.",
    "(interval)": "Time between samples where there is no column of times (s).",
    "(sha256)": "Checksum of the file, verified when it is read.",
}

_HEAD = """\
# A scenario for coaxshell; run it by: coaxshell run THIS_FILE
# Numbers are in SI units, or texts with a unit of their own, such as "6 mm", "70 GPa" or "0.13 ms".
# Shells, layers and fluids are listed from the inside out; there is one fluid more than shells.
# Every entry that a file may have is explained at the end.
#
"""


def scenario_text(preset: str) -> str:
    """Return a scenario file made from a preset; InputError when there is none of that name."""
    reference = "\n".join(f"# {line}".rstrip() for line in _reference())
    return f"{_HEAD}{presets.text(preset).rstrip()}\n\n{reference}\n"


def _reference() -> Iterator[str]:
    yield "-" * 100
    yield "Every entry that this file may have; those in (parentheses) may be left out."
    yield ""
    yield "name: what the system is called"
    yield f"fluids: a list of names ({', '.join([*fluids.names(), *fluids.ALIASES])}) or of tables:"
    yield from _entries(Fluid)
    yield "[materials.NAME]: a material of your own; the library has " + ", ".join([*materials.names(), *materials.ALIASES])
    yield "  elastic:"
    yield from _entries(Elastic)
    yield "  viscoelastic, a rubber:"
    yield from _entries(Viscoelastic)
    yield "  piezoelectric:"
    yield from _entries(Piezoelectric)
    yield "[[shells]]: one table a shell"
    yield from _entries(Shell)
    yield "  or a rigid one:"
    yield "    radius                   Radius of the surface (m)."
    yield "    rigid = true             Marks it as rigid."
    yield "  each layer of a shell:"
    yield from _entries(Layer)
    yield "[source], or [[source]] several times: where the shock comes from"
    for source in _SOURCES:
        yield from _kind(source)
    yield "[source.pulse]: the free-field pressure at the head point, for sources that have a pulse"
    for pulse in _PULSES:
        yield from _kind(pulse)
    yield "    instead of time and pressure:"
    for name, meaning in _OF_A_RECORD.items():
        yield f"    {name:<24} {meaning}"
    yield "[absorbers]: a ring of equal absorbers between two shells; or [[absorbers]], one table each, with an angle instead of count"
    yield from _entries(AbsorberRing)
    yield "  in three dimensions [[absorbers]], each at a point of the axis:"
    yield from _entries(PointAbsorber)
    yield "[absorbers.law]: what the links of an absorber exert besides its damper and springs"
    for law in laws.LAWS.values():
        yield from _kind(law)
    yield "[control]: piezoelectric feedback from a shell's sensors to its actuators; or [[control]], several laws, each for its shells"
    yield from _entries(PDControl)
    yield "  or of any other law:"
    yield from _entries(Feedback)
    yield "[sea]: surface, bottom and pressure of the sea around the shells"
    yield from _entries(Sea)


def _kind(model: type[Described]) -> Iterator[str]:
    yield f'  type = "{model.model_fields["type"].default}"'
    yield from _entries(model)


def _entries(model: type[Described]) -> Iterator[str]:
    explained = explanations(model)
    for name, field in model.model_fields.items():
        if name == "type":
            continue
        shown = name if field.is_required() else f"({name})"
        yield f"    {shown:<24} {' '.join(explained.get(name, '').split())}"
