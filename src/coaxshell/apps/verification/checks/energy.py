"""Energy: what the exterior pressure does on the outer shell is stored, dissipated or taken by the actuators."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Curve, Finding, Panel, Sheet, at_least, value, within
from coaxshell.model import presets
from coaxshell.response.energy import energy as energy_of

LIMITS = {"bare": 5e-6, "active": 5e-6, "absorbers": 5e-5, "hybrid": 5e-5}
"""Largest closure residual over the largest work; with cubic springs it is the march's own error, of second order."""

SOURCE = "theory 10: first law"
EVERY = 0.04
"""Energies are taken so often, in transits."""


@check("energy", "Energy closure")
def energy(bench: Bench) -> Iterator[Finding]:
    """Work of the exterior pressure = energy of shells, fluids, springs and masses + dissipation + work of the actuators, at all times."""
    settings: dict[str, Any] = {"duration": 2.0, "modes": bench.choose(12, 24)}
    closures, shown = [], None
    chosen = {name: LIMITS[name] for name in bench.choose(("bare", "hybrid"), tuple(LIMITS))}
    for number, (name, limit) in enumerate(chosen.items()):
        system = presets.load(name)
        residuals = []
        for step in (4e-3, 2e-3, 1e-3) if limit > 2e-5 and not bench.quick else (2e-3,):
            balance = energy_of(bench.simulate(system, time_step=step, **settings).solution, every=round(EVERY / step))
            residuals.append(float(np.abs(balance["closure_relative"]).max()))
        work = float(np.abs(balance["exterior_work"]).max())
        what = f"{name}: residual at any time, over the largest work"
        yield within(
            what, SOURCE, "0", residuals[-1], limit, found=f"{residuals[-1]:.2g} of {value(work, 'J/m')}", measure="relative, largest"
        )
        if len(residuals) > 1:
            yield at_least(
                f"{name}: order of the residual in dt, 4e-3 to 1e-3",
                "theory 7: 2, once above the linear part's floor",
                1.6,
                float(np.log2(residuals[0] / residuals[-1]) / 2),
            )
        closures.append(Curve(name, balance["time"].values, np.log10(np.maximum(np.abs(balance["closure_relative"].values), 1e-14))))
        shown = balance
        bench.done((number + 1) / len(chosen))
    assert shown is not None
    panels = [_shares(shown), Panel("closure residual / largest work", "time (a/c)", "log10", closures)]
    yield Sheet("Energy of the hybrid system, and closure", "Stores, losses and actuators add up to the work done.", panels)


def _shares(balance: Any) -> Panel:
    time = balance["time"].values
    by_role = {role: [v for v in balance.data_vars.values() if v.attrs["role"] == role] for role in ("store", "loss")}
    fluids = sum(v.values for v in by_role["store"] if "fluid" in v.attrs["group"])
    stores = sum(v.values for v in by_role["store"])
    losses = {v.attrs["group"]: v.values for v in by_role["loss"]}
    curves = [
        Curve("work of the exterior pressure", time, balance["exterior_work"].values),
        Curve("stored", time, np.asarray(stores)),
        Curve("of these in fluids", time, np.asarray(fluids)),
        *(Curve({"actuators": "taken by actuators"}.get(group, f"lost in {group}"), time, values) for group, values in losses.items()),
    ]
    return Panel("hybrid", "time (a/c)", "energy (J/m)", curves)
