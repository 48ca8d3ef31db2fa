"""The paper's third limiting case (its Figs. 2d and 2e, after Iakovlev 2015): two steel shells, the inner one evacuated."""

from __future__ import annotations

from collections.abc import Iterator

from coaxshell.apps.verification.bench import Bench, tables
from coaxshell.apps.verification.paper_histories import SIDES, both_sides, extremum, least_stress
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Finding, Panel, Sheet
from coaxshell.model import presets

THICKNESS = 1e-2
SOURCE = "reference/README.md, four digits"


@check("paper-double", "Paper's Fig. 2d, 2e: double shell, inner one evacuated")
def paper_double(bench: Bench) -> Iterator[Finding]:
    """Compare the least stresses of both shells and their times with four-digit values, plane shock of 250 kPa.

    The figures themselves are not available as numbers; their histories are drawn here with ours.
    """
    stored = tables()["double-shock"]
    response = bench.simulate(presets.load("iakovlev-double"), duration=5.0, time_step=1e-3, modes=300)
    panels = []
    for shell in ("outer", "inner"):
        for side in SIDES:
            pair = stored[f"{shell}_{side}"]
            yield from least_stress(response, shell, side, f"{shell} {side}", SOURCE, pair, 3.5e-4)
    for shell in ("inner", "outer"):
        panels.append(
            Panel(f"{shell} shell: displacement", "time (a/c)", "w / h", both_sides(response, "displacement", shell, 1 / THICKNESS))
        )
        marks = [extremum("reference", stored[f"{shell}_{side}"], side) for side in SIDES]
        curves = [*both_sides(response, "stress", shell, 1e-6), *marks]
        panels.append(Panel(f"{shell} shell: hoop stress (Eq. 22)", "time (a/c)", "stress (MPa)", curves))
    yield Sheet(
        "Fig. 2d, 2e: double shell with a hollow inner shell, plane shock of 250 kPa",
        "Dots: reference minima of the stress.",
        panels,
    )
