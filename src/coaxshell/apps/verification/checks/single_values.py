"""Values from high-precision inversion: response functions, rigid cylinder, evacuated shell under a plane step."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.special import gamma

from coaxshell.acoustics.basis import Modes
from coaxshell.acoustics.operators import all_orders
from coaxshell.apps.verification.bench import Bench, tables
from coaxshell.apps.verification.loads import surface_pressure
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Curve, Finding, Panel, Sheet, value, within
from coaxshell.apps.verification.systems import PLANE_STEP, STEP, evacuated
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.radial_functions import RadialFunctions
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.structure_spectra import StructureSpectra

GRID = LaplaceGrid(5e-3, 1200, wrap_around=1e-12)


@check("reference-values", "Reference values from high-precision inversion")
def reference_values(bench: Bench) -> Iterator[Finding]:
    """Compare modal histories with values inverted with 30 digits by two methods: plane wave, t = 0 at first contact."""
    stored = tables()
    exterior = sharp_inverse(GRID, RadialFunctions(GRID.nodes, 1.0, all_orders(20)).exterior, lead=1.0)
    rigid = sharp_inverse(GRID, surface_pressure(PLANE_STEP, GRID, 2, STEP), lead=1.5)
    fine = LaplaceGrid(1e-3, 5200)
    problem = dimensionless(evacuated())
    spectrum = StructureSpectra(problem, fine, Modes.up_to(2)).normal[-1, 0] * fine.nodes * (problem.scales.pressure / STEP)
    velocity = fine.invert(spectrum)
    parts = (
        ("exterior", "exterior response function K/(sK')", GRID, exterior, {"m0": 1e-11, "m1": 1e-11, "m2": 1e-11, "m5": 5e-11}),
        ("exterior-short", "exterior response function K/(sK')", GRID, exterior, {"m20": 2e-9}),
        ("rigid", "pressure on a rigid cylinder", GRID, rigid, {"m0": 1e-10, "m1": 1e-10, "m2": 1e-10}),
        ("evacuated", "velocity of the evacuated shell", fine, velocity, {"m0": 1e-9, "m1": 1e-9, "m2": 1e-9}),
    )
    panels: dict[str, list[Curve]] = {}
    for table, what, grid, histories, limits in parts:
        curves = panels.setdefault(what, [])
        for name, limit in limits.items():
            times, expected = np.array(stored[table]["time"]), np.array(stored[table][name])
            found = histories[int(name[1:])]
            at = np.round(times / grid.time_step).astype(int)
            yield _row(f"{what}, m = {name[1:]}, at {times.size} times", f"reference/README.md, table {table}", expected, found[at], limit)
            curves += _curves(name, grid, found, times, expected)
    yield Sheet(
        "Modal histories against high-precision values",
        "Lines: coaxshell. Dots: 30-digit values. All dimensionless, plane wave.",
        [Panel(what, "time (a/c)", "", curves) for what, curves in panels.items()],
    )


def _row(what: str, source: str, expected: FloatArray, found: FloatArray, limit: float) -> Finding:
    error = float(np.abs(found - expected).max())
    return within(what, source, f"last {value(expected[-1])}", error, limit, found=f"last {value(found[-1])}", measure="absolute, largest")


def _curves(name: str, grid: LaplaceGrid, found: FloatArray, times: FloatArray, expected: FloatArray) -> list[Curve]:
    colours = {"m0": "blue", "m1": "orange", "m2": "green", "m5": "purple", "m20": "grey"}
    return [
        Curve(f"m = {name[1:]}", grid.time[2:], found[2:], colour=colours[name]),
        Curve("", times, expected, "points", colour=colours[name]),
    ]


def sharp_inverse(grid: LaplaceGrid, spectrum: ComplexArray, lead: float, terms: int = 4) -> FloatArray:
    """Return the inverse of spectra that behave as s^-lead (c_0 + c_1/s + ...) at high frequency, fronts at t = 0 included.

    Terms (s + 1)^-p, p = lead, lead + 1, ..., are fitted to the upper three quarters of the band, taken off, and their known
    inverses t^(p-1) e^-t/Gamma(p) added back. That is exact whatever the fit; a good fit leaves little for the band limit to spoil.
    """
    power = lead + np.arange(terms)
    scale = abs(grid.nodes[-1] + 1.0)
    basis = ((grid.nodes[:, None] + 1.0) / scale) ** -power
    upper = slice(grid.nodes.size // 4, None)
    weight = 1.0 / np.abs(basis[upper, 0])
    matrix, values = basis[upper] * weight[:, None], (spectrum[..., upper] * weight).T
    fit = np.linalg.lstsq(np.concatenate([matrix.real, matrix.imag]), np.concatenate([values.real, values.imag]))[0]
    inverse = scale ** power[:, None] / gamma(power)[:, None] * np.maximum(grid.time, 1e-300) ** (power[:, None] - 1.0)
    result: FloatArray = grid.invert(spectrum - (basis @ fit).T) + fit.T @ (inverse * np.exp(-grid.time))
    return result
