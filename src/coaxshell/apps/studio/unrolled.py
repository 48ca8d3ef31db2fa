"""The stress of a shell of a three-dimensional run on the wall laid flat, over the whole run: angle across, axial position up."""

from __future__ import annotations

import numpy as np

from coaxshell.apps.studio import worker
from coaxshell.apps.studio.arrays import Item, Packed, packed
from coaxshell.errors import InputError
from coaxshell.model import RigidShell, System
from coaxshell.model.places import shell_phrase
from coaxshell.numerics.arrays import FloatArray
from coaxshell.plotting.scales import round_up
from coaxshell.plotting.unrolled import alike_on_both_sides
from coaxshell.response.quantities import QUANTITIES
from coaxshell.response.spatial import SpatialResponse
from coaxshell.solver.settings import Settings

COMPONENTS = {"stress": "hoop", "axial_stress": "axial", "shear_stress": "shear", "von_mises_stress": "von_mises"}
"""Quantities that can be shown, and what :meth:`SpatialResponse.stress` calls them."""
ANGLES: FloatArray = np.arange(-180.0, 181.0, 3.0)
_SHARE = 0.999
"""Of all values, that which the colours reach."""


def require_flat(system: System, settings: Settings, shell: int) -> None:
    """Raise InputError for what has no stress over angle and axial position."""
    if settings.dimensions != 3:
        raise InputError("run", "is of two dimensions, alike along the axis", "choose three dimensions")
    if shell >= len(system.shells) or isinstance(system.shells[shell], RigidShell):
        raise InputError("shell", f"{shell} is no shell that can be stressed", f"give the number of one, below {len(system.shells)}")
    places = set(settings.stations) | ({-z for z in settings.stations} if alike_on_both_sides(system) else set())
    if len(places) < 2:
        raise InputError("stations", "there is one alone", "give several, such as 0, 0.25, 0.5, 0.75, 1")


def unrolled(system: System, settings: Settings, shell: int, quantity: str, frames: int) -> Packed:
    """Return a component of the stress of a shell, float32 (frames, positions, angles), at about so many instants of the run.

    Where sources are alike on both sides of z = 0, stations count for both; the shear stress changes its sign there.
    """
    with worker.part(0, 2, "solving"):
        response = worker.answer(system, settings)
    assert isinstance(response, SpatialResponse)
    worker.report(0.5, "wall laid flat")
    some = response.thin(max(1, -(-response.time.size // frames)))
    stress = np.asarray(some.stress(shell, ANGLES, component=COMPONENTS[quantity]), dtype=np.float32)
    z, values = _both_sides(some, stress, -1.0 if quantity == "shear_stress" else 1.0)
    known = QUANTITIES[quantity]
    header = {
        "shell": shell,
        "name": shell_phrase(shell, len(system.shells)),
        "quantity": quantity,
        "label": known.label,
        "signed": quantity != "von_mises_stress",
        "limit": round_up(float(np.quantile(np.abs(values), _SHARE)) or 1.0),
        "transit_time_seconds": system.transit_time,
    }
    places = {"time": Item(some.time, "transits"), "z": Item(z, "m"), "angle": Item(ANGLES, "deg")}
    return packed(header, {**places, "values": Item(values, known.unit)})


def _both_sides(response: SpatialResponse, values: np.ndarray, sign: float) -> tuple[FloatArray, np.ndarray]:
    """Return axial positions, ascending, and the values there."""
    z = response.stations
    if alike_on_both_sides(response.system):
        z, values = np.concatenate([z, -z]), np.concatenate([values, sign * values], axis=1)
    z, first = np.unique(z + 0.0, return_index=True)
    return z, values[:, first]
