"""What the numbers rest on: warnings, estimated errors, and how to repeat the run."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from coaxshell.apps.report.parts import Code, Item, Listed, Section, Subject, Table
from coaxshell.response import Response
from coaxshell.solver.settings import Settings

_PRINTED = 110
"""Lines of a scenario that are printed; longer ones are left to the file that can be saved."""


def trust(subject: Subject) -> Section:
    """Return the section of warnings and estimated errors."""
    items: list[Item] = []
    for name, response in subject.labelled.items():
        texts = list(response.warnings)
        whose = f"Warnings of {name}" if name else "Warnings"
        items += [f"{whose}: none."] if not texts else [f"{whose}:", Listed(texts)]
    rows: list[tuple[str, ...]] = []
    for name, response in subject.labelled.items():
        found = response.errors()
        for shell in found["shell"].values:
            for quantity in found["quantity"].values:
                values = found.sel(shell=shell, quantity=quantity).to_numpy().tolist()
                if any(map(math.isfinite, values)):
                    rows.append((" ".join(filter(None, [name, str(shell)])), str(quantity), *map(_error, values)))
    causes = list(dict.fromkeys(str(cause) for response in subject.runs.values() for cause in response.errors()["cause"].values))
    same = all(len(row) == 2 + len(causes) for row in rows)
    if same:
        items.append(Table("Estimated relative errors (L2 over surface and time), by cause", ("shell", "quantity", *causes), rows, 2))
    return Section("Warnings and estimated errors", items)


def _error(value: float) -> str:
    return "unknown" if math.isnan(value) else f"{value:.1e}" if value else "0"


def repeating(subject: Subject, circumstances: str) -> Section:
    """Return the section on how to repeat: scenario, commands, versions."""
    items: list[Item] = [f"Computed with {circumstances}."]
    commands = []
    for number, (name, response) in enumerate(subject.runs.items()):
        file = f"scenario{'' if number == 0 else '-compared'}.toml"
        text = response.system.to_toml_string()
        lines = text.count("\n")
        told = f"{name}: the scenario, as {file}"
        shown = number == 0 and lines <= _PRINTED
        items += [f"{told}." if shown else f"{told} ({lines} lines: shown and saved from the page, not printed).", Code(text, file, shown)]
        commands.append(f"coaxshell run {file}{options_of(response)} --output run{number + 1}.nc")
    compare = " --compare run2.nc" if len(subject.runs) > 1 else ""
    commands.append(f"coaxshell report run1.nc{compare} --output report.html")
    return Section("How to repeat", [*items, "Commands:", Code("\n".join(commands))])


def options_of(response: Response) -> str:
    """Return the options of a command that give the resolution of a run, where it is not the usual one."""
    usual: Mapping[str, Any] = Settings().arguments()
    found = ""
    for name, value in response.settings.arguments().items():
        if value is not None and value != usual.get(name):
            text = ",".join(f"{each:g}" for each in value) if isinstance(value, list | tuple) else f"{value}"
            found += f" --{name.replace('_', '-')} {text}"
    return found
