"""The paper's statements one by one, in every model in which they are judged."""

from __future__ import annotations

import warnings
from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from coaxshell.apps.paper import real_electrodes
from coaxshell.apps.paper.reproduction import reproduce
from coaxshell.apps.paper.reproduction.plan import VARIANTS
from coaxshell.apps.paper.sphere.compared import SPHERE
from coaxshell.apps.paper.sphere.kept import known_claims
from coaxshell.apps.paper.thickness.compared import EXACT
from coaxshell.apps.paper.thickness.judged import judged_with_both
from coaxshell.apps.paper.thickness.kept import known_of_absorbers
from coaxshell.apps.verification.markdown import table
from coaxshell.errors import PhysicsWarning
from coaxshell.numerics.files import write_text
from coaxshell.solver.settings import Settings

CONTROL = Settings(modes=100, time_step=4e-3)
"""The resolution of statements on control with what actuators can do."""
ACTUATIONS = {"whole actuation": "whole actuation", "electrodes": "electrodes"}
COLUMNS = (*VARIANTS, "sphere", "exact walls", *ACTUATIONS)
SHORT = {"holds": "holds", "holds in part": "in part", "does not hold": "no", "not judged": "–"}
HEAD = """# The statements, one by one

The paper's {count} statements in our words (`coaxshell.apps.paper.claims`), and what was found of each; what follows from all this is
told under [the paper, computed again](reproduction.md).

## How they are judged

Each statement has its place, a criterion and a function from runs to measured numbers, a verdict and one sentence why. The verdicts are
*holds*, *holds in part* ("in part") and *does not hold* ("no"). The report of `coaxshell reproduce` has the criteria and all numbers,
and what was found where a slip turns a verdict. Criteria were set before the results at the paper's resolution were seen, with two
corrections of what is measured: the rigid link that stiff absorbers are compared with carries their mass of 10 kg, and the heavy mass
is looked at up to t = 1, as the text speaks of short times. Three details of the means were settled after a coarse trial (M = 24, step
0.01): the inner shell that vanishes has 1 % of the radius and is of steel, the direct engine's time is sampled at N = 10, 25 and 50
without 300, and the fields behind the statements are laid out every 0.01 transits. Common to several:

| in the text | measured as |
|---|---|
| practically no effect, nearly identical | at most 1 % relative L2 change of the stress at the inner head and tail (5 %: in part) |
| onset, arrival | the stress passes 1 % of its peak |
| rapid oscillations | what is left above 4 cycles in a transit |
| close to a rigid link | distance of the stress from that with a link of 1e13 N/m, over all that this link does to the bare system |
| a front comparable to the incident wave (Mach stem) | largest interior pressure at least half the incident peak, and at least half \
of the wall's on its gap side |

Statements that need what a model does not have (fields, or other than two shells in three fluids) are "not judged" in it, marked –. Under
the radius factor energy is not conserved, so that what is said about energy there only tells what its fields would add up to.

| column | model | told under |
|---|---|---|
| corrected | the paper's, without the slips of its printed equations: M = 150, time step 0.001 | [here](#found-in-the-corrected-model) |
| radius factor, no projection, both slips | with printed slips turned on | [slips](slips.md) |
| sphere | under the spherical front itself, in three dimensions, read at z = 0 | [slice or sphere](generated/slice-or-sphere.md) |
| exact walls | layers as elastic solids, wetted at their faces | [thin or exact](generated/thin-or-exact.md) |
| whole actuation | the paper's law with all that its actuators exert, the traction and the moment too | [its actuators][control] |
| electrodes | pairs of electrodes, which sense and drive the same layers | [the same][control] |

[control]: howto/control-limits.md#what-the-paper-says-of-control

The last four are compared with the paper's model at a resolution of their own, where that has the verdicts of the first column.
`python docs/pictures statements.md` makes this page anew, a quarter of an hour of a processor.

## Verdicts

"""
FOUND = """
## Found in the corrected model

"""


class Row(NamedTuple):
    """A statement: its number and text, its verdicts by column, and what was found in the corrected model."""

    number: int
    statement: str
    verdicts: Mapping[str, str]
    found: str


def page(rows: Iterable[Row]) -> str:
    """Return the page in Markdown."""
    rows = tuple(rows)
    counted = {name: Counter(row.verdicts.get(name, "not judged") for row in rows) for name in COLUMNS}
    tally = table(("", *COLUMNS), [(word, *(str(counted[name][verdict]) for name in COLUMNS)) for verdict, word in SHORT.items()])
    verdicts = [(str(row.number), row.statement, *(SHORT[row.verdicts.get(name, "not judged")] for name in COLUMNS)) for row in rows]
    found = [(str(row.number), row.statement, row.found) for row in rows]
    parts = (
        HEAD.format(count=len(rows)),
        tally + "\n\n",
        table(("no.", "statement", *COLUMNS), verdicts) + "\n",
        FOUND + table(("no.", "statement", "found"), found) + "\n",
    )
    return "".join(parts)


def beyond() -> dict[str, dict[int, str]]:
    """Return the verdicts beyond the paper's model by column and number of the statement."""
    walls = (*judged_with_both(), *known_of_absorbers())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PhysicsWarning)
        control = {name: {one.number: one.verdict for one in real_electrodes.judged(of, CONTROL)} for name, of in ACTUATIONS.items()}
    return {
        "sphere": {one.claim.number: one.findings[SPHERE].verdict for one in known_claims().claims},
        "exact walls": {one.claim.number: one.findings[EXACT].verdict for one in walls},
        **control,
    }


def write(target: Path) -> None:
    """Judge the statements in all models and write their page."""
    with TemporaryDirectory() as folder:
        judged = reproduce(Path(folder), Settings(), only=frozenset({"claims"})).judged
    more = beyond()
    rows = []
    for one in judged:
        verdicts = {name: one.findings[name].verdict for name in VARIANTS}
        verdicts |= {name: found[one.claim.number] for name, found in more.items() if one.claim.number in found}
        rows.append(Row(one.claim.number, one.claim.statement, verdicts, one.corrected.why))
    write_text(target, page(rows))
