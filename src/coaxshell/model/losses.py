"""Losses of a material, as they are described: a loss factor, the frequency at which its moduli hold, and the model that carries both."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from coaxshell.model.units import Frequency, quantity

LossFactor = Annotated[float, quantity("number", least=0, most=1)]
LossModel = Literal["prony", "constant-q"]
REFERENCE_FREQUENCY = 1000.0
"""Hz; the middle of what shocks on shells of a metre excite."""

LOSSES: dict[str, Any] = {"loss_factor": 0.0, "reference_frequency": REFERENCE_FREQUENCY, "loss_model": "prony"}
"""Entries of a material's losses and what they are unless given."""

__all__ = ["LOSSES", "REFERENCE_FREQUENCY", "Frequency", "LossFactor", "LossModel", "written"]


def written(entries: dict[str, Any]) -> dict[str, Any]:
    """Return the entries of a material as they are written: losses that change nothing are left out, as before there were any."""
    if entries.get("loss_factor", 0.0) == 0.0:
        return {name: value for name, value in entries.items() if name not in LOSSES}
    return entries
