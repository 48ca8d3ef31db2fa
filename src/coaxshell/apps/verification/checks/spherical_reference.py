"""The bare double shell under a true spherical wave against reference/spherical_bare.npz."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from coaxshell.apps.verification.bench import Bench, spherical_bare
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Curve, Finding, Panel, Sheet, distance, value, within
from coaxshell.apps.verification.systems import SMOOTH_SPHERE
from coaxshell.model import presets
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.response import Response

SOURCE = "reference/spherical_bare.npz"
STATIONS, ANGLES = (0.0, 0.7, 1.5), (0.0, 60.0, 180.0)
SHELLS = ("inner", "outer")
QUANTITIES = {"hoop": ("hoop stress", "Pa"), "axial": ("axial stress", "Pa"), "w": ("displacement", "m")}
TOLERANCE = 1e-5


@check("spherical-histories", "Reference histories under a true spherical wave")
def spherical_histories(bench: Bench) -> Iterator[Finding]:
    """Compare with a solution in the Laplace domain that shares no code with this one: M = 60, t = 0 to 4, three stations, three angles.

    The paper's bare double shell, a point source at 3 a with a smooth pulse; hoop and axial stress of the core and normal displacement.
    """
    stored, duration = spherical_bare(), bench.choose(2.0, 4.0)
    modes, step = bench.choose((50, 1e-2), (60, 4e-3))
    bare = presets.load("bare").replace(source=SMOOTH_SPHERE)
    response = bench.simulate(bare, duration=duration, time_step=step, modes=modes, dimensions=3, stations=STATIONS)
    until = stored["t"] <= duration + 1e-9
    at = np.round(stored["t"][until] / step).astype(int)
    for key, (name, unit) in QUANTITIES.items():
        for number, shell in enumerate(SHELLS):
            found, expected = history(response, key, shell)[at], np.moveaxis(stored[key][number], -1, 0)[until]
            errors = [distance(found[:, z, k], expected[:, z, k]) for z in range(len(STATIONS)) for k in range(len(ANGLES))]
            peaks = [value(float(x.flat[np.abs(x).argmax()]), unit) for x in (expected, found)]
            what = f"{name}, {shell} shell: worst history of nine (largest peak shown)"
            yield within(what, SOURCE, peaks[0], max(errors), TOLERANCE, found=peaks[1])
    yield _sheet(response, stored)


def history(response: Response, key: str, shell: str) -> FloatArray:
    """Return a quantity of the reference at all stations and angles, shape (T, stations, angles)."""
    if key == "w":
        return np.asarray(response.displacement(shell, ANGLES))
    return np.asarray(response.stress(shell, ANGLES, component=key))


def _sheet(response: Response, stored: dict[str, FloatArray]) -> Sheet:
    panels = []
    for number, shell in enumerate(SHELLS):
        ours, curves = history(response, "axial", shell) / 1e3, []
        for z, (station, colour) in enumerate(zip(STATIONS, ("blue", "orange", "green"), strict=True)):
            theirs = stored["axial"][number, z, 0] / 1e3
            curves.append(Curve(f"z = {station:g} m", response.time, ours[:, z, 0], colour=colour))
            curves.append(Curve("", stored["t"][::5], theirs[::5], "points", colour=colour))
        panels.append(Panel(f"{shell} shell", "time (a/c)", "axial stress (kPa)", curves))
    return Sheet("Axial stress at the head, along the axis", "Lines: coaxshell. Dots: stored histories of an independent solution.", panels)
