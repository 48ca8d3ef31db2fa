"""Systems and sources that several checks use."""

from __future__ import annotations

from typing import Any

from coaxshell.model import presets
from coaxshell.model.absorbers import absorber_ring
from coaxshell.model.control import PDControl
from coaxshell.model.elastic import Elastic
from coaxshell.model.fluids import VACUUM, Fluid
from coaxshell.model.layers import Layer
from coaxshell.model.pulses import Gaussian, Step
from coaxshell.model.shells import Shell
from coaxshell.model.sources import PlaneWave, SphericalWave
from coaxshell.model.system import System

WATER = Fluid(density=1000, sound_speed=1400)
STEEL = Elastic(name="steel", density=7800, youngs_modulus=177.45e9, poisson_ratio=0.3)
STEP = 1e5
"""Height of the plane step, Pa."""

PLANE_STEP = PlaneWave(pulse=Step(pressure=STEP))
SMOOTH = Gaussian(peak_pressure=2.5e4, width=0.05 / 1400)
"""A pulse 0.05 transits wide: neither of two methods pays for a front."""
BROAD = Gaussian(peak_pressure=2.5e4, width=0.1 / 1400)
"""A pulse twice as wide, for three dimensions."""
SMOOTH_SPHERE = SphericalWave(distance=3.0, pulse=BROAD)
"""A source for three dimensions."""
GAINS = PDControl(proportional=-2e4, derivative=-150)
"""The paper's gains."""


def thin_shell(radius: float = 1.0, thickness: float = 1e-2, **changes: Any) -> Shell:
    """Return a one-layer shell, by default of steel, 1 m and 1 cm."""
    return Shell(radius=radius, layers=[Layer(STEEL.replace(**changes), thickness)])


def evacuated(radius: float = 1.0, thickness: float = 1e-2) -> System:
    """Return one steel shell with nothing inside, under a plane step."""
    return System(shells=[thin_shell(radius, thickness)], fluids=[VACUUM, WATER], source=PLANE_STEP)


def smooth(preset: str) -> System:
    """Return a preset with its own geometry of source and the smooth pulse."""
    system = presets.load(preset)
    distance = system.source_distances[0]
    source = PlaneWave(pulse=SMOOTH) if distance is None else SphericalWave(distance=distance, pulse=SMOOTH)
    return system.replace(source=source)


def cubic_ring(count: int) -> Any:
    """Return absorbers whose cubic springs matter."""
    return absorber_ring(count, mass=10, damping=1e6, linear_stiffness=1e9, cubic_stiffness=1e21)
