"""The bare double shell against reference/bare_double_shell.npz."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from coaxshell.apps.verification.bench import Bench, bare_double_shell
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Curve, Finding, Panel, Sheet, distance, value, within
from coaxshell.model import materials, presets
from coaxshell.model.shells import Shell
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.response import Response

SOURCE = "reference/bare_double_shell.npz"
SIDES = {"head": 0.0, "tail": 180.0}
LIMITS = {"displacement": 4e-7, "stress": 1e-6}
MODAL = (0, 1, 2, 5, 20, 80)


def without_stiffening() -> System:
    """Return the paper's bare system without piezoelectric stiffening: mass and stiffness of the layers kept, E_32 = 0."""
    inert = materials.PZT4.replace(e32=0.0, e33=0.0)
    bare = presets.load("bare")
    shells = [
        shell.replace(layers=[layer.replace(material=inert) if layer.role != "core" else layer for layer in shell.layers])
        for shell in bare.shells
        if isinstance(shell, Shell)
    ]
    return bare.replace(shells=shells)


@check("reference-histories", "Reference histories of the bare double shell")
def reference_histories(bench: Bench) -> Iterator[Finding]:
    """Compare with spectral elements in r and implicit Gauss integration in time: no Laplace transform, no Bessel function there.

    M = 150, t = 0 to 5.
    """
    stored = bare_double_shell()
    response = bench.simulate(without_stiffening(), duration=5.0, time_step=bench.choose(2e-3, 1e-3), modes=150)
    bench.done(0.8)
    at = np.round(stored["time"] / response.settings.time_step).astype(int)
    relax = bench.choose(40.0, 1.0)
    panels = []
    for quantity, limit in LIMITS.items():
        for shell in ("inner", "outer"):
            curves = []
            for side, angle in SIDES.items():
                found, expected = _history(response, quantity, shell, angle), stored[f"{quantity}_{shell}_{side}"]
                unit = "Pa" if quantity == "stress" else "a"
                peaks = [value(float(h[np.abs(h).argmax()]), unit) for h in (expected, found[at])]
                yield within(
                    f"{quantity} history, {shell} {side} (peak shown)",
                    SOURCE,
                    peaks[0],
                    distance(found[at], expected),
                    limit * relax,
                    found=peaks[1],
                )
                scale = 1e-6 if quantity == "stress" else 1e6
                curves += _curves(side, response.time, found * scale, stored["time"], expected * scale)
            label = "hoop stress (MPa)" if quantity == "stress" else "displacement / a (1e-6)"
            panels.append(Panel(f"{shell} shell", "time (a/c)", label, curves))
    yield from _modal_rows(response, stored, at, relax)
    yield Sheet(
        "Bare double shell against the stored reference",
        "Lines: coaxshell, spectral engine. Dots: stored histories of an independent method, every 0.1 transits.",
        panels,
    )


def _history(response: Response, quantity: str, shell: str, angle: float) -> FloatArray:
    return np.asarray(getattr(response, quantity)(shell, [angle]))[:, 0]


def _curves(side: str, time: FloatArray, ours: FloatArray, at: FloatArray, theirs: FloatArray) -> list[Curve]:
    colour = "blue" if side == "head" else "orange"
    return [
        Curve(f"{side}, coaxshell", time, ours, colour=colour),
        Curve(f"{side}, reference", at[::5], theirs[::5], "points", colour=colour),
    ]


def _modal_rows(response: Response, stored: dict[str, FloatArray], at: FloatArray, relax: float) -> Iterator[Finding]:
    """Compare single orders; high ones are small and held to a fraction of the whole displacement."""
    for component, histories in (("W", response.solution.normal), ("V", response.solution.tangential)):
        for index, shell in enumerate(("inner", "outer")):
            whole = float(np.linalg.norm(stored[f"displacement_{shell}_head"]))
            errors = [float(np.linalg.norm(histories[index, 0, m, at] - stored[f"{component}_{shell}_{m}"])) / whole for m in MODAL]
            yield within(
                f"modal amplitudes {component}, {shell} shell, m = {', '.join(map(str, MODAL))}",
                SOURCE,
                "stored histories",
                max(errors),
                5e-7 * relax,
                measure="L2, of the head's displacement",
            )
