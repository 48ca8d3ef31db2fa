"""The argument parser's own complaints, rewritten as one line that names the option, the value and what is allowed."""

from __future__ import annotations

from typing import Any


def is_usage_error(error: BaseException) -> bool:
    """Tell whether an exception is the argument parser's complaint about what the user typed."""
    return hasattr(error, "format_message") and getattr(error, "exit_code", None) is not None


def usage_text(error: Any) -> str:
    """Return the complaint on one line, with what is allowed where the parser leaves it out."""
    message = " ".join(str(error.format_message()).split()).rstrip(".")
    context = getattr(error, "ctx", None)
    if context is None:
        return message
    kind = type(error).__name__
    if "No such command" in message:
        return f"{message}; allowed: {', '.join(_commands(context))}"
    if kind == "NoSuchOption":
        return f"no such option: {error.option_name}; allowed: {', '.join(_options(context))}"
    if kind == "MissingParameter":
        return f"{message}; usage: {_usage(context)}"
    if "unexpected extra argument" in message:
        return f"{message}; usage: {_usage(context)}"
    return message


def _commands(context: Any) -> list[str]:
    return list(context.command.list_commands(context))


def _options(context: Any) -> list[str]:
    return [name for parameter in context.command.get_params(context) for name in parameter.opts if name.startswith("--")]


def _usage(context: Any) -> str:
    return " ".join(str(context.get_usage()).removeprefix("Usage: ").replace("{", "").replace("}", "").split())
