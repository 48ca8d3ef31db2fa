"""The report "slice, cylinder or sphere?": tables, pictures and what follows from them, for a page and for the reproduction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from coaxshell.apps.paper.claims.systems import preset
from coaxshell.apps.paper.sphere import texts
from coaxshell.apps.paper.sphere.compared import KINDS, SPHERE, Compared, compare
from coaxshell.apps.paper.sphere.judged import Judgement
from coaxshell.apps.verification.markdown import table
from coaxshell.solver.settings import Settings
from coaxshell.solver.slice_error import SliceMap, slice_map

if TYPE_CHECKING:
    from matplotlib.figure import Figure

RESOLUTION = Settings(duration=4.0, time_step=4e-3, modes=60)
"""At which the report is made: 20 s of one processor."""


@dataclass(frozen=True)
class Report:
    """Hold what the report is written from.

    Attributes
    ----------
    resolution : Settings
    found : Compared
        The paper's bare shells under the sphere, the slice, a line and a plane wave.
    known : SliceMap
        The package's map of the slice's error.
    judged : Judgement or None
        The paper's claims under both.
    """

    resolution: Settings
    found: Compared
    known: SliceMap
    judged: Judgement | None = None

    @property
    def peak_rows(self) -> list[tuple[str, ...]]:
        """Largest hoop stress at each point under each source."""
        peaks = {kind: self.found.peaks(kind) for kind in (SPHERE, *KINDS)}
        return [
            (point, *(f"{values[i] / 1e6:.4f} ({times[i]:.3f})" for values, times in peaks.values()))
            for i, point in enumerate(self.found.points)
        ]

    @property
    def difference_rows(self) -> list[tuple[str, ...]]:
        """Difference of the histories from the sphere's at each point, and at all together."""
        each = {kind: self.found.difference(kind) for kind in KINDS}
        rows = [(point, *(f"{100 * values[i]:.0f} %" for values in each.values())) for i, point in enumerate(self.found.points)]
        return [*rows, ("all four", *(f"{100 * self.found.overall(kind):.0f} %" for kind in KINDS))]

    @property
    def distance_rows(self) -> list[tuple[str, ...]]:
        """Error of each source of two dimensions by the distance, from the map."""
        known = self.known
        j, k = list(known.decay).index(texts.SHOWN_DECAY), list(known.duration).index(texts.SHOWN_DURATION)
        tables = (known.error, known.line, known.plane)
        return [(f"{distance:g}", *(f"{100 * table[i, j, k]:.0f} %" for table in tables)) for i, distance in enumerate(known.distance)]

    @property
    def tables(self) -> list[tuple[str, tuple[str, ...], list[tuple[str, ...]]]]:
        """The tables: what each shows, its headings and its rows."""
        return [
            (texts.PEAK_CAPTION, texts.PEAK_HEADINGS, self.peak_rows),
            (texts.DIFFERENCE_CAPTION, texts.DIFFERENCE_HEADINGS, self.difference_rows),
            (texts.DISTANCE_CAPTION, texts.DISTANCE_HEADINGS, self.distance_rows),
        ]

    @property
    def told(self) -> str:
        """The resolution in words."""
        at = self.resolution
        return f"Computed with M = {at.modes}, time step {at.time_step:g}, to t = {at.duration:g}; the map with M = 30, time step 0.008."

    def markdown(self, folder: str = "") -> str:
        """Return the report as Markdown text without its title; its pictures lie in a folder beside it."""
        shown = [f"![{caption}]({folder}{name}.png)" for name, caption in texts.CAPTIONS.items()]
        peaks, differences, distances = (f"{caption}\n\n{table(headings, rows)}" for caption, headings, rows in self.tables)
        use = "\n".join(f"- {line}" for line in texts.USE)
        pieces = [texts.ABOUT, self.told, peaks, differences, texts.WHY, shown[0], "## The map", texts.MAP, shown[1], distances]
        claims = [] if self.judged is None else [f"## {texts.CLAIMS_TITLE}", *claims_markdown(self.judged)]
        return "\n\n".join([*pieces, *claims, "## What to use when", use]) + "\n"

    def figures(self) -> dict[str, Figure]:
        """Return the pictures by the names of their files."""
        from coaxshell.apps.paper.sphere.pictures import figure_error_map, figure_histories

        return {"slice-or-sphere-histories": figure_histories(self.found), "slice-or-sphere-map": figure_error_map(self.known)}


def claims_markdown(judged: Judgement) -> list[str]:
    """Return what is said about the paper's claims under slice and sphere, and their table, as Markdown."""
    return [texts.CLAIMS, judged.told, table(texts.CLAIM_HEADINGS, judged.rows)]


def report(resolution: Settings = RESOLUTION, judged: Judgement | None = None) -> Report:
    """Return the report, by one run in three dimensions and three in two, and what has been found about the paper's claims, if anything."""
    return Report(resolution, compare(preset("bare"), resolution), slice_map(), judged)
