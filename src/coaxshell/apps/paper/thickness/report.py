"""The report "thin or exact walls?": tables, pictures and what follows from them, for a page and for the reproduction."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from coaxshell.apps.paper.claims.systems import preset
from coaxshell.apps.paper.thickness import texts
from coaxshell.apps.paper.thickness.compared import THIN, Compared, compare
from coaxshell.apps.paper.thickness.error_map import scaled
from coaxshell.apps.paper.thickness.judged import rows
from coaxshell.apps.verification.markdown import table
from coaxshell.model import PlaneShock
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.texts import typeset
from coaxshell.solver.settings import Settings
from coaxshell.solver.thin_error import WALLS, WETTED, ThinMap, thin_map

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from coaxshell.apps.paper.claims import Judged

RESOLUTION = Settings(duration=3.0, time_step=4e-3, modes=60)
"""At which the report is made: a few seconds of one processor."""
FACTORS = (1.0, 2.0, 4.0)
"""Times the paper's thickness."""
THINNEST, LONGEST_DECAY = 0.008, 5.0
"""Of the map's part that the power laws hold."""


@dataclass(frozen=True)
class PowerLaw:
    """The error A (h/R)^a decay^b duration^c, decay and duration in transits, and the factor within which it holds the map."""

    scale: float
    thickness: float
    decay: float
    duration: float
    within: float

    @property
    def told(self) -> tuple[str, ...]:
        """The constant, the powers and the factor."""
        powers = (typeset(f"{power:.2f}") for power in (self.thickness, self.decay, self.duration))
        return f"{self.scale:.2g}", *powers, f"{self.within:.1f}"


def power_law(known: ThinMap, wall: str, wetted: str) -> PowerLaw:
    """Return the power law of least squares of the logarithms of a wall's part of the map, thin walls and long pulses left out."""
    number = WALLS.index(wall)
    axes = np.meshgrid(known.thickness[number], known.decay, known.duration, indexing="ij")
    chosen = (axes[0] >= THINNEST) & (axes[1] <= LONGEST_DECAY)
    error = np.log(known.stress[number, WETTED.index(wetted)][chosen])
    rows = np.stack([np.ones(error.size), *(np.log(axis[chosen]) for axis in axes)], axis=1)
    found = np.linalg.lstsq(rows, error, rcond=None)[0]
    scale, thickness, decay, duration = (float(x) for x in found)
    return PowerLaw(float(np.exp(scale)), thickness, decay, duration, float(np.exp(np.abs(error - rows @ found).max())))


@dataclass(frozen=True)
class Report:
    """Hold what the report is written from.

    Attributes
    ----------
    resolution : Settings
    found : dict of str to Compared
        The paper's bare shells under a plane wave, by the thickness of their walls in words.
    known : ThinMap
        The package's map of the thin walls' error.
    judged : tuple of Judged
        The paper's statements with both, if any.
    """

    resolution: Settings
    found: dict[str, Compared]
    known: ThinMap
    judged: tuple[Judged, ...] = ()

    def _rows(self, of: Callable[[Compared, str], FloatArray], form: str) -> list[tuple[str, ...]]:
        return [
            (thickness, texts.WETTED_NAMES[theory], *(form.format(value) for value in of(one, theory)))
            for thickness, one in self.found.items()
            for theory in THIN
        ]

    @property
    def fit_rows(self) -> list[tuple[str, ...]]:
        """The power law of each wall of the map."""
        laws = {(wall, wetted): power_law(self.known, wall, wetted) for wall in WALLS for wetted in WETTED}
        return [(texts.WALL_NAMES[wall], texts.WETTED_NAMES[wetted], *law.told) for (wall, wetted), law in laws.items()]

    @property
    def fit_caption(self) -> str:
        """What the power laws hold."""
        return texts.FIT.format(thinnest=THINNEST, decay=LONGEST_DECAY)

    @property
    def tables(self) -> list[tuple[str, tuple[str, ...], list[tuple[str, ...]]]]:
        """The tables: what each shows, its headings and its rows."""
        headings = ("walls", "thin, wetted at", *next(iter(self.found.values())).points)
        return [
            (texts.ERROR_CAPTION, headings, self._rows(lambda one, theory: 100.0 * one.difference(theory), "{:.1f} %")),
            (texts.PEAK_CAPTION, headings, self._rows(lambda one, theory: one.peak_ratio(theory), "{:.3f}")),
            (texts.MOTION_CAPTION, headings, self._rows(lambda one, theory: 100.0 * one.difference(theory, "displacement"), "{:.1f} %")),
            (self.fit_caption, texts.FIT_HEADINGS, self.fit_rows),
        ]

    @property
    def map_told(self) -> str:
        """What the map shows, with the range of other systems."""
        low, high = float(self.known.spread.min()), float(self.known.spread.max())
        return texts.MAP.format(duration=texts.SHOWN_DURATION, low=low, high=high)

    @property
    def told(self) -> str:
        """The resolution in words."""
        at = self.resolution
        return f"Computed with M = {at.modes}, time step {at.time_step:g}, to t = {at.duration:g}; the map with M = 40, time step 0.005."

    def markdown(self, folder: str = "") -> str:
        """Return the report as Markdown text without its title; its pictures lie in a folder beside it."""
        shown = [f"![{caption}]({folder}{name}.png)" for name, caption in texts.CAPTIONS.items()]
        errors, peaks, motion, fit = (f"{caption}\n\n{table(headings, rows)}" for caption, headings, rows in self.tables)
        use = "\n".join(f"- {line}" for line in texts.USE)
        pieces = [texts.ABOUT, errors, peaks, motion, self.told, texts.WHY, shown[0], "## The map", self.map_told, shown[1], fit]
        written = "\n\n".join([*pieces, *self._claims, "## What to use when", use]) + "\n"
        return re.sub(r'(\w+ = "\w+")', r"`\1`", written)  # options as they are typed

    @property
    def _claims(self) -> list[str]:
        """What is said about the paper's statements, and their table."""
        if not self.judged:
            return []
        found = rows(self.judged)
        turned = [row[0] for row in found if row[2] != row[3]]
        change = "change their verdicts" if len(turned) > 1 else "alone changes its verdict"
        told = f"no. {', '.join(turned)} {change}" if turned else "none changes its verdict"
        said = texts.CLAIMS.format(count=len(found), turned=told)
        return [f"## {texts.CLAIMS_TITLE}", said, table(texts.CLAIM_HEADINGS, found)]

    def figures(self) -> dict[str, Figure]:
        """Return the pictures by the names of their files."""
        from coaxshell.apps.paper.thickness.pictures import figure_error_map, figure_histories

        histories = figure_histories(next(iter(self.found.values())))
        return dict(zip(texts.CAPTIONS, (histories, figure_error_map(self.known)), strict=True))


def report(resolution: Settings = RESOLUTION, factors: tuple[float, ...] = FACTORS, judged: tuple[Judged, ...] = ()) -> Report:
    """Return the report, by three runs for each thickness, with what has been found about the paper's statements, if anything."""
    bare = preset("bare")
    plane = PlaneShock(peak_pressure=25e3, decay_time=bare.sources[0].pulse.decay_time)  # type: ignore[union-attr]
    walls = bare.replace(source=plane)
    thickness = 1e3 * bare.shells[-1].thickness
    found = {f"{factor * thickness:g} mm": compare(scaled(walls, factor), resolution) for factor in factors}
    return Report(resolution, found, thin_map(), judged)
