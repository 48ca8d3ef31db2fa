"""Oracles and printed errors over many random systems, and what came of them as a table."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from oracles import ORACLES, limit
from random_systems import Case, random_case
from true_errors import true_errors

import coaxshell as cx

RIGHT, WRONG = 1e-9, 1.0
"""True errors below are not worth printing; errors above, printed and true, say alike that the answer is of no use."""


class Ratio(NamedTuple):
    """A true error over the printed one, of one shell: at least ``ratio``, at most ``most``."""

    ratio: float
    most: float
    seed: int
    kind: str
    shell: int
    true: float
    printed: float
    absorbers: bool
    off_axis: bool
    marched: bool


GROUPS: dict[str, Any] = {
    "all": lambda one: True,
    "without absorbers": lambda one: not one.absorbers,
    "with absorbers": lambda one: one.absorbers,
    "sources off 0 degrees": lambda one: one.off_axis,
    "marched": lambda one: one.marched,
}


@dataclass
class Study:
    """What many systems came to.

    Attributes
    ----------
    mismatches : dict
        By oracle, a list of (mismatch over its limit, seed, kind).
    ratios : dict
        By cause and quantity, a list of :class:`Ratio`.
    refused : list of str
        Runs that ended in an InputError, and why.
    """

    mismatches: dict[str, list[tuple[float, int, str]]] = field(default_factory=dict)
    ratios: dict[tuple[str, str], list[Ratio]] = field(default_factory=dict)
    refused: list[str] = field(default_factory=list)

    def add(self, seed: int, oracles: Iterable[str] = ORACLES, *, refine: bool = True) -> None:
        """Run one system through some oracles, and its refinements."""
        case = random_case(seed)
        try:
            response = cx.simulate(case.system, **case.settings)
            for name in oracles:
                found = ORACLES[name](case, response)
                if found is not None:
                    allowed = limit(name, case, response)
                    over = found / allowed if allowed else float(found > 0)
                    self.mismatches.setdefault(name, []).append((over, seed, case.kind))
            if refine:
                for key, ratio in printed(case, response):
                    self.ratios.setdefault(key, []).append(ratio)
        except cx.InputError as error:
            self.refused.append(f"{seed} ({case.kind}): {error}")

    def broken(self) -> list[str]:
        """Return the oracles that some system did not meet, one line a system."""
        return [
            f"{name}: {over:.3g} times the limit, seed {seed} ({kind})"
            for name, all_ in self.mismatches.items()
            for over, seed, kind in all_
            if not over <= 1.0
        ]

    def __str__(self) -> str:
        """Return the table."""
        lines = ["oracle          systems  worst/limit   seed"]
        for name, found in self.mismatches.items():
            worst = max(found, key=lambda one: np.nan_to_num(one[0], nan=np.inf))
            lines.append(f"{name:15s} {len(found):7d} {worst[0]:12.2g} {worst[1]:6d}  {worst[2]}")
        for group, holds in GROUPS.items():
            title = "true/printed, " + group
            lines += ["", f"{title:37s} systems numbers  median   >1 %   >2 %  >10 %  <1/100 %      worst   seed"]
            for (cause, quantity), everything in self.ratios.items():
                members = [one for one in everything if holds(one)]
                if not members:
                    continue
                x = np.array([one.ratio for one in members])
                worst = members[int(x.argmax())]
                shares = "".join(f"{100 * np.mean(x > most):7.1f}" for most in (1, 2, 10))
                lines.append(
                    f"{cause + ' of ' + quantity:37s} {len({one.seed for one in members}):7d} {x.size:7d} {np.median(x):7.2g}{shares} "
                    f"{100 * np.mean([one.most < 0.01 for one in members]):9.1f} {worst.ratio:10.3g} {worst.seed:6d}  {worst.kind}"
                )
        return "\n".join([*lines, "", *(f"refused: {one}" for one in self.refused), *(f"BROKEN {one}" for one in self.broken())])


def printed(case: Case, response: cx.Response) -> Iterator[tuple[tuple[str, str], Ratio]]:
    """Yield true over printed errors by cause and quantity, of all shells; "step" is time step and march together."""
    true, errors = true_errors(case, response), response.errors()
    shown = {"orders": errors.sel(cause="orders"), "step": errors.sel(cause=["time step", "march"]).sum("cause", skipna=False)}
    absorbers = bool(case.system.absorber_list)
    off_axis = any(source.angle != 0.0 for source in case.system.sources)
    marched = bool(errors.sel(cause="march").max() > 0.0)
    for cause, values in shown.items():
        for quantity, name in enumerate(("displacement", "stress")):
            pairs = zip(*true[cause][..., quantity], values.sel(quantity=name).values, strict=True)
            for shell, (least, most, said) in enumerate(pairs):
                if np.isfinite(least) and least > RIGHT:
                    ratios = [1.0 if min(one, said) >= WRONG else float(one / max(said, 1e-300)) for one in (least, most)]
                    yield (
                        (cause, name),
                        Ratio(*ratios, case.seed, case.kind, shell, float(least), float(said), absorbers, off_axis, marched),
                    )
