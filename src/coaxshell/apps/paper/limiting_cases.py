"""The paper's Figure 2: a shell without fluid inside, one filled with water, and two shells of which the inner one is hollow."""

from __future__ import annotations

import numpy as np

from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.apps.paper.histories import named_warnings
from coaxshell.apps.paper.known_runs import Runs
from coaxshell.apps.paper.observed import Observed
from coaxshell.apps.paper.recipes import Drawn
from coaxshell.errors import InputError
from coaxshell.model import VACUUM, RigidShell, Shell, System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.progress import Progress
from coaxshell.plotting.curve_sheets import SheetCurve, SheetPanel, figure_curve_sheet
from coaxshell.solver.excitation import SurfaceLoads
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.settings import Settings

THICKNESSES = {5e-3: "sky", 1e-2: "blue", 2e-2: "green", 4e-2: "orange"}
"""Thicknesses of the filled shell, m, with their colours; the paper shows several and names none, these are ours."""

_ANGLES = {0.0: "blue", 45.0: "sky", 90.0: "green", 135.0: "amber", 180.0: "orange"}
_SIDES = {"head": "solid", "tail": (0, (4.0, 1.3))}
_COLOURS = {"outer": "blue", "inner": "orange"}
_RELATIVE = "displacement / thickness, $w/h$"


def limiting_cases(systems: list[System], runs: Runs, progress: Progress | None) -> Drawn:
    """Draw Figure 2 for an evacuated shell, a filled one in several thicknesses, and a double one."""
    wanted = limiting_systems(systems)
    filled_ones = [name for name in wanted if name.startswith("filled")]
    found = {name: (wanted[name], run) for name, run in runs.each(wanted, progress)}
    water = [(*found[name], thickness) for thickness, name in zip(THICKNESSES, filled_ones, strict=True)]
    panels = [
        SheetPanel("a  Evacuated shell, no motion", "pressure / incident peak", _pressures(*found["evacuated"], runs.resolution)),
        SheetPanel("b  Evacuated shell", _RELATIVE, _ends(*found["evacuated"], "displacement", ("outer",))),
        *(SheetPanel(f"c  Filled shell, {side}", _RELATIVE, _filled(water, side)) for side in _SIDES),
        SheetPanel("d  Double shell, inner one hollow", _RELATIVE, _ends(*found["double"], "displacement", ("inner", "outer"))),
        SheetPanel("e  Double shell, inner one hollow", "hoop stress (MPa)", _ends(*found["double"], "stress", ("inner", "outer"))),
    ]
    warnings = [(name, text) for name, (_, run) in found.items() for text in run.warnings]
    return Drawn(figure_curve_sheet(panels), named_warnings(warnings))


def limiting_systems(systems: list[System]) -> dict[str, System]:
    """Return the systems of Figure 2 by name, from an evacuated shell, a filled one and a double one."""
    evacuated, filled, double = systems
    filled_ones = {
        f"filled, {1e3 * thickness:g} mm": filled.replace_path("shells[0].layers[0].thickness", thickness) for thickness in THICKNESSES
    }
    return {"evacuated": evacuated, **filled_ones, "double": double}


def rigid_pressure(system: System, resolution: Settings, modes: int, angles: list[float]) -> tuple[FloatArray, FloatArray]:
    """Return times (T,) and incident plus diffracted pressure on the outermost surface held still, over the peak pressure, (T, A).

    The sums over orders and frequencies are smoothed by Lanczos's factors, as the fronts at the surface are jumps.

    Parameters
    ----------
    system : System
        Its first source, a shock, and its exterior fluid are taken.
    resolution : Settings
        Its duration and time step.
    modes : int
        Highest order.
    angles : list of float
        Degrees from the head.

    Raises
    ------
    InputError
        The source has no peak pressure.
    """
    source = system.sources[0]
    peak = getattr(source, "peak_pressure", None)
    if peak is None:
        raise InputError("source", "it has no peak pressure to which the surface pressure could be related", "give a shock")
    rigid = System(shells=[RigidShell(radius=system.shells[-1].radius)], fluids=[VACUUM, system.exterior], source=source.replace(angle=0.0))
    problem = dimensionless(rigid)
    grid = LaplaceGrid(resolution.time_step, round(resolution.duration / resolution.time_step))
    radial = RadialBasis(Modes.up_to(modes), grid.nodes)
    load = SurfaceLoads(problem, grid, radial.modes)(radial, slice(None))[0]
    modal = grid.invert(load, grid.lanczos()) * (problem.scales.pressure / peak)
    number = np.arange(modes + 1)
    basis = np.sinc(number / (modes + 1.0)) * np.cos(np.radians(np.multiply.outer(angles, number)))
    return grid.time, np.asarray((basis @ modal).T, dtype=np.float64)


def _pressures(system: System, run: Observed, resolution: Settings) -> list[SheetCurve]:
    time, values = rigid_pressure(system, resolution, run.modes, list(_ANGLES))
    return [SheetCurve(f"{angle:g}°", time, values[:, k], colour) for k, (angle, colour) in enumerate(_ANGLES.items())]


def _history(system: System, run: Observed, quantity: str, shell: str, side: str) -> FloatArray:
    """Return the stress in MPa, or the displacement over the thickness of the shell."""
    return run.at(quantity, shell, side) / (1e6 if quantity == "stress" else _thickness(system, shell))


def _thickness(system: System, shell: str) -> float:
    wall = system.shells[system.shell_index(shell)]
    if not isinstance(wall, Shell):
        raise InputError("shells", f"the {shell} shell is rigid and has no thickness", "give an elastic one")
    return float(sum(layer.thickness for layer in wall.layers))


def _ends(system: System, run: Observed, quantity: str, shells: tuple[str, ...]) -> list[SheetCurve]:
    return [
        SheetCurve(
            f"{shell} {side}" if len(shells) > 1 else side,
            run.time,
            _history(system, run, quantity, shell, side),
            _COLOURS[shell],
            dash,
        )
        for shell in shells
        for side, dash in _SIDES.items()
    ]


def _filled(water: list[tuple[System, Observed, float]], side: str) -> list[SheetCurve]:
    dash = _SIDES[side]
    return [
        SheetCurve(f"{1e3 * thickness:g} mm", run.time, _history(system, run, "displacement", "outer", side), THICKNESSES[thickness], dash)
        for system, run, thickness in water
    ]
