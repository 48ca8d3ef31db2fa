"""Piezoelectric material by its three-dimensional constants, poled along the radius (axis 3)."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import SerializerFunctionWrapHandler, model_serializer, model_validator

from coaxshell.errors import InputError
from coaxshell.model.base import Described
from coaxshell.model.losses import REFERENCE_FREQUENCY, Frequency, LossFactor, LossModel, written
from coaxshell.model.units import Density, Modulus, quantity

Stiffness = Annotated[float, quantity("stress")]
ChargePerArea = Annotated[float, quantity("charge density")]
Permittivity = Annotated[float, quantity("permittivity", above=0)]
Field = Annotated[float, quantity("electric field", above=0)]


class Piezoelectric(Described):
    """Describe a piezoelectric ceramic poled along 3 (radial), with 2 along the hoop and 1 along the axis.

    The shell uses the constants reduced by sigma_33 = 0 (paper, Eq. A.11):
    c22 - c23^2/c33, e32 - c23 e33/c33, and the permittivity chosen by *permittivity_reduction*.
    """

    type: Literal["piezoelectric"] = "piezoelectric"
    name: str = "piezoelectric"
    """What the material is called; in a file the name of its table."""
    density: Density
    """Mass per volume (kg/m^3)."""
    c22: Modulus
    """Hoop stiffness at constant field (Pa)."""
    c23: Stiffness
    """Hoop-radial stiffness at constant field (Pa)."""
    c33: Modulus
    """Radial stiffness at constant field (Pa)."""
    e32: ChargePerArea
    """Hoop piezoelectric stress constant (C/m^2)."""
    e33: ChargePerArea
    """Radial piezoelectric stress constant (C/m^2)."""
    permittivity_22: Permittivity
    """Hoop permittivity at constant strain (F/m)."""
    permittivity_33: Permittivity
    """Radial permittivity at constant strain (F/m)."""
    c11: Modulus | None = None
    """Axial stiffness (Pa); needed in three dimensions alone."""
    c12: Stiffness | None = None
    """Axial-hoop stiffness (Pa); needed in three dimensions alone."""
    c13: Stiffness | None = None
    """Axial-radial stiffness (Pa); needed in three dimensions alone."""
    c66: Modulus | None = None
    """Axial-hoop shear stiffness (Pa); needed in three dimensions alone."""
    c44: Modulus | None = None
    """Shear stiffness along the radius, on axis and hoop alike (Pa); needed of elastic solids alone."""
    e31: ChargePerArea | None = None
    """Axial piezoelectric stress constant (C/m^2); needed in three dimensions alone."""
    e15: ChargePerArea | None = None
    """Shear piezoelectric stress constant, on axis and hoop alike (C/m^2); needed of elastic solids alone."""
    permittivity_11: Permittivity | None = None
    """Axial permittivity (F/m); needed in three dimensions alone."""
    permittivity_reduction: Literal["standard", "printed"] = "standard"
    """Reduced radial permittivity: "standard" is mu33 + e33^2/c33, "printed" is the paper's mu33 - e33^2/c33."""
    actuator_coupling: Literal["plane-stress", "printed"] = "plane-stress"
    """Coupling of the actuator: "plane-stress" is e32 - c23 e33/c33, "printed" is the paper's bare e32 (Eq. 4)."""
    field_limit: Field = 590e3
    """Largest electric field the material stands before it depoles (V/m); 590 V/mm is PZT-4's."""
    loss_factor: LossFactor = 0.0
    """Loss factor eta of its stiffness, the same at all frequencies of a run, from 0 (no losses) to 1; the fields lose nothing."""
    reference_frequency: Frequency = REFERENCE_FREQUENCY
    """Frequency at which the stiffness has the magnitudes given (Hz): with losses it grows with the frequency."""
    loss_model: LossModel = "prony"
    """How losses are carried: "prony" fits a series of springs and dampers over the band of the run, "constant-q" is a power law."""
    strength: Modulus | None = None
    """Stress that it stands (Pa): yield strength of a metal, tensile strength of a ceramic; margins are told against it."""
    reference: str = ""
    """Where the constants come from."""

    @model_serializer(mode="wrap")
    def _without_idle_losses(self, handler: SerializerFunctionWrapHandler) -> dict[str, Any]:
        return written(handler(self))

    @model_validator(mode="after")
    def _stable(self) -> Self:
        if self.c22 * self.c33 <= self.c23**2:
            raise InputError(
                "c23",
                f"{self.c23!r} Pa makes the material unstable: c23^2 = {self.c23**2:g} is not below c22*c33 = {self.c22 * self.c33:g}",
                "must satisfy c23^2 < c22*c33",
            )
        correction = self.e33**2 / self.c33
        if self.permittivity_reduction == "printed" and self.permittivity_33 <= correction:
            raise InputError(
                "permittivity_33",
                f"{self.permittivity_33!r} F/m is not above e33^2/c33 = {correction:g} F/m, so the printed reduction is not positive",
                'must be greater than e33^2/c33, or use permittivity_reduction = "standard"',
            )
        return self
