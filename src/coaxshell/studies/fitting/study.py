"""A fit as a study file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.naming import suggestion
from coaxshell.model.paths import within
from coaxshell.studies.fitting.fitting import ITERATIONS, FitPlan, plan_of
from coaxshell.studies.fitting.measurement import Measurement
from coaxshell.studies.study_file import Study, flat

_ENTRIES = frozenset({"from", "to"})


class FitStudy(Study):
    """Describe a fit; entries as the arguments of :func:`coaxshell.fit`."""

    _called: ClassVar[str] = "a fit"

    variables: list[str] | dict[str, Any]
    """What is looked for: dotted paths, or ranges by dotted path."""
    measured: list[dict[str, Any]]
    """Records: a file and what it holds, or times and values."""
    confidence: float = 0.95
    """Confidence of the intervals, a share of 1."""
    iterations: int = ITERATIONS
    """Steps at most, each time the records are weighted anew."""

    def plan(self, folder: Path) -> FitPlan:
        """Return it with all parts checked; InputError names what is wrong. Files are relative to *folder*."""
        system = self.system(folder)
        records = [_measurement(one, f"measured[{number}]", folder) for number, one in enumerate(self.measured)]
        variables = self.variables if isinstance(self.variables, list) else flat(self.variables, _ENTRIES)
        limits = (self.confidence, self.iterations)
        return plan_of(system, records, variables, self.settings(system), long_enough="duration" not in self.resolution, limits=limits)


def _measurement(entries: Mapping[str, Any], where: str, folder: Path) -> Measurement:
    given = dict(entries)
    file = given.pop("file", None)
    try:
        if file is None:
            if "time" not in given:
                known = ["file", *Measurement.model_fields]
                wrong = next((name for name in given if name not in known), None)
                if wrong is not None:
                    raise InputError(wrong, "is not an entry of a measurement", suggestion(wrong, known))
                raise InputError("file", "is missing", "give the file of the record, or its time and values")
            return Measurement.model_validate(given)
        if not isinstance(file, str):
            raise InputError("file", f"{shown(file)} is no file", 'give its name, as in file = "gauge1.csv"')
        return Measurement.from_file(folder / file, **given)
    except InputError as error:
        raise within(where, error) from None
