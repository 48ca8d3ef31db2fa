"""The paper's claims judged twice at one resolution: under its slice in two dimensions, and under the true sphere in three at z = 0."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from coaxshell.apps.paper import cases
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
LEAST = 4.0
"""Shortest run in which all instants that the claims are about lie, transits."""


@dataclass(frozen=True)
class Topic:
    """Claims of one module that mean something under the sphere, and the systems that they ask for beside the bare one."""

    module: str
    names: tuple[str, ...]
    asked: Callable[[], Mapping[str, System]]


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


def claims_resolution(resolution: Settings) -> Settings:
    """Return a resolution that is no finer and no longer than the finest at which claims are judged in three dimensions."""
    modes = min(resolution.modes, RESOLUTION.modes) if isinstance(resolution.modes, int) and isinstance(RESOLUTION.modes, int) else 60
    step = max(resolution.time_step, RESOLUTION.time_step)
    return replace(resolution.up_to(RESOLUTION.duration), modes=modes, time_step=step)


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
    resolution : Settings
        Of the runs in two dimensions; those in three have the same.
    claims : tuple of Judged
        Under the names "corrected" (slice) and "sphere".
    """

    resolution: Settings
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
        at = f"M = {self.resolution.modes}, time step {self.resolution.time_step:g}, to t = {self.resolution.duration:g}"
        return f"Of {len(self.claims)} statements {told[0]} under the slice, {told[1]} under the sphere. {which} Both computed with {at}."


def judged_in_both(
    resolution: Settings, topics: Sequence[Topic] = TOPICS, store: Store | None = None, in_slice: Runs | None = None
) -> Judgement:
    """Return the claims of some topics with what is found under the slice and under the sphere, by the same criteria.

    Parameters
    ----------
    resolution : Settings
        Of all runs, but for the dimensions.
    topics : sequence of Topic
    store : Store, optional
        Where finished runs are kept.
    in_slice : Runs, optional
        Runs in two dimensions at that resolution, if there are any.
    """
    known = {claim.name: claim for claim in claims()}
    variants = {CORRECTED: in_slice or Runs(resolution, store=store), SPHERE: under_the_sphere(resolution, store)}
    chosen = [known[name] for one in topics for name in one.names]
    return Judgement(resolution, tuple(Judged(one, {name: one.work(runs) for name, runs in variants.items()}) for one in chosen))


def pair(judged: Judged) -> tuple[Finding, Finding]:
    """Return what is found under the slice and under the sphere."""
    return judged.corrected, judged.findings[SPHERE]
