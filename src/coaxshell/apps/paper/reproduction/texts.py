"""What the report says, whatever it is written in."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from coaxshell.apps.paper.claims import Judged
from coaxshell.apps.paper.known_runs import CORRECTED
from coaxshell.apps.paper.reproduction.plan import VARIANTS
from coaxshell.apps.paper.reproduction.results import VERDICTS, DrawnFigure, Estimate, Results
from coaxshell.apps.paper.slips import SLIPS
from coaxshell.numerics.texts import percent
from coaxshell.solver.settings import Settings

TITLE = "coaxshell: the paper, computed again"
ABOUT = (
    "Every figure, every checkable statement and every slip of Vesal, Hasheminejad and Lissek, Transient Vibroacoustic Control of a "
    "Shock-Loaded Inter-Connected Cylindrical Double Shell, computed here from its description of the system; statements are given in our "
    "words, numbers are this run's. A statement is judged in the corrected model and in models with slips of the "
    "printed equations turned on "
    "that could have been in a program: what changes there follows from the slip. What the authors' program did is not known to us."
)
CLAIM_HEADINGS = ("no.", "place", "statement, and what counts as holding", *VARIANTS, "found in the corrected model")
TALLY_HEADINGS = ("model", *VERDICTS)
SLIP_HEADINGS = ("slip", "where", "printed", "to use", "in a program?", "why")
EFFECT_HEADINGS = (
    "slips",
    "system",
    "inner peak (MPa)",
    "with the slip (MPa)",
    "change",
    "outer peak (MPa)",
    "with the slip (MPa)",
    "inner stress, L2",
)
TIME_HEADINGS = ("part", "seconds", "processor seconds")


def settings_text(resolution: Settings) -> str:
    """Return the resolution in words."""
    return f"M = {resolution.modes}, time step {resolution.time_step:g}, duration {resolution.duration:g} transits"


def options_of(resolution: Settings) -> str:
    """Return the options of a command that give a resolution, "" if it is the paper's."""
    plain = asdict(Settings())
    texts = {"duration": "--duration", "time_step": "--time-step", "modes": "--modes"}
    return "".join(f" {option} {getattr(resolution, name):g}" for name, option in texts.items() if getattr(resolution, name) != plain[name])


def figure_command(figure: DrawnFigure, resolution: Settings) -> str:
    """Return the command that draws a figure again."""
    return f"coaxshell figure {figure.recipe.number}{options_of(resolution)}"


def circumstances_of(results: Results) -> str:
    """Return how the run went in a sentence or two."""
    kept = f" {results.resumed} of its {len(results.seconds)} parts were there from an earlier call." if results.resumed else ""
    work = sum(results.processor.values())
    processes = "one process" if results.workers == 1 else f"{results.workers} processes"
    spent = f"{results.elapsed:.0f} s on {processes}; the parts took {work:.0f} s of processor time"
    return f"{settings_text(results.resolution)}. {spent}.{kept}"


def tally_rows(results: Results) -> list[tuple[str, ...]]:
    """Return the number of claims by model and verdict."""
    return [(name, *(str(results.tally(name)[verdict]) for verdict in VERDICTS)) for name in VARIANTS]


def turned_text(judged: Judged) -> list[str]:
    """Return what is found in the variants that judge otherwise."""
    return [f"{name}: {judged.findings[name].verdict}. {judged.findings[name].why}" for name in judged.turned]


def estimate_text(estimate: Estimate) -> str:
    """Return the estimate of the direct engine's time."""
    singles = ", ".join(
        f"{n}: {d:.1f} s (ours {s:.1f} s)" for n, d, s in zip(estimate.sample, estimate.direct, estimate.spectral, strict=True)
    )
    ours = "" if estimate.ours is None else f" Ours took {estimate.ours:.0f} s for all, the structure prepared once a part."
    return (
        f"Processor time of single runs with that many absorbers, one BLAS thread: {singles}. All {estimate.runs} "
        f"numbers of Figure 9 by the direct "
        f"engine would take about {estimate.whole:.0f} s of processor time, extrapolated from the sample's mean.{ours}"
    )


def time_rows(results: Results) -> list[tuple[str, ...]]:
    """Return the times of the parts."""
    return [(name, f"{seconds:.1f}", f"{results.processor[name]:.1f}") for name, seconds in results.seconds.items()]


def slip_rows() -> list[tuple[str, ...]]:
    """Return the slips."""
    return [(s.key, s.where, s.printed, s.corrected, s.in_code, s.why) for s in SLIPS.values()]


def effect_rows(results: Results) -> list[tuple[str, ...]]:
    """Return the measured effects of slips."""
    return [_effect(effect) for effect in results.effects]


def _effect(effect: Mapping[str, Any]) -> tuple[str, ...]:
    plain, slipped, grows = effect["corrected"], effect["slipped"], effect["growth"]
    name = " + ".join(effect["slips"])
    if slipped is None:
        told = f"grows as exp({grows['rate']:.3g} t)" if grows else "grows"
        return name, effect["case"], _mega(plain["inner"]), "unbounded", told, _mega(plain["outer"]), "unbounded", ""
    change = percent(slipped["inner"] / plain["inner"] - 1, signed=True)
    moved = f"{100 * effect['inner_change']:.3g} %"
    return (
        name,
        effect["case"],
        _mega(plain["inner"]),
        _mega(slipped["inner"]),
        change,
        _mega(plain["outer"]),
        _mega(slipped["outer"]),
        moved,
    )


def _mega(value: float) -> str:
    return f"{value / 1e6:.4f}"


def claim_cells(judged: Judged) -> tuple[str, ...]:
    """Return a claim's row as plain text."""
    claim = judged.claim
    return (
        str(claim.number),
        claim.place,
        f"{claim.statement} ({claim.criterion})",
        *(judged.findings[name].verdict for name in VARIANTS),
        judged.findings[CORRECTED].why,
    )
