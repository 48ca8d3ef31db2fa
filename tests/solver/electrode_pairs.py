"""The preset "electrodes" with walls of either theory, for tests that put them beside each other."""

from __future__ import annotations

from typing import Any

import coaxshell as cx

PAIRS = cx.presets.load("electrodes")
BOTH = ("elastic", "elastic")


def pairs(theories: tuple[str, str] = BOTH, loss_factor: float = 0.0, scale: float = 1.0, numerator: Any = None, **law: Any) -> cx.System:
    """Return pairs of electrodes under a lead, walls of two theories, all layers with a loss factor and *scale* times as thick."""
    shells = []
    for shell, theory in zip(PAIRS.shells, theories, strict=True):
        layers = []
        for layer in shell.layers:
            standard = {"permittivity_reduction": "standard"} if isinstance(layer.material, cx.Piezoelectric) else {}
            material = layer.material.replace(loss_factor=loss_factor, **standard)
            layers.append(layer.replace(material=material, thickness=scale * layer.thickness))
        shells.append(shell.replace(layers=layers, theory=theory, **({"wetted": "faces"} if theory == "thin" else {})))
    control = cx.Feedback(numerator=numerator or [2 * PAIRS.transit_time, 3], transducers="electrodes", **law)
    return PAIRS.replace(shells=shells, control=control)
