"""Slow loads: static compliances of rings, interior and gap fluids in closed form."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.independent.walls import Wall
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Finding, close
from coaxshell.apps.verification.systems import PLANE_STEP, STEP, WATER, evacuated, thin_shell
from coaxshell.model import presets
from coaxshell.model.fluids import VACUUM, Fluid
from coaxshell.model.shells import Shell
from coaxshell.model.system import System
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.scaling import dimensionless

SLOW = np.array([1e-6 + 0j])


@check("statics", "Static compliance")
def statics(bench: Bench) -> Iterator[Finding]:
    """Compare the modal compliance at s -> 0 with closed forms: hoop stiffness a22/R^2, bending d22 (m^2 - 1)^2/R^4, bulk of the fluids."""
    wall = Wall.of(thin_shell())
    system = evacuated()
    hoop = wall.radius**2 / wall.a22
    yield close("evacuated shell, order 0: W per pressure", "closed form R²/a22", hoop, _compliance(system, 0)[0], 1e-6, unit="m/Pa")
    for m in (2, 3, 10):
        thin = wall.radius**4 / (wall.d22 * (m**2 - 1) ** 2)
        found = _compliance(system, m)[0]
        yield close(f"evacuated shell, order {m}", "closed form R⁴/(d22 (m²-1)²), inextensional", thin, found, 2e-5 * m**2, unit="m/Pa")
        k = wall.stiffness(m)
        exact = 1 / (k[1, 1] - k[0, 1] ** 2 / k[0, 0])
        yield close(f"evacuated shell, order {m}, stretching included", "theory 2; 2 by 2 by hand", exact, found, 1e-6, unit="m/Pa")
    bulk = WATER.density * WATER.sound_speed**2
    filled = System(shells=[thin_shell()], fluids=[WATER, WATER], source=PLANE_STEP)
    expected = 1 / (1 / hoop + 2 * bulk / wall.radius)
    yield close("filled shell, order 0", "closed form 1/(a22/R² + 2ρc²/R)", expected, _compliance(filled, 0)[0], 1e-6, unit="m/Pa")
    yield from _double()
    response = bench.simulate(evacuated(), duration=400.0, time_step=0.05, modes=2)
    late = float(response.modal("outer").values[0, 0, -1])
    yield close("evacuated shell under a plane step: breathing at t = 400", "closed form p R²/a22", STEP * hoop, late, 1e-4, unit="m")


def _double() -> Iterator[Finding]:
    """Yield the static breathing of the paper's double shell: a22/R² on the diagonal plus the bulk of gap and interior."""
    system = presets.load("bare")
    walls = [Wall.of(shell) for shell in system.shells if isinstance(shell, Shell)]
    interior, gap = (fluid.density * fluid.sound_speed**2 if isinstance(fluid, Fluid) else 0.0 for fluid in system.fluids[:2])
    ra, rb = (wall.radius for wall in walls)
    spring = gap * 2 / (rb**2 - ra**2)
    matrix = np.diag([wall.a22 / wall.radius**2 for wall in walls])
    matrix[0, 0] += interior * 2 / ra + spring * ra
    matrix[1, 1] += spring * rb
    matrix[0, 1], matrix[1, 0] = -spring * rb, -spring * ra
    expected, found = np.linalg.solve(matrix, [0.0, 1.0]), _compliance(system, 0)
    for name, wanted, got in zip(("inner", "outer"), expected, found, strict=True):
        what = f"double shell, order 0: {name} shell per pressure on the outer one"
        yield close(what, "closed form, 2 by 2 with the fluids' bulk", float(wanted), got, 1e-6, unit="m/Pa")
    empty = system.replace(fluids=[VACUUM, VACUUM, WATER])
    alone = _compliance(empty, 0)
    yield close("the same in vacuo inside: outer shell", "closed form R²/a22", rb**2 / walls[1].a22, alone[1], 1e-6, unit="m/Pa")
    yield close("the same in vacuo inside: inner shell", "closed form", 0.0, alone[0], 1e-20, unit="m/Pa", measure="absolute")


def _compliance(system: System, m: int) -> list[float]:
    """Return W of all shells (m) per modal pressure (Pa) on the outermost, at s -> 0."""
    problem = dimensionless(system)
    modal = ModalSystem(problem, SLOW, Modes(np.array([float(m)])))
    return [float(w[0, 0].real) * problem.scales.length / problem.scales.pressure for w in modal.solve(len(problem.shells) - 1, 1.0)]
