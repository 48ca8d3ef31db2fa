"""The commands and their options, read from the command line's own parser."""

from __future__ import annotations

import re
from typing import Any

from typer.main import get_command

from coaxshell.apps.cli.app import application

HEAD = """# Command line

Written at every build from the commands themselves: the same text as `coaxshell COMMAND --help`.

Exit codes: 0 done; 2 bad input, with one line on stderr that says where, what is wrong and what is allowed; 130 interrupted; 1 anything
else. Progress and warnings go to stderr, results to stdout. `--debug`, anywhere on the line, shows where an error came from.
"""

# What is typed stands as it is typed: in running text two hyphens become a dash, and quotation marks are curled.
TYPED = re.compile(r"\w+ = \{[^}]*\}|[\w.\[\]]*=?\"[^\"]*\"|(?<![\w-])(?:coaxshell \w+ )?--[a-z][a-z-]*(?: auto\b)?")


def command_reference() -> str:
    """Return the page as Markdown."""
    group: Any = get_command(application())
    return "\n\n".join([HEAD, *(_section(name, command) for name, command in group.commands.items() if not command.hidden)]) + "\n"


def _section(name: str, command: Any) -> str:
    parts = [f"## coaxshell {name}", _plain(command.help or "")]
    arguments = [one for one in command.params if one.param_type_name == "argument"]
    options = [one for one in command.params if one.param_type_name == "option" and one.name != "help"]
    usage = " ".join(_argument(one) for one in arguments)
    parts.append(f"```text\ncoaxshell {name} {'[OPTIONS] ' if options else ''}{usage}".rstrip() + "\n```")
    rows = [f"| `{_argument(one)}` | {_cell(one)} |" for one in arguments]
    rows += [f"| `{_option(one)}` | {_cell(one)} |" for one in options]
    if rows:
        parts.append("\n".join(["| argument or option | meaning |", "|---|---|", *rows]))
    return "\n\n".join(parts)


def _argument(one: Any) -> str:
    name = one.metavar or one.name.upper()
    return name if one.required else f"[{name}]"


def _option(one: Any) -> str:
    names = ", ".join([*one.opts, *one.secondary_opts])
    value = "" if one.is_flag else f" {one.metavar or one.name.upper()}"
    return names + value.replace("|", "\\|")


def _cell(one: Any) -> str:
    text = _plain(one.help or "")
    default = one.default
    if default not in (None, False, ()) and not callable(default) and "[default" not in text and str(default) != "[]":
        text += f" Default: `{one.opts[0] if default is True else default}`."
    return text.replace("|", "\\|")


def _plain(text: str) -> str:
    text = " ".join(text.split()).replace("<", "&lt;").replace("*", "\\*")
    return TYPED.sub(lambda found: f"`{found[0]}`", text)
