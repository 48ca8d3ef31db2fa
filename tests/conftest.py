"""What several rooms of tests share: the steel ring in water, spectra without inversion, and an inversion good to 1e-10."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import settings
from scipy.special import gamma

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.apps.verification import bench
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.structure_spectra import StructureSpectra

# A busy machine must not fail a test: no example has a deadline.
settings.register_profile("untimed", deadline=None)
settings.load_profile("untimed")

WATER = cx.Fluid(density=1000, sound_speed=1400)
STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=177.45e9, poisson_ratio=0.3)


@pytest.fixture(scope="session")
def tables() -> dict[str, Any]:
    """Return the tables of high-precision values."""
    return bench.tables()


@pytest.fixture(scope="session")
def water() -> cx.Fluid:
    return WATER


@pytest.fixture(scope="session")
def ring() -> Callable[..., cx.Shell]:
    """Return a maker of one-layer shells, by default of steel, 1 m and 1 cm."""

    def build(radius: float = 1.0, thickness: float = 1e-2, **changes: Any) -> cx.Shell:
        return cx.Shell(radius=radius, layers=[cx.Layer(STEEL.replace(**changes), thickness)])

    return build


@pytest.fixture(scope="session")
def shock() -> cx.PlaneShock:
    return cx.PlaneShock(peak_pressure=250e3, decay_time=1.314e-4)


@pytest.fixture(scope="session")
def double(ring: Callable[..., cx.Shell], shock: cx.PlaneShock) -> cx.System:
    """Return two steel shells with water everywhere."""
    return cx.System(shells=[ring(0.5), ring(1.0)], fluids=[WATER] * 3, source=shock)


@pytest.fixture(scope="session")
def spectra() -> Callable[..., StructureSpectra]:
    """Return a function from a system, a grid and the highest order to W and V (shells, parities, M + 1, nodes), dimensionless."""

    def solve(system: cx.System, grid: LaplaceGrid, modes: int) -> StructureSpectra:
        return StructureSpectra(dimensionless(system), grid, Modes.up_to(modes))

    return solve


@pytest.fixture(scope="session")
def sharp_inverse() -> Callable[..., np.ndarray]:
    """Return an inversion for spectra that behave as s^-lead (c_0 + c_1/s + ...) at high frequency, fronts at t = 0 included.

    Terms (s + 1)^-p, p = lead, lead + 1, ..., are fitted to the upper three quarters of the band, taken off, and their known
    inverses t^(p-1) e^-t/Gamma(p) added back. That is exact whatever the fit; a good fit leaves little for the band limit to spoil.
    """

    def invert(grid: LaplaceGrid, spectrum: np.ndarray, lead: float, terms: int = 4) -> np.ndarray:
        power = lead + np.arange(terms)
        scale = abs(grid.nodes[-1] + 1.0)
        basis = ((grid.nodes[:, None] + 1.0) / scale) ** -power
        upper = slice(grid.nodes.size // 4, None)
        weight = 1.0 / np.abs(basis[upper, 0])
        matrix, values = basis[upper] * weight[:, None], (spectrum[..., upper] * weight).T
        stacked = np.concatenate([matrix.real, matrix.imag]), np.concatenate([values.real, values.imag])
        fit = np.linalg.lstsq(*stacked, rcond=None)[0]
        inverse = scale ** power[:, None] / gamma(power)[:, None] * np.maximum(grid.time, 1e-300) ** (power[:, None] - 1.0)
        return grid.invert(spectrum - (basis @ fit).T) + fit.T @ (inverse * np.exp(-grid.time))

    return invert


TOGETHER = ("tests/studio/browser/", "tests/studio/", "tests/paper/test_claims.py", "tests/paper/test_reproduction.py")
"""What one test process carries out alone, for servers, browsers and runs take long to start; the two of the paper share theirs."""


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Keep these tests together by their place: xdist's marks of groups go unread by some versions of pytest."""
    from xdist.scheduler import LoadScopeScheduling

    class ByPlace(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            place = next((place for place in TOGETHER if nodeid.startswith(place)), nodeid)
            return "tests/paper" if place.startswith("tests/paper/test_") and place in TOGETHER else place

    return ByPlace(config, log)
