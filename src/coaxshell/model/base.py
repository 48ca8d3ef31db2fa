"""The common base of every description: frozen, strict about keys, and with errors of one line in the user's terms."""

from __future__ import annotations

import reprlib
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Self

from pydantic import BaseModel, ConfigDict, GetJsonSchemaHandler, ValidationError
from pydantic_core import CoreSchema, ErrorDetails

from coaxshell.errors import InputError
from coaxshell.model.explanations import explanations
from coaxshell.model.naming import suggestion
from coaxshell.model.paths import within, written


def shown(value: object) -> str:
    """Show a value as the user wrote it, cut to a length that fits on one line; what is large is never written out as a whole."""
    if isinstance(value, str | bytes):
        value = value[:80]
    elif isinstance(value, int) and not -(10**60) < value < 10**60:
        return "a number of more than 60 digits"
    text = " ".join((repr if isinstance(value, str | bytes | float) else reprlib.repr)(value).split())
    return text if len(text) <= 60 else text[:57] + "..."


WORDS = {
    "a valid tuple": "a list",
    "a valid integer": "a whole number",
    "a valid string": "text",
    "a valid boolean": "true or false",
    "a valid dictionary": "a table",
}
"""pydantic's words, and those of a user who knows neither Python nor pydantic."""

MOST_TOLD = 30
"""Further problems that an error carries: a form has few fields, a list of numbers may have thousands."""


class _Unstated:
    """What stands in a signature where an argument is required."""

    def __repr__(self) -> str:
        return "<required>"


UNSTATED: Any = _Unstated()
"""Default of an argument that is required, so that its absence is told like every other problem."""


def stated(arguments: Mapping[str, Any]) -> dict[str, Any]:
    """Return the arguments that were given."""
    return {name: value for name, value in arguments.items() if value is not UNSTATED}


if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass
else:
    ModelMetaclass = type(BaseModel)

_THEIRS = frozenset(dir(BaseModel))
"""What pydantic brings to every description: of no use to those who describe shells."""


class _Readable(ModelMetaclass):
    """Show in ``dir`` and ``help`` the methods of a description, and nothing of pydantic's.

    Type checkers that know nothing of pydantic take the entries as any keywords, texts with units among them: this class does not
    promise them the types that are kept.
    """

    def __dir__(self) -> list[str]:
        return ["__doc__", "__init__", *(name for name in super().__dir__() if name not in _THEIRS and not name.startswith("_"))]


class Described(BaseModel, metaclass=_Readable):
    """A part of a description: immutable, unknown keys refused, every problem told as one :class:`InputError`."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    _called: ClassVar[str] = ""
    """What errors call it, where its users do not know the name of the class."""

    def __init__(self, /, **data: Any) -> None:
        """Build it from its entries as keywords, numbers in SI or texts with a unit; InputError names the entry that is wrong."""
        try:
            super().__init__(**data)
        except ValidationError as error:
            raise _told(error, type(self)) from None

    @classmethod
    def model_validate(cls, obj: Any, **options: Any) -> Self:
        """Build from a mapping or an instance; InputError with the full path when something is wrong."""
        try:
            return super().model_validate(obj, **options)
        except ValidationError as error:
            raise _told(error, cls) from None

    @classmethod
    def __get_pydantic_json_schema__(cls, core_schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Return the schema with the explanation of each entry."""
        schema = handler(core_schema)
        entries = handler.resolve_ref_schema(schema).get("properties", {})
        for name, text in explanations(cls).items():
            if name in entries:
                entries[name].setdefault("description", text)
        return schema

    def __dir__(self) -> list[str]:
        return sorted({*type(self).model_fields, *(name for name in dir(type(self)) if not name.startswith("_"))})

    def __repr_args__(self) -> Iterable[tuple[str | None, Any]]:
        """Yield what was given, but for the kind, which the class tells, and the source of constants."""
        for name in type(self).model_fields:
            if name in self.model_fields_set and name not in ("type", "reference"):
                yield name, getattr(self, name)

    def replace(self, **changes: Any) -> Self:
        """Return a copy with the given fields changed, checked as a whole again; derived defaults follow the change."""
        kept = {name: getattr(self, name) for name in type(self).model_fields if name in self.model_fields_set}
        return type(self)(**{**kept, **changes})

    if not TYPE_CHECKING:  # hidden from mypy, which would otherwise accept any assignment

        def __setattr__(self, name: str, value: object) -> None:
            raise InputError(name, f"a {type(self).__name__} cannot be changed in place", f"use .replace({name}=...) to get a changed copy")


def _told(error: ValidationError, cls: type[BaseModel]) -> InputError:
    """Translate pydantic's report into the first problem, in the user's terms, with the others beside it."""
    # A default that depends on a bad field is a consequence, not a problem of its own.
    problems = [p for p in error.errors(include_url=False) if p["type"] != "default_factory_not_called"]
    # An entry that is misspelt is often missing too: the name is what is wrong.
    problems.sort(key=lambda p: p["type"] != "extra_forbidden")
    first, *others = [one for problem in problems for one in _each(_one(problem, cls))]
    return InputError(first.where, first.problem, first.remedy, tuple(others[:MOST_TOLD]))


def _each(error: InputError) -> list[InputError]:
    return [InputError(error.where, error.problem, error.remedy), *error.also]


def _one(first: ErrorDetails, cls: type[BaseModel]) -> InputError:
    """Translate one of pydantic's reports."""
    where = written(first["loc"])
    value = first["input"]
    name = getattr(cls, "_called", "") or cls.__name__
    context: Mapping[str, Any] = first.get("ctx") or {}
    cause = context.get("error")
    if isinstance(cause, InputError):
        return within(where, cause)
    match first["type"]:
        case "missing":
            return InputError(where, "is missing", f"{name} needs it")
        case "extra_forbidden":
            return InputError(where, f"is not an entry of {name}", suggestion(str(first["loc"][-1]), _entries(cls)))
        case "literal_error":
            return InputError(where, f"{shown(value)} is not allowed", f"must be {context['expected']}")
        case "value_error":
            return InputError(where, f"{shown(value)} is not allowed", str(cause))
        case "too_short":
            return InputError(where, f"{len(value)} given", f"must be at least {context['min_length']}")
        case _:
            text = first["msg"].removeprefix("Input should be ")
            for theirs, ours in WORDS.items():
                text = text.replace(theirs, ours)
            return InputError(where, f"{shown(value)} is not allowed", f"must be {text[:1].lower()}{text[1:]}")


def _entries(cls: type[BaseModel]) -> list[str]:
    return [field.alias or name for name, field in cls.model_fields.items()]
