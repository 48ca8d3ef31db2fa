"""What a claim is, and what is found about it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from coaxshell.apps.paper.known_runs import CORRECTED, NoFieldsError
from coaxshell.errors import InputError
from coaxshell.numerics.texts import typeset

if TYPE_CHECKING:
    from coaxshell.apps.paper.known_runs import Runs

Verdict = Literal["holds", "holds in part", "does not hold", "not judged"]


@dataclass(frozen=True)
class Finding:
    """What was measured, and what it says about a claim.

    Attributes
    ----------
    measured : mapping of str to float
        Numbers by what they are, units included in the name.
    verdict : str
        "holds", "holds in part", "does not hold", or "not judged" where a variant of the model does not touch the claim.
    why : str
        One sentence with the numbers.
    """

    measured: Mapping[str, float]
    verdict: Verdict
    why: str

    def __post_init__(self) -> None:
        """Print the sentence's numbers as a reader expects them."""
        object.__setattr__(self, "why", typeset(self.why))


@dataclass(frozen=True)
class Claim:
    """One checkable statement of the paper.

    Attributes
    ----------
    number : int
        Its place in the list, from 1.
    name : str
        Short name, unique.
    place : str
        Where the paper makes it.
    statement : str
        What it says, in our words.
    criterion : str
        What counts as holding, and as holding in part.
    work : callable
        From runs to a finding.
    """

    number: int
    name: str
    place: str
    statement: str
    criterion: str
    work: Callable[[Runs], Finding]


@dataclass(frozen=True)
class Judged:
    """A claim and what was found about it in each variant of the model."""

    claim: Claim
    findings: Mapping[str, Finding]

    @property
    def corrected(self) -> Finding:
        """The finding in the corrected model."""
        return self.findings[CORRECTED]

    @property
    def turned(self) -> tuple[str, ...]:
        """The variants in which the verdict is another one than in the corrected model."""
        return tuple(name for name, found in self.findings.items() if found.verdict not in ("not judged", self.corrected.verdict))


def judge(claim: Claim, variants: Mapping[str, Runs]) -> Judged:
    """Return what is found about a claim in each variant; one that a variant cannot tell is "not judged" in it.

    Raises
    ------
    ValueError
        A number of the corrected model is not finite.
    """
    findings: dict[str, Finding] = {}
    for name, runs in variants.items():
        try:
            found = claim.work(runs)
        except NoFieldsError:
            found = Finding({}, "not judged", "Fields under this slip are not computed.")
        except InputError:
            if name == CORRECTED:
                raise
            found = Finding({}, "not judged", "The slip is defined for two elastic shells in three fluids only.")
        bad = [what for what, value in found.measured.items() if not math.isfinite(value)]
        if bad and name == CORRECTED:
            raise ValueError(f"claim {claim.name}: {bad[0]} is not finite")
        findings[name] = found
    return Judged(claim, findings)


def graded(holds: bool, partly: bool = False) -> Verdict:
    """Return the verdict of two conditions, the second one weaker."""
    if holds:
        return "holds"
    return "holds in part" if partly else "does not hold"


Work = Callable[["Runs"], Finding]

REGISTERED: dict[str, tuple[str, str, str, Work]] = {}
"""Claims by name: place, statement, criterion, work."""


def claim(place: str, statement: str, criterion: str) -> Callable[[Work], Work]:
    """Register a function from runs to a finding as a claim; its name is the function's."""

    def register(work: Work) -> Work:
        REGISTERED[work.__name__.replace("_", "-")] = (place, statement, criterion, work)
        return work

    return register
