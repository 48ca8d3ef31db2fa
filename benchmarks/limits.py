"""Runs whose voltages stop at a limit, at the paper's resolution and at that of a preview, beside the same runs without a limit.

Aim: 3 s at the paper's resolution (M = 150, dt = 1e-3, T = 5) and 0.5 s at a preview (M = 60, dt = 4e-3) on two quiet cores.
"""

from __future__ import annotations

import coaxshell as cx
from benchmarks.measure import medians

PRESETS = ("active", "hybrid", "electrodes")
LIMITS = (590e3, 10e3)
"""V/m: PZT-4's, and one that all voltages reach."""
RESOLUTIONS = {"paper": {"modes": 150, "time_step": 1e-3}, "preview": {"modes": 60, "time_step": 4e-3}}


def limited(preset: str, field_limit: float) -> cx.System:
    """Return a preset whose actuators saturate at a field."""
    return cx.presets.load(preset).with_overrides({"control.saturation": True, "control.field_limit": field_limit})


def main(repeats: int = 3) -> None:
    """Print medians of whole cold runs."""
    for name, resolution in RESOLUTIONS.items():
        for preset in PRESETS:
            systems = [cx.presets.load(preset), *(limited(preset, field) for field in LIMITS)]
            calls = [lambda one=one, at=resolution: cx.simulate(one, duration=5.0, **at) for one in systems]
            free, *stopped = medians(calls, repeats)
            told = ", ".join(f"{seconds:.2f} s at {field / 1e3:g} V/mm" for field, seconds in zip(LIMITS, stopped, strict=True))
            print(f"{name}, {preset}: {free:.2f} s without a limit, {told}", flush=True)


if __name__ == "__main__":
    main()
