"""Near the surface of the sea: images, what comes back of the scattered wave, and the bubble of a charge."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.special import kv, kvp

from coaxshell.acoustics.images import Planes
from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Finding, close, within
from coaxshell.model import presets
from coaxshell.model.bubble import oscillation
from coaxshell.model.pulses import Gaussian
from coaxshell.model.sea import Sea
from coaxshell.model.sources import LineWave, SphericalShock
from coaxshell.numerics.radial_functions import RadialFunctions
from coaxshell.solver.emitters import emitters
from coaxshell.solver.graf import returned_load

TIMES = (1.2, 1.6, 1.9)
PERIOD = "measured, 2.11 W^(1/3)/(d + 10)^(5/6), Swisdak 1978"


@check("sea", "Surface and bottom of the sea")
def sea(bench: Bench) -> Iterator[Finding]:
    """Compare images with geometry, Graf's sum with a value, walls near a surface and a bottom with the water beside them, and a bubble."""
    bare = presets.load("bare")
    shock = SphericalShock(distance=5.0, peak_pressure=1e5, decay_time=1e-4)
    system = bare.replace(source=shock, sea=Sea(depth=3.0))
    image = emitters(system, 2, 5.0)[1]
    geometry = "mirror image of a source at 5 a, surface at 3 a"
    yield close("distance of the image", geometry, 7.810249676, float(image.geometry.distance or 0.0), 1e-9, unit="a")
    yield close("direction of the image", geometry, 50.19442891, image.source.angle, 1e-9, unit="degrees")
    yield close("delay of the image", geometry, 2.810249676, image.source.delay / system.transit_time, 1e-9, unit="a/c")
    planes, waves = Planes(3.0, None, 0.0), np.zeros((1, 4, 1), np.complex128)
    waves[0, 2] = kv(2, 2.0)
    load = returned_load(waves, RadialFunctions(np.array([2.0 + 0.0j]), 1.0, np.arange(4.0)), planes, planes.images(9.0))
    found = float((load[0, 1, 0] * 2.0 * kvp(1, 2.0)).real)
    yield close("order 2 seen by order 1", "K₃(12) + K₁(12), Graf's theorem", 5.442387699e-6, found, 1e-9)
    pulse = Gaussian(peak_pressure=2.5e4, width=8e-5)
    near = bare.replace(source=LineWave(distance=2.2, pulse=pulse), sea=Sea(depth=1.4, bottom=1.6, up=70.0))
    run = bench.simulate(near, duration=2.0, time_step=1e-2, modes=10)
    around = np.arange(0.0, 360.0, 7.5)
    water = run.velocity(radius=[1.0], angle=around, time=list(TIMES)).values[:, 0, 0]
    wall = run.shell_velocity("outer", angle=around).sel(time=list(TIMES), method="nearest").values
    low = [np.fft.rfft(values, axis=1)[:, :8] for values in (water, -wall)]
    error = float(np.abs(low[0] - low[1]).max() / np.abs(low[1]).max())
    yield within("velocity beside a wall, two reflections", "field of images, without Graf's theorem", "the wall's own", error, 1e-3)
    time, strength = oscillation(10.0, 20.0, 3.50, 1)
    measured = 2.11 * 10.0 ** (1 / 3) / 30.0 ** (5 / 6)
    first = float(time[np.where(time > 0.6 * measured, strength, -np.inf).argmax()])
    yield close("period of a bubble, 10 kg TNT at 20 m", PERIOD, measured, first, 0.05, unit="s")
