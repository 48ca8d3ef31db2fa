"""The paper's first limiting case (its Figs. 2a and 2b, after Iakovlev 2008): an evacuated steel shell under a plane wave."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from coaxshell.apps.verification.bench import Bench, tables
from coaxshell.apps.verification.loads import surface_pressure
from coaxshell.apps.verification.paper_histories import both_sides, extremum, history, least_stress
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Curve, Finding, Panel, Sheet, close, distance, within
from coaxshell.model import presets
from coaxshell.model.fluids import Fluid
from coaxshell.model.sources import PlaneShock
from coaxshell.numerics.laplace_grid import LaplaceGrid

THICKNESS, PEAK, DECAY = 1e-2, 250e3, 1.314e-4
SOURCE = "reference/README.md, four digits"


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
