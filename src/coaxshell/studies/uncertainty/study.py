"""A study of uncertain properties as a study file."""

from __future__ import annotations

from pathlib import Path
from typing import Any, ClassVar

from coaxshell.studies.metrics import metrics_of
from coaxshell.studies.study_file import MetricTexts, Study, Tell, flat
from coaxshell.studies.uncertainty.laws import LAWS
from coaxshell.studies.uncertainty.plan import Plan, plan_of
from coaxshell.studies.user_functions import UserCode


class SensitivityStudy(Study):
    """Describe a study of uncertain properties."""

    _called: ClassVar[str] = "a study of uncertain properties"

    uncertain: dict[str, Any]
    """Distributions by dotted path."""
    metrics: MetricTexts
    """What to read: names, or a table of names of your own."""
    indices: bool = True
    """Whether Sobol indices are wanted, or the statistics alone, which take fewer runs."""
    samples: int = 256
    """Base points, a power of two: samples * (properties + 2) runs with indices, as many runs as samples without."""
    seed: int = 0
    """Makes points and intervals repeatable."""
    confidence: float = 0.95
    """Confidence of the intervals, a share of 1."""

    def plan(self, folder: Path, *, allow_code: bool = False, tell: Tell | None = None) -> Plan:
        """Return it with all parts checked; InputError names what is wrong. Arguments as of :meth:`Study.twice`."""
        system = self.system(folder)
        resolution = self.settings(system)
        sampling = (self.samples, self.seed, self.confidence)

        def make(code: UserCode) -> Plan:
            metrics = metrics_of(self.metrics, system, code)
            return plan_of(system, flat(self.uncertain, LAWS), metrics, resolution, sampling, indices=self.indices)

        return self.twice(make, folder, lambda plan: plan.metrics, allow_code=allow_code, tell=tell)
