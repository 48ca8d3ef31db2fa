"""Magnitudes that no material or fluid has, and what was probably meant: remarked when a system is solved, never refused."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from coaxshell.model.fluids import Fluid
from coaxshell.model.pulses import Sampled
from coaxshell.model.shells import Shell

if TYPE_CHECKING:
    from coaxshell.model.system import System

USUAL: dict[str, tuple[float, float, str, tuple[tuple[float, str], ...]]] = {
    "youngs_modulus": (1e8, 1.3e12, "Pa", ((1e9, "GPa"), (1e6, "MPa"))),
    "density": (50.0, 25_000.0, "kg/m^3", ((1e3, "g/cm^3"),)),
    "sound_speed": (300.0, 10_000.0, "m/s", ((1e3, "km/s"), (1e-3, "mm/s"))),
}
"""Least and largest usual value, its unit, and units that people have in mind. Young's moduli from polymers to diamond (1.2e12 Pa) and
densities from foams to osmium (22,590 kg/m^3): M. F. Ashby, Materials Selection in Mechanical Design; sound speeds from air to hydrogen
and glass: CRC Handbook of Chemistry and Physics. A value outside that would be usual in another unit was probably meant in that one;
one that would not, such as a wall of next to nothing, is somebody's intention."""

EXTREME: dict[str, tuple[float, float, str, str]] = {
    "peak_pressure": (
        1e-2,
        1e10,
        "Pa",
        "any pulse that is worth computing; is its unit right (mPa is a thousandth of a pascal, MPa a million)?",
    ),
    "pulse": (1e-8, 60.0, "s", "any shock; is its unit right (s, ms, us)?"),
    "radius": (1e-4, 1e3, "m", "any shell that is built; is its unit right (m, mm)?"),
    "distance": (1e-4, 1e5, "m", "any distance from which a shock arrives as a wave; is its unit right (m, km)?"),
    "delay": (0.0, 600.0, "s", "any delay between shocks; is its unit right (s, ms, us)?"),
}
"""Least and largest value that is not remarked, its unit, and what to ask: far beyond what is built or fired, so that a model in other
units (a pressure of 1, a radius of 1, a time of 1) passes. A gauge's threshold is 1 Pa, 1e10 Pa the surface of a charge, 500 m the longest
ship; the longest shock lasts about a second."""
MOST_OF_METALS = (1e10, 0.15)
"""Young's modulus of what is no polymer, Pa, and the largest loss factor that structures of it have, joints included: 7 % of critical
damping (V. Adams, A. Askenazi, Building Better Products with Finite Element Analysis)."""
THICKEST = 0.5
"""Wall over mid-surface radius beyond which a shell is a thick cylinder, whatever theory."""


def remarks(system: System) -> list[str]:
    """Return a remark on each magnitude that is out of its range, with the likely meaning, and those on measured records."""
    found: list[str] = []
    for i, shell in enumerate(system.shells):
        found += _extreme(f"shells[{i}].radius", "radius", shell.radius)
        if isinstance(shell, Shell):
            found += _thick(f"shells[{i}]", sum(layer.thickness for layer in shell.layers), shell.radius)
        for j, layer in enumerate(shell.layers if isinstance(shell, Shell) else ()):
            for name in ("youngs_modulus", "density"):
                found += _told(f"shells[{i}].layers[{j}].material.{name}", name, getattr(layer.material, name, None))
            found += _lossy(f"shells[{i}].layers[{j}].material.loss_factor", layer.material)
    for i, fluid in enumerate(system.fluids):
        if isinstance(fluid, Fluid):
            found += _told(f"fluids[{i}].sound_speed", "sound_speed", fluid.sound_speed)
    for i, source in enumerate(system.sources):
        where = f"source[{i}]" if isinstance(system.source, tuple) else "source"
        if isinstance(source.pulse, Sampled):
            found += [f"{where}.pulse: {text}" for text in source.pulse.remarks]
        else:
            found += _extreme(f"{where}: the peak", "peak_pressure", source.pulse.peak)
            for name in ("decay_time", "width", "rise_time", "centre"):
                value = getattr(source.pulse, name, None)
                found += _extreme(f"{where}: {name}", "pulse", value or None)  # a rise of 0 is a sharp front
        for name in ("distance", "delay"):
            found += _extreme(f"{where}.{name}", name, getattr(source, name, None))
    return list(dict.fromkeys(found))


def _told(where: str, name: str, value: Any) -> Iterator[str]:
    least, most, unit, likely = USUAL[name]
    if not isinstance(value, float) or least <= value <= most:
        return
    meant = next((word for factor, word in likely if least <= value * factor <= most), None)
    if meant is not None:
        yield f"{where} = {value:g} {unit} is outside {least:g} to {most:g} {unit}; is {value:g} {meant} meant?"


def _lossy(where: str, material: Any) -> Iterator[str]:
    stiff, most = MOST_OF_METALS
    loss = getattr(material, "loss_factor", 0.0)
    if loss > most and max(getattr(material, "youngs_modulus", 0.0), getattr(material, "c22", 0.0)) > stiff:
        yield f"{where} = {loss:g} is above {most:g}, more than structures of metal lose with all their joints; is it meant in percent?"


def _extreme(where: str, name: str, value: Any) -> Iterator[str]:
    least, most, unit, question = EXTREME[name]
    if isinstance(value, float) and not least <= value <= most:
        side = f"below {least:g}" if value < least else f"above {most:g}"
        yield f"{where} = {value:g} {unit} ({side} {unit}) is outside {question}"


def _thick(where: str, thickness: float, radius: float) -> Iterator[str]:
    if thickness > THICKEST * radius:
        ratio = f"{thickness / radius:.3g} of its radius {radius:g} m"
        yield f"{where}: the wall of {thickness:g} m is {ratio}, more than {THICKEST:g}; is its unit right (m, mm)?"
