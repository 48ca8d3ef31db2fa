"""What each slip does to the stress of the shells, measured where it matters."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from coaxshell.apps.paper import cases
from coaxshell.apps.paper.slips.growth import Growth, growth
from coaxshell.apps.paper.slips.solving import solve_each
from coaxshell.apps.paper.slips.switches import with_permittivity
from coaxshell.errors import InputError
from coaxshell.model import Absorber, System, absorber_ring, presets
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.progress import Progress
from coaxshell.numerics.texts import rounded
from coaxshell.solver.settings import Settings

if TYPE_CHECKING:
    from coaxshell.response import Response


OFF_AXIS = 30.0
"""Degrees between the head and the single absorber that stands for Figure 8."""


@dataclass(frozen=True)
class Stresses:
    """Largest hoop stress (Pa) of the inner and the outer shell at the head, at the tail and anywhere."""

    inner_head: float
    inner_tail: float
    inner: float
    outer_head: float
    outer_tail: float
    outer: float


@dataclass(frozen=True)
class Effect:
    """What some slips do to one configuration.

    Attributes
    ----------
    slips : tuple of str
        Keys of the slips that are on together.
    case : str
        Name of the configuration, a key of :data:`CASES`.
    corrected, slipped : Stresses or None
        Without and with the slips; ``slipped`` is None where the slips make the system grow without bound.
    inner_change : float or None
        Change of the inner shell's stress over its surface and all times, relative (L2).
    growth : Growth or None
        The fastest growth, where there is one.
    """

    slips: tuple[str, ...]
    case: str
    corrected: Stresses
    slipped: Stresses | None
    inner_change: float | None
    growth: Growth | None = None

    def change(self, name: str) -> float | None:
        """Return the relative change of one of :class:`Stresses`."""
        return None if self.slipped is None else float(getattr(self.slipped, name) / getattr(self.corrected, name) - 1.0)


def _single(angle: float) -> Callable[[], System]:
    return lambda: presets.load("bare").replace(absorbers=[Absorber(angle=angle, **cases.CUBIC)])


CASES: Mapping[str, Callable[[], System]] = MappingProxyType(
    {
        "bare": lambda: presets.load("bare"),
        "one absorber at the head": _single(0.0),
        "one absorber off the axis": _single(OFF_AXIS),
        "25 undamped absorbers": lambda: presets.load("bare").replace(absorbers=absorber_ring(cases.ADOPTED_COUNT, **cases.CUBIC)),
        "absorbers": lambda: presets.load("absorbers"),
        "active": lambda: presets.load("active"),
        "hybrid": lambda: presets.load("hybrid"),
        "active, standard permittivity": lambda: with_permittivity(presets.load("active"), "standard"),
    }
)
"""Configurations by name: the paper's presets, and systems of its figures."""

STUDIES: Sequence[tuple[tuple[str, ...], tuple[str, ...]]] = (
    (("radius-factor",), ("bare", "absorbers", "25 undamped absorbers", "active", "hybrid")),
    (("missing-projection",), ("one absorber at the head", "25 undamped absorbers", "absorbers", "hybrid")),
    (("radius-factor", "missing-projection"), ("25 undamped absorbers", "absorbers", "hybrid")),
    (("outside-sum",), ("25 undamped absorbers", "absorbers")),
    (("outside-sum-first",), ("25 undamped absorbers", "absorbers")),
    (("outside-sum", "missing-projection"), ("25 undamped absorbers", "absorbers")),
    (("cosine-only",), ("one absorber off the axis",)),
    (("control-sign",), ("active",)),
    (("permittivity",), ("active, standard permittivity",)),
    (("doubled-curvature",), ("active",)),
    (("printed-strain",), ("bare", "active")),
    (("incident-potential",), ("bare",)),
    (("incident-potential-impulse",), ("bare",)),
    (("diffraction-sign",), ("bare",)),
    (("incident-potential", "diffraction-sign"), ("bare",)),
    (("interior-derivative",), ("bare",)),
    (("interior-function",), ("bare",)),
    (("radiation-sign",), ("bare",)),
)
"""Which slips are measured on which configurations."""


def effects(
    resolution: Settings | None = None,
    studies: Sequence[tuple[tuple[str, ...], tuple[str, ...]]] = STUDIES,
    progress: Progress | None = None,
) -> Iterator[Effect]:
    """Yield the effect of slips on configurations, one by one.

    Parameters
    ----------
    resolution : Settings, optional
        The paper's unless given.
    studies : sequence of (keys, names)
        Slips that are on together and the configurations, of :data:`CASES`, on which they are.
    progress : callable, optional
        Called with the fraction done and the name of the slips in work.
    """
    resolution = resolution or Settings()
    wanted = {name: CASES[name]() for name in CASES if any(name in names for _, names in studies)}
    plain = {name: _measured(response) for name, response in solve_each(wanted, resolution)}
    for number, (keys, names) in enumerate(studies):
        if progress:
            progress((number + 1) / (len(studies) + 1), " + ".join(keys))
        yield from _effects(keys, {name: wanted[name] for name in names}, plain, resolution)
    if progress:
        progress(1.0, "slips")


def _effects(
    keys: tuple[str, ...], systems: dict[str, System], plain: dict[str, tuple[Stresses, FloatArray]], resolution: Settings
) -> Iterator[Effect]:
    try:
        for name, response in solve_each(systems, resolution, frozenset(keys)):
            corrected, history = plain[name]
            slipped, other = _measured(response)
            yield Effect(keys, name, corrected, slipped, relative_change(history, other))
    except InputError:
        modes = resolution.modes if isinstance(resolution.modes, int) else 150
        found = {name: growth(system, frozenset(keys), modes, 1.0 / resolution.duration) for name, system in systems.items()}
        if not all(found.values()):
            raise
        yield from (Effect(keys, name, plain[name][0], None, None, fastest) for name, fastest in found.items())


def _measured(response: Response) -> tuple[Stresses, FloatArray]:
    """Return the peaks of a run and the modal stress of its inner shell, (parities, M + 1, T)."""
    inner, *_, outer = response.summary().shells
    values = [peak.value for shell in (inner, outer) for peak in (shell.stress_head, shell.stress_tail, shell.stress)]
    return Stresses(*values), np.asarray(response.modal("inner", "stress"))


def relative_change(before: FloatArray, after: FloatArray) -> float:
    """Return the L2 norm over circle and time of the difference of two modal histories over that of the first (Parseval in theta)."""
    difference = np.zeros((2, *before.shape[1:]))
    difference[: after.shape[0]] += after
    difference[: before.shape[0]] -= before
    return float(np.sqrt(_square(difference) / _square(before)))


def _square(modal: FloatArray) -> float:
    return float(np.sum(modal[:, 0] ** 2) + 0.5 * np.sum(modal[:, 1:] ** 2))


def table(found: Sequence[Effect]) -> str:
    """Return the effects as a Markdown table, stresses in MPa, "corrected → with the slip"."""
    names = [field.name for field in fields(Stresses)]
    head = ["slips", "case", *(name.replace("_", " ") for name in names), "change of the inner stress (L2)"]
    rows = [head, ["---"] * len(head)]
    for effect in found:
        cells = [f"{getattr(effect.corrected, name) / 1e6:.3f} → {_shown(effect.slipped, name)}" for name in names]
        rows.append([" + ".join(effect.slips), effect.case, *cells, _outcome(effect)])
    return "\n".join("| " + " | ".join(row) + " |" for row in rows) + "\n"


def _shown(stresses: Stresses | None, name: str) -> str:
    return "∞" if stresses is None else f"{getattr(stresses, name) / 1e6:.3f}"


def _outcome(effect: Effect) -> str:
    if effect.growth is not None:
        return f"grows by e^({rounded(effect.growth.rate, 3)} t), order {effect.growth.order}"
    assert effect.inner_change is not None
    return rounded(effect.inner_change, 2)
