"""The parts of the reproduction, each independent of the others, and what they cost: runs, and what fields, pictures and films add."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import TYPE_CHECKING

from coaxshell.apps.paper import cases
from coaxshell.apps.paper.absorbers import SHOWN
from coaxshell.apps.paper.claims import systems
from coaxshell.apps.paper.figures import FIGURES
from coaxshell.apps.paper.known_runs import CORRECTED
from coaxshell.apps.paper.limiting_cases import limiting_systems
from coaxshell.apps.paper.recipes import FigureRecipe
from coaxshell.apps.paper.sphere.judged import LEAST, TOPICS, topic
from coaxshell.apps.paper.sphere.report import RESOLUTION as SPHERE_RESOLUTION
from coaxshell.apps.paper.thickness.compared import with_walls
from coaxshell.apps.paper.thickness.report import FACTORS
from coaxshell.apps.paper.thickness.report import RESOLUTION as WALLS_RESOLUTION
from coaxshell.model.system import System
from coaxshell.numerics.cost import Cost
from coaxshell.solver.cost import run_cost
from coaxshell.solver.settings import Settings
from coaxshell.studies import cost

if TYPE_CHECKING:
    from coaxshell.model import System

VARIANTS: Mapping[str, frozenset[str]] = MappingProxyType(
    {
        CORRECTED: frozenset(),
        "radius factor": frozenset({"radius-factor"}),
        "no projection": frozenset({"missing-projection"}),
        "both slips": frozenset({"radius-factor", "missing-projection"}),
    }
)
"""Models under which the claims are judged, by name, with the slips that are turned on."""

WITH_FIELDS = (CORRECTED, "radius factor")
"""Variants whose fields are computed."""

QUICK = Settings(duration=5.0, time_step=1e-2, modes=24)
"""The coarse resolution of a trial."""

LIMITS = "of limiting cases"
"""A group that slips, defined for two shells in three fluids, do not reach."""

_CHUNK = 13
DIRECT_SAMPLE = (10, 25, 50)
"""Numbers of absorbers on which the direct engine's time is measured."""


@dataclass(frozen=True)
class Part:
    """One part of the work: a kind (what is done), what to, and how it is called.

    Attributes
    ----------
    kind : str
        "runs", "fields", "figure", "film", "slips", "sphere", "claims under the sphere", "walls" or "direct".
    about : str
        Which one: a group of runs, a system, the number of a figure, a module of claims.
    variant : str
        Model.
    """

    kind: str
    about: str
    variant: str = CORRECTED

    @property
    def title(self) -> str:
        """The part in words."""
        model = "" if self.variant == CORRECTED else f", {self.variant}"
        return f"{self.kind} {self.about}".strip() + model


SPHERE = Part("sphere", "beside the slice")
"""The part in three dimensions."""
WALLS = Part("walls", "thin or exact")
"""The part with elastic walls."""


def sphere_resolution(resolution: Settings) -> Settings:
    """Return a resolution that is no finer and no longer than that of the report on slice and sphere, which it would not change."""
    return _no_finer(resolution, SPHERE_RESOLUTION)


def walls_resolution(resolution: Settings) -> Settings:
    """Return the same for the report on thin and exact walls."""
    return _no_finer(resolution, WALLS_RESOLUTION)


def _no_finer(resolution: Settings, finest: Settings) -> Settings:
    modes = min(resolution.modes, finest.modes) if isinstance(resolution.modes, int) else finest.modes
    return replace(resolution.up_to(finest.duration), modes=modes, time_step=max(resolution.time_step, finest.time_step))


def sphere_claims(resolution: Settings) -> Iterator[Part]:
    """Yield the parts that judge claims in three dimensions, where the run lasts long enough for them."""
    if resolution.duration >= LEAST:
        yield from (Part("claims under the sphere", topic.module) for topic in TOPICS)


@dataclass(frozen=True)
class Group:
    """Runs that are solved together."""

    systems: Mapping[str, System]
    resolution: Settings
    peaks_only: bool = False


def groups(resolution: Settings) -> dict[str, Group]:
    """Return all runs that figures and claims ask for, in groups that take comparable times."""
    bare = systems.preset("bare")
    coarse = resolution.modes if isinstance(resolution.modes, int) else 150
    found = {
        "of the presets": Group({name: systems.preset(name) for name in ("bare", "absorbers", "active", "hybrid")}, resolution),
        "with half the time step": Group({"bare": bare}, replace(resolution, time_step=resolution.time_step / 2.0)),
        "with twice the orders": Group({"bare": bare}, replace(resolution, modes=2 * coarse)),
        LIMITS: Group(_limits(), resolution),
        "of linear stiffnesses": Group(cases.linear_stiffness(bare) | {"rigid": systems.with_rigid_link()}, resolution),
        "of masses": Group(cases.mass(bare), resolution),
        "of cubic stiffnesses": Group(cases.cubic_stiffness(bare), resolution),
        "of attachment positions": Group(cases.offset(bare), resolution.up_to(SHOWN)),
        "of dampings": Group(cases.damping(bare), resolution),
        "of gains": Group(cases.gains(bare), resolution),
    }
    counts = sorted({*cases.COUNTS, *cases.COARSE_COUNTS})
    for start in range(0, len(counts), _CHUNK):
        chunk = tuple(counts[start : start + _CHUNK])
        found[f"of {chunk[0]} to {chunk[-1]} absorbers"] = Group(cases.count(bare, chunk), resolution, peaks_only=True)
    return found


def _limits() -> dict[str, System]:
    made = (
        systems.emptied_by_thin_fluid(),
        systems.double_hollow_by_thin_fluid(),
        systems.filled_by_shrinking(),
        systems.hollow_inside(),
    )
    printed = (systems.preset(name) for name in ("iakovlev-evacuated", "iakovlev-filled", "iakovlev-double"))
    drawn = limiting_systems([systems.preset(name) for name in ("iakovlev-evacuated", "iakovlev-filled", "iakovlev-double")])
    return {system.name: system for system in (*printed, *made)} | drawn


def parts(resolution: Settings, *, only: frozenset[str] = frozenset(), film: bool = True) -> Iterator[Part]:
    """Yield the parts in the order in which they are begun, long ones first.

    Parameters
    ----------
    resolution : Settings
    only : frozenset of str
        Of "figures", "claims", "slips", "sphere", "walls", "film" and "estimate"; all if empty.
    film : bool
        Whether a film is made.
    """

    def wanted(name: str) -> bool:
        return not only or name in only

    if wanted("slips"):
        yield Part("slips", "one by one")
    if wanted("sphere"):
        yield from sphere_claims(resolution)
        yield SPHERE
    if wanted("walls"):
        yield WALLS
    if film and wanted("film"):
        yield Part("film", "bare against hybrid")
    if wanted("figures"):
        yield from (Part("figure", number) for number in ("13", "4", "14", "3", "12"))
    if wanted("claims"):
        yield from (Part("fields", name, variant) for variant in WITH_FIELDS for name in ("bare", "hybrid"))
    if wanted("estimate"):
        yield Part("direct", "engine on a sample")
    if wanted("claims") or wanted("figures"):
        for variant in VARIANTS if wanted("claims") else (CORRECTED,):
            yield from (Part("runs", name, variant) for name in groups(resolution) if variant == CORRECTED or name != LIMITS)


_FIELDS, _FILM = Cost(1e9, 15.0), Cost(0.7e9, 30.0)
"""Beside their runs; the fields' own blocks stay within 1 GB."""
_SLIPS = 12
"""Times that the slips solve the four presets, each and in pairs."""
_READ = 0.1
"""Seconds to read the peaks of a run and to keep it."""


def part_cost(part: Part, resolution: Settings) -> Cost:
    """Return what one part costs; seconds of one processor, within a factor of 3."""
    if part.kind == "runs":
        group = groups(resolution)[part.about]
        return _runs(group.systems.values(), group.resolution)
    if part.kind == "direct":
        sample = cases.count(systems.preset("bare"), DIRECT_SAMPLE).values()
        return _runs(sample, resolution).then(_runs(sample, replace(resolution, refinement=1), "direct"))
    if part.kind == "slips":
        each = _runs([systems.preset(name) for name in ("bare", "absorbers", "active", "hybrid")], resolution)
        return Cost(each.memory, _SLIPS * each.seconds)
    if part.kind == "sphere":
        at = sphere_resolution(resolution)
        return _runs([systems.preset("bare")], replace(at, dimensions=3)).then(_runs([systems.preset("bare")] * 3, at))
    if part.kind == "walls":
        each = _runs([systems.preset("bare"), with_walls(systems.preset("bare"), theory="elastic")], walls_resolution(resolution))
        return Cost(each.memory, 2.0 * len(FACTORS) * each.seconds)
    if part.kind == "claims under the sphere":
        about = topic(part.about)
        at, asked = about.resolution(resolution), [systems.preset("bare"), *about.asked().values()]
        return _runs(asked, replace(at, dimensions=3)).then(_runs(asked, at)).then(_FIELDS)
    if part.kind == "film":
        return _runs([systems.preset(name) for name in ("bare", "hybrid")], resolution).then(_FILM)
    if part.kind == "fields":
        return _runs([systems.preset(part.about)], resolution).then(_FIELDS)
    recipe = FIGURES[part.about]
    presets = recipe.presets if isinstance(recipe, FigureRecipe) else ()
    return _runs([systems.preset(name) for name in presets], resolution).then(_FIELDS)


def require_room(parts: Sequence[Part], resolution: Settings, workers: int) -> Cost:
    """Return the cost of some parts, so many at a time: the memory of the largest of them side by side.

    Raises
    ------
    InputError
        They do not fit into memory side by side; it names the number of processes that do.
    """
    if not parts:
        return Cost(0.0)
    costs = [part_cost(part, resolution) for part in parts]
    each = Cost(max(one.memory for one in costs), sum(one.seconds for one in costs) / len(costs))
    return cost.require_room(each, len(costs), workers, "the reproduction of {count} parts")


def _runs(solved: Iterable[System], resolution: Settings, engine: str = "spectral") -> Cost:
    total = Cost(0.0)
    for system in solved:
        total = total.then(run_cost(system, replace(resolution, engine=engine))).then(Cost(0.0, _READ))
    return total
