"""What the reproduction found, gathered from the finished parts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from coaxshell.apps.paper import cases
from coaxshell.apps.paper.claims import Judged, claims, judge, systems
from coaxshell.apps.paper.claims.claim import Verdict
from coaxshell.apps.paper.figures import FIGURES
from coaxshell.apps.paper.known_runs import CORRECTED
from coaxshell.apps.paper.recipes import FigureRecipe
from coaxshell.apps.paper.reproduction.plan import SPHERE, VARIANTS, WALLS, Part, sphere_claims
from coaxshell.apps.paper.reproduction.work import picture, runs_of
from coaxshell.apps.paper.sphere.judged import Judgement, judged_in_both
from coaxshell.apps.paper.sphere.texts import CAPTIONS
from coaxshell.apps.paper.thickness.texts import CAPTIONS as WALL_CAPTIONS
from coaxshell.solver.settings import Settings
from coaxshell.studies.store import Store

if TYPE_CHECKING:
    from coaxshell.apps.paper.recipes import StudyRecipe

VERDICTS: tuple[Verdict, ...] = ("holds", "holds in part", "does not hold", "not judged")


@dataclass(frozen=True)
class DrawnFigure:
    """A figure as PNG bytes, the warnings of its runs, and the seconds of its part (0 if it shares the runs of the claims)."""

    recipe: FigureRecipe | StudyRecipe
    png: bytes
    warnings: tuple[str, ...]
    seconds: float


@dataclass(frozen=True)
class Estimate:
    """Processor seconds of all of Figure 9's runs: by the direct engine, extrapolated from a sample, and by ours, as measured."""

    sample: tuple[int, ...]
    direct: tuple[float, ...]
    spectral: tuple[float, ...]
    ours: float | None

    @property
    def runs(self) -> int:
        """How many numbers of absorbers Figure 9 shows."""
        return len({*cases.COUNTS, *cases.COARSE_COUNTS})

    @property
    def whole(self) -> float:
        """The sample's mean times the number of runs."""
        return self.runs * sum(self.direct) / len(self.direct)


@dataclass(frozen=True)
class ReportSection:
    """A report: Markdown, the tables with captions and headings, the resolution in words, pictures as PNG bytes."""

    markdown: str
    tables: list[tuple[str, list[str], list[list[str]]]]
    told: str
    pictures: Mapping[str, bytes]


@dataclass(frozen=True)
class SphereSection(ReportSection):
    """What slice and sphere differ by; ``judged`` are the paper's claims under both, None if the run is too short for them."""

    judged: Judgement | None = None


@dataclass(frozen=True)
class WallsSection(ReportSection):
    """What thin and exact walls differ by; ``map_told`` is what its map shows."""

    map_told: str = ""


@dataclass(frozen=True)
class Results:
    """Everything that the report tells.

    Attributes
    ----------
    resolution : Settings
    figures : tuple of DrawnFigure
    judged : tuple of Judged
    effects : list of dict
        Of slips, as :class:`coaxshell.apps.paper.slips.effects.Effect`.
    film : tuple of (bytes, ending) or None
    estimate : Estimate or None
    seconds, processor : mapping of str to float
        Of clock and of processor time, by part.
    elapsed : float
        Of this call, from its start to the report.
    resumed : int
        Parts that were there already.
    workers : int
    sphere : SphereSection or None
    walls : WallsSection or None
    """

    resolution: Settings
    figures: tuple[DrawnFigure, ...] = ()
    judged: tuple[Judged, ...] = ()
    effects: list[dict[str, Any]] = field(default_factory=list)
    film: tuple[bytes, str] | None = None
    estimate: Estimate | None = None
    seconds: Mapping[str, float] = field(default_factory=dict)
    processor: Mapping[str, float] = field(default_factory=dict)
    elapsed: float = 0.0
    resumed: int = 0
    workers: int = 1
    sphere: SphereSection | None = None
    walls: WallsSection | None = None

    def tally(self, variant: str) -> Counter[Verdict]:
        """Return how many claims have each verdict in a variant."""
        return Counter(judged.findings[variant].verdict for judged in self.judged)


def drawn_figures(
    resolution: Settings, store: Store, pieces: Mapping[Part, tuple[dict[str, Any], dict[str, Any]]]
) -> tuple[DrawnFigure, ...]:
    """Return all figures: those of a few responses from their parts, those of many runs drawn from the runs in the store."""
    runs = runs_of(CORRECTED, resolution, store)
    found = []
    for number, recipe in FIGURES.items():
        if isinstance(recipe, FigureRecipe):
            arrays, values = pieces[Part("figure", number)]
            found.append(DrawnFigure(recipe, arrays["png"].tobytes(), tuple(values["warnings"]), values["seconds"]))
        else:
            drawn = recipe.draw([systems.preset(name) for name in recipe.presets], runs, None)
            found.append(DrawnFigure(recipe, picture(drawn.figure).tobytes(), drawn.warnings, 0.0))
    return tuple(found)


def judged_claims(resolution: Settings, store: Store) -> tuple[Judged, ...]:
    """Return every claim with its findings in all variants, from the runs in the store."""
    variants = {name: runs_of(name, resolution, store) for name in VARIANTS}
    return tuple(judge(claim, variants) for claim in claims())


def sphere_of(resolution: Settings, store: Store, pieces: Mapping[Part, tuple[dict[str, Any], dict[str, Any]]]) -> SphereSection | None:
    """Return what slice and sphere differ by, if it was computed, and the claims judged under both from the runs in the store."""
    piece = pieces.get(SPHERE)
    if piece is None:
        return None
    arrays, values = piece
    pictures = {name: arrays[name].tobytes() for name in CAPTIONS}
    judged = judged_in_both(resolution, store=store) if any(sphere_claims(resolution)) else None
    return SphereSection(values["markdown"], values["tables"], values["told"], pictures, judged)


def walls_of(pieces: Mapping[Part, tuple[dict[str, Any], dict[str, Any]]]) -> WallsSection | None:
    """Return what thin and exact walls differ by, if it was computed."""
    piece = pieces.get(WALLS)
    if piece is None:
        return None
    arrays, values = piece
    pictures = {name: arrays[name].tobytes() for name in WALL_CAPTIONS}
    return WallsSection(values["markdown"], values["tables"], values["told"], pictures, values["map_told"])


def estimate_of(pieces: Mapping[Part, tuple[dict[str, Any], dict[str, Any]]]) -> Estimate | None:
    """Return what the direct engine would take for Figure 9, if it was measured."""
    piece = pieces.get(Part("direct", "engine on a sample"))
    if piece is None:
        return None
    counted = [
        values["processor"]
        for part, (_, values) in pieces.items()
        if part.kind == "runs" and part.about.endswith("absorbers") and part.variant == CORRECTED
    ]
    values = piece[1]
    return Estimate(tuple(values["sample"]), tuple(values["direct"]), tuple(values["spectral"]), sum(counted) if counted else None)
