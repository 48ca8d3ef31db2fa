"""What several rooms of tests share: the steel ring in water, spectra without inversion, and an inversion good to 1e-10."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import settings
from scipy.special import gamma

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.apps.verification import bench, chosen
from coaxshell.apps.verification.checks import independent_stations
from coaxshell.apps.verification.rows import Row
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
def quick_rows() -> Iterator[Callable[[str], tuple[Row, ...]]]:
    """Give a function from the name of a check to the rows of its quick version, which is carried out once and shares solutions.

    The waves of the independent method, the same whatever is wrong with ours, are solved once in a process.
    """
    place = bench.Bench(quick=True)

    @cache
    def rows(name: str) -> tuple[Row, ...]:
        (one,) = chosen([name], quick=True)
        return tuple(found for found in one.work(place) if isinstance(found, Row))

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(independent_stations, "Waves", cache(independent_stations.Waves))
        yield rows


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


TOGETHER = ("tests/studio/browser/", "tests/studio/", "tests/paper/", "tests/house/")
"""Places whose tests one process carries out alone, for what they share takes long: servers, browsers, runs, all files parsed."""

LONG = (
    "tests/studio/browser/",
    "tests/paper/",
    "tests/studio/",
    "tests/response/test_whole_length_energy.py",
    "tests/verification/test_checks.py",
    "tests/studies/test_resilience.py",
    "tests/export/test_kills.py",
    "tests/cli/test_fields.py",
    "tests/studies/test_uncertainty.py",
    "tests/studies/test_optimise.py",
    "tests/release/test_readme.py",
    "tests/solver/test_point_absorbers.py",
    "tests/cross/test_direct_engine.py",
)
"""Places and files that take longest, the longest first: begun first, none of them is left to one process at the end."""


READERS_OF_CHECKS = (
    "tests/analytic/test_axial_limits.py",
    "tests/analytic/test_stations.py",
    "tests/analytic/test_transparency.py",
    "tests/independent/test_axial_waves.py",
    "tests/reference/test_spherical_bare.py",
)
"""Files whose tests hold the rows of checks to closer limits: carried out where the checks are."""


def unit_of(nodeid: str) -> str:
    """Return which tests are carried out together, in one process: those of a file, which share its fixtures, or of a place."""
    file = nodeid.partition("::")[0]
    if file in READERS_OF_CHECKS:
        return "tests/verification/test_checks.py"
    return next((place for place in TOGETHER if file.startswith(place)), file)


def mark_slow_cases(items: list[pytest.Item], *, all_collected: bool) -> None:
    """Mark the cases that ``slow_for(*cases)`` names as slow, and all but those that ``slow_except(*cases)`` names.

    Raises
    ------
    pytest.UsageError
        If a mark names a case that its test has not, or leaves none that always runs, where whole files were collected.
    """
    named: dict[str, set[str]] = {}
    cases: dict[str, dict[str, bool]] = {}
    for item in items:
        asked = {mark.name: set(mark.args) for mark in item.iter_markers() if mark.name in ("slow_for", "slow_except")}
        if not asked:
            continue
        case, test = item.callspec.id if hasattr(item, "callspec") else "", item.nodeid.partition("[")[0]
        if slow := case in asked.get("slow_for", ()) or case not in asked.get("slow_except", {case}):
            item.add_marker(pytest.mark.slow)
        named[test] = set().union(*asked.values())
        cases.setdefault(test, {})[case] = slow
    if all_collected and (lost := {test: some for test, names in named.items() if (some := names - set(cases[test]))}):
        raise pytest.UsageError(f"slow_for or slow_except names cases that are not there: {lost}")
    if all_collected and (none := [test for test, of in cases.items() if all(of.values())]):
        raise pytest.UsageError(f"no case is left that always runs: {none}")


def pytest_collection_finish() -> None:
    """Take what collection has made out of every later search for garbage: it stays to the end, and there is much of it."""
    gc.collect()
    gc.freeze()


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark slow cases before any is left out; put the longest units first where several processes share the tests."""
    mark_slow_cases(items, all_collected=not any("::" in argument for argument in config.args))
    if hasattr(config, "workerinput"):
        rank = {unit: number for number, unit in enumerate(LONG)}
        items.sort(key=lambda item: rank.get(unit_of(item.nodeid), len(rank)))


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Give out whole units, in order: xdist's marks of groups go unread by some versions of pytest."""
    from xdist.scheduler import LoadScopeScheduling

    class ByUnit(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return unit_of(nodeid)

    config.option.loadscopereorder = False
    return ByUnit(config, log)
