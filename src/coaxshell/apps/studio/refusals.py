"""Requests that are refused: one exception, one shape of the answer."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from starlette.responses import JSONResponse

from coaxshell.errors import InputError


class RefusedError(Exception):
    """A request that is not carried out.

    Parameters
    ----------
    status : int
        HTTP status, 4xx or 503.
    code : str
        The kind of reason, one word for programs.
    where, problem, remedy : str
        As of an InputError.
    """

    def __init__(self, status: int, code: str, where: str, problem: str, remedy: str) -> None:
        super().__init__(f"{where}: {problem}; {remedy}")
        self.status, self.code, self.where, self.problem, self.remedy = status, code, where, problem, remedy

    @classmethod
    def of(cls, error: InputError, code: str = "input", status: int = 422) -> RefusedError:
        """Return the refusal of a description or setting that the library does not accept."""
        return cls(status, code, error.where, error.problem, error.remedy)

    @property
    def response(self) -> JSONResponse:
        """The answer."""
        headers = {"Retry-After": "1"} if self.status in (429, 503) else None
        told = {"code": self.code, "where": self.where, "problem": self.problem, "remedy": self.remedy}
        return JSONResponse({"error": told}, self.status, headers)


def told(error: InputError) -> dict[str, Any]:
    """Return the answer to a description with problems, which is part of the conversation: the first, and all of them."""
    problems = [{"where": one.where, "problem": one.problem, "remedy": one.remedy} for one in (error, *error.also)]
    return {"ok": False, "problem": problems[0], "problems": problems}


def internal(where: str) -> dict[str, Any]:
    """Return the answer to a request at which the server failed."""
    told = {"code": "internal", "where": where, "problem": "the server failed", "remedy": "its log in the terminal tells more"}
    return {"error": told}


@contextmanager
def readable(where: str) -> Iterator[None]:
    """Turn what numbers far out of the usual do to those who read them into an InputError."""
    try:
        yield
    except InputError:
        raise
    except (ArithmeticError, LookupError, MemoryError, RecursionError, TypeError, ValueError) as error:
        raise InputError(where, f"cannot be read ({type(error).__name__})", "give finite numbers of usual size") from None


def not_found(what: str) -> RefusedError:
    """Return the refusal of something that is not there."""
    return RefusedError(404, "not-found", what, "there is no such thing here", "see the list of routes in docs/studio-api.md")
