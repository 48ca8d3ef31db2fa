"""The figures that can be asked for by number."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

from coaxshell.apps.paper import cases
from coaxshell.apps.paper.histories import BOTH, INNER, MAGNIFIED, PER_LENGTH, hybrid, stress_study
from coaxshell.apps.paper.known_runs import Runs
from coaxshell.apps.paper.recipes import Drawn, FigureRecipe, StudyRecipe
from coaxshell.errors import InputError
from coaxshell.numerics.progress import Progress

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from coaxshell.model import System
    from coaxshell.response import Response


def _bare_histories(responses: list[Response], progress: Progress | None) -> Figure:
    from coaxshell.plotting.bare_histories import figure_bare_histories

    return figure_bare_histories(responses[0])


def _snapshots(responses: list[Response], progress: Progress | None) -> Figure:
    from coaxshell.plotting.snapshots import figure_snapshots

    return figure_snapshots(*responses, units="relative", progress=progress)


def _pressure_rms(responses: list[Response], progress: Progress | None) -> Figure:
    from coaxshell.plotting.pressure_rms import figure_pressure_rms

    return figure_pressure_rms(*responses)


def _limiting_cases(systems: list[System], runs: Runs, progress: Progress | None) -> Drawn:
    from coaxshell.apps.paper.limiting_cases import limiting_cases

    return limiting_cases(systems, runs, progress)


def _offsets(systems: list[System], runs: Runs, progress: Progress | None) -> Drawn:
    from coaxshell.apps.paper.absorbers import offsets

    return offsets(systems, runs, progress)


def _counts(systems: list[System], runs: Runs, progress: Progress | None) -> Drawn:
    from coaxshell.apps.paper.absorbers import counts

    return counts()(systems, runs, progress)


_BARE = ("bare",)
_COMPARED = ("bare", "hybrid")
_ALL_FOUR = ("bare", "absorbers", "active", "hybrid")
_RING = "25 equal absorbers, the first at the head; damping of each per metre of the shells' length"
_GAINS = "feedback on both shells; gains in V/V, the derivative one per unit of dimensionless time"

_RECIPES: tuple[FigureRecipe | StudyRecipe, ...] = (
    StudyRecipe(
        "2",
        "limiting cases: evacuated, filled and double shell",
        ("iakovlev-evacuated", "iakovlev-filled", "iakovlev-double"),
        _limiting_cases,
        "Steel shells. a: incident plus diffracted pressure on the evacuated shell held still. b: its displacement. c: displacement of "
        "a shell with water inside and outside, for four thicknesses. d, e: displacement and hoop stress of two shells, the inner hollow.",
    ),
    FigureRecipe(
        "3",
        "stress and displacement at head and tail of each shell",
        _BARE,
        _bare_histories,
        "Hoop stress (left scales) and inward displacement (right scales) of the shells without absorbers and control. "
        "Circles mark the largest magnitudes.",
    ),
    FigureRecipe(
        "4",
        "snapshots of the acoustic field and of the stress",
        _BARE,
        _snapshots,
        "Total pressure in the three fluids, over the exterior fluid's density times its sound speed squared, and "
        "hoop stress on the shells at "
        "several instants.",
    ),
    StudyRecipe(
        "5",
        "effect of an absorber's linear stiffness on the inner shell",
        _BARE,
        stress_study(cases.linear_stiffness, INNER, PER_LENGTH + "; $m$ = 10 kg, linear, undamped", MAGNIFIED),
        "Hoop stress of the inner shell with one linear absorber of 10 kg between the heads, for five stiffnesses, and without. "
        "The insets magnify the largest extremum.",
    ),
    StudyRecipe(
        "6",
        "effect of an absorber's mass on the inner shell",
        _BARE,
        stress_study(cases.mass, INNER, PER_LENGTH + r"; $k_\mathrm{l}$ = $10^9$ N/m, linear, undamped", MAGNIFIED),
        "Hoop stress of the inner shell with one linear absorber of 1e9 N/m between the heads, for five masses, and without. "
        "Mass 0 is two springs in series.",
    ),
    StudyRecipe(
        "7",
        "effect of an absorber's cubic stiffness on the inner shell",
        _BARE,
        stress_study(cases.cubic_stiffness, INNER, PER_LENGTH + r"; $m$ = 10 kg, $k_\mathrm{l}$ = $10^9$ N/m, undamped", MAGNIFIED),
        "Hoop stress of the inner shell with one absorber of 10 kg and 1e9 N/m between the heads, linear and with four cubic "
        "stiffnesses, and without.",
    ),
    StudyRecipe(
        "8",
        "effect of an absorber's position on the displacement of the heads",
        _BARE,
        _offsets,
        "Inward displacement of the heads with one cubic absorber at the head (red), 3 to 60 degrees beside it (dashed, coloured by "
        "the offset), and without (black). Cosine and sine orders are carried.",
    ),
    StudyRecipe(
        "9",
        "effect of the number of absorbers on the stress of both shells",
        _BARE,
        _counts,
        "Largest hoop stress at the head, at the tail and anywhere on a shell (left scales) and its root mean square over surface and "
        "time (right scales) with rings of equal undamped cubic absorbers, the first one at the head. The scales do not begin at zero.",
    ),
    StudyRecipe(
        "10",
        "effect of the damping of 25 absorbers on the inner shell",
        _BARE,
        stress_study(cases.damping, INNER, _RING, MAGNIFIED),
        "Hoop stress of the inner shell with a ring of 25 cubic absorbers, undamped and with three dampings, and without.",
    ),
    StudyRecipe(
        "11",
        "effect of the control gains on both shells",
        _BARE,
        stress_study(cases.gains, BOTH, _GAINS, None),
        "Hoop stress of both shells under derivative, proportional and combined feedback, and without.",
    ),
    FigureRecipe(
        "12",
        "stress of both shells: bare, absorbers, active, hybrid",
        _ALL_FOUR,
        hybrid,
        "Hoop stress of both shells without any control, with 25 absorbers, with feedback, and with both together.",
    ),
    FigureRecipe(
        "13",
        "acoustic field and stress, bare against hybrid",
        _COMPARED,
        _snapshots,
        "Total pressure over the exterior fluid's density times its sound speed squared, and hoop stress on the "
        "shells, without control (left) "
        "and with both kinds (right).",
    ),
    FigureRecipe(
        "14",
        "RMS of the pressure outside and inside, bare against hybrid",
        _COMPARED,
        _pressure_rms,
        "Root mean square of the total pressure over the exterior within three radii and over the interior, against time.",
    ),
)

FIGURES: Mapping[str, FigureRecipe | StudyRecipe] = MappingProxyType({recipe.number: recipe for recipe in _RECIPES})
"""Figures by their number in the paper."""


def figure_recipe(number: str) -> FigureRecipe | StudyRecipe:
    """Return the recipe of a figure; InputError that lists the available ones if there is none."""
    try:
        return FIGURES[number]
    except KeyError:
        raise InputError("figure", f"there is no figure {number!r}", f"allowed: {', '.join(FIGURES)}") from None
