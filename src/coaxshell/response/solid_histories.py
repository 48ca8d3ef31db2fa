"""Displacements and stresses at angles and depths of elastic walls."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.response import arguments
from coaxshell.response.components import SOLID, solid_von_mises
from coaxshell.response.labels import ALONG_AXIS, COUNTERCLOCKWISE, INWARD, history
from coaxshell.response.modal import combined, stress_gain_of
from coaxshell.response.synthesis import angle_basis, at_angles
from coaxshell.response.wall_motion import WallMotion
from coaxshell.structure.elastic_depth import SIDES, STRESSES, Shown
from coaxshell.structure.elastic_wall import ElasticWall

COMPONENTS = ("hoop", "axial", "radial", "radial_hoop", "von_mises")
"""Stresses of a plane problem; those with the axis in their shear vanish."""
AT_STATIONS = (*STRESSES, "von_mises")
"""Those at stations along the axis."""


def solid_stress(motion: WallMotion, shell: int, theta: FloatArray, depth: float | None, component: str) -> FloatArray:
    """Return a stress of an elastic wall at angles (degrees), Pa, shape (T, A).

    Parameters
    ----------
    motion : WallMotion
    shell : int
    theta : ndarray, shape () or (A,)
    depth : float or None
        z, m, outward from the middle; None for the design depth.
    component : str
        One of :data:`COMPONENTS`, or of :data:`AT_STATIONS`; "von_mises" by :func:`~coaxshell.response.components.solid_von_mises`.
    """
    wall = motion.solution.problem.shells[shell]
    assert isinstance(wall, ElasticWall)
    solution = motion.solution
    z = solution.problem.scales.length * wall.design_depth if depth is None else depth

    def of(name: Shown) -> FloatArray:
        if depth is None and solution.along is not None:
            return combined(solution, shell, stress_gain_of(solution, shell, component=name), theta, SIDES[name])
        return _at(motion, shell, theta, name, z)

    if component != "von_mises":
        return of(component)  # type: ignore[arg-type]
    names = SOLID if solution.along is None else STRESSES
    return solid_von_mises(**{name: of(name) for name in names})  # type: ignore[arg-type]


def _at(motion: WallMotion, shell: int, theta: FloatArray, what: Shown, depth: float) -> FloatArray:
    modal = motion.within(shell, what, depth)
    return at_angles(modal, angle_basis(np.atleast_1d(theta), modal.shape[1], modal.shape[0], SIDES[what]))


def displacement_at_depth(motion: WallMotion, shell: int, angle: npt.ArrayLike, depth: object, component: str = "normal") -> xr.DataArray:
    """Return the displacement of an elastic wall at angles and a depth, m, dims (time, angle).

    Parameters
    ----------
    motion : WallMotion
    shell : int
    angle : array_like, shape () or (A,)
        Degrees from the source direction.
    depth : float or str
        z in metres from the middle of the wall, positive outward, or a face, "inner" or "outer".
    component : str
        "normal" (positive inward), "tangential" (positive towards increasing angle) or, at stations, "axial" (towards increasing z).

    Raises
    ------
    InputError
        If the wall is no elastic one, or an argument is not allowed.
    """
    solution = motion.solution
    wall, length = solution.problem.shells[shell], solution.problem.scales.length
    component = arguments.one_of("component", component, ("normal", "tangential", *(("axial",) if solution.along is not None else ())))
    if not isinstance(wall, ElasticWall):
        raise InputError("depth", "a thin wall moves as its mid-surface does", 'leave it out, or use theory = "elastic"')
    z = arguments.depth_of((length * wall.faces[0], length * wall.faces[1]), depth)
    theta = arguments.angles(angle)
    what: Shown = "along_axis" if component == "axial" else component  # type: ignore[assignment]
    values = _at(motion, shell, theta, what, z)
    sign = {"normal": INWARD, "tangential": COUNTERCLOCKWISE, "axial": ALONG_AXIS}[component]
    told = f"{component} displacement at {z:g} m outward of the middle"
    labelled = history(solution, values, theta, shell, name=f"{component}_displacement", long_name=told, units="m", sign=sign)
    labelled.attrs["depth"] = z
    return labelled


def component_of(wall: object, component: str, *, plane: bool = True) -> str:
    """Return the component asked for of an elastic wall, in a plane problem or at a station; InputError if it has none of that name."""
    if not plane:
        return arguments.one_of("component", component, AT_STATIONS)
    if component in STRESSES and component not in COMPONENTS:
        raise InputError(
            "component", f"{component!r} vanishes where nothing changes along the axis", f"must be one of {', '.join(COMPONENTS)}"
        )
    return arguments.one_of("component", component, COMPONENTS)
