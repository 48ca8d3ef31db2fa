"""What a variable of a study changes of a metric, as a metric of its own: studies then run, send and keep it as they do any other."""

from __future__ import annotations

from dataclasses import dataclass
from weakref import WeakKeyDictionary

from coaxshell.errors import InputError
from coaxshell.studies.gradients.sensitivity import MetricSensitivity
from coaxshell.studies.metrics import Metric
from coaxshell.studies.reading import DesignReading, MetricSource

_NONE = Metric("", "", "")
_known: WeakKeyDictionary[DesignReading, dict[tuple[str, float | None], MetricSensitivity]] = WeakKeyDictionary()


@dataclass(frozen=True)
class SlopeMetric(Metric):
    """A metric as it is searched, with a mean of a power in the place of a peak, or what one variable changes of it.

    Attributes
    ----------
    of : Metric
    power : float or None
    fields : tuple of (str, float)
        Paths of the fields that take the variable's value, each with what it moves by per unit of it; empty for the value itself.
    """

    of: Metric = _NONE
    power: float | None = None
    fields: tuple[tuple[str, float], ...] = ()

    @property
    def of_design(self) -> bool:
        """Whether it is read without a run: it stands beside metrics of runs."""
        return False

    @property
    def identity(self) -> str:
        """What a hash should cover."""
        return f"{self.of.identity} ^ {self.power} by {self.fields}"

    def __call__(self, reading: DesignReading) -> float:
        """Return its value."""
        assert isinstance(reading, MetricSource)
        found = _known.setdefault(reading, {})
        key = self.of.identity, self.power
        if key not in found:
            found[key] = MetricSensitivity(reading.system, self.of, self.power, reading.response)
        if not self.fields:
            return found[key].value
        return sum(moved * found[key].of(path) for path, moved in self.fields)


def slope_metrics(metric: Metric, power: float, variables: list[tuple[tuple[str, float], ...]]) -> tuple[SlopeMetric, ...]:
    """Return a metric as it is searched, then what each variable changes of it.

    Parameters
    ----------
    metric : Metric
    power : float
    variables : list of tuple
        The fields of each variable, as those of :class:`SlopeMetric`.

    Raises
    ------
    InputError
        If the metric has no gradient.
    """
    from coaxshell.studies.gradients.readings import has_gradient

    if not has_gradient(metric):
        remedy = 'use method="cma-es", or RMS and peaks of stress, displacement or voltage, masses and distances'
        raise InputError("method", f'"gradient" needs metrics that have one, and {metric.name} has none', remedy)
    searched = SlopeMetric(f"{metric.name} as searched", metric.units, metric.long_name, of=metric, power=power)
    by = (
        SlopeMetric(
            f"d({metric.name}) by {fields[0][0] if fields else 'a count'}",
            metric.units,
            metric.long_name,
            of=metric,
            power=power,
            fields=fields,
        )
        for fields in variables
    )
    return (searched, *by)
