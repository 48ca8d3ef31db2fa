"""An inclined plane wave, one wave of complex wavenumber, as the limit of spherical ones from far off the plane, sums of many real ones."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Finding, close, distance, within
from coaxshell.apps.verification.systems import BROAD
from coaxshell.model import presets
from coaxshell.model.sources import PlaneWave, SphericalWave
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray

SOURCE = "spherical waves from afar, Richardson's extrapolation in 1/R0"
INCLINATION = 8.0
"""Degrees; its trace runs along the axis at 7.2 c, faster than any wave of the walls, so that a far source is soon a plane wave."""
STATIONS, ANGLES = (0.0, -0.5), (0.0, 60.0, 90.0, 180.0)
STEP, DURATION, MODES = 1e-2, 1.6, 18
LEAD = 30
"""Steps by which the plane wave is late, so that it reaches the station behind z = 0 after t = 0."""


@check("inclined-waves", "Inclined plane waves as limits of spherical ones")
def inclined_waves(bench: Bench) -> Iterator[Finding]:
    """Compare stresses at stations under a plane wave inclined by 8 degrees with those of point sources in its direction, up to 320 a away.

    What is left falls as 1/R0; it is extrapolated from three distances.
    """
    bare, places = presets.load("bare"), bench.choose((40.0, 80.0, 160.0), (80.0, 160.0, 320.0))
    plane = PlaneWave(pulse=BROAD, inclination=INCLINATION, delay=LEAD * STEP / 1400)
    expected = _stresses(bench, bare.replace(source=plane), LEAD)
    found = [_stresses(bench, *_from_afar(bare, far)) for far in places]
    for key in expected:
        near, middle, far = (one[key] for one in found)
        limit = (8 * far - 6 * middle + near) / 3
        shell, component = key
        what = f"{component} stress, {shell} shell, stations at 0 and -0.5 m"
        yield within(what, SOURCE, "the same", distance(limit, expected[key]), bench.choose(5e-3, 2e-3))
    ratio = distance(found[1]["inner", "hoop"], expected["inner", "hoop"]) / distance(found[2]["inner", "hoop"], expected["inner", "hoop"])
    yield close("hoop stress, inner shell: what is left, over that at twice the distance", "falls as 1/R0", 2.0, ratio, 0.05)


def _from_afar(bare: System, far: float) -> tuple[System, int]:
    """Return the system under a point source in the wave's direction, as strong at z = 0, and the step at which it is there."""
    start = far - 1.0
    z = -start * np.tan(np.radians(INCLINATION))
    range_ = np.hypot(start, z)
    step = int(np.ceil((range_ - start) / STEP))
    pulse = BROAD.replace(peak_pressure=BROAD.peak_pressure * range_ / start)
    delay = (step * STEP - (range_ - start)) / 1400
    return bare.replace(source=SphericalWave(distance=far, z=z, pulse=pulse, delay=delay)), step


def _stresses(bench: Bench, system: System, first: int) -> dict[tuple[str, str], FloatArray]:
    """Return stresses by shell and component, (T, stations, angles), from the step on at which the wave is at the head at z = 0."""
    steps = round(DURATION / STEP)
    response = bench.simulate(system, duration=(first + steps) * STEP, time_step=STEP, modes=MODES, dimensions=3, stations=STATIONS)
    return {
        (shell, component): np.asarray(response.stress(shell, ANGLES, component=component))[first : first + steps + 1]
        for shell in ("inner", "outer")
        for component in ("hoop", "axial", "shear")
    }
