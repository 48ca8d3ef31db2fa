"""Stations of a three-dimensional run against the waves of the independent solver, added up: displacements, stresses, signs and weights."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.independent import RadialElements
from coaxshell.apps.verification.independent.walls import strains
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Finding, distance, within
from coaxshell.apps.verification.systems import SMOOTH_SPHERE
from coaxshell.model import presets
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray

SOURCE = "independent: spectral elements in r, Gauss in t"
STATIONS, ANGLES = (-0.4, 0.9), (10.0, 70.0, 180.0)
STEP = 2e-3
NAMES = {
    "normal": "normal displacement",
    "tangential": "tangential displacement",
    "axial displacement": "axial displacement",
    "hoop": "hoop stress",
    "axial": "axial stress",
    "shear": "shear stress",
}


@check("independent-stations", "An independent method in three dimensions")
def independent_stations(bench: Bench) -> Iterator[Finding]:
    """Compare displacements and stresses at two stations and three angles with waves of the independent method, added up over m and k.

    The bare double shell under a true spherical wave at 3 a; orders and wavenumbers of both are those of the run.
    """
    bare, (modes, duration) = presets.load("bare").replace(source=SMOOTH_SPHERE), bench.choose((4, 1.4), (8, 1.6))
    response = bench.simulate(bare, duration=duration, time_step=STEP / 2, modes=modes, dimensions=3, stations=STATIONS)
    period = float(response.settings.axial_period or 0.0)
    waves = Waves(bare, period, modes, duration)
    for shell in range(len(bare.shells)):
        theirs = waves.at_stations(shell)
        for name, label in NAMES.items():
            if name in ("hoop", "axial", "shear"):
                ours = np.asarray(response.stress(shell, ANGLES, component=name))
            else:
                ours = np.asarray(response.displacement(shell, ANGLES, component=name.partition(" ")[0]))
            error = distance(ours[::2], theirs[name])
            where = ("inner", "outer")[shell]
            yield within(f"{label}, {where} shell, all stations and angles", SOURCE, "the other method's", error, 1e-6)
        bench.done((shell + 1) / len(bare.shells))


class Waves:
    """All waves of the independent method within (m/M)^2 + (k/M)^2 <= 1, k = 2 pi j/L, and what they add up to.

    Parameters
    ----------
    system : System
        Of a reference radius of 1 m.
    period : float
        L, in m.
    modes : int
        M.
    duration : float
        In transits.
    """

    def __init__(self, system: System, period: float, modes: int, duration: float) -> None:
        self.wavenumbers = 2 * np.pi / period * np.arange(int(modes * period / (2 * np.pi)) + 1)
        self.weights = np.where(self.wavenumbers == 0, 2.0, 4.0) / period
        tops = np.floor(np.sqrt(modes**2 - self.wavenumbers**2) + 1e-9).astype(int)
        self.solved = [
            RadialElements(system, int(top), duration, wavenumber=float(k)).solve(STEP, round(duration / STEP))
            for k, top in zip(self.wavenumbers, tops, strict=True)
        ]

    def at_stations(self, shell: int) -> dict[str, FloatArray]:
        """Return displacements (m) and stresses (Pa) of a shell by name, each (T, stations, angles)."""
        z, theta = np.array(STATIONS), np.radians(ANGLES)
        total = {name: np.zeros((self.solved[0].time.size, z.size, theta.size)) for name in NAMES}
        for k, weight, wave in zip(self.wavenumbers, self.weights, self.solved, strict=True):
            wall = wave.assembly.walls[shell]
            along = weight * np.stack([np.cos(k * z), np.sin(k * z)])
            for m in range(wave.modes + 1):
                motion = np.stack([wave.v[shell, m], wave.w[shell, m], wave.u[shell, m]])
                axial, hoop, shear = strains(m, float(k), wall.radius)[0] @ motion
                q, nu, cosine, sine = wall.core, wall.poisson, np.cos(m * theta), np.sin(m * theta)
                shares = {
                    "normal": (motion[1], along[0], cosine),
                    "tangential": (motion[0], along[0], sine),
                    "axial displacement": (motion[2], along[1], cosine),
                    "hoop": (q * (hoop + nu * axial), along[0], cosine),
                    "axial": (q * (axial + nu * hoop), along[0], cosine),
                    "shear": (q * (1 - nu) / 2 * shear, along[1], sine),
                }
                for name, parts in shares.items():
                    total[name] += np.einsum("t,z,a->tza", *parts)
        return total
