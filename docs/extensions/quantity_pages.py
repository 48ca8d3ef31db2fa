"""What can be read of a shell, as one table."""

from __future__ import annotations

from coaxshell.response.quantities import QUANTITIES, Quantity

HEAD = """# Quantities of a shell

Each is read by its name: `response.history(shell, angle, "NAME")`, `response.plot("NAME")`, `coaxshell plot RUN --quantity NAME`; in
a study as `inner.peak_...`. All stand in one table of the program, from which this page is made;
[contributing](../contributing.md) shows how to add one.

| name | what it is | unit | positive | needs | metrics | summary | tables, files, comparisons |
|---|---|---|---|---|---|---|---|
"""
_NEEDS = {"": "–", "elastic": "an elastic wall", "sensor": "a sensor layer", "control": "sensor, actuator and control"}


def quantity_table() -> str:
    """Return the page: one row for each quantity."""
    return HEAD + "".join(_row(quantity) for quantity in QUANTITIES.values())


def _row(quantity: Quantity) -> str:
    metrics = ", ".join(f"`{quantity.metric(where)}`" for where in quantity.metrics)
    cells = (
        f"`{quantity.name}`",
        quantity.long_name,
        quantity.unit,
        quantity.sign.removeprefix("positive "),
        _NEEDS[quantity.needs],
        metrics or "–",
        ", ".join(quantity.summary) or "–",
        "yes" if quantity.column else "–",
    )
    return f"| {' | '.join(cells)} |\n"
