"""The suite itself passes, and a wrong package would not."""

from __future__ import annotations

import numpy as np
import pytest

from coaxshell.apps.verification import checks, chosen, run
from coaxshell.apps.verification.bench import Bench, bare_double_shell, tables
from coaxshell.apps.verification.rows import Row
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.radial_functions import RadialFunctions
from coaxshell.structure.thin_wall import ThinWall


@pytest.mark.slow_for("axial-wavenumbers", "independent", "inclined-waves", "engines", "modes")
@pytest.mark.parametrize("name", [one.name for one in checks()])
def test_quick_check_passes(quick_rows, name):
    assert quick_rows(name)
    assert not [row.cells for row in quick_rows(name) if row.verdict != "pass"]


@pytest.mark.slow
def test_full_suite_passes():
    report = run(chosen(None, quick=False))
    assert not [row.cells for row in report.rows if row.verdict != "pass"]
    assert len(report.rows) > 200
    assert report.seconds < 300


def failing(*names):
    """Return the names of those checks that fail, each carried out to its first row that does."""
    bench = Bench(quick=True)

    def fails(one):
        return any(isinstance(found, Row) and found.verdict == "FAIL" for found in one.work(bench))

    return {one.name for one in chosen(list(names), quick=True) if fails(one)}


def test_a_wrong_fluid_is_seen(monkeypatch):
    right = RadialFunctions.__dict__["exterior"].func
    wrong = property(lambda self: 1.001 * right(self))
    monkeypatch.setattr(RadialFunctions, "exterior", wrong)
    names = {"reference-values", "transparency", "form-function", "published", "independent"}
    assert failing(*names) == names


def test_a_wrong_wall_is_seen(monkeypatch):
    stiffness = ThinWall.stiffness

    def wrong(wall, orders):
        right = stiffness(wall, orders)
        return type(right)(*(1.001 * entry for entry in right))

    monkeypatch.setattr(ThinWall, "stiffness", wrong)
    assert failing("statics", "ring-frequencies", "independent", "form-function") == {
        "statics",
        "ring-frequencies",
        "independent",
        "form-function",
    }


@pytest.mark.slow
@pytest.mark.usefixtures("quick_rows")
def test_a_wrong_wavenumber_is_seen(monkeypatch):
    right = Modes.kappa
    monkeypatch.setattr(Modes, "kappa", lambda modes, slowness, s: right(Modes(modes.orders, 1.001 * modes.wavenumber), slowness, s))
    names = {"axial-limits", "axial-wavenumbers", "independent-stations", "spherical-histories"}
    assert failing(*names) == names


def test_the_package_carries_its_references():
    assert set(tables()) == {"exterior", "exterior-short", "rigid", "evacuated", "evacuated-shock", "double-shock"}
    assert bare_double_shell()["time"].shape == bare_double_shell()["stress_inner_head"].shape


def test_the_bench_shares_solutions():
    from coaxshell.model import presets

    bench = Bench()
    settings = {"duration": 0.5, "time_step": 0.02, "modes": 3}
    first = bench.simulate(presets.load("bare"), **settings)
    again = bench.simulate(presets.load("bare"), **settings)
    assert again.solution.normal is first.solution.normal
    assert bench.simulate(presets.load("bare"), **settings) is again
    assert bench.simulate(presets.load("bare"), **{**settings, "modes": 4}) is not first
    assert np.isfinite(first.solution.normal).all()
