"""The paper's claims judged twice at one resolution each: under its slice in two dimensions, under the true sphere in three at z = 0."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from typing import TYPE_CHECKING

from coaxshell.apps.paper import cases
from coaxshell.apps.paper.absorbers import SHOWN
from coaxshell.apps.paper.claims import Finding, Judged, claims, systems
from coaxshell.apps.paper.known_runs import CORRECTED, Runs
from coaxshell.apps.paper.sphere import texts
from coaxshell.apps.paper.sphere.compared import SPHERE
from coaxshell.solver.settings import Settings

if TYPE_CHECKING:
    from coaxshell.model import System
    from coaxshell.numerics.progress import Progress
    from coaxshell.response import Response
    from coaxshell.studies.store import Store

RESOLUTION = Settings(duration=5.0, time_step=4e-3, modes=60)
"""The finest at which claims are judged in three dimensions: a quarter of a minute of one processor a run."""
OF_ABSORBERS = replace(RESOLUTION, time_step=2e-2)
"""Of claims about absorbers alone, which ask for many runs; there the slice's verdicts are those at the paper's resolution."""
OF_POSITIONS = replace(OF_ABSORBERS, modes=30, duration=SHOWN)
"""Of claims about where one absorber sits: twenty-two runs that end early."""
LEAST = 4.0
"""Shortest run in which all instants that the claims are about lie, transits."""


@dataclass(frozen=True)
class Topic:
    """Claims of one module that mean something under the sphere.

    Attributes
    ----------
    module : str
    names : tuple of str
        Of its claims.
    asked : callable
        Returns the systems that they ask for beside the bare one.
    finest : Settings
        The resolution that is enough for them.
    """

    module: str
    names: tuple[str, ...]
    asked: Callable[[], Mapping[str, System]]
    finest: Settings = RESOLUTION

    def resolution(self, wanted: Settings) -> Settings:
        """Return a resolution that is no finer and no longer than the wanted one, nor than what is enough."""
        modes = min(highest for highest in (wanted.modes, self.finest.modes) if isinstance(highest, int))
        step = max(wanted.time_step, self.finest.time_step)
        return replace(wanted.up_to(self.finest.duration), modes=modes, time_step=step)


def _bare() -> System:
    return systems.preset("bare")


TOPICS = (
    Topic("setting", ("interior-fluid-brings-rapid-oscillations",), lambda: {"hollow": systems.hollow_inside()}),
    Topic(
        "bare",
        (
            "outer-head-begins-at-0",
            "inner-head-begins-at-0-5",
            "tails-begin-before-the-front",
            "stress-fluctuates-more",
            "inner-shell-is-stressed-more",
            "inner-shell-is-displaced-more",
            "tail-bears-the-peak",
            "inner-extrema-at-the-printed-instants",
        ),
        dict,
    ),
    Topic(
        "waves",
        (
            "outer-shell-barely-weakens-the-wave",
            "mach-stem-at-2",
            "mach-stem-at-3-1",
            "fronts-are-aligned-at-3-1",
            "shells-are-transparent",
        ),
        dict,
    ),
    Topic(
        "stiffness",
        (
            "link-starts-the-inner-shell-at-once",
            "single-absorber-is-marginal",
            "soft-link-has-no-effect",
            "adopted-stiffness-mitigates",
            "stiff-link-is-rigid",
        ),
        lambda: cases.linear_stiffness(_bare()) | {"rigid": systems.with_rigid_link()},
        OF_ABSORBERS,
    ),
    Topic(
        "mass",
        (
            "every-mass-changes-little",
            "vanishing-mass-is-not-bare",
            "light-absorber-is-springs-in-series",
            "heavy-mass-is-an-anchor",
            "adopted-mass-lowers-the-extrema",
        ),
        lambda: cases.mass(_bare()),
        OF_ABSORBERS,
    ),
    Topic(
        "cubic",
        (
            "weak-cubic-spring-is-linear",
            "adopted-cubic-spring-works-better",
            "adopted-cubic-force-is-comparable",
            "strong-cubic-spring-nears-a-rigid-link",
            "rigid-link-spoils-the-mitigation",
        ),
        lambda: cases.cubic_stiffness(_bare()) | {"rigid": systems.with_rigid_link()},
        OF_ABSORBERS,
    ),
    Topic(
        "position",
        ("three-degrees-matter", "difference-widens", "marginal-beyond-30-degrees", "gone-at-60-degrees"),
        lambda: cases.offset(_bare()),
        OF_POSITIONS,
    ),
    Topic("count", ("twenty-per-cent-at-25",), lambda: cases.count(_bare(), (0, cases.ADOPTED_COUNT)), OF_ABSORBERS),
    Topic(
        "damping",
        ("little-damping-does-nothing", "adopted-damping-suppresses", "damping-helps-the-tail-most"),
        lambda: cases.damping(_bare()),
        OF_ABSORBERS,
    ),
    Topic(
        "active",
        (
            "voltage-is-within-the-limit",
            "proportional-gain-matters-most",
            "proportional-gain-lowers-the-inner-stress",
            "derivative-gain-alone-is-marginal",
            "derivative-gain-suppresses-rapid-oscillations",
            "both-gains-do-more",
        ),
        lambda: cases.gains(_bare()),
    ),
    Topic(
        "hybrid",
        (
            "hybrid-attenuates-everywhere",
            "hybrid-beats-its-parts",
            "inner-stress-from-0-1",
            "stress-is-lower-at-1-and-3",
            "effect-grows-with-time",
        ),
        lambda: {name: systems.preset(name) for name in ("absorbers", "active", "hybrid")},
    ),
)
"""In the order of the paper's text. A further topic is one more line."""


def topic(module: str) -> Topic:
    """Return the topic of a module."""
    return next(one for one in TOPICS if one.module == module)


def under_the_sphere(resolution: Settings, store: Store | None = None) -> Runs:
    """Return runs in three dimensions, read at z = 0."""
    return Runs(replace(resolution, dimensions=3, stations=(0.0,)), solver=_each, variant=SPHERE, store=store)


def _each(wanted: Mapping[str, System], resolution: Settings, progress: Progress | None) -> Iterator[tuple[str, Response]]:
    from coaxshell.response import simulate

    for number, (name, system) in enumerate(wanted.items()):
        if progress:
            progress(number / len(wanted), "solving in three dimensions")
        yield name, simulate(system, settings=resolution)


@dataclass(frozen=True)
class Judgement:
    """Claims with what is found about them under the slice and under the sphere.

    Attributes
    ----------
    resolutions : mapping of str to Settings
        Of the runs in two dimensions, by the name of the claim; those in three have the same.
    claims : tuple of Judged
        Under the names "corrected" (slice) and "sphere".
    """

    resolutions: Mapping[str, Settings]
    claims: tuple[Judged, ...]

    @property
    def rows(self) -> list[tuple[str, ...]]:
        """A row a claim: its number and statement, both verdicts, and what is found under each source."""
        return [
            (str(one.claim.number), one.claim.statement, *(found.verdict for found in pair(one)), *(found.why for found in pair(one)))
            for one in self.claims
        ]

    @property
    def told(self) -> str:
        """How many claims have which verdict under each source and how many turn, and the resolution, in words."""
        counts = [Counter(pair(one)[k].verdict for one in self.claims) for k in (0, 1)]
        told = [", ".join(f"{count[verdict]} {word}" for verdict, word in texts.VERDICTS.items()) for count in counts]
        turned = [str(one.claim.number) for one in self.claims if one.turned]
        which = f"Verdicts turn: no. {', '.join(turned)}." if turned else "No verdict turns."
        return f"Of {len(self.claims)} statements {told[0]} under the slice, {told[1]} under the sphere. {which} {self._computed}"

    @property
    def _computed(self) -> str:
        """The resolutions in words, each with the numbers of its claims unless there is but one."""
        numbers: dict[str, list[int]] = {}
        for one in self.claims:
            at = self.resolutions[one.claim.name]
            told = f"M = {at.modes}, time step {at.time_step:g}, to t = {at.duration:g}"
            numbers.setdefault(told, []).append(one.claim.number)
        if len(numbers) == 1:
            return f"Both computed with {next(iter(numbers))}."
        return f"Both computed with {'; '.join(f'{told} (no. {spans(of)})' for told, of in numbers.items())}."


def spans(numbers: Sequence[int]) -> str:
    """Return ascending numbers in words, neighbours as "3 to 5"."""
    of = [[number for _, number in group] for _, group in groupby(enumerate(numbers), lambda item: item[1] - item[0])]
    return ", ".join(f"{one[0]} to {one[-1]}" if len(one) > 1 else str(one[0]) for one in of)


def judged_in_both(resolution: Settings, topics: Sequence[Topic] = TOPICS, store: Store | None = None) -> Judgement:
    """Return the claims of some topics with what is found under the slice and under the sphere, by the same criteria.

    Parameters
    ----------
    resolution : Settings
        Finest of all runs; a topic's are no finer than is enough for it. Runs that are compared differ in their dimensions alone.
    topics : sequence of Topic
    store : Store, optional
        Where finished runs are kept.
    """
    known = {claim.name: claim for claim in claims()}
    variants: dict[Settings, dict[str, Runs]] = {}
    resolutions: dict[str, Settings] = {}
    judged: list[Judged] = []
    for one in topics:
        at = one.resolution(resolution)
        if at not in variants:
            variants[at] = {CORRECTED: Runs(at, store=store), SPHERE: under_the_sphere(at, store)}
        resolutions |= dict.fromkeys(one.names, at)
        judged += [Judged(known[name], {which: known[name].work(runs) for which, runs in variants[at].items()}) for name in one.names]
    return Judgement(resolutions, tuple(judged))


def pair(judged: Judged) -> tuple[Finding, Finding]:
    """Return what is found under the slice and under the sphere."""
    return judged.corrected, judged.findings[SPHERE]
