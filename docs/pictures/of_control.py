"""What control can really do: the largest stress of core and ceramics against delay, corner of the amplifier and number of segments."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any

from saving import save

import coaxshell as cx
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, new_figure, style

GAINS = (0.3, 1.0, 3.0, 10.0, 30.0)
HIGHEST = (1, 2, 3, 4, 10)
"""The search of each point: derivative gains in transits, and the highest order that is fed back."""
DELAYS = (0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0)
"""Microseconds."""
CORNERS = (2.0, 5.0, 10.0, 20.0, 50.0, 200.0)
"""Kilohertz."""
COUNTS = (4, 6, 8, 12, 16, 24, 32, 48, 64, 96)
Peaks = tuple[float, float]


@cache
def pairs(loss: float) -> cx.System:
    """Return the double shell with ceramics on both faces of each wall, its materials with a loss factor, without control."""
    system = cx.presets.load("electrodes").replace(control=None)
    if not loss:
        return system
    lossy = [
        one.replace(layers=[layer.replace(material=layer.material.replace(loss_factor=loss)) for layer in one.layers])
        for one in system.shells
    ]
    return system.replace(shells=lossy)


def peaks(system: cx.System, modes: int) -> Peaks:
    """Return the largest hoop stress of the inner shell's core and of its ceramics, Pa."""
    found = cx.simulate(system, duration=3.0, time_step=1e-2, modes=modes).layer_peaks("inner", component="hoop")
    return found[1].value, max(found[0].value, found[2].value)


def best(loss: float, delay: float, corner: float) -> Peaks:
    """Return the peaks of the law that leaves the core least, of all that are stable, as parts of those without control."""
    free = pairs(loss)
    found = []
    for gain, highest in product(GAINS, HIGHEST):
        law = cx.Feedback(
            numerator=[gain * free.transit_time, 0.0],
            delay=1e-6 * delay,
            amplifier_corner=1e3 * corner,
            weights=highest,
            transducers="electrodes",
        )
        try:
            found.append(peaks(free.replace(control=law), 24))
        except cx.InputError:  # it would grow
            continue
    bare = peaks(free, 24)
    core, ceramics = min(found)
    return core / bare[0], ceramics / bare[1]


def limits(target: Path) -> None:
    """Stress of core and ceramics against delay and corner."""
    with style():
        figure = new_figure(PAGE_WIDTH, 3.0)
        axes = figure.subplots(1, 2, sharey=True)
        for loss, faint in ((0.0, 0.5), (0.05, 1.0)):
            rows = [best(loss, delay, 200.0) for delay in DELAYS]
            for part, colour, dash, k in (("core", "blue", "-", 0), ("ceramics", "orange", "--", 1)):
                label = f"{part}, loss factor {loss:g}"
                axes[0].plot(
                    range(len(DELAYS)), [row[k] for row in rows], dash, marker="o" if not loss else "s", color=COLOURS[colour],
                    alpha=faint, label=label, markersize=4,
                )  # fmt: skip
            print(loss, [f"{row[0] - 1:+.0%} {row[1] - 1:+.0%}" for row in rows])
        rows = [best(0.05, 5.0, corner) for corner in CORNERS]
        for part, colour, dash, k in (("core", "blue", "-", 0), ("ceramics", "orange", "--", 1)):
            axes[1].semilogx(CORNERS, [row[k] for row in rows], dash, marker="s", color=COLOURS[colour], label=part, markersize=4)
        axes[0].set_xticks(range(len(DELAYS)), [f"{delay:g}" for delay in DELAYS])
        axes[1].set_xticks(CORNERS, [f"{corner:g}" for corner in CORNERS])
        axes[1].minorticks_off()
        axes[0].set(xlabel="delay (µs), corner 200 kHz", ylabel="largest hoop stress / without control", ylim=(0.0, 3.2))
        axes[1].set_xlabel("corner of the amplifier (kHz), delay 5 µs")
        for ax in axes:
            ax.axhline(1.0, color=COLOURS["grey"], linewidth=0.8)
            ax.legend()
    save(figure, target, dpi=150)


def segments(target: Path) -> None:
    """Stress of core and ceramics against the number of segments, all alive and one dead."""
    bare = peaks(pairs(0.0), 100)
    with style():
        figure = new_figure(PAGE_WIDTH, 3.4)
        axes = figure.subplots(1, 2)
        for gain, colour, mark in ((2, "blue", "o"), (10, "orange", "s")):
            whole = _changes(bare, derivative=gain)
            alive = [_changes(bare, derivative=gain, segments=count) for count in COUNTS]
            dead = [_changes(bare, derivative=gain, segments=count, dead=[0]) for count in COUNTS if count <= 48]
            for k, ax in enumerate(axes):
                line: Callable[..., Any] = ax.semilogx
                line(
                    COUNTS,
                    [row[k] for row in alive],
                    "-",
                    marker=mark,
                    color=COLOURS[colour],
                    label=f"$k_d$ = {gain}, all segments alive",
                    markersize=4,
                )
                ax.axhline(whole[k], linestyle=":", color=COLOURS[colour], label=f"$k_d$ = {gain}, electrodes as fine as the orders")
                counts = COUNTS[: len(dead)]
                line(counts, [row[k] for row in dead], "--", marker=mark, color=COLOURS[colour], markerfacecolor="white",
                     label=f"$k_d$ = {gain}, the segment at the head dead", markersize=4)  # fmt: skip
        for ax, part in zip(axes, ("core", "ceramics"), strict=True):
            ax.axhline(0.0, color=COLOURS["grey"], linewidth=0.8)
            ax.set_xticks(COUNTS, [f"{count}" if count != 64 else "" for count in COUNTS])
            ax.minorticks_off()
            ax.set(title=f"{part} of the inner shell", xlabel="segments around each wall", ylabel="largest hoop stress against none (%)")
        figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    save(figure, target, dpi=163)


def _changes(bare: Peaks, **law: Any) -> Peaks:
    control = cx.PDControl(proportional=0.0, transducers="electrodes", **law)
    core, ceramics = peaks(pairs(0.0).replace(control=control), 100)
    return 100.0 * (core / bare[0] - 1.0), 100.0 * (ceramics / bare[1] - 1.0)
