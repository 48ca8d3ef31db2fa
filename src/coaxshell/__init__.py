"""How concentric cylindrical shells in fluids answer an acoustic shock.

Describe a :class:`System` (or load one of ``presets``), :func:`simulate` it, and read the :class:`Response`::

    import coaxshell as cx

    response = cx.simulate(cx.presets.load("bare"))
    response.stress("inner", angle=[0, 180])

Names are imported when they are first used, so that importing the package costs next to nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from coaxshell._moved import keep_old_names
from coaxshell._version import __version__
from coaxshell.errors import InputError, PhysicsWarning
from coaxshell.numerics.late import supply

if TYPE_CHECKING:
    from coaxshell import export, plotting
    from coaxshell.model import (
        EXPLOSIVES,
        VACUUM,
        Absorber,
        AbsorberRing,
        Elastic,
        Explosive,
        Exponential,
        Feedback,
        Fluid,
        Gaussian,
        Layer,
        LineShock,
        LineWave,
        PDControl,
        Piezoelectric,
        PlaneShock,
        PlaneWave,
        PointAbsorber,
        RigidShell,
        Sampled,
        Sea,
        Shell,
        SphericalShock,
        SphericalWave,
        Step,
        System,
        UnderwaterExplosion,
        Vacuum,
        Viscoelastic,
        absorber_ring,
        fluids,
        laws,
        materials,
        presets,
    )
    from coaxshell.response import (
        PreparedSystem,
        Response,
        frequency_response,
        load_response,
        mounted_spectrum,
        natural_frequencies,
        prepare,
        simulate,
        stability_margins,
    )
    from coaxshell.solver.settings import Settings
    from coaxshell.studies import (
        Choice,
        Execution,
        Integer,
        LogNormal,
        Measurement,
        Normal,
        Objective,
        Optimum,
        Range,
        Uniform,
        design_control,
        fit,
        gradient,
        optimise,
        robustness,
        sensitivity,
        sweep,
        to_state_space,
    )

_ROOMS = ("coaxshell.model", "coaxshell.solver.settings", "coaxshell.response", "coaxshell.studies")
"""Where names are looked for; each room brings those before it along."""
_SUBPACKAGES = ("export", "plotting")

__all__ = [
    "EXPLOSIVES",
    "VACUUM",
    "Absorber",
    "AbsorberRing",
    "Choice",
    "Elastic",
    "Execution",
    "Explosive",
    "Exponential",
    "Feedback",
    "Fluid",
    "Gaussian",
    "InputError",
    "Integer",
    "Layer",
    "LineShock",
    "LineWave",
    "LogNormal",
    "Measurement",
    "Normal",
    "Objective",
    "Optimum",
    "PDControl",
    "PhysicsWarning",
    "Piezoelectric",
    "PlaneShock",
    "PlaneWave",
    "PointAbsorber",
    "PreparedSystem",
    "Range",
    "Response",
    "RigidShell",
    "Sampled",
    "Sea",
    "Settings",
    "Shell",
    "SphericalShock",
    "SphericalWave",
    "Step",
    "System",
    "UnderwaterExplosion",
    "Uniform",
    "Vacuum",
    "Viscoelastic",
    "__version__",
    "absorber_ring",
    "design_control",
    "export",
    "fit",
    "fluids",
    "frequency_response",
    "gradient",
    "laws",
    "load_response",
    "materials",
    "mounted_spectrum",
    "natural_frequencies",
    "optimise",
    "plotting",
    "prepare",
    "presets",
    "robustness",
    "sensitivity",
    "simulate",
    "stability_margins",
    "sweep",
    "to_state_space",
]


keep_old_names()
supply(figure_curves="coaxshell.plotting.curves", report="coaxshell.apps.report")


def __getattr__(name: str) -> Any:
    if name in _SUBPACKAGES:
        return import_module(f"coaxshell.{name}")
    for room in _ROOMS if name in __all__ else ():
        module = import_module(room)
        if hasattr(module, name):
            value = globals()[name] = getattr(module, name)
            return value
    raise AttributeError(f"module 'coaxshell' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
