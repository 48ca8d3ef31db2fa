"""From the arguments of the process to its exit code: every failure becomes one line on stderr.

Exit codes: 0 done, 2 bad input, 130 interrupted, 143 terminated, 141 nobody reads what is printed (as with ``| head``), 1 anything else.
The argument parser's own complaints are rewritten as one line that names the option, the value and what is allowed. Ctrl-C and a request
to terminate end a command alike; one that leaves something behind says what.
"""

from __future__ import annotations

import errno
import os
import signal
import sys
import threading
import traceback
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from coaxshell.apps.cli.output import give_up_stdout, plain_physics_warnings, prepare_streams, printable
from coaxshell.apps.cli.progress import Interrupted
from coaxshell.errors import InputError

DONE, FAILED, BAD_INPUT, INTERRUPTED, NOBODY_READS, TERMINATED = 0, 1, 2, 130, 141, 143


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code.

    Parameters
    ----------
    argv : sequence of str, optional
        The arguments without the program's name; those of the process when left out.
    """
    prepare_streams()
    arguments = list(sys.argv[1:] if argv is None else argv)
    debug = "--debug" in arguments
    arguments = [argument for argument in arguments if argument != "--debug"]
    with termination() as told:
        code = _run(arguments, debug)
    return TERMINATED if told.asked and code == INTERRUPTED else code


def _run(arguments: list[str], debug: bool) -> int:
    try:
        with plain_physics_warnings():
            code = _invoke(arguments)
        sys.stdout.flush()
    except KeyboardInterrupt:
        code = INTERRUPTED
    except BrokenPipeError:
        give_up_stdout()
        return NOBODY_READS
    except BaseException as error:  # noqa: BLE001  (the last stop before the user's terminal)
        return _explain(error, debug)
    if code == INTERRUPTED:
        _complain("interrupted; nothing was left behind")
    return code


def _invoke(arguments: list[str]) -> int:
    from typer.main import get_command

    from coaxshell.apps.cli.app import application

    outcome: Any = get_command(application(arguments)).main(args=arguments, prog_name="coaxshell", standalone_mode=False)
    return outcome if isinstance(outcome, int) else DONE


def _explain(error: BaseException, debug: bool) -> int:
    if debug:
        traceback.print_exception(error)
    if isinstance(error, SystemExit) and isinstance(error.__context__, BrokenPipeError):  # the argument parser's way
        give_up_stdout()
        return NOBODY_READS
    if isinstance(error, SystemExit):
        return error.code if isinstance(error.code, int) else FAILED
    if isinstance(error, Interrupted):
        _complain(str(error))
        return INTERRUPTED
    if isinstance(error, InputError):
        _complain(str(error))
        return BAD_INPUT
    if is_usage_error(error):
        _complain(usage_text(error))
        return BAD_INPUT
    if type(error).__name__ == "Abort":
        _complain("interrupted; nothing was left behind")
        return INTERRUPTED
    if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EBADF, errno.EIO) and error.filename is None:
        give_up_stdout()  # every writer of files has its own words: this was the text
        _complain(f"cannot print: {os.strerror(error.errno).lower()}")
        return FAILED
    hint = "" if debug else " (run again with --debug to see where)"
    _complain(f"unexpected {type(error).__name__}: {error}{hint}")
    return FAILED


def _complain(text: str) -> None:
    sys.stderr.write("error: " + printable(" ".join(text.split())) + "\n")


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


class Termination:
    """Whether the process has been asked to terminate (SIGTERM)."""

    asked = False

    def end(self, *_: object) -> None:
        """Take the signal as Ctrl-C."""
        self.asked = True
        raise KeyboardInterrupt


@contextmanager
def termination() -> Iterator[Termination]:
    """Turn SIGTERM into Ctrl-C while this lasts, so that temporaries go; elsewhere than in the main thread nothing is done."""
    told = Termination()
    if threading.current_thread() is not threading.main_thread() or signal.getsignal(signal.SIGTERM) is not signal.SIG_DFL:
        yield told
        return
    signal.signal(signal.SIGTERM, told.end)
    try:
        yield told
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
