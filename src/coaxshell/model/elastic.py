"""Isotropic elastic material, with or without losses."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import SerializerFunctionWrapHandler, model_serializer

from coaxshell.model.base import Described
from coaxshell.model.losses import REFERENCE_FREQUENCY, Frequency, LossFactor, LossModel, written
from coaxshell.model.units import Density, Modulus, quantity


class Elastic(Described):
    """Describe an isotropic, linearly elastic material; in plane strain its modulus is E/(1 - nu^2)."""

    type: Literal["elastic"] = "elastic"
    name: str = "elastic"
    """What the material is called; in a file the name of its table."""
    density: Density
    """Mass per volume (kg/m^3)."""
    youngs_modulus: Modulus
    """Young's modulus E (Pa)."""
    poisson_ratio: Annotated[float, quantity("number", above=-1, below=0.5)]
    """Poisson's ratio nu, between -1 and 0.5."""
    loss_factor: LossFactor = 0.0
    """Loss factor eta of its moduli, the same at all frequencies of a run, from 0 (no losses) to 1."""
    reference_frequency: Frequency = REFERENCE_FREQUENCY
    """Frequency at which the moduli have the magnitudes given (Hz): with losses they grow with the frequency."""
    loss_model: LossModel = "prony"
    """How losses are carried: "prony" fits a series of springs and dampers over the band of the run, "constant-q" is a power law."""
    strength: Modulus | None = None
    """Stress that it stands (Pa): yield strength of a metal, tensile strength of a ceramic; margins are told against it."""
    reference: str = ""
    """Where the constants come from."""

    @model_serializer(mode="wrap")
    def _without_idle_losses(self, handler: SerializerFunctionWrapHandler) -> dict[str, Any]:
        return written(handler(self))
