"""Adding orders: how fast what is left out decays."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Curve, Finding, Panel, Sheet, at_least, close, distance, orders, within
from coaxshell.model import presets
from coaxshell.model.pulses import Gaussian
from coaxshell.model.sources import PlaneWave, Source
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.response import Response
from coaxshell.response.synthesis import mean_square

CUTS = (15, 30, 60, 120)
LEAST = {("outer", "displacement"): 1.4, ("outer", "stress"): 0.5, ("inner", "stress"): 0.9}
"""Least order in 1/M; the outer stress is the membrane wave's, whose modal stress hardly decays from m = 100 to 250."""

PAPER = {"outer": 1.2e-3, "inner": 9e-5}
"""What the orders from 151 to 255 add to the stress (theory 7)."""


@check("modes", "Convergence in the number of orders")
def modes(bench: Bench) -> Iterator[Finding]:
    """Double M: the norm over surface and time of the orders above a cut, out of many more, and what M = 150 leaves out."""
    many = bench.choose(300, 400)
    response = bench.simulate(presets.load("bare"), duration=bench.choose(3.0, 5.0), time_step=2e-3, modes=many)
    curves = []
    for (shell, quantity), least in LEAST.items():
        left = np.array([_left_out(response, shell, quantity, cut) for cut in CUTS])
        yield at_least(
            f"{quantity}, {shell} shell: least order in 1/M, M = 15 to 120",
            f"theory 10; against M = {many}",
            least,
            float(orders(left).min()),
        )
        curves.append(Curve(f"{quantity}, {shell}", np.array(CUTS, float), left))
    yield from _paper(bench)
    smooth: Source = PlaneWave(pulse=Gaussian(peak_pressure=2.5e4, width=8e-5))
    pulse = bench.simulate(presets.load("bare").replace(source=smooth), duration=3.0, time_step=2e-3, modes=160)
    left = np.array([_left_out(pulse, "outer", "stress", cut) for cut in CUTS])
    yield at_least("smooth pulse, outer stress: order from M = 15 to 30", "theory 10", 5.0, float(orders(left)[0]))
    yield within("smooth pulse, outer stress: left out at M = 60", "theory 10", "0", float(left[2]), 1e-7)
    curves.append(Curve("stress, outer, smooth pulse", np.array(CUTS, float), np.maximum(left, 1e-12)))
    yield Sheet(
        "Convergence in the number of orders",
        "Relative L2 norm, over surface and time, of all orders above M.",
        [Panel("", "M", "left out", curves, logarithmic=True)],
    )


def _paper(bench: Bench) -> Iterator[Finding]:
    """Compare M = 150 with M = 255 in the stress at head and tail."""
    few, more = (bench.simulate(presets.load("bare"), duration=5.0, time_step=2e-3, modes=m) for m in (150, 255))
    for shell, expected in PAPER.items():
        found = distance(few.stress(shell), more.stress(shell))
        what = f"stress, {shell} shell, head and tail: what M = 150 leaves out of M = 255"
        yield close(what, "theory 7, two digits and one", expected, found, 0.1)


def _left_out(response: Response, shell: str, quantity: str, cut: int) -> float:
    """Return the norm over surface and time of the orders above a cut, over that of all orders."""
    modal: FloatArray = np.asarray(response.modal(shell, quantity))
    tail = modal.copy()
    tail[:, : cut + 1] = 0.0
    return float(np.sqrt(mean_square(tail).sum() / mean_square(modal).sum()))
