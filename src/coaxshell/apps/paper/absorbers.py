"""The paper's Figures 8 and 9: where one absorber sits, and how many there are."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from coaxshell.apps.paper import cases
from coaxshell.apps.paper.histories import named_warnings, point_name, solved_curves
from coaxshell.apps.paper.known_runs import Runs
from coaxshell.apps.paper.recipes import Drawn
from coaxshell.errors import InputError
from coaxshell.model import Shell
from coaxshell.numerics.progress import Progress
from coaxshell.plotting.absorber_counts import StressByCount, figure_absorber_counts
from coaxshell.plotting.histories import QUANTITIES
from coaxshell.plotting.offsets import figure_offsets

if TYPE_CHECKING:
    from coaxshell.apps.paper.observed import StressPeaks
    from coaxshell.model import System
    from coaxshell.response.summary import ShellSummary

SHOWN = 2.0
"""Last instant of Figure 8, transits."""

HEADS = (("inner", 0.0), ("outer", 0.0))
_MEGA = 1e-6


def offsets(systems: list[System], runs: Runs, progress: Progress | None) -> Drawn:
    """Draw Figure 8: the displacement at the heads for an absorber at 0 to 60 degrees beside them, up to t = 2."""
    solved, warnings = solved_curves(cases.offset(systems[0]), HEADS, "displacement", runs, progress, SHOWN)
    panels = {
        point_name(*point): (curves["bare"], {float(name): curve for name, curve in curves.items() if name != "bare"})
        for point, curves in solved.items()
    }
    return Drawn(figure_offsets(panels, QUANTITIES["displacement"].label), warnings)


def counts(
    fine: Sequence[int] = cases.COUNTS, coarse: Sequence[int] = cases.COARSE_COUNTS
) -> Callable[[list[System], Runs, Progress | None], Drawn]:
    """Return what draws Figure 9: peak and RMS stress of both shells, for two lists of numbers of absorbers."""

    def draw(systems: list[System], runs: Runs, progress: Progress | None) -> Drawn:
        if not all(isinstance(shell, Shell) for shell in (systems[0].shells[0], systems[0].shells[-1])):
            raise InputError("shells", "the innermost or the outermost one is rigid and has no stress", "give elastic ones")
        wanted = tuple(sorted({*fine, *coarse}))
        stress: dict[str, dict[int, ShellSummary | StressPeaks]] = {"inner": {}, "outer": {}}
        warnings: list[tuple[str, str]] = []
        for name, run in runs.each(cases.count(systems[0], wanted), progress, peaks_only=True):
            for shell in stress:
                stress[shell][int(name)] = run.shells[shell]
            warnings += [(f"N = {name}", text) for text in run.warnings]
        panels = [
            (f"{shell.capitalize()} shell, $N$ = {chosen[0]} to {chosen[-1]}", _by_count(stress[shell], chosen))
            for chosen in (coarse, fine)
            for shell in ("inner", "outer")
        ]
        return Drawn(figure_absorber_counts(panels), named_warnings(warnings))

    return draw


def _by_count(found: Mapping[int, ShellSummary | StressPeaks], chosen: Sequence[int]) -> StressByCount:
    summaries = [found[n] for n in chosen]
    head, tail, anywhere = (
        _MEGA * np.array([getattr(s, name).value for s in summaries]) for name in ("stress_head", "stress_tail", "stress")
    )
    rms = _MEGA * np.array([s.stress_rms for s in summaries])
    return StressByCount(np.array(chosen, dtype=np.float64), head, tail, anywhere, rms)
