"""Stability margins of a system's feedback: how much more gain, phase or delay the loop of each shell stands, by order."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Unpack

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.gains import segments_of
from coaxshell.model.loading import SystemLike, as_system
from coaxshell.model.places import shell_name
from coaxshell.model.system import System
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.progress import Progress, ShareDone
from coaxshell.solver.axial.belt_ties import ties_of_belts
from coaxshell.solver.axial.sampling import AxialSampling, require_seen
from coaxshell.solver.axial.stability import require_stable_waves
from coaxshell.solver.margins import Loop, LoopMargins, loops, margins_of
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.segmented_margins import CutLoop, segmented_loops
from coaxshell.solver.settings import Settings, SettingsKeywords
from coaxshell.solver.stability import require_stable
from coaxshell.solver.tied_stability import Tied, require_stable_ties

_DEGREES, _HERTZ, _SECONDS, _FACTOR = "deg", "Hz", "s", "1"
_STAGE, _FOLLOWED = "margins", 0.7
"""The share of the work that loops take; the rest is where they cross the axis and the circle."""
_WAVES = 6
"""Axial wavenumbers in three dimensions."""
_VARIABLES = {
    "gain_margin": (_FACTOR, "least factor above 1 on the gain at which the order grows"),
    "lesser_gain_margin": (_FACTOR, "largest factor below 1 on the gain at which the order grows, 0 where there is none"),
    "phase_margin": (_DEGREES, "least turn of the loop's phase at which the order grows"),
    "delay_margin": (_SECONDS, "least further delay at which the order grows"),
    "gain_margin_frequency": (_HERTZ, "where the gain margin is"),
    "phase_margin_frequency": (_HERTZ, "where the phase margin is"),
    "delay_margin_frequency": (_HERTZ, "where the delay margin is"),
}


class LoopResponse(NamedTuple):
    """L of an order of a shell's loop at frequencies (Hz): 1 - L = 0 is where it would grow. An axial ``wavenumber`` is in 1/m."""

    shell: str
    order: int
    frequency: FloatArray
    values: ComplexArray
    wavenumber: float = 0.0


def stability_margins(system: SystemLike, *, progress: Progress | None = None, **keywords: Unpack[SettingsKeywords]) -> xr.Dataset:
    """Return gain, phase and delay margins of the feedback of each shell, the loops of the others closed, by order.

    The loop of one shell is 1 - L = D/D', the determinant of all with its feedback over that without. It is read on Re s = 1/duration,
    the least growth that counts: the gain margin is 1/L where L is real and positive, the phase margin its angle where its magnitude
    is 1, the delay margin that angle over omega there, beyond the delay that the law has.

    Parameters
    ----------
    system : System, str or Path
        A description, the name of a preset or the path of a scenario file, with control.
    progress : callable, optional
        Called with the fraction done and the name of the stage; an exception from it ends the search.
    **keywords
        As to :func:`simulate`: ``duration`` and ``modes`` count.

    Returns
    -------
    Dataset, dims (shell, order), in three dimensions (shell, wavenumber, order)
        Infinite margins where no change of that kind makes an order grow, of the gain by about ten times or less. In three dimensions of
        six axial wavenumbers from 0 to ``axial_modes`` (that of the highest order unless given), NaN of waves that a run has not; of
        electrodes cut along the axis from 0 to pi over their pitch, each with all that they cannot tell from it. Of electrodes in N
        segments the order is q of a pattern, 0 to N/2, with the orders N - q, N + q, ... that are tied to it; all segments of a wall
        change together. Dead ones tie all patterns: a loop is told by the one that its segments follow most.

    Raises
    ------
    InputError
        If nothing is fed back, or the system is unstable.
    """
    found = as_system(system)
    settings = Settings.asked(found, keywords)
    return worst_loops(found, settings, progress)[0]


def worst_loops(system: System, settings: Settings, progress: Progress | None = None) -> tuple[xr.Dataset, list[LoopResponse]]:
    """Return the margins of a system, and L of the order of each loop that stands the least delay."""
    if settings.dimensions == 3:
        return _worst_waves(system, settings, progress)
    problem, modes = _problem(system, settings)
    if segments_of(system) is not None:
        return _worst_patterns(problem, modes, _least(settings), progress)
    found = loops(problem, Tied(modes), _least(settings), _part(progress, 0.0, _FOLLOWED))
    if not found.surely_stable:
        (require_stable_ties if problem.tied else require_stable)(problem, modes.max_order, settings.duration)
    all_loops = found.each
    margins = {}
    for number, (shell, loop) in enumerate(all_loops.items()):
        _part(progress, _FOLLOWED, 1.0)(number / len(all_loops))
        margins[shell] = margins_of(modes.orders, *loop)
    worst = [_of_order(problem, shell, int(margins[shell].delay.argmin()), loop) for shell, loop in all_loops.items()]
    return labelled(problem, modes, margins), worst


def _worst_patterns(problem: Problem, modes: Modes, least: float, progress: Progress | None) -> tuple[xr.Dataset, list[LoopResponse]]:
    """Return the margins of segments by their patterns, and L of the loop of each wall that stands the least delay."""
    found = segmented_loops(problem, Tied(modes), least, _part(progress, 0.0, 1.0))
    margins = {shell: cut.margins for shell, cut in found.items()}
    told = _of_patterns(labelled(problem, Modes(next(iter(margins.values())).orders), margins), problem)
    return told, [_worst_of_cut(problem, shell, cut) for shell, cut in found.items()]


def _of_patterns(told: xr.Dataset, problem: Problem) -> xr.Dataset:
    """Return margins whose orders are told to be patterns."""
    told["order"].attrs |= {"long_name": "pattern q of the segments, with the orders N - q, N + q, ... tied to it"}
    return told.assign_attrs(segments=segments_of(problem.system))


def _worst_of_cut(problem: Problem, shell: int, cut: CutLoop) -> LoopResponse:
    row = int(margins_of(cut.patterns, *cut.loop).delay.argmin())
    return _of_order(problem, shell, row, cut.loop)._replace(order=int(cut.patterns[row]))


def labelled(problem: Problem, modes: Modes, margins: dict[int, LoopMargins]) -> xr.Dataset:
    """Return margins in SI with names and units."""
    values = {name: np.stack([_entry(one, name, problem) for one in margins.values()]) for name in _VARIABLES}
    return _dataset(problem, list(margins), modes.orders, ("shell", "order"), values)


def _entry(margins: LoopMargins, name: str, problem: Problem) -> FloatArray:
    """Return a margin of each order in SI."""
    units = {
        _DEGREES: 180.0 / np.pi,
        _SECONDS: problem.scales.time,
        _HERTZ: 1.0 / (2.0 * np.pi * problem.scales.time),
        _FACTOR: 1.0,
    }
    kept = "lesser_gain" if name == "lesser_gain_margin" else name.replace("_margin", "")
    return np.asarray(units[_VARIABLES[name][0]] * getattr(margins, kept))


def _dataset(
    problem: Problem, shells: list[int], orders: FloatArray, dims: tuple[str, ...], values: dict[str, FloatArray], **axes: xr.Variable
) -> xr.Dataset:
    variables = {name: xr.Variable(dims, values[name], {"units": unit, "long_name": told}) for name, (unit, told) in _VARIABLES.items()}
    coordinates = {
        "shell": xr.Variable("shell", [shell_name(i, len(problem.shells)) for i in shells]),
        "order": xr.Variable("order", orders.astype(int), {"long_name": "circumferential order m"}),
        **axes,
    }
    return xr.Dataset(variables, coordinates)


def _part(progress: Progress | None, begin: float, end: float) -> ShareDone:
    """Return what tells the share of a part of the work that lies between two shares of the whole."""

    def told(share: float) -> None:
        if progress is not None:
            progress(begin + (end - begin) * share, _STAGE)

    return told


def _worst_waves(system: System, settings: Settings, progress: Progress | None) -> tuple[xr.Dataset, list[LoopResponse]]:
    """Return the margins of the waves of a run in three dimensions, and L of the wave of each loop that stands the least delay."""
    problem, orders = _problem(system, settings)
    sampling = _sampling(problem, settings, orders.max_order)
    ties, wavenumbers = _asked(problem, sampling)
    found: dict[str, dict[int, FloatArray]] = {}
    worst: dict[int, LoopResponse] = {}
    cut = segments_of(system)
    asked = cut is not None
    if cut is not None:
        require_stable_waves(problem, sampling, settings.duration)
        orders = Modes.up_to(cut // 2)
    count = len(ties)
    for place, tied in enumerate(ties):
        each, stable = _of_wave(problem, tied, _least(settings), _part(progress, place / count, (place + 1) / count))
        if not (stable or asked):
            require_stable_waves(problem, sampling, settings.duration)
            asked = True
        for shell, (margins, response) in each.items():
            for name in _VARIABLES:
                known = found.setdefault(name, {}).setdefault(shell, np.full((count, orders.count), np.nan))
                there = min(margins.orders.size, tied.modes.count)  # patterns above the orders of a wave have none of them
                known[place, :there] = _entry(margins, name, problem)[:there]
            known = found["delay_margin"][shell]
            if shell not in worst or margins.delay.min() * problem.scales.time <= np.nanmin(known):
                worst[shell] = response._replace(wavenumber=float(wavenumbers[place]) / problem.scales.length)
    values = {name: np.stack([each[shell] for shell in worst]) for name, each in found.items()}
    others = "" if problem.belts is None else ", with those that the electrodes cannot tell from it"
    told = {"units": "1/m", "long_name": f"axial wavenumber k{others}"}
    axis = xr.Variable("wavenumber", wavenumbers / problem.scales.length, told)
    margins_told = _dataset(problem, list(worst), orders.orders, ("shell", "wavenumber", "order"), values, wavenumber=axis)
    if problem.belts is not None:
        margins_told.attrs["segment_pitch"] = problem.belts.pitch * problem.scales.length
    return margins_told if cut is None else _of_patterns(margins_told, problem), list(worst.values())


def _sampling(problem: Problem, settings: Settings, max_order: int) -> AxialSampling:
    """Return the axial wavenumbers at which margins are asked, or whose classes are, where electrodes are cut along the axis."""
    highest, belts = settings.axial_modes or float(max_order), problem.belts
    if belts is None:
        return AxialSampling(2.0 * np.pi * (_WAVES - 1) / highest, max_order, highest)
    require_seen(problem, belts, highest)
    if belts.broken:
        name = "dead_belts" if belts.dead_belts else "dead_electrodes"
        told = f"leave {name} out for the margins of belts that are all alike; a run counts the poles with dead ones"
        raise InputError(f"control.{name}", "leaves no two belts alike, and margins are those of classes of belts", told)
    return AxialSampling(2 * (_WAVES - 1) * belts.pitch, max_order, highest)


def _asked(problem: Problem, sampling: AxialSampling) -> tuple[Sequence[Tied], FloatArray]:
    """Return the waves, or the classes of waves, whose loops are asked, and the axial wavenumber (the lowest of a class) of each."""
    if problem.belts is None:
        return [Tied(modes) for modes in sampling.modes], sampling.wavenumbers
    ties = ties_of_belts(problem, sampling)
    return ties, sampling.wavenumbers[: len(ties)]


def _of_wave(problem: Problem, tied: Tied, least: float, told: ShareDone) -> tuple[dict[int, tuple[LoopMargins, LoopResponse]], bool]:
    """Return the margins of each loop at one axial wavenumber with L of what stands the least delay, and whether the wave is stable.

    Of segments, whose poles are counted before, it is.
    """
    if segments_of(problem.system) is not None:
        cuts = segmented_loops(problem, tied, least, told)
        return {shell: (cut.margins, _worst_of_cut(problem, shell, cut)) for shell, cut in cuts.items()}, True
    whole, found = loops(problem, tied, least, told), {}
    for shell, loop in whole.each.items():
        margins = margins_of(tied.modes.orders, *loop)
        found[shell] = margins, _of_order(problem, shell, int(margins.delay.argmin()), loop)
    return found, whole.surely_stable


def _problem(system: System, settings: Settings) -> tuple[Problem, Modes]:
    if not isinstance(settings.modes, int):
        raise InputError("modes", f"{settings.modes!r} is not allowed here", "give the highest order")
    problem = dimensionless(system, settings.dimensions, settings)
    if all(wall.gains is None or wall.gains.zero for wall in problem.shells):
        raise InputError("control", "nothing is fed back", "give the system a PDControl or a Feedback")
    if settings.dimensions == 2 and segments_of(system) is not None:  # of other loops the margins themselves tell it
        require_stable_ties(problem, settings.modes, settings.duration)
    return problem, Modes.up_to(settings.modes)


def _least(settings: Settings) -> float:
    return 1.0 / settings.duration


def _of_order(problem: Problem, shell: int, order: int, loop: Loop) -> LoopResponse:
    name = shell_name(shell, len(problem.shells))
    return LoopResponse(name, order, loop.nodes.imag / (2.0 * np.pi * problem.scales.time), loop.values[order])
