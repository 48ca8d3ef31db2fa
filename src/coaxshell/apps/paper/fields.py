"""What is kept of the pressure field of a run, and of its energy."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.progress import Progress

if TYPE_CHECKING:
    from coaxshell.response import Response

Fields = Mapping[str, FloatArray]

SNAPSHOTS = (1.0, 2.0, 3.0, 3.1, 4.0)
"""Instants of the whole field, transits; those that the paper's text discusses."""

OUTERMOST = 3.0
"""Radius to which the exterior is looked at, as in Figures 4 and 13."""

RESOLUTION = 0.01
"""Time resolution of the pressures, transits: a hundredth of the outer radius in space, less than the grids' spacing."""

_FACE = 1e-9
_RADII = {"interior": 25, "gap": 25, "exterior": 80}


def fields_of(response: Response, progress: Progress | None = None) -> dict[str, FloatArray]:
    """Return what is kept of the fields of a response with two shells and a shock; pressures are relative to the incident peak.

    - ``angle``: degrees from the head, 0 to 180 in steps of 2; ``snapshot time``; ``<region> radius``; ``<region> snapshot``
      (time, radius, angle), orders weighted by Lanczos's factors;
    - ``gap peak`` (radius): the largest magnitude on the head's ray in the gap up to t = 1;
    - ``wall time``; ``inner wall``, ``outer wall`` (time, face, angle): inside and outside of each shell, where its fluids wet it;
    - ``rms time``, ``<region> rms`` over its area; ``energy time``, and J/m: ``stored``, ``dissipated`` (dampers), ``actuators``,
      ``radiated``, ``worked`` (by the exterior pressure), ``residual``.

    Of a run in three dimensions it is the field across the axis at z = 0, at the finest time resolution that its orders bear, without the
    exterior, without means over areas and without energies.

    Parameters
    ----------
    response : Response
    progress : callable, optional
        Called with the fraction done and "fields".
    """

    def tell(fraction: float) -> None:
        if progress:
            progress(fraction, "fields")

    head, peak = float(response.system.sources[0].angle), float(getattr(response.system.sources[0], "peak_pressure"))  # noqa: B009
    last, spatial = float(response.time[-1]), response.stations is not None
    angle = np.arange(0.0, 181.0, 2.0)
    kept: dict[str, FloatArray] = {"angle": angle}
    finest: dict[str, Any] = {} if spatial else {"time_resolution": RESOLUTION}

    def polar(radius: FloatArray, time: FloatArray) -> FloatArray:
        found = response.pressure(radius=radius, angle=head + angle, time=time, filter="lanczos", **finest)
        return np.asarray(found, dtype=np.float64) / peak

    kept["snapshot time"] = np.array([t for t in SNAPSHOTS if t <= last])
    inner, outer = ([r / response.system.reference_radius for r in shell.wetted_radii] for shell in response.system.shells)
    regions = {"interior": (0.0, inner[0]), "gap": (inner[1], outer[0]), "exterior": (outer[1], OUTERMOST)}
    for region, (start, stop) in list(regions.items())[: 2 if spatial else 3]:
        kept[f"{region} radius"] = start + (stop - start) * (np.arange(_RADII[region]) + 0.5) / _RADII[region]
        kept[f"{region} snapshot"] = polar(kept[f"{region} radius"], kept["snapshot time"])
    tell(0.3)
    kept["wall time"] = np.arange(0.5, last + 1e-9, 0.05)
    for shell, faces in (("inner", inner), ("outer", outer)):
        kept[f"{shell} wall"] = polar(np.array([faces[0] - _FACE, faces[1] + _FACE]), kept["wall time"])
    ray = response.pressure(radius=kept["gap radius"], angle=[head], time=np.arange(0.0, min(1.0, last), RESOLUTION))
    kept["gap peak"] = np.abs(np.asarray(ray, dtype=np.float64)).max(axis=(0, 2)) / peak
    tell(0.5)
    if spatial:
        return kept
    kept["rms time"] = np.linspace(0.0, last, round(last / 0.05) + 1)
    for region in ("interior", "gap", "exterior"):
        outermost = OUTERMOST if region == "exterior" else None
        kept[f"{region} rms"] = (
            np.asarray(response.pressure_rms(region, outermost, time=kept["rms time"], time_resolution=RESOLUTION), dtype=np.float64) / peak
        )
    tell(0.7)
    return kept | _energy(response)


def _energy(response: Response) -> dict[str, FloatArray]:
    balance = response.energy(every=max(1, round(0.25 / float(response.time[1] - response.time[0]))))

    def total(role: str) -> FloatArray:
        zero = np.zeros(balance.sizes["time"])
        return np.asarray(sum((np.asarray(v, dtype=np.float64) for v in balance.data_vars.values() if v.attrs.get("role") == role), zero))

    def one(name: str) -> FloatArray:
        return np.asarray(balance[name], dtype=np.float64) if name in balance else np.zeros(balance.sizes["time"])

    return {
        "energy time": np.asarray(balance["time"], dtype=np.float64),
        "stored": total("store"),
        "dissipated": one("damper_dissipation"),
        "actuators": one("actuator_work"),
        "radiated": one("radiated_energy"),
        "worked": one("exterior_work"),
        "residual": one("closure_residual"),
    }
