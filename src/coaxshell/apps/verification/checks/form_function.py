"""Steady scattering: backscatter form functions of a rigid cylinder and an evacuated shell against the classical series."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.special import h1vp, hankel1, jv, jvp

from coaxshell.acoustics.operators import all_orders
from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.independent.walls import Wall
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Curve, Finding, Panel, Sheet, within
from coaxshell.apps.verification.systems import evacuated, thin_shell
from coaxshell.model.shells import RigidShell
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response import frequency_response

ORDERS = all_orders(60)
M = ORDERS[:, None]
SOURCE = "theory 10; classical series, SciPy's Hankel functions"


@check("form-function", "Steady backscatter: form functions")
def form_function(bench: Bench) -> Iterator[Finding]:
    """Compare the far field at s = i omega with the classical series in Hankel functions, |f| = 2/sqrt(pi ka) |sum eps_m (-1)^m b_m|.

    b_m = J_m'/H_m' for the rigid cylinder; for the shell with the wall's modal stiffness worked out by hand.
    """
    ka = np.linspace(0.1, 20.0, bench.choose(200, 800))
    rigid, shell = _ours(ka)
    classical = {"rigid cylinder": _series(ka, None), "evacuated steel shell, h/R = 0.01": _series(ka, Wall.of(thin_shell()))}
    panels = []
    for (name, expected), found in zip(classical.items(), (rigid, shell), strict=True):
        error = float((np.abs(found - expected) / np.maximum(expected, 0.1)).max())
        shown = f"{expected[-1]:.7g} at ka = 20", f"{found[-1]:.7g} at ka = 20"
        yield within(
            f"{name}, {ka.size} frequencies to ka = 20", SOURCE, shown[0], error, 2e-6, found=shown[1], measure="relative, largest"
        )
        every = slice(None, None, max(1, ka.size // 50))
        curves = [
            Curve("coaxshell", ka, found, colour="blue"),
            Curve("classical series", ka[every], expected[every], "points", colour="orange"),
        ]
        panels.append(Panel(name, "ka", "|f|, backscatter", curves))
    yield Sheet("Backscatter form functions", "Lines: coaxshell at s = i omega. Dots: the classical series.", panels)


def _ours(ka: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return |f| of the rigid cylinder and of the shell as the package gives them."""
    shell = evacuated()
    rigid = shell.replace(shells=[RigidShell(radius=1.0)])
    hertz = ka * shell.exterior.sound_speed / (2.0 * np.pi)
    found = [np.abs(frequency_response(system, hertz, "form_function").to_numpy()) for system in (rigid, shell)]
    return found[0], found[1]


def _series(ka: FloatArray, wall: Wall | None) -> FloatArray:
    """Return 2/sqrt(pi ka) |sum eps_m (-1)^m b_m|, b = (J' - q J)/(H' - q H), q = 0 on a rigid wall, k q = -(ka)^2/Z else."""
    q = np.zeros((ORDERS.size, ka.size))
    if wall is not None:
        bulk, length = 1000.0 * 1400.0**2, wall.radius
        inertia = -(ka**2) * wall.inertia / (1000.0 * length)
        for m in range(ORDERS.size):
            k = wall.stiffness(m) * length / bulk
            coupled = k[0, 1] ** 2 / (inertia + k[0, 0]) if m else 0.0
            q[m] = -ka / (inertia + k[1, 1] - coupled)
    with np.errstate(all="ignore"):
        b = (jvp(M, ka) - q * jv(M, ka)) / (h1vp(M, ka) - q * hankel1(M, ka))
    terms = np.where(M == 0, 1, 2) * (-1.0) ** M * np.where(np.isfinite(b), b, 0.0)
    result: FloatArray = 2 / np.sqrt(np.pi * ka) * np.abs(terms.sum(axis=0))
    return result
