"""The paper's three limiting cases (its Fig. 2) under a shock: steel shells that are known from elsewhere.

An evacuated one (Figs. 2a and 2b, after Iakovlev 2008, a plane wave); one with water inside and outside (Fig. 2c, after Iakovlev 2014); two
of them, the inner one evacuated (Figs. 2d and 2e, after Iakovlev 2015).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from coaxshell.apps.verification.bench import Bench, tables
from coaxshell.apps.verification.checks.independent import compare
from coaxshell.apps.verification.loads import surface_pressure
from coaxshell.apps.verification.paper_histories import SIDES, both_sides, extremum, history, least_stress
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Curve, Finding, Panel, Sheet, close, distance, within
from coaxshell.apps.verification.systems import SMOOTH
from coaxshell.model import presets
from coaxshell.model.fluids import VACUUM, Fluid
from coaxshell.model.sources import PlaneShock, SphericalWave
from coaxshell.model.system import System
from coaxshell.numerics.laplace_grid import LaplaceGrid

THICKNESS, PEAK, DECAY = 1e-2, 250e3, 1.314e-4
SOURCE = "reference/README.md, four digits"
THICKNESSES = {5e-3: "sky", 1e-2: "blue", 2e-2: "green", 4e-2: "orange"}
"""In metres, with a colour each: the paper shows several and names none, these are ours."""


@check("paper-evacuated", "Paper's Fig. 2a, 2b: evacuated single shell")
def paper_evacuated(bench: Bench) -> Iterator[Finding]:
    """Compare displacement and stress with four-digit values, and vacuum with the paper's "negligibly small" density.

    Figs. 2a and 2b themselves are not available as numbers; their histories are drawn here with ours.
    """
    stored = tables()["evacuated-shock"]
    system = presets.load("iakovlev-evacuated")
    response = bench.simulate(system, duration=5.0, time_step=1e-3, modes=300)
    head = history(response, "displacement", "outer", "head") / THICKNESS
    yield close("head: w/h at t = 1", SOURCE, stored["w_head_at_1"], float(head[1000]), 1.2e-4)
    yield close("head: largest w/h", SOURCE, stored["w_head_peak"][1], float(head.max()), 1.2e-4)
    yield close(
        "head: time of it",
        SOURCE,
        stored["w_head_peak"][0],
        float(response.time[head.argmax()]),
        5e-3,
        unit="a/c",
        measure="absolute",
    )
    for side in ("head", "tail"):
        yield from least_stress(response, "outer", side, side, SOURCE, stored[f"stress_{side}"], 2.5e-4)
    rest = bench.simulate(system, duration=60.0, time_step=1e-2, modes=8)
    ends = [float(history(rest, "displacement", "outer", side)[-1]) / THICKNESS for side in ("head", "tail")]
    yield close("w/h at rest, half of head minus tail", "reference/README.md; impulse", stored["w_final"], (ends[0] - ends[1]) / 2, 1e-4)
    exact = bench.simulate(system, duration=2.0, time_step=4e-3, modes=40)
    for density, limit in ((1e-2, 1e-4), (1e-4, 1e-6)):
        gas = system.replace(fluids=[Fluid(density=density, sound_speed=1.0), system.exterior])
        emulated = bench.simulate(gas, duration=2.0, time_step=4e-3, modes=40)
        error = distance(history(emulated, "displacement", "outer", "head"), history(exact, "displacement", "outer", "head"))
        yield within(
            f"gas of {density:g} kg/m³ and 1 m/s inside, as the paper emulates it: head",
            "paper, Model verification",
            "vacuum's",
            error,
            limit,
        )
    yield Sheet(
        "Fig. 2a, 2b: evacuated single shell, plane shock of 250 kPa",
        "Left: incident plus diffracted pressure over the peak, without the shell's own motion. Dots: reference values.",
        [
            Panel("incident + diffracted pressure", "time (a/c)", "(p0 + pd) / peak", _surface()),
            Panel(
                "displacement",
                "time (a/c)",
                "w / h",
                [*both_sides(response, "displacement", "outer", 1 / THICKNESS), extremum("reference", stored["w_head_peak"], "head")],
            ),
            Panel(
                "hoop stress (Eq. 22)",
                "time (a/c)",
                "stress (MPa)",
                [
                    *both_sides(response, "stress", "outer", 1e-6),
                    *(extremum("reference", stored[f"stress_{side}"], side) for side in ("head", "tail")),
                ],
            ),
        ],
    )


def _surface() -> list[Curve]:
    grid, modes = LaplaceGrid(2e-3, 2500), 250
    modal = grid.invert(surface_pressure(PlaneShock(peak_pressure=PEAK, decay_time=DECAY), grid, modes, PEAK), grid.lanczos())
    weights = np.sinc(np.arange(modes + 1) / (modes + 1.0))
    curves = []
    for angle, colour in ((0.0, "blue"), (90.0, "green"), (180.0, "orange")):
        curves.append(Curve(f"{angle:g}°", grid.time, (weights * np.cos(np.radians(angle) * np.arange(modes + 1))) @ modal, colour=colour))
    return curves


@check("paper-filled", "Paper's Fig. 2c: fluid-filled single shell")
def paper_filled(bench: Bench) -> Iterator[Finding]:
    """Compare several thicknesses with the independent method, and with the paper's way of making the case: a tiny inner shell.

    The paper names no thickness and its figure is not available as numbers; the thicknesses are ours and the histories are drawn.
    """
    chosen = bench.choose([1e-2], list(THICKNESSES))
    for thickness in chosen:
        smooth = _shell(thickness).replace(source=SphericalWave(distance=5.0, pulse=SMOOTH))
        yield within(
            f"thickness {1e3 * thickness:g} mm, smooth pulse, M = 8: worst history",
            "independent: spectral elements in r, Gauss in t",
            "the other method's",
            compare(bench, smooth, 1e-3, 2e-3),
            5e-7,
        )
    single = presets.load("iakovlev-filled")
    settings = {"duration": 4.0, "time_step": 4e-3, "modes": 40}
    exact = bench.simulate(single, **settings)
    for radius, limit in ((0.1, 2e-2), (0.01, 2e-4)):
        tiny = single.replace(
            shells=[single.shells[0].replace(radius=radius, layers=_layers(radius / 100)), single.shells[0]],
            fluids=[VACUUM, single.fluids[0], single.fluids[1]],
        )
        emulated = bench.simulate(tiny, **settings)
        error = max(distance(history(emulated, "displacement", "outer", s), history(exact, "displacement", "outer", s)) for s in SIDES)
        yield within(
            f"double shell with an inner radius of {radius:g} m: outer shell",
            "paper, Model verification",
            "the single shell's",
            error,
            limit,
        )
    yield _sheet(bench)


def _layers(thickness: float) -> list[object]:
    layer = presets.load("iakovlev-filled").shells[0].layers[0]  # type: ignore[union-attr]
    return [layer.replace(thickness=thickness)]


def _shell(thickness: float) -> System:
    return presets.load("iakovlev-filled").replace_path("shells[0].layers[0].thickness", thickness)


def _sheet(bench: Bench) -> Sheet:
    panels: dict[str, list[Curve]] = {side: [] for side in SIDES}
    for thickness, colour in THICKNESSES.items():
        response = bench.simulate(_shell(thickness), duration=8.0, time_step=4e-3, modes=bench.choose(40, 100))
        for side, curves in panels.items():
            w = history(response, "displacement", "outer", side) / thickness
            curves.append(Curve(f"h = {1e3 * thickness:g} mm", np.asarray(response.time), 1e3 * w, colour=colour))
    return Sheet(
        "Fig. 2c: fluid-filled single shell, spherical shock of 25 kPa, decay time 3.76 ms",
        "Displacement over thickness at head and tail; water of 1470 m/s inside and outside.",
        [Panel(side, "time (a/c)", "w / h (1e-3)", curves) for side, curves in panels.items()],
    )


@check("paper-double", "Paper's Fig. 2d, 2e: double shell, inner one evacuated")
def paper_double(bench: Bench) -> Iterator[Finding]:
    """Compare the least stresses of both shells and their times with four-digit values, plane shock of 250 kPa.

    The figures themselves are not available as numbers; their histories are drawn here with ours.
    """
    stored = tables()["double-shock"]
    response = bench.simulate(presets.load("iakovlev-double"), duration=5.0, time_step=1e-3, modes=300)
    panels = []
    for shell in ("outer", "inner"):
        for side in SIDES:
            pair = stored[f"{shell}_{side}"]
            yield from least_stress(response, shell, side, f"{shell} {side}", SOURCE, pair, 3.5e-4)
    for shell in ("inner", "outer"):
        panels.append(
            Panel(f"{shell} shell: displacement", "time (a/c)", "w / h", both_sides(response, "displacement", shell, 1 / THICKNESS))
        )
        marks = [extremum("reference", stored[f"{shell}_{side}"], side) for side in SIDES]
        curves = [*both_sides(response, "stress", shell, 1e-6), *marks]
        panels.append(Panel(f"{shell} shell: hoop stress (Eq. 22)", "time (a/c)", "stress (MPa)", curves))
    yield Sheet(
        "Fig. 2d, 2e: double shell with a hollow inner shell, plane shock of 250 kPa",
        "Dots: reference minima of the stress.",
        panels,
    )
