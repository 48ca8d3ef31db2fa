"""The systems that claims are about, beside those of the figures."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import TYPE_CHECKING

from coaxshell.apps.paper import cases
from coaxshell.model import VACUUM, Absorber, Fluid, Layer, Shell, System, presets

if TYPE_CHECKING:
    from coaxshell.apps.paper.known_runs import Runs
    from coaxshell.apps.paper.observed import Observed

RIGID_LINK = 1e13
"""Stiffness of a link that stands for a rigid one, N/m per metre."""

THIN_FLUID = Fluid(density=1e-3, sound_speed=1.0)
"""A fluid of "very small" density and sound speed, as the paper uses in place of none; the paper names no values."""


CORE = 0.01
"""Radius of an inner shell that counts as negligible, over that of the outer one; its wall is a tenth of its own radius thick."""


@cache
def preset(name: str) -> System:
    """Return a preset; the same object every time."""
    return presets.load(name)


def bare(runs: Runs) -> Observed:
    """Return the run of the bare system."""
    return runs(preset("bare"))


def varied(runs: Runs, of: Callable[[System], cases.Cases], values: tuple[float, ...]) -> dict[float, Observed]:
    """Return the runs of a figure's cases by the value that is varied; the bare system is left out."""
    systems = of(preset("bare"))
    found = dict(runs.each(systems))
    names = [name for name in systems if name != "bare"]
    return {value: found[name] for value, name in zip(values, names, strict=True)}


def with_rigid_link() -> System:
    """Return the bare system with a link at the heads that is as good as rigid and as heavy as the absorbers compared with it."""
    link = Absorber(angle=cases.head_of(preset("bare")), mass=cases.LINEAR["mass"], linear_stiffness=RIGID_LINK)
    return preset("bare").replace(name="rigid link", absorbers=[link])


def hollow_inside() -> System:
    """Return the bare system with a vacuum inside."""
    system = preset("bare")
    return system.replace(name="bare, hollow", fluids=(VACUUM, *system.fluids[1:]))


def emptied_by_thin_fluid() -> System:
    """Return the evacuated shell of Figure 2 as the paper makes it: an inner shell of half the radius, thin fluids inside."""
    system = preset("iakovlev-evacuated")
    wall = system.shells[0]
    if not isinstance(wall, Shell):
        raise TypeError("the evacuated shell is elastic")
    inner = Shell(radius=0.5 * wall.radius, layers=wall.layers)
    return system.replace(name="evacuated by a thin fluid", shells=(inner, wall), fluids=(THIN_FLUID, THIN_FLUID, system.exterior))


def double_hollow_by_thin_fluid() -> System:
    """Return the double shell of Figure 2 as the paper makes it: a thin fluid inside instead of none."""
    system = preset("iakovlev-double")
    return system.replace(name="double, thin fluid inside", fluids=(THIN_FLUID, *system.fluids[1:]))


def filled_by_shrinking() -> System:
    """Return the filled shell of Figure 2 as the paper makes it: an inner shell of negligible radius, a thin fluid within."""
    system = preset("iakovlev-filled")
    wall = system.shells[0]
    if not isinstance(wall, Shell):
        raise TypeError("the filled shell is elastic")
    core = Shell(radius=CORE * wall.radius, layers=[Layer(wall.layers[0].material, 0.1 * CORE * wall.radius)])
    return system.replace(name="filled by shrinking", shells=(core, wall), fluids=(THIN_FLUID, *system.fluids))
