"""The best control law of a system for the electronics that there are, and what it does: :func:`design_control`."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any, Unpack

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.control import PDControl, Transducers
from coaxshell.model.feedback import Feedback
from coaxshell.model.loading import SystemLike, as_system
from coaxshell.model.places import shell_name
from coaxshell.model.prefixes import engineering
from coaxshell.model.system import System
from coaxshell.model.units import to_si
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.progress import Progress
from coaxshell.numerics.texts import percent
from coaxshell.response import Response, simulate
from coaxshell.response.effort import ControlEffort
from coaxshell.response.margins import stability_margins
from coaxshell.response.summary_text import aligned
from coaxshell.solver.interface.saturation import voltage_limit
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.settings import Settings, SettingsKeywords
from coaxshell.studies.control_design.bench import Bench
from coaxshell.studies.control_design.kinds import KINDS
from coaxshell.studies.control_design.search import Limits, Search, Trial

USUAL = Settings(duration=3.0, time_step=1e-2, modes=24)
"""Resolution of a design unless asked for: stress and voltage of the paper's systems within a few per cent."""
_FILTERS = (1, 2, 3, 4, 6, 9, 14, 24)
"""Highest orders that modal filters are tried with."""
_RANKED = 3
"""Filters that all kinds are tried with: those with which rate feedback does best."""


@dataclass(frozen=True)
class Reduction:
    """What a law does to one shell, largest hoop stresses of a run: of the core and of any ceramic, Pa, without and with control."""

    shell: str
    core: tuple[float, float]
    ceramic: tuple[float, float]

    @property
    def share(self) -> float:
        """The share of the core's stress that control takes off."""
        return 1.0 - self.core[1] / self.core[0]


@dataclass(frozen=True)
class Alternative:
    """The best law of one kind: what it leaves of the stress of the worst shell, and its margins."""

    kind: str
    law: Feedback
    left: float
    gain_margin: float
    phase_margin: float
    kept: bool


@dataclass(frozen=True, eq=False)
class ControlDesign:
    """A control law, what it stands, what it does and what it costs; ``print(design)`` tells all of it.

    Attributes
    ----------
    law : Feedback
    kind : str
        "rate", "pd", "lead-lag", "resonant" or "positive-position".
    system : System
        Under the law.
    settings : Settings
    margins : Dataset
        Of the loop of each shell by order, see :func:`coaxshell.stability_margins`.
    reductions : tuple of Reduction
        Of a run with all that the system has.
    effort : ControlEffort
    alternatives : tuple of Alternative
        The best of each kind, as the search judged it: linear, without absorbers, best first.
    response : Response
        The run under the law.
    """

    law: Feedback
    kind: str
    system: System
    settings: Settings
    margins: xr.Dataset
    reductions: tuple[Reduction, ...]
    effort: ControlEffort
    alternatives: tuple[Alternative, ...]
    response: Response

    def to_dict(self) -> dict[str, Any]:
        """Return it as plain data, ready for JSON."""
        return {
            "kind": self.kind,
            "law": self.law.model_dump(mode="json", exclude_none=True),
            "margins": {name: _finite(float(self.margins[name].min())) for name in ("gain_margin", "phase_margin", "delay_margin")},
            "reductions": [
                {"shell": one.shell, "core": list(one.core), "ceramic": list(one.ceramic), "share": one.share} for one in self.reductions
            ],
            "effort": self.effort.to_dict(),
            "alternatives": [
                {
                    "kind": one.kind,
                    "left": one.left,
                    "gain_margin": _finite(one.gain_margin),
                    "phase_margin": _finite(one.phase_margin),
                    "kept": one.kept,
                    "law": one.law.model_dump(mode="json", exclude_none=True),
                }
                for one in self.alternatives
            ],
            "settings": self.settings.arguments(),
        }

    def __str__(self) -> str:
        """Return law, margins, reductions, effort and alternatives as text."""
        return "\n".join([*self._law(), "", *self._reduced(), "", str(self.effort), "", *self._others()])

    def _repr_html_(self) -> str:
        return f"<pre>{escape(str(self))}</pre>"

    def _law(self) -> Iterator[str]:
        law = self.law
        yield f"{KINDS[self.kind].words}: H = ({_polynomial(law.numerator)})/({_polynomial(law.denominator)}), s in 1/s"
        around = [] if law.amplifier_corner is None else [f"corner {engineering(law.amplifier_corner, 'Hz')}"]
        around += [f"delay {engineering(law.delay, 's')}"] if law.delay else []
        yield f"of the orders up to {law.weights}" + (f", {', '.join(around)}" if around else "")
        least = {name: float(self.margins[f"{name}_margin"].min()) for name in ("gain", "phase", "delay")}
        gain = "10 times or more" if math.isinf(least["gain"]) else f"{least['gain']:.3g} times"
        phase = "any" if math.isinf(least["phase"]) else f"{least['phase']:.3g} deg"
        delay = "any" if math.isinf(least["delay"]) else engineering(least["delay"], "s")
        yield f"margins: gain {gain}, phase {phase}, {delay} more delay"

    def _reduced(self) -> list[str]:
        rows: list[tuple[str, ...]] = [("shell", "core without", "with", "change", "ceramics without", "with")]
        for one in self.reductions:
            core, ceramic = ([engineering(x, "Pa") for x in pair] for pair in (one.core, one.ceramic))
            rows.append((one.shell, *core, percent(-one.share, 0, signed=True), *ceramic))
        return aligned(rows)

    def _others(self) -> list[str]:
        rows = [("kind", "stress left", "gain margin", "phase margin", "limits")]
        for one in self.alternatives:
            gain, phase = (f"{x:.3g}" if math.isfinite(x) else "any" for x in (one.gain_margin, one.phase_margin))
            rows.append((one.kind, percent(one.left, 0) if one.kept else "", gain, phase, "kept" if one.kept else "not kept"))
        return aligned(rows)


def design_control(
    system: SystemLike,
    *,
    delay: float | str = 0.0,
    bandwidth: float | str | None = None,
    kinds: Sequence[str] | str | None = None,
    shells: str | Sequence[int | str] = "all",
    transducers: Transducers = "electrodes",
    gain_margin: float = 2.0,
    phase_margin: float = 30.0,
    voltage: float | None = None,
    ceramic_stress: float | str | None = None,
    of: int | str | Sequence[int | str] | None = None,
    progress: Progress | None = None,
    **keywords: Unpack[SettingsKeywords],
) -> ControlDesign:
    """Return the law that leaves least of the largest hoop stress of the cores, under margins and limits.

    Rate, proportional-derivative, lead-lag, resonant and positive position feedback, each behind modal filters of several widths, are
    searched on the plant of the system, which is found once: a law then costs a hundredth of a run. The best one is run and its margins
    are found as of any system. A system of two shells takes five to thirty seconds.

    Parameters
    ----------
    system : System, str or Path
        Its layers have their roles; what control it has is left out.
    delay : float or str
        Of converters and computation, s or "5 us".
    bandwidth : float or str, optional
        Corner of first order of the amplifier, Hz.
    kinds : str or sequence of str, optional
        "rate", "pd", "lead-lag", "resonant", "positive-position"; all unless given.
    shells : "all" or sequence
        Which shells are controlled.
    transducers : str
        "electrodes" or "paper".
    gain_margin, phase_margin : float
        What the loops have to stand, all changed alike: a factor above 1, degrees.
    voltage : float, optional
        Largest voltage at any point, V; what the actuators stand unless it is less.
    ceramic_stress : float or str, optional
        Largest hoop stress of the ceramics, Pa.
    of : shell or sequence of shells, optional
        Whose core counts, the worst of them; all controlled ones unless given.
    progress : callable, optional
        Called with the fraction done and the name of the stage.
    **keywords
        As to :func:`simulate`; duration 3, time_step 0.01 and 24 modes unless given.

    Raises
    ------
    InputError
        If an argument is not allowed, a wall is one of elastic solids, or no law keeps the limits: with the best found and what it lacks.
    """
    found = as_system(system)
    settings = Settings.of(found, {name: x for name, x in keywords.items() if name != "settings"}, base=_base(found, keywords))
    if settings.dimensions == 3 or settings.engine != "spectral" or not isinstance(settings.modes, int):
        raise InputError("settings", "a law is designed in two dimensions", 'use dimensions=2, engine="spectral" and a number of modes')
    late, band = _number("delay", delay, "time", 0.0), None if bandwidth is None else _number("bandwidth", bandwidth, "frequency", None)
    margin, phase = _number("gain_margin", gain_margin, "number", 1.0), _number("phase_margin", phase_margin, "number", 0.0)
    ceramic = None if ceramic_stress is None else _number("ceramic_stress", ceramic_stress, "stress", None)
    chosen = _kinds(kinds)
    under = found.replace(control=PDControl(proportional=0, derivative=0, transducers=transducers, shells=shells))
    problem = dimensionless(under, settings=settings)
    bench = Bench(problem, settings, late / problem.scales.time)
    limits = Limits(margin, math.radians(phase), _volts(problem, bench, voltage), ceramic)
    corner = None if band is None else 2.0 * math.pi * band * problem.scales.time
    search = Search(bench, limits, _counted(found, bench, of), bench.delay, corner)
    best = _searched(search, chosen, progress)
    law = {"delay": late, "amplifier_corner": band, "transducers": transducers, "shells": shells}
    ranked = [(one, _described(one, problem, law)) for one in best]
    if not ranked[0][0].kept:
        raise _refusal(ranked[0][0], limits)
    return _design(found, settings, ranked, progress)


def _base(system: System, keywords: SettingsKeywords) -> Settings:
    given = keywords.get("settings")
    return USUAL if given is None else Settings.of(system, given, base=USUAL)


def _searched(search: Search, chosen: list[str], progress: Progress | None) -> list[Trial]:
    """Return the best law of each kind, best first."""
    highest = search.bench.modes.max_order
    filters = sorted({min(one, highest) for one in _FILTERS})
    jobs, done = len(filters) + min(_RANKED, len(filters)) * len(chosen), 0

    def best(name: str, filtered: int) -> Trial:
        nonlocal done
        if progress is not None:
            progress(0.9 * done / jobs, "search for laws")
        done += 1
        return search.best(KINDS[name], filtered)

    first = {filtered: best("rate", filtered) for filtered in filters}
    ranked = sorted(first.values(), key=lambda one: one.score)
    found = []
    for name in chosen:
        trials = ranked if name == "rate" else [best(name, one.highest) for one in ranked[:_RANKED]]
        found.append(min(trials, key=lambda one: one.score))
    return sorted(found, key=lambda one: one.score)


def _described(trial: Trial, problem: Problem, law: dict[str, Any]) -> Feedback:
    """Return a law of the search in SI."""
    time = problem.scales.time
    top, bottom = (tuple(float(f"{a * time ** (len(x) - 1 - i):.6g}") for i, a in enumerate(x)) for x in trial.polynomials)
    return Feedback(numerator=top, denominator=bottom, weights=trial.highest, **law)


def _design(system: System, settings: Settings, ranked: list[tuple[Trial, Feedback]], progress: Progress | None) -> ControlDesign:
    trial, law = ranked[0]
    if progress is not None:
        progress(0.9, "run under the law")
    under = system.replace(control=law)
    response, alone = simulate(under, settings=settings), simulate(system.replace(control=None), settings=settings)
    reductions = tuple(_reduction(under, alone, response, i) for i in under.controlled_shells)
    alternatives = tuple(
        Alternative(one.kind, described, one.score, one.margins.gain, math.degrees(one.margins.phase), one.kept)
        for one, described in ranked
    )
    margins = stability_margins(under, settings=settings)
    return ControlDesign(law, trial.kind, under, settings, margins, reductions, response.control_effort(), alternatives, response)


def _reduction(system: System, alone: Response, response: Response, shell: int) -> Reduction:
    wall = system.shells[shell]
    core = wall.layers.index(wall.core)  # type: ignore[union-attr]
    ceramics = [i for i, layer in enumerate(wall.layers) if layer.role not in ("core", "passive")]  # type: ignore[union-attr]
    peaks = [[one.value for one in run.layer_peaks(shell, "hoop")] for run in (alone, response)]
    core_pair, ceramic_pair = ([run[core] for run in peaks], [max(run[i] for i in ceramics) for run in peaks])
    return Reduction(shell_name(shell, len(system.shells)), (core_pair[0], core_pair[1]), (ceramic_pair[0], ceramic_pair[1]))


def _refusal(trial: Trial, limits: Limits) -> InputError:
    margins, wanted = trial.margins, f"gain {limits.gain_margin:g} times, phase {math.degrees(limits.phase_margin):g} deg"
    if margins.unstable:
        told = f"every law that was tried makes {margins.unstable} poles or more grow"
        return InputError("system", told, 'put sensors and actuators into one layer, role = "self-sensing", or answer sooner')
    if trial.effect is None:
        told = f"the best law stands gain {margins.gain:.3g} times and phase {math.degrees(margins.phase):.3g} deg, less than {wanted}"
        return InputError("gain_margin", told, "ask for less margin, or answer sooner")
    volts, ceramic = _shown(trial.effect.volts, "V"), _shown(trial.effect.ceramic, "Pa")
    told = f"the best law needs {volts} and stresses ceramics by {ceramic}"
    return InputError("voltage", told, "allow more, or ask for less margin")


def _shown(values: FloatArray, unit: str) -> str:
    return " and ".join(engineering(float(x), unit) for x in values)


def _volts(problem: Problem, bench: Bench, voltage: float | None) -> FloatArray:
    stands = np.array([voltage_limit(problem, i) for i in bench.at_run.shells])
    return stands if voltage is None else np.minimum(stands, _number("voltage", voltage, "number", None))


def _counted(system: System, bench: Bench, of: int | str | Sequence[int | str] | None) -> FloatArray:
    """Return which of the controlled shells count."""
    shells = bench.at_run.shells
    wanted = shells if of is None else tuple(system.shell_indices(of))
    for one in wanted:
        if one not in shells:
            raise InputError("of", f"shells[{one}] is not controlled", "name controlled shells")
    return np.array([shell in wanted for shell in shells])


def _kinds(kinds: Sequence[str] | str | None) -> list[str]:
    chosen = list(KINDS) if kinds is None else [kinds] if isinstance(kinds, str) else list(kinds)
    for one in chosen:
        if one not in KINDS:
            raise InputError("kinds", f"{shown(one)} is unknown", f"allowed: {', '.join(KINDS)}")
    if not chosen:
        raise InputError("kinds", "the list is empty", f"allowed: {', '.join(KINDS)}")
    return chosen


def _number(name: str, value: Any, dimension: str, least: float | None) -> float:
    """Return a number of a dimension, at least something or, for None, above 0."""
    try:
        number = to_si(value, dimension)
    except InputError as error:
        raise InputError(name, error.problem, error.remedy) from None
    if number < (0.0 if least is None else least) or (least is None and number == 0.0):
        raise InputError(name, f"{number:g} is not allowed", "must be above 0" if least is None else f"must be at least {least:g}")
    return number


def _polynomial(coefficients: Sequence[float]) -> str:
    """Return a polynomial in s as text."""
    powers = ["", " s", *(f" s^{n}" for n in range(2, len(coefficients)))]
    terms = [f"{x:.4g}{powers[len(coefficients) - 1 - i]}" for i, x in enumerate(coefficients) if x != 0.0]
    return " + ".join(terms).replace("+ -", "- ") or "0"


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
