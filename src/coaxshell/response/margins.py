"""Stability margins of a system's feedback: how much more gain, phase or delay the loop of each shell stands, by order."""

from __future__ import annotations

from typing import NamedTuple, Unpack

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.loading import SystemLike, as_system
from coaxshell.model.places import shell_name
from coaxshell.model.system import System
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.modes import Modes
from coaxshell.solver.dimensions import require_whole_electrodes
from coaxshell.solver.margins import Loop, LoopMargins, loops, margins_of
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.settings import Settings, SettingsKeywords
from coaxshell.solver.stability import require_stable

_DEGREES, _HERTZ, _SECONDS, _FACTOR = "deg", "Hz", "s", "1"
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
    """L of an order of a shell's loop at frequencies (Hz): 1 - L = 0 is where it would grow."""

    shell: str
    order: int
    frequency: FloatArray
    values: ComplexArray


def stability_margins(system: SystemLike, **keywords: Unpack[SettingsKeywords]) -> xr.Dataset:
    """Return gain, phase and delay margins of the feedback of each shell, the loops of the others closed, by order.

    The loop of one shell is 1 - L = D/D', the determinant of all with its feedback over that without. It is read on Re s = 1/duration,
    the least growth that counts: the gain margin is 1/L where L is real and positive, the phase margin its angle where its magnitude
    is 1, the delay margin that angle over omega there, beyond the delay that the law has.

    Parameters
    ----------
    system : System, str or Path
        A description, the name of a preset or the path of a scenario file, with control.
    **keywords
        As to :func:`simulate`: ``duration`` and ``modes`` count.

    Returns
    -------
    Dataset, dims (shell, order)
        Infinite margins where no change of that kind makes an order grow, of the gain by about ten times or less.

    Raises
    ------
    InputError
        If nothing is fed back, the system is unstable, or in three dimensions.
    """
    found = as_system(system)
    settings = Settings.asked(found, keywords)
    return worst_loops(found, settings)[0]


def worst_loops(system: System, settings: Settings) -> tuple[xr.Dataset, list[LoopResponse]]:
    """Return the margins of a system, and L of the order of each loop that stands the least delay."""
    problem, modes = _problem(system, settings)
    all_loops = loops(problem, modes, _least(settings))
    margins = {shell: margins_of(modes.orders, *loop) for shell, loop in all_loops.items()}
    worst = [_of_order(problem, shell, int(margins[shell].delay.argmin()), loop) for shell, loop in all_loops.items()]
    return labelled(problem, modes, margins), worst


def labelled(problem: Problem, modes: Modes, margins: dict[int, LoopMargins]) -> xr.Dataset:
    """Return margins in SI with names and units."""
    count, hertz = len(problem.shells), 1.0 / (2.0 * np.pi * problem.scales.time)
    units = {_DEGREES: 180.0 / np.pi, _SECONDS: problem.scales.time, _HERTZ: hertz, _FACTOR: 1.0}
    names = {name: name.removeprefix("lesser_").replace("_margin", "") for name in _VARIABLES}
    names["lesser_gain_margin"] = "lesser_gain"
    variables = {
        name: xr.Variable(
            ("shell", "order"),
            units[unit] * np.stack([getattr(one, names[name]) for one in margins.values()]),
            {"units": unit, "long_name": told},
        )
        for name, (unit, told) in _VARIABLES.items()
    }
    coordinates = {
        "shell": xr.Variable("shell", [shell_name(i, count) for i in margins]),
        "order": xr.Variable("order", modes.orders.astype(int), {"long_name": "circumferential order m"}),
    }
    return xr.Dataset(variables, coordinates)


def _problem(system: System, settings: Settings) -> tuple[Problem, Modes]:
    if settings.dimensions == 3:
        raise InputError("dimensions", "margins are those of motion that is alike along the axis", "use dimensions=2")
    require_whole_electrodes(system, "the list of margins by order", "leave segments out")
    if not isinstance(settings.modes, int):
        raise InputError("modes", f"{settings.modes!r} is not allowed here", "give the highest order")
    problem = dimensionless(system, settings=settings)
    if all(wall.gains is None or wall.gains.zero for wall in problem.shells):
        raise InputError("control", "nothing is fed back", "give the system a PDControl or a Feedback")
    require_stable(problem, settings.modes, settings.duration)
    return problem, Modes.up_to(settings.modes)


def _least(settings: Settings) -> float:
    return 1.0 / settings.duration


def _of_order(problem: Problem, shell: int, order: int, loop: Loop) -> LoopResponse:
    name = shell_name(shell, len(problem.shells))
    return LoopResponse(name, order, loop.nodes.imag / (2.0 * np.pi * problem.scales.time), loop.values[order])
