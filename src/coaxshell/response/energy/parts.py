"""The stores, flows and losses of one motion, each with its name, as they count in a balance."""

from __future__ import annotations

from typing import NamedTuple

from coaxshell.model.places import region_name, shell_name, shell_phrase
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.progress import Progress, ShareDone
from coaxshell.response.energy.absorbers import AbsorberEnergy, absorber_energy
from coaxshell.response.energy.electrodes import electrical_energy
from coaxshell.response.energy.fluids import fluid_energy
from coaxshell.response.energy.motion import Motion
from coaxshell.response.energy.shells import actuator_work, shell_energy
from coaxshell.response.energy.work import SurfaceWork, surface_pressures


class Entry(NamedTuple):
    """One history of the balance: at the kept instants, dimensionless until it is labelled.

    ``role`` is "store", "loss", "work" or "balance"; ``group`` names what it belongs to.
    """

    values: FloatArray
    role: str
    group: str
    long_name: str


def parts_of(motion: Motion, report: Progress) -> dict[str, Entry]:
    """Return all of them by name; *report* is told the fraction done and the stage."""
    report(0.1, "work on the surface")
    entries = _surface(motion)
    report(0.25, "shells and absorbers")
    entries |= {**_shells(motion), **absorber_entries(absorber_energy(motion))}
    return entries | _fluids(motion, lambda fraction: report(0.35 + 0.65 * fraction, "fluids"))


def _surface(motion: Motion) -> dict[str, Entry]:
    """Return the work of the exterior pressure and its parts on the outermost shell, and the energy radiated."""
    parts = surface_pressures(motion)
    work = SurfaceWork(motion.grid, motion.problem.head * motion.circle, motion.face_velocity(-1, 1))
    incident, scattered, radiated = (work(part)[motion.kept] for part in parts)
    where = "on the outer shell, since the start"
    return {
        "exterior_work": Entry(incident + scattered + radiated, "work", "exterior", f"work of the total exterior pressure {where}"),
        "incident_work": Entry(incident, "work", "exterior", f"work of the incident pressure {where}"),
        "scattered_work": Entry(scattered, "work", "exterior", f"work of the rigidly scattered pressure {where}"),
        "radiated_work": Entry(radiated, "work", "exterior", f"work of the radiated pressure {where}"),
        "radiated_energy": Entry(-radiated, "work", "exterior", "energy given by the outer shell's motion to the exterior fluid"),
    }


def _shells(motion: Motion) -> dict[str, Entry]:
    count = len(motion.problem.shells)
    entries: dict[str, Entry] = {}
    for i in range(count):
        if not motion.problem.shells[i].moves:
            continue
        found, lost = shell_energy(motion, i)
        name = shell_name(i, count) if i in (0, count - 1) else f"shell_{i}"
        group = shell_phrase(i, count)
        for part, what in (("kinetic", "kinetic"), ("strain", "strain"), ("piezoelectric", "piezoelectric (open-circuit)")):
            entries[f"{name}_{part}"] = Entry(getattr(found, part), "store", group, f"{what} energy of the {group}")
        if lost is not None:
            entries[f"{name}_dissipation"] = Entry(lost, "loss", group, f"energy dissipated in the {group}")
    taken = actuator_work(motion)[motion.kept]
    entries["actuator_work"] = Entry(taken, "loss", "actuators", "work that the actuators have taken from the shells")
    if (electrical := electrical_energy(motion)) is not None:
        supplied, held = (values[motion.kept] for values in electrical)
        entries["amplifier_work"] = Entry(supplied, "work", "actuators", "energy from the amplifiers of the actuators, since the start")
        entries["actuator_field"] = Entry(held, "work", "actuators", "energy in the fields of the actuators that amplifiers charge")
    return entries


def absorber_entries(found: AbsorberEnergy) -> dict[str, Entry]:
    """Return the energy of absorbers by the names of the balance."""
    kinetic, spring, dissipated, defect, lost = found
    friction = "energy lost in friction, at stops and in viscoelastic branches of the absorbers"
    law = "what the forces on the moving ends make of the dampers' dissipation, less damper_dissipation: error of the time step"
    return {
        "absorber_kinetic": Entry(kinetic, "store", "absorbers", "kinetic energy of the absorbers' masses"),
        "absorber_spring": Entry(spring, "store", "absorbers", "energy of the absorbers' springs, linear and cubic"),
        "damper_dissipation": Entry(dissipated, "loss", "dampers", "energy dissipated in the absorbers' dampers"),
        "damper_defect": Entry(defect, "balance", "dampers", law),
    } | ({} if lost is None else {"law_dissipation": Entry(lost, "loss", "absorbers", friction)})


def _fluids(motion: Motion, progress: ShareDone) -> dict[str, Entry]:
    regions = len(motion.problem.shells)
    entries: dict[str, Entry] = {}
    for i in range(regions):
        found = fluid_energy(motion, i, lambda fraction, i=i: progress((i + fraction) / regions))  # type: ignore[misc]
        if found is None:
            continue
        region = region_name(i, regions)
        name, group = region.replace(" ", "_"), f"fluid of {region}" if " " in region else f"{region} fluid"
        entries[f"{name}_kinetic"] = Entry(found.kinetic, "store", group, f"kinetic energy of the {group}")
        entries[f"{name}_compression"] = Entry(found.compression, "store", group, f"compression energy of the {group}")
    return entries
