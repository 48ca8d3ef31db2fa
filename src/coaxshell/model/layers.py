"""The layers of a wall, and the shell that they make."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from coaxshell.errors import InputError
from coaxshell.model.base import UNSTATED, Described, stated
from coaxshell.model.elastic import Elastic
from coaxshell.model.materials import AnyMaterial, Material
from coaxshell.model.piezoelectric import Piezoelectric
from coaxshell.model.units import Length

Role = Literal["core", "sensor", "charge-sensor", "actuator", "self-sensing", "passive"]
Wetted = Literal["mid-surface", "faces"]
Theory = Literal["thin", "elastic"]
PIEZOELECTRIC_ROLES = "'sensor', 'charge-sensor', 'actuator', 'self-sensing' or 'passive'"


def serves(own: str, role: str) -> bool:
    """Return whether a layer of a role of its *own* serves as a "sensor" or "actuator": a self-sensing one as both."""
    return own == role or (own == "self-sensing" and role in ("sensor", "actuator")) or (own == "charge-sensor" and role == "sensor")


class Layer(Described):
    """Describe a layer: material, thickness, and its role ("core" for elastic ones unless said otherwise)."""

    material: AnyMaterial
    """A material, or the name of one in the library."""
    thickness: Length
    """Thickness (m)."""
    role: Role = Field(default_factory=lambda data: "core" if isinstance(data["material"], Elastic) else "passive")
    """"core" bears the load; piezoelectric and wired: "sensor" (open circuit), "charge-sensor" (short circuit, read by its charge),
    "actuator", "self-sensing" (both, by a bridge); "passive": none of these."""

    def __init__(
        self,
        material: Material | str | Mapping[str, Any] = UNSTATED,
        thickness: float | str = UNSTATED,
        role: Role | None = None,
        **unknown: Any,
    ) -> None:
        given = {"material": material, "thickness": thickness, "role": UNSTATED if role is None else role}
        super().__init__(**stated(given), **unknown)

    def __repr_args__(self) -> Iterable[tuple[str | None, Any]]:
        """Name the material instead of its constants."""
        yield from ((name, self.material.name if name == "material" else value) for name, value in super().__repr_args__())

    @model_validator(mode="after")
    def _role_fits(self) -> Self:
        if isinstance(self.material, Piezoelectric):
            if "role" not in self.model_fields_set:
                raise InputError("role", f"is missing for the piezoelectric {self.material.name!r}", f"must be {PIEZOELECTRIC_ROLES}")
            if self.role == "core":
                raise InputError(
                    "role", f"'core' is not allowed for the piezoelectric {self.material.name!r}", f"must be {PIEZOELECTRIC_ROLES}"
                )
        elif self.role in ("sensor", "charge-sensor", "actuator", "self-sensing"):
            raise InputError(
                "role",
                f"{self.role!r} is not allowed for the {self.material.type} {self.material.name!r}",
                "must be 'core' or 'passive', or the material piezoelectric",
            )
        return self


class Shell(Described):
    """Describe a circular cylindrical shell by the radius of its mid-surface and its layers, from the inside out."""

    radius: Length
    """Radius of the mid-surface (m)."""
    layers: Annotated[tuple[Layer, ...], Field(min_length=1)]
    """The layers, innermost (z < 0) first."""
    wetted: Wetted = "mid-surface"
    """Where the fluids meet the wall: "mid-surface", as in the paper, or its true "faces", which is more exact for thick walls."""
    theory: Theory = "thin"
    """Theory of the wall: "thin" (Kirchhoff and Love), or its layers as "elastic" solids, wetted at the faces; for thick or soft walls."""

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if self.thickness >= self.radius:
            raise InputError(
                "layers",
                f"total thickness {self.thickness:g} m is not thin against the radius {self.radius:g} m",
                f"must be less than the radius {self.radius:g} m",
            )
        return self

    @property
    def thickness(self) -> float:
        """Total thickness of the wall (m)."""
        return sum(layer.thickness for layer in self.layers)

    @property
    def inner_radius(self) -> float:
        """Radius of the inner face, radius - thickness/2 (m)."""
        return self.radius - self.thickness / 2

    @property
    def outer_radius(self) -> float:
        """Radius of the outer face, radius + thickness/2 (m)."""
        return self.radius + self.thickness / 2

    @property
    def wetted_radii(self) -> tuple[float, float]:
        """Radii of the surfaces that the fluids inside and outside wet (m)."""
        at_faces = self.wetted == "faces" or self.theory == "elastic"
        return (self.inner_radius, self.outer_radius) if at_faces else (self.radius, self.radius)

    @property
    def core(self) -> Layer:
        """The layer whose stress is reported: the first core, else the thickest elastic layer, else the thickest layer."""
        for layer in self.layers:
            if layer.role == "core":
                return layer
        elastic = [layer for layer in self.layers if isinstance(layer.material, Elastic)]
        return max(elastic or self.layers, key=lambda layer: layer.thickness)

    @property
    def sensor(self) -> Layer | None:
        """The first layer that senses, if there is one."""
        return next(iter(self.serving("sensor")), None)

    @property
    def actuator(self) -> Layer | None:
        """The first layer that drives, if there is one."""
        return next(iter(self.serving("actuator")), None)

    def serving(self, role: str) -> list[Layer]:
        """Return the layers that serve as "sensor" or "actuator", from the inside out; self-sensing ones as both."""
        return [layer for layer in self.layers if serves(layer.role, role)]
