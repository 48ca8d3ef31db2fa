"""Three dimensions wave by wave, against spectral elements in r and implicit Gauss integration in time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.independent import RadialElements
from coaxshell.apps.verification.modal import modal_histories
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Curve, Finding, Panel, Sheet, within
from coaxshell.apps.verification.systems import GAINS, SMOOTH_SPHERE
from coaxshell.model import presets
from coaxshell.model.fluids import VACUUM, Fluid
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes

SOURCE = "independent: spectral elements in r, Gauss in t"
MODES, DURATION, STEP = 6, 2.0, 2e-3
WAVENUMBERS = (0.0, 0.5, 3.0, 12.0)
TOLERANCE = 1e-6


class Pair(NamedTuple):
    """W, V, U of all shells and orders by the package and by the other method, each (3, shells, orders, T), and their times."""

    ours: FloatArray
    theirs: FloatArray
    time: FloatArray

    @property
    def distance(self) -> float:
        """The largest L2 distance of one displacement of one shell at one order, over all three displacements of it together."""
        size = np.sqrt((self.theirs**2).sum(axis=(0, -1)))
        return float((np.linalg.norm(self.ours - self.theirs, axis=-1) / size).max())


def configurations() -> dict[str, System]:
    """Return the systems that are compared."""
    bare = presets.load("bare").replace(source=SMOOTH_SPHERE)
    wall, outer = bare.shells
    fluids = [VACUUM, Fluid(density=900, sound_speed=1200), Fluid(density=1200, sound_speed=1700), bare.exterior]
    return {
        "bare": bare,
        "active control": bare.replace(control=GAINS),
        "three shells, four fluids, vacuum inside": bare.replace(
            shells=[wall.replace(radius=0.4), wall.replace(radius=0.7), outer], fluids=fluids
        ),
    }


def compared(system: System, wavenumber: float, modes: int, duration: float, step: float) -> Pair:
    """Return orders 0 to ``modes`` of a system at an axial wavenumber by both methods; the package at half the step."""
    steps = round(duration / step)
    other = RadialElements(system, modes, duration, wavenumber=wavenumber).solve(step, steps)
    ours = modal_histories(system, LaplaceGrid(step / 2, 2 * steps), Modes.up_to(modes, wavenumber))[..., ::2]
    theirs = np.array([other.w, other.v, other.u])
    both = min(ours.shape[-1], theirs.shape[-1])
    return Pair(ours[..., :both], theirs[..., :both], other.time[:both])


@check("axial-wavenumbers", "Three dimensions, wave by wave")
def axial_wavenumbers(bench: Bench) -> Iterator[Finding]:
    """Compare W, V and U of all shells, orders 0 to 6, at axial wavenumbers k from 0 to 12/a, under a true spherical wave at 3 a.

    The other method is coaxshell.apps.verification.independent: k^2 added to the radial wave equation, walls integrated through the
    thickness, the wave projected by quadrature; no Laplace transform, no Bessel function.
    """
    systems = configurations()
    modes, duration = bench.choose((3, 1.5), (MODES, DURATION))
    cases = [("bare", k) for k in bench.choose((0.5, 3.0), WAVENUMBERS)]
    cases += [(name, k) for name in systems if name != "bare" and not bench.quick for k in WAVENUMBERS[-2:]]
    curves = []
    for done, (name, k) in enumerate(cases, start=1):
        pair = compared(systems[name], k, modes, duration, STEP)
        what = f"{name}, ka = {k:g}: worst of W, V, U of all shells and orders"
        yield within(what, SOURCE, "the other method's", pair.distance, TOLERANCE)
        if (name, k) == ("bare", 3.0):
            curves = _curves(pair)
        bench.done(done / len(cases))
    yield Sheet(
        "Order 1 at ka = 3 by two methods",
        "Bare double shell under a true spherical wave at 3 a, a smooth pulse; amplitudes of the outer shell.",
        [Panel("outer shell", "time (a/c)", "amplitude / a² (1e-9)", curves)],
    )


def _curves(pair: Pair) -> list[Curve]:
    curves = []
    for which, (name, colour) in enumerate({"W, inward": "blue", "V, along the hoop": "orange", "U, along the axis": "green"}.items()):
        ours, theirs = (1e9 * x[which, -1, 1] for x in (pair.ours, pair.theirs))
        curves.append(Curve(f"{name}, coaxshell", pair.time, ours, colour=colour))
        curves.append(Curve(f"{name}, other method", pair.time[::25], theirs[::25], "points", colour=colour))
    return curves
