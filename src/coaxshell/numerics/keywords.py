"""Keywords that many functions share, declared once: a ``TypedDict`` tells type checkers, a dataclass their defaults."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from inspect import Parameter, signature
from typing import Any, TypeVar

F = TypeVar("F", bound=Callable[..., Any])


def showing(keywords: type, *holders: type) -> Callable[[F], F]:
    """Let ``help`` and the documentation show one by one what a function takes as ``**keywords: Unpack[...]``.

    Parameters
    ----------
    keywords : type
        The ``TypedDict`` that names them, with their types.
    *holders : type
        Dataclasses whose fields have their defaults; what is no field is None unless given.
    """
    defaults = {field.name: field.default for holder in holders for field in fields(holder)}
    shown = [
        Parameter(name, Parameter.KEYWORD_ONLY, default=defaults.get(name), annotation=getattr(kind, "__forward_arg__", kind))
        for name, kind in keywords.__annotations__.items()
    ]

    def told(function: F) -> F:
        whole, written = signature(function), [one for one in signature(function).parameters.values() if one.kind is not one.VAR_KEYWORD]
        shows: Any = function
        shows.__signature__ = whole.replace(parameters=written + shown)
        return function

    return told
