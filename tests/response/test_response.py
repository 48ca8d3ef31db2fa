"""The response itself and the call that makes it."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

from coaxshell import solver
from coaxshell.errors import InputError
from coaxshell.response import Response, simulate
from coaxshell.solver.settings import Settings
from coaxshell.solver.solution import ModalSolution


def test_attributes(response: Response, solution: ModalSolution) -> None:
    assert response.solution is solution
    assert response.system.name == "by hand"
    assert (response.shells, response.modes, response.engine) == (2, 12, "spectral")
    assert response.settings.time_step == 0.025
    assert response.estimates is solution.estimates
    assert response.warnings == solution.warnings
    assert response.timings == solution.timings
    np.testing.assert_allclose(response.time_seconds, response.time * 1.25 / 1400, rtol=1e-15)
    assert repr(response) == "<Response: 'by hand', 2 shells, 12 modes, t = 0 to 2 transits>"


def test_simulate_hands_the_settings_on(solution: ModalSolution, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = {}

    def solve(system: object, *, settings: Settings, progress: object = None) -> ModalSolution:
        asked.update(system=system, settings=settings, progress=progress)
        return solution

    monkeypatch.setattr(solver, "solve", solve, raising=False)
    found = simulate(solution.problem.system, duration=2.0, time_step=0.01, modes="auto", tolerance=1e-2, progress=print)
    assert found.solution is solution
    assert asked["settings"] == Settings(duration=2.0, time_step=0.01, modes="auto", engine="spectral", tolerance=1e-2)
    assert asked["progress"] is print
    with pytest.raises(InputError, match="engine: 'magic'"):
        simulate(solution.problem.system, engine="magic")


def test_the_package_imports_without_xarray() -> None:
    code = "import sys, coaxshell; sys.exit('xarray' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
