"""What can be read of a shell, as one table."""

from __future__ import annotations

from coaxshell.plotting.units import pretty
from coaxshell.response.quantities import QUANTITIES, Quantity

HEAD = """# Quantities of a shell

Each is read by its name: `response.history(shell, angle, "NAME")`, `response.plot("NAME")`, `coaxshell plot RUN --quantity NAME`; in
a study as `inner.peak_...`. All stand in one table of the program, from which this page is made;
[contributing](../contributing.md) shows how to add one.

| name | what it is | unit | positive | needs |
|---|---|---|---|---|
"""
READ = """
## Where else it is read

Further metrics, among them voltages over a segment of the wall and as the control law asks for them, are listed with the
[design studies](../studies.md#metrics).

| name | metrics | summary | tables, files, comparisons |
|---|---|---|---|
"""
_NEEDS = {
    "elastic": "an elastic wall",
    "sensor": "a sensor layer",
    "control": "sensor, actuator and control",
    "electrodes": "control by electrodes, two dimensions",
}


def quantity_table() -> str:
    """Return the page: what each quantity is, and where it is read."""
    rows = QUANTITIES.values()
    return HEAD + "".join(_row(_what(one)) for one in rows) + READ + "".join(_row(_where(one)) for one in rows)


def _row(cells: tuple[str, ...]) -> str:
    return f"| {' | '.join(cells)} |\n"


def _what(quantity: Quantity) -> tuple[str, ...]:
    sign = quantity.sign.removeprefix("positive ").replace("phi_s", r"$\varphi_s$").replace("of u ", "of $u$ ")
    needs = [*([_NEEDS[quantity.needs]] if quantity.needs else []), *(["three dimensions"] if quantity.dimensions == 3 else [])]
    return f"`{quantity.name}`", quantity.long_name, pretty(quantity.unit), sign, ", ".join(needs) or "–"


def _where(quantity: Quantity) -> tuple[str, ...]:
    metrics = ", ".join(f"`{quantity.metric(where)}`" for where in quantity.metrics)
    return f"`{quantity.name}`", metrics or "–", ", ".join(quantity.summary) or "–", "yes" if quantity.column else "–"
