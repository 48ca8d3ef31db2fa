"""A system in one line, and its drawing beside a table, as HTML for notebooks: no script, no style sheet, nothing from outside."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from coaxshell.model.absorbers import AbsorberRing, linked_shells
from coaxshell.model.control import PDControl
from coaxshell.model.display.drawing import ROLE_COLOURS, cross_section
from coaxshell.model.feedback import Feedback
from coaxshell.model.fluids import Fluid, Vacuum
from coaxshell.model.gains import gains_of, saturates
from coaxshell.model.parts import SystemParts, laws_of, shells_under
from coaxshell.model.places import region_side, shell_name, shell_phrase
from coaxshell.model.prefixes import engineering
from coaxshell.model.sea import Sea
from coaxshell.model.shells import RigidShell, Shell
from coaxshell.model.sources import Source, UnderwaterExplosion

Cells = Sequence[str]


def system_line(system: SystemParts) -> str:
    """Return name, shells with their radii, fluids, sources, absorbers and control in one line."""
    radii = ", ".join(engineering(shell.radius, "m") for shell in system.shells)
    count = len(system.shells)
    fluids = " | ".join((fluid.name or "a fluid") if isinstance(fluid, Fluid) else "vacuum" for fluid in system.fluids)
    sources = ", ".join(f"{source.type} of {engineering(source.pulse.peak, 'Pa')}" for source in system.sources)
    parts = [f"{count} shell{'s' * (count != 1)} ({radii})", f"fluids {fluids}", sources]
    if system.absorber_list:
        parts.append(f"{len(system.absorber_list)} absorbers")
    if system.point_absorbers:
        parts.append(f"{len(system.point_absorbers)} point absorbers")
    if laws_of(system):
        words = "control by electrodes" if all(law.transducers == "electrodes" for law in laws_of(system)) else "control"
        words = words if len(laws_of(system)) == 1 else f"{len(laws_of(system))} laws of {words}"
        parts.append(f"saturating {words}" if saturates(system) else words)
    if system.sea is not None:
        parts.append(f"{system.sea.depth:g} m deep in the sea")
    name = f"{system.name!r}, " if system.name else ""
    return f"<System: {name}{'; '.join(parts)}>"


def system_card(system: SystemParts) -> str:
    """Return a system's drawing and a table of its parts as HTML."""
    return card(system, system.name or "unnamed system", [("", "part", "what it is"), *_parts(system)])


def card(system: SystemParts, heading: str, rows: Sequence[Cells], notes: Sequence[str] = ()) -> str:
    """Return a system's drawing beside a table of plain text, the first row its headings, and notes below, as HTML.

    Parameters
    ----------
    system : SystemParts
        What is drawn.
    heading : str
    rows : sequence of sequences of str
        Escaped here; a first cell that is a colour (``#...``) becomes a patch of it.
    notes : sequence of str
        Paragraphs below the table.
    """
    head, *body = rows
    table = "".join(
        [
            '<table style="border-collapse:collapse;font-size:13px;line-height:1.35"><thead><tr>',
            *(f'<th style="text-align:left;padding:2px 10px 2px 0">{escape(cell)}</th>' for cell in head),
            "</tr></thead><tbody>",
            *(f"<tr>{''.join(_cell(cell) for cell in row)}</tr>" for row in body),
            "</tbody></table>",
        ]
    )
    below = "".join(f'<p style="margin:6px 0 0;font-size:12px;max-width:46em">{escape(note)}</p>' for note in notes)
    return (
        '<div class="coaxshell" style="display:flex;flex-wrap:wrap;gap:18px;align-items:flex-start">'
        f'{cross_section(system)}<div><p style="margin:2px 0 6px"><b>{escape(heading)}</b></p>{table}{below}</div></div>'
    )


def _cell(text: str) -> str:
    if text.startswith("#"):
        patch = f'<span style="display:inline-block;width:9px;height:9px;background:{escape(text)}"></span>'
        return f'<td style="padding:1px 6px 1px 0">{patch}</td>'
    return f'<td style="text-align:left;padding:1px 10px 1px 0;vertical-align:top">{escape(text)}</td>'


def _parts(system: SystemParts) -> list[Cells]:
    rows: list[Cells] = []
    for number, shell in enumerate(system.shells):
        rows.append(("", region_side(number, len(system.shells)), _fluid(system.fluids[number])))
        rows += _shell_rows(number, len(system.shells), shell)
    rows.append(("", region_side(len(system.shells), len(system.shells)), _fluid(system.fluids[-1])))
    rows += [("", "source", _source(system, source)) for source in system.sources]
    if system.absorber_list:
        rows.append(("", "absorbers", _absorbers(system)))
    if system.point_absorbers:
        rows.append(("", "point absorbers", _point_absorbers(system)))
    rows += [("", "control", _control(system, law)) for law in laws_of(system)]
    if system.sea is not None:
        rows.append(("", "sea", _sea(system.sea)))
    return rows


def _control(system: SystemParts, control: PDControl | Feedback) -> str:
    """Return what a control law is and which shells it is for."""
    stop = ", by electrodes" if control.transducers == "electrodes" else ""
    stop += ", stops at the field limit" if control.saturation else ""
    stop += ", stops at the current limit" if control.current_saturation else ""
    numbers = shells_under(system, control)
    if isinstance(control, Feedback):
        return _law(control, [shell_phrase(i, len(system.shells)) for i in numbers]) + stop
    each: dict[tuple[float, float], list[str]] = {}
    for i in numbers:
        each.setdefault(gains_of(system, i), []).append(shell_phrase(i, len(system.shells)))
    return "; ".join(f"k_p = {p:g}, k_d = {d:g} on {', '.join(names)}" for (p, d), names in each.items()) + stop


def _law(law: Feedback, names: Sequence[str]) -> str:
    """Return what a rational law is in a few words."""
    parts = [f"H(s) of degree {len(law.numerator) - 1} over {len(law.denominator) - 1}"]
    parts += [
        f"{name} corner {engineering(x, 'Hz')}" for name, x in (("sensor", law.sensor_corner), ("amplifier", law.amplifier_corner)) if x
    ]
    parts += [f"delay {engineering(law.delay, 's')}"] if law.delay else []
    if law.weights is not None:
        parts.append(f"orders up to {law.weights}" if isinstance(law.weights, int) else f"{len(law.weights)} orders weighted")
    return f"{', '.join(parts)} on {', '.join(names)}"


def _sea(sea: Sea) -> str:
    planes = ["reflecting surface"] if sea.surface else []
    planes += [f"rigid bottom {_length(sea.bottom)} below"] if sea.bottom is not None else []
    return f"axis {_length(sea.depth)} deep, surface towards {sea.up:g}°, {' and '.join(planes) or 'nothing reflects'}"


def _shell_rows(number: int, shells: int, shell: Shell | RigidShell) -> list[Cells]:
    name = shell_phrase(number, shells)
    if isinstance(shell, RigidShell):
        return [("", name, f"rigid, radius {_length(shell.radius)}")]
    theory = "elastic solids" if shell.theory == "elastic" else ""
    wetted = f", {theory or 'wetted at its faces'}" if shell.wetted == "faces" or theory else ""
    rows: list[Cells] = [("", name, f"radius {_length(shell.radius)}, {_length(shell.thickness)} thick{wetted}")]
    return rows + [(ROLE_COLOURS[x.role], "", f"{_length(x.thickness)} {x.material.name}, {x.role}") for x in shell.layers]


def _fluid(fluid: Fluid | Vacuum) -> str:
    if isinstance(fluid, Vacuum):
        return "vacuum"
    constants = f"{fluid.density:g} kg/m³, {fluid.sound_speed:g} m/s"
    return f"{fluid.name}, {constants}" if fluid.name else constants


def _source(system: SystemParts, source: Source) -> str:
    distance = system.source_distance(source)
    where = "" if distance is None else f" {_length(distance)} from the axis,"
    turned = f" at {source.angle:g}°," if source.angle else ""
    z, inclination = getattr(source, "z", 0.0), getattr(source, "inclination", 0.0)
    turned += (f" at z = {_length(z)}," if z else "") + (f" inclined by {inclination:g}°," if inclination else "")
    bubble = source.bubble if isinstance(source, UnderwaterExplosion) else None
    after = "" if bubble is None else f", bubble of {_length(bubble.largest_radius)}, first pulse after {engineering(bubble.period, 's')}"
    return f"{source.type.replace('-', ' ')},{where}{turned} peak {_pressure(abs(source.pulse.peak))}{after}"


def _point_absorbers(system: SystemParts) -> str:
    many = system.point_absorbers
    places = sorted({one.z for one in many})
    where = f"z = {places[0]:g} m" if len(places) == 1 else f"z = {places[0]:g} to {places[-1]:g} m"
    return f"{len(many)} at {where}, {engineering(sum(one.mass for one in many), 'kg')} together"


def _absorbers(system: SystemParts) -> str:
    many = system.absorber_list
    first = many[0]
    alike = len({one.replace(angle=0.0) for one in many}) == 1
    count = "1" if len(many) == 1 else f"{len(many)}{'' if alike else ' different'}"
    spread = f", every {360 / len(many):.4g}°" if isinstance(system.absorbers, AbsorberRing) and len(many) > 1 else ""
    if not alike:
        return f"{count}{spread}"
    law = f"m = {first.mass:g} kg/m, c = {first.damping:.3g}, k_l = {first.linear_stiffness:.3g}, k_nl = {first.cubic_stiffness:.3g}"
    besides = [f"law {first.law.type}"] if first.law is not None else []
    besides += [f"b = {first.inertance:.3g}"] if first.inertance else []
    inner, outer = linked_shells(first)
    if first.links == "both" and outer > inner + 1:
        besides.append(f"from {' to '.join(shell_name(i, len(system.shells)) for i in (inner, outer))}")
    besides += (
        [f"on the {first.links} shell alone{', the other link on a core' if first.grounded else ''}"] if first.links != "both" else []
    )
    return f"{count}{spread}: {', '.join([law, *besides])} (SI, per metre)"


def _length(value: float) -> str:
    return f"{1e3 * value:.4g} mm" if abs(value) < 0.1 else f"{value:.4g} m"


def _pressure(value: float) -> str:
    for factor, unit in ((1e6, "MPa"), (1e3, "kPa")):
        if value >= factor:
            return f"{value / factor:.4g} {unit}"
    return f"{value:.4g} Pa"
