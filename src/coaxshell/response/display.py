"""How a response shows itself in a notebook: its system's cross-section and the peaks of the summary."""

from __future__ import annotations

from coaxshell.model.display import card
from coaxshell.model.prefixes import engineering
from coaxshell.response.summary import ShellSummary, Summary, summarise
from coaxshell.solver.solution import ModalSolution


def response_card(solution: ModalSolution) -> str:
    """Return the drawing of the system that was solved beside its peaks, error estimates and warnings, as HTML."""
    found = summarise(solution)
    rows = [
        ("", *("stress: head", "tail", "anywhere", "RMS", "relative displacement: head", "tail")),
        *(_row(shell) for shell in found.shells),
    ]
    return card(solution.problem.system, found.title or "unnamed system", rows, _notes(found))


def _row(shell: ShellSummary) -> tuple[str, ...]:
    stresses = (shell.stress_head.value, shell.stress_tail.value, shell.stress.value, shell.stress_rms)
    return (
        shell.name,
        *(engineering(value, "Pa") for value in stresses),
        *(engineering(peak.value, "m") for peak in (shell.relative_displacement_head, shell.relative_displacement_tail)),
    )


def _notes(found: Summary) -> list[str]:
    settings = found.settings
    left_out = ", ".join(f"{shell.name} {shell.stress_truncation:.1e}" for shell in found.shells)
    return [
        f"{settings['engine']} engine, {settings['modes']} modes, time step {settings['time_step']:g}, "
        f"t = {found.window[0]:g} to {found.window[1]:g} transits of {engineering(found.transit_time, 's')}",
        *([f"estimated relative error of the stress: {left_out}"] if left_out else []),
        *(f"warning: {text}" for text in found.warnings),
    ]
