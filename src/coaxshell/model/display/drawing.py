"""The cross-section of a system as SVG: radii to scale, walls thicker than they are, the source to the right at 0 degrees."""

from __future__ import annotations

import math
from collections.abc import Iterator
from html import escape

from coaxshell.model.absorbers import Absorber, drawn_radii
from coaxshell.model.fluids import Fluid, Vacuum
from coaxshell.model.layers import Shell
from coaxshell.model.parts import SystemParts
from coaxshell.model.shells import RigidShell
from coaxshell.model.sources import Source

SIZE = 300
"""Width and height, pixels."""
REACH = 1.75
"""Half the width of what is seen, in units of the outermost radius."""
WALL = 0.09
"""Drawn thickness of the thickest wall, in the same unit, where there is room for it."""
FRONT = 1.3
"""Distance of the drawn front from the axis, in the same unit."""

ROLE_COLOURS = {
    "core": "#7A8794",
    "sensor": "#009E73",
    "charge-sensor": "#56B4E9",
    "actuator": "#D55E00",
    "self-sensing": "#CC79A7",
    "passive": "#B8A24A",
}
"""Colours of layers by role, told apart with any kind of colour vision."""
_WATER = "#2F7FC1"
_SHOCK = "#B5232A"


def wall_factor(system: SystemParts) -> float:
    """Return by how much walls are drawn thicker than they are: at least 1, and so that neighbours never touch."""
    shells = [shell for shell in system.shells if shell.thickness > 0]
    if not shells:
        return 1.0
    wanted = WALL * system.reference_radius / max(shell.thickness for shell in shells)
    room = [0.7 * (b.radius - a.radius) / (0.5 * (a.thickness + b.thickness)) for a, b in _neighbours(system)]
    centre = 0.7 * shells[0].radius / (0.5 * shells[0].thickness)
    return max(1.0, min(wanted, centre, *room))


def cross_section(system: SystemParts) -> str:
    """Return the drawing as an ``<svg>`` element that needs nothing outside itself and takes the page's text colour."""
    factor = wall_factor(system)
    said = f"walls drawn {factor:.3g} times as thick" if factor > 1 else "to scale"
    title = escape(f"Cross-section of {system.name or 'the system'}, {said}")
    half = SIZE / 2
    return "".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{SIZE}" height="{SIZE}" viewBox="{-half:g} {-half:g} {SIZE} {SIZE}" '
            f'role="img" style="max-width:100%;height:auto"><title>{title}</title>',
            *_fluids(system),
            *_sea(system),
            *_absorbers(system, factor),
            *(element for shell in system.shells for element in _shell(system, shell, factor)),
            *(element for source in system.sources for element in _source(system, source)),
            f'<text x="{4 - half:g}" y="{half - 5:g}" font-size="10" fill="currentColor" opacity="0.7">{said}</text></svg>',
        ]
    )


def _neighbours(system: SystemParts) -> Iterator[tuple[Shell | RigidShell, Shell | RigidShell]]:
    return ((a, b) for a, b in zip(system.shells, system.shells[1:], strict=False) if a.thickness + b.thickness > 0)


def _pixels(system: SystemParts, length: float) -> float:
    return length / system.reference_radius * SIZE / 2 / REACH


def _at(system: SystemParts, radius: float, angle: float) -> tuple[float, float]:
    turn = math.radians(angle)
    r = _pixels(system, radius)
    return r * math.cos(turn), -r * math.sin(turn)


def _opacity(fluid: Fluid | Vacuum) -> float:
    return 0.0 if isinstance(fluid, Vacuum) else 0.05 + 0.15 * min(1.0, fluid.density / 1000.0)


def _fluids(system: SystemParts) -> Iterator[str]:
    half = SIZE / 2
    outside = _opacity(system.fluids[-1])
    edge = f"M{-half:g} {-half:g}H{half:g}V{half:g}H{-half:g}Z"
    hole = _circle(_pixels(system, system.reference_radius))
    yield f'<path d="{edge}{hole}" fill="{_WATER}" fill-rule="evenodd" opacity="{outside:.3g}"/>'
    inner = 0.0
    for shell, fluid in zip(system.shells, system.fluids, strict=False):
        radius = _pixels(system, shell.radius)
        hole = _circle(inner) if inner else ""
        yield f'<path d="{_circle(radius)}{hole}" fill="{_WATER}" fill-rule="evenodd" opacity="{_opacity(fluid):.3g}"/>'
        inner = radius


def _sea(system: SystemParts) -> Iterator[str]:
    """Yield the surface of the sea, the air above it in white, and the bottom, hatched; beyond the picture an arrow with the distance."""
    sea = system.sea
    if sea is None:
        return
    turn, wide = f'transform="rotate({-sea.up:g})"', SIZE
    at = _pixels(system, sea.depth)
    if at < SIZE / 2 * math.sqrt(2.0):
        waves = "".join("q-4 4 0 8t0 8" for _ in range(2 * wide // 16 + 1))
        yield f'<g {turn}><path d="M{at:.1f} {-wide}{waves}" fill="none" stroke="{_WATER}" stroke-width="1.6"/>'
        yield f'<path d="M{at + 3:.1f} {-wide}h{wide}v{2 * wide}h{-wide}Z" fill="#FFFFFF" opacity="0.85"/></g>'
    if sea.bottom is not None and (down := _pixels(system, sea.bottom)) < SIZE / 2 * math.sqrt(2.0):
        hatch = "".join(f"M{-down:.1f} {y}l-9 -9" for y in range(-wide, wide, 9))
        line = f'<path d="M{-down:.1f} {-wide}V{wide}" stroke-width="1.8"/>'
        yield f'<g {turn} stroke="#6B5B3E">{line}<path d="{hatch}" stroke-width="0.8"/></g>'
    said = [f"surface {sea.depth:g} m above the axis"] if sea.surface else [f"{sea.depth:g} m deep, surface left out"]
    said += [f"bottom {sea.bottom:g} m below"] if sea.bottom is not None else []
    half = SIZE / 2
    yield f'<text x="{4 - half:g}" y="{half - 17:g}" font-size="10" fill="currentColor" opacity="0.7">{", ".join(said)}</text>'
    yield from _arrow_up(sea.up)


def _arrow_up(up: float) -> Iterator[str]:
    """Yield a small arrow in the corner that points to the surface."""
    half = SIZE / 2
    yield (
        f'<g transform="translate({half - 16:g} {16 - half:g}) rotate({-up:g})" fill="none" stroke="{_WATER}" stroke-width="1.5">'
        '<path d="M-9 0H8m-5 -4l5 4l-5 4"/><title>towards the surface</title></g>'
    )


def _circle(radius: float) -> str:
    arc = f"A{radius:.2f} {radius:.2f} 0 1 0"
    return f"M{radius:.2f} 0{arc} {-radius:.2f} 0{arc} {radius:.2f} 0Z"


def _shell(system: SystemParts, shell: Shell | RigidShell, factor: float) -> Iterator[str]:
    if isinstance(shell, RigidShell):
        yield f'<circle r="{_pixels(system, shell.radius):.2f}" fill="none" stroke="currentColor" stroke-width="3"/>'
        return
    bottom = shell.radius - factor * shell.thickness / 2
    for layer in shell.layers:
        width = factor * layer.thickness
        middle = bottom + width / 2
        yield (
            f'<circle r="{_pixels(system, middle):.2f}" fill="none" stroke="{ROLE_COLOURS[layer.role]}" '
            f'stroke-width="{max(_pixels(system, width), 0.6):.2f}"><title>{escape(layer.material.name)}, {layer.role}</title></circle>'
        )
        bottom += width


def _absorbers(system: SystemParts, factor: float) -> Iterator[str]:
    for absorber in system.absorber_list:
        yield from _absorber(system, absorber, factor)


def _absorber(system: SystemParts, absorber: Absorber, factor: float) -> Iterator[str]:
    inside = [shell.radius - factor * shell.thickness / 2 for shell in system.shells]
    outside = [shell.radius + factor * shell.thickness / 2 for shell in system.shells]
    (x1, y1), (x, y), (x2, y2) = (_at(system, radius, absorber.angle) for radius in drawn_radii(absorber, inside, outside))
    yield f'<path d="M{x1:.1f} {y1:.1f}L{x2:.1f} {y2:.1f}" stroke="currentColor" stroke-width="0.8" opacity="0.6"/>'
    yield f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.4" fill="currentColor"/>'


def _source(system: SystemParts, source: Source) -> Iterator[str]:
    """Yield the front, coming in along the source's ray, an arrow, and the source itself where it is in the picture."""
    distance = system.source_distance(source)
    a = system.reference_radius
    at = FRONT * a if distance is None else min(FRONT * a, (a + distance) / 2)
    x = _pixels(system, at)
    reach = SIZE  # longer than the picture, which cuts it
    if distance is None:
        front = f"M{x:.1f} {-reach}V{reach}"
    else:
        radius = _pixels(system, distance - at)
        spread = min(math.pi / 2, reach / radius)
        dx, dy = radius * (1 - math.cos(spread)), radius * math.sin(spread)
        front = f"M{x + dx:.1f} {-dy:.1f}A{radius:.1f} {radius:.1f} 0 0 0 {x + dx:.1f} {dy:.1f}"
    tip, tail = x - 14, x + 24
    arrow = f"M{tail:.1f} 0H{tip:.1f}m5 -4l-5 4l5 4"
    turn = f'transform="rotate({-source.angle:g})"'
    yield f'<g {turn} fill="none" stroke="{_SHOCK}" stroke-width="1.8"><path d="{front}"/><path d="{arrow}"/></g>'
    if distance is not None and _pixels(system, distance) < SIZE / 2:
        yield f'<circle cx="{_pixels(system, distance):.1f}" cy="0" r="3.5" fill="{_SHOCK}" {turn}/>'
