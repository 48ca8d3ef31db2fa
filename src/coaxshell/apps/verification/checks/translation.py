"""Rigid translation: no strain, no voltage, and the velocity that a plane step leaves."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Curve, Finding, Panel, Sheet, close, value, within
from coaxshell.apps.verification.systems import PLANE_STEP, STEP, WATER, evacuated, thin_shell
from coaxshell.model import presets
from coaxshell.model.fluids import VACUUM
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.response.response import Response
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.structure_spectra import StructureSpectra

ANGLES = [0, 30, 90, 180]
SHELL_MASS = 2 * 7800 * 1e-2 / 1000
"""Mass of a steel shell, 1 m and 1 cm, over that of the water it displaces."""


@check("translation", "Rigid translation")
def translation(bench: Bench) -> Iterator[Finding]:
    """A shell that moves as a body (V = W, order 1) has no stress and no sensor voltage; a plane step sets it moving.

    Its late velocity is 2/(1 + M/M_d) times the particle velocity, M the mass within the outer surface, M_d that of the displaced fluid.
    """
    yield from _no_strain(bench)
    grid = LaplaceGrid(0.05, bench.choose(1000, 2000))
    limit = 2 / (1 + SHELL_MASS)
    history = _velocity(evacuated(), grid)
    yield close("2/(1 + M/M_d) of the evacuated shell", "reference/README.md", 1.73010, limit, 5e-6)
    late = float(history[-1])
    yield close(f"evacuated shell: velocity at t = {grid.time[-1]:g}", "theory 10; closed form", limit, late, 2e-4)
    longer = LaplaceGrid(0.05, bench.choose(2000, 4000))
    filled = System(shells=[thin_shell()], fluids=[WATER, WATER], source=PLANE_STEP)
    inside = _velocity(filled, longer)
    mean = float(inside[-1000:].mean())  # sloshing inside rings on slowly
    yield close("water-filled shell: mean late velocity", "theory 10; closed form", 2 / (2 + SHELL_MASS), mean, 3e-3)
    double = System(shells=[thin_shell(0.5), thin_shell()], fluids=[VACUUM, WATER, WATER], source=PLANE_STEP)
    rough = float(_velocity(double, longer)[-1000:].mean())
    yield close(
        "double shell, inner one evacuated: mean late velocity", "closed form, gap's added mass after Fritz 1972", _double(), rough, 3e-3
    )
    yield _sheet(grid, history, inside[: grid.steps + 1], limit)


def _double() -> float:
    """Return the late velocity of the outer of two shells, the inner one empty: added masses of the annulus and of the exterior."""
    ra, rb = 0.5, 1.0
    area = rb**2 - ra**2
    matrix = [
        [SHELL_MASS + ra * (rb**2 + ra**2) / area, -2 * ra * rb**2 / area],
        [-2 * ra**2 * rb / area, SHELL_MASS + rb * (rb**2 + ra**2) / area + 1],
    ]
    return float(np.linalg.solve(matrix, [0.0, 2.0])[1])


def _no_strain(bench: Bench) -> Iterator[Finding]:
    solution = bench.simulate(presets.load("bare"), duration=1.5, time_step=1e-2, modes=4).solution
    w = np.zeros_like(solution.normal)
    w[:, :, 1] = np.linspace(0, 1e-6, w.shape[-1])
    moved = Response(replace(solution, normal=w, tangential=w.copy()))
    breathing = 70e9 / (1 - 0.33**2) * 1e-6
    for shell in ("inner", "outer"):
        stress = max(float(np.abs(np.asarray(moved.stress(shell, ANGLES, depth=depth))).max()) for depth in (None, "inner", "outer"))
        what = f"stress of a translation by 1 µm, {shell} shell, over that of breathing by 1 µm"
        yield within(
            what, "theory 10; Eqs. 22, A.4", "0", stress / breathing, 1e-12, found=value(stress / breathing), measure="relative, largest"
        )
        volts = float(np.abs(np.asarray(moved.sensor_voltage(shell, ANGLES))).max())
        yield within(
            f"sensor voltage of it, {shell} shell", "theory 10; Eq. 20", "0 V", volts, 1e-12, found=value(volts, "V"), measure="absolute"
        )


def _velocity(system: System, grid: LaplaceGrid) -> FloatArray:
    """Return dW_1/dt of the outermost shell over p0/(rho c)."""
    problem = dimensionless(system)
    return grid.invert(StructureSpectra(problem, grid, Modes.up_to(1)).normal[-1, 0, 1] * grid.nodes * (problem.scales.pressure / STEP))


def _sheet(grid: LaplaceGrid, evacuated_: FloatArray, filled: FloatArray, limit: float) -> Sheet:
    shown = grid.time <= 30
    flat = np.ones(int(shown.sum()))
    curves = [
        Curve("evacuated", grid.time[shown], evacuated_[shown], colour="blue"),
        Curve("its limit 1.7301", grid.time[shown], limit * flat, "dashed", colour="blue"),
        Curve("filled with water", grid.time[shown], filled[shown], colour="orange"),
        Curve("its limit", grid.time[shown], 2 / (2 + SHELL_MASS) * flat, "dashed", colour="orange"),
    ]
    panel = Panel("", "time (a/c)", "velocity of order 1 / (p/ρc)", curves)
    return Sheet("Translation under a plane step", "A steel shell of 1 cm and 1 m in water; the water inside sloshes on.", [panel])
