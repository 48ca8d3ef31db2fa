"""Natural frequencies that others publish as benchmarks: rings in vacuo, a ring in water, a cylinder in an annulus of liquid, a cylinder
on shear diaphragms.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.optimize import brentq

from coaxshell.acoustics.operators import annulus
from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Finding, close
from coaxshell.model.elastic import Elastic
from coaxshell.model.fluids import VACUUM, Fluid
from coaxshell.model.layers import Layer, Shell
from coaxshell.model.sources import PlaneShock
from coaxshell.model.system import System
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.radial_functions import RadialFunctions
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.scaling import dimensionless

INCH, POUND = 0.0254, 4.4482216152605
"""m and N."""
PSI, DENSITY = POUND / INCH**2, POUND / INCH**4
"""Pa, and kg/m^3 of 1 lbf s^2/in^4."""
LIGHT = Fluid(density=1e-6, sound_speed=1500.0)
"""Stands for a vacuum outside, where the model needs a fluid."""
SHOCK = PlaneShock(peak_pressure=1.0, decay_time=1e-3)
SEARCH = 0.03
"""Relative half-width of the interval around the published frequency in which ours is looked for."""
STEEL_67 = (30e6 * PSI, 7.3e-4 * DENSITY)
RINGS = (
    ("ANSYS VM67, breathing", 0, 10 * INCH, 0.05 * INCH, *STEEL_67, 3226.4, 1e-4),
    ("ANSYS VM67, order 2", 2, 10 * INCH, 0.05 * INCH, *STEEL_67, 12.496, 1e-4),
    ("NAFEMS R0015 test 6, in plane, order 2", 2, 1.0, 0.1 * np.sqrt(0.75), 2e11, 8000.0, 53.382, 2e-3),
    ("NAFEMS R0015 test 6, in plane, order 3", 3, 1.0, 0.1 * np.sqrt(0.75), 2e11, 8000.0, 150.99, 2e-3),
    ("NAFEMS R0015 test 6, in plane, order 4", 4, 1.0, 0.1 * np.sqrt(0.75), 2e11, 8000.0, 289.51, 2e-3),
    ("code_aster SDLS109, ovalization", 2, 0.369, 0.048, 1.85e11, 7800.0, 211.65, 3e-3),
    ("code_aster SDLS109, order 3", 3, 0.369, 0.048, 1.85e11, 7800.0, 598.64, 3e-3),
)
"""Name, order, radius, thickness (m), modulus (Pa), density (kg/m^3), published frequency (Hz), tolerance.

Free rings are in plane stress, so that Poisson's ratio is 0 here. The circular section of R0015, diameter d, has the bending stiffness over
mass of a rectangular one of d sqrt(3/4). Published values are those of inextensional bending; ours stretches, by (h/R)^2.
"""
DIAPHRAGMS = ((1, 0.016101), (2, 0.009382), (3, 0.022105), (4, 0.042095), (6, 0.099730), (10, 0.284436))
"""Order and omega R sqrt((1 - nu^2) rho/E) of a cylinder of length 20 R, h = R/100, nu = 0.3, one half wave along it: k = pi/(20 R)."""
LOY = "C. T. Loy, K. Y. Lam, C. Shu, Shock and Vibration 4 (1997) 193"
RING_177 = (10 * INCH, 0.25 * INCH, 30e6 * PSI, 0.0089 * DENSITY)
WATER_177 = Fluid(density=0.001156 * DENSITY, sound_speed=57480 * INCH)


@check("published-frequencies", "Published natural frequencies")
def published_frequencies(bench: Bench) -> Iterator[Finding]:
    """Compare zeros of the modal determinant, and the added mass of an annulus, with frequencies from other codes' verification manuals."""
    for name, order, radius, thickness, modulus, density, expected, tolerance in RINGS:
        found = natural_frequency(radius, thickness, modulus, density, LIGHT, order, expected)
        yield close(f"{name}, ring in vacuo", name.split(",")[0], expected, found, tolerance, unit="Hz")
    found = natural_frequency(*RING_177, WATER_177, 2, 10.198)
    yield close("ANSYS VM177, ring in water, order 2", "ANSYS VM177 (Schroeder & Marcus 1975)", 10.198, found, 2e-4, unit="Hz")
    for order, expected in DIAPHRAGMS:
        found = on_diaphragms(order, expected)
        yield close(f"cylinder on shear diaphragms, order {order}, omega R/c", LOY, expected, found, 1e-3)  # Love's theory there
    yield close(
        "ANSYS VM154, spring-held cylinder in an annulus of liquid", "ANSYS VM154 (Fritz 1972)", 1.5293, fluid_coupling(), 1e-4, unit="Hz"
    )


def natural_frequency(radius: float, thickness: float, modulus: float, density: float, outside: Fluid, order: int, near: float) -> float:
    """Return the frequency (Hz) of a ring with the modulus of plane stress, next to a guess; empty inside."""
    material = Elastic(name="published", density=density, youngs_modulus=modulus, poisson_ratio=0.0)
    mode = Modes(np.array([float(order)]))
    return zero(Shell(radius=radius, layers=[Layer(material, thickness)]), outside, mode, 2 * np.pi * near) / (2 * np.pi)


def on_diaphragms(order: int, near: float) -> float:
    """Return omega R sqrt((1 - nu^2) rho/E) of the cylinder of :data:`DIAPHRAGMS`, next to a guess."""
    modulus, density, poisson = 2e11, 7800.0, 0.3
    material = Elastic(name="published", density=density, youngs_modulus=modulus, poisson_ratio=poisson)
    per_unit = float(np.sqrt((1 - poisson**2) * density / modulus))
    mode = Modes(np.array([float(order)]), np.pi / 20)
    return per_unit * zero(Shell(radius=1.0, layers=[Layer(material, 0.01)]), LIGHT, mode, near / per_unit)


def zero(shell: Shell, outside: Fluid, mode: Modes, near: float) -> float:
    """Return the angular frequency (1/s) next to a guess at which the real part of the modal determinant vanishes; empty inside."""
    problem = dimensionless(System(shells=[shell], fluids=[VACUUM, outside], source=SHOCK))

    def determinant(frequency: float) -> float:
        s = np.array([1e-12 + 1j * frequency * problem.scales.time])
        return float(ModalSystem(problem, s, mode).determinant()[0, 0].real)

    return float(brentq(determinant, (1 - SEARCH) * near, (1 + SEARCH) * near, xtol=1e-9 * near))


def fluid_coupling() -> float:
    """Return the frequency (Hz) of a massless cylinder of 7 in on a spring of 10 lbf/in, 1 in long, in a liquid held by one of 8 in."""
    inner, outer, density, spring = 7 * INCH, 8 * INCH, 9.34e-5 * DENSITY, 10 * POUND / INCH
    walls = (RadialFunctions(np.array([1e-6 + 0j]), radius / outer, np.array([1.0])) for radius in (inner, outer))
    displaced = density * np.pi * inner**2 * INCH
    added = displaced * abs(float(annulus(*walls).aa[0, 0].real)) / (inner / outer)
    return float(np.sqrt(spring / added) / (2 * np.pi))
