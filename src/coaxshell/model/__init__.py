"""What a user describes: frozen, validated, in SI, written to TOML and back without loss."""

from __future__ import annotations

from coaxshell.model import fluids, laws, materials, presets
from coaxshell.model.absorbers import Absorber, AbsorberRing, PointAbsorber, absorber_ring
from coaxshell.model.base import Described
from coaxshell.model.control import PDControl
from coaxshell.model.elastic import Elastic
from coaxshell.model.explosives import EXPLOSIVES, Explosive
from coaxshell.model.feedback import Feedback
from coaxshell.model.fluids import VACUUM, Fluid, Vacuum
from coaxshell.model.layers import Layer
from coaxshell.model.piezoelectric import Piezoelectric
from coaxshell.model.pulses import Exponential, Gaussian, Pulse, Sampled, Step
from coaxshell.model.sea import Sea
from coaxshell.model.shells import RigidShell, Shell
from coaxshell.model.sources import (
    LineShock,
    LineWave,
    PlaneShock,
    PlaneWave,
    Source,
    SphericalShock,
    SphericalWave,
    UnderwaterExplosion,
    source_distance,
)
from coaxshell.model.system import System
from coaxshell.model.viscoelastic import Viscoelastic

__all__ = [
    "EXPLOSIVES",
    "VACUUM",
    "Absorber",
    "AbsorberRing",
    "Described",
    "Elastic",
    "Explosive",
    "Exponential",
    "Feedback",
    "Fluid",
    "Gaussian",
    "Layer",
    "LineShock",
    "LineWave",
    "PDControl",
    "Piezoelectric",
    "PlaneShock",
    "PlaneWave",
    "PointAbsorber",
    "Pulse",
    "RigidShell",
    "Sampled",
    "Sea",
    "Shell",
    "Source",
    "SphericalShock",
    "SphericalWave",
    "Step",
    "System",
    "UnderwaterExplosion",
    "Vacuum",
    "Viscoelastic",
    "absorber_ring",
    "fluids",
    "laws",
    "materials",
    "presets",
    "source_distance",
]
