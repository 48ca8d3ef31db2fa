"""What a run in three dimensions costs: every axial wavenumber is a run in two dimensions, of which the sums at the stations are kept."""

from __future__ import annotations

import math

from coaxshell.model.system import System
from coaxshell.numerics.cost import Cost
from coaxshell.solver.run_size import Size
from coaxshell.solver.settings import Settings

_FIELDS = 9
"""Transforms kept at each station: three displacements, four derivatives along the axis, potentials of two layers."""
_ELLIPSE = math.pi / 4.0
"""Share of the pairs of order and wavenumber below both bounds that are solved."""


def wavenumbers(system: System, settings: Settings, highest_order: int) -> int:
    """Return about how many axial wavenumbers are solved: 1 + L k_max/(2 pi), L the axial period; 1 where no source is a point.

    The period that causality asks depends on all waves of the system; three times duration and a little more stands for it here.
    """
    places = [float(getattr(source, "z", 0.0)) for source in system.sources if source.geometry == "spherical"]
    if not places:
        return 1
    radius = system.reference_radius
    furthest = max(abs(z - place) for z in settings.stations for place in places) / radius
    period = furthest + 3.0 * (settings.duration + 2.0) if settings.axial_period is None else settings.axial_period / radius
    return 1 + math.floor(period * (settings.axial_modes or highest_order) / (2.0 * math.pi))


def spatial_cost(system: System, settings: Settings, size: Size) -> Cost:
    """Return the cost of a run in three dimensions, given the *size* of the same run in two."""
    waves = wavenumbers(system, settings, size.orders - 1)
    kept = _FIELDS * len(settings.stations) * size.shells * size.source_parities
    memory = kept * (size.plane + size.history) + 6.0 * size.shells * size.plane
    each = (0.6e-6 + 0.1e-6 * size.source_parities) * size.shells * size.orders * size.nodes
    return Cost(memory, 0.1 + waves * (_ELLIPSE if waves > 1 else 1.0) * each)
