"""A wall as a stack of solid layers: where its faces and layers lie, how fast waves run in it, and what resolves them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.lobatto import lobatto
from coaxshell.numerics.modes import Modes
from coaxshell.structure.elastic_mesh import degree
from coaxshell.structure.shell_model import ShellModel, WallEnergy, WallMotion, WallOperator
from coaxshell.structure.solid import AXIAL, HOOP, RADIAL, SolidLayer

UNSTATED_FREQUENCY = 300.0
"""Up to which waves are resolved where no run has said so, radians per transit."""

SPARED, LEAST_SEARCHED = 4, 2
"""Degrees that the search for the largest stress does without, whose polynomials are good to 1e-3 between their points, and the least."""
SPARED_ALONG = 2
"""Those that a search along the axis does without, which reads no place between its points again: good to 3e-4."""


@dataclass(frozen=True, kw_only=True)
class LayeredWall(ShellModel):
    """A wall of solid layers, as far as their places and their numbers tell.

    Attributes
    ----------
    layers : tuple of SolidLayer
        From the inside out, dimensionless.
    core : int
        Number of the layer whose stress is reported.
    frequency : float
        Up to which waves are resolved, radians per transit; a matter of a run's resolution, not of the wall.
    """

    layers: tuple[SolidLayer, ...]
    core: int
    frequency: float = field(default=UNSTATED_FREQUENCY, compare=False)

    @classmethod
    def of(cls, layers: tuple[SolidLayer, ...], core: int) -> Self:
        """Return the wall of dimensionless layers."""
        radius = 0.5 * (layers[0].inner + layers[-1].outer)
        mass = sum(0.5 * layer.density * (layer.outer**2 - layer.inner**2) for layer in layers) / radius
        return cls(radius=radius, mass=mass, layers=layers, core=core)

    def resolving(self, frequency: float) -> Self:
        """Return the wall with degrees for waves up to a frequency, radians per transit."""
        return replace(self, frequency=frequency)

    @property
    def wetted(self) -> tuple[float, float]:
        """Radii of its faces."""
        return self.layers[0].inner, self.layers[-1].outer

    @property
    def faces(self) -> tuple[float, float]:
        """Depths of its inner and its outer face."""
        return self.layers[0].inner - self.radius, self.layers[-1].outer - self.radius

    @property
    def faces_move_alike(self) -> bool:
        """No."""
        return False

    @property
    def design_depth(self) -> float:
        """Depth whose stress is reported unless another is asked for: the middle of the wall if its core is there, else the core's."""
        core = self.layers[self.core]
        inside = core.inner <= self.radius <= core.outer
        return 0.0 if inside else 0.5 * (core.inner + core.outer) - self.radius

    def points(self, order: float, wavenumber: float = 0.0, spared: int = SPARED) -> tuple[FloatArray, ...]:
        """Return depths of each layer, from the inside out, through which a polynomial holds its stress up to an order and wavenumber.

        Gauss-Lobatto points of a degree so much below that of the displacements, which resolves waves to 1e-6. Between two layers
        the outer one is meant at a depth: the last point of a layer lies within it by a hair.
        """
        found, hair = [], 1e-8 * (self.layers[-1].outer - self.layers[0].inner)
        for layer in self.layers:
            rule = lobatto(max(LEAST_SEARCHED, self.degree_of(layer, order, wavenumber) - spared))
            depths = layer.inner - self.radius + 0.5 * layer.thickness * (1.0 + rule.points)
            depths[-1] = layer.outer - self.radius - (0.0 if layer is self.layers[-1] else hair)
            found.append(depths)
        return tuple(found)

    def degree_of(self, layer: SolidLayer, order: float, wavenumber: float = 0.0) -> int:
        """Return the degree that resolves the waves of a layer up to an order and an axial wavenumber."""
        return degree(layer, order, wavenumber, self.frequency)

    def layer_at(self, depth: float) -> int:
        """Return the number of the layer at a depth; between two layers the outer one is meant, but for the core at its design depth."""
        radius, slack = self.radius + depth, 1e-9 * (self.layers[-1].outer - self.layers[0].inner)
        return next((i for i, layer in enumerate(self.layers) if radius < layer.outer - slack), len(self.layers) - 1)

    @property
    def piezoelectric(self) -> tuple[int, ...]:
        """Numbers of the piezoelectric layers, from the inside out."""
        return tuple(i for i, layer in enumerate(self.layers) if layer.coupling is not None)

    def shape_count(self, order: float, wavenumber: float) -> int:
        """Return how many shapes there are in a wave along the axis."""
        return 3 * (1 + sum(degree(layer, order, wavenumber, self.frequency) for layer in self.layers))

    def highest_frequency(self, modes: Modes) -> FloatArray:
        """Return the frequency at which each order stretches along the wall, that of its fastest layer's plate waves."""
        return np.asarray(self.plate_speed * np.sqrt(modes.gradient_squared(self.radius)))

    @property
    def plate_speed(self) -> float:
        """Speed of stretching waves along the wall at low frequencies, sqrt(sum of t (c22 - c23^2/c33) per mass)."""
        moduli = [x.stiffness[HOOP][HOOP] - x.stiffness[HOOP][RADIAL] ** 2 / x.stiffness[RADIAL][RADIAL] for x in self.layers]
        stiff = sum(x.thickness * modulus for x, modulus in zip(self.layers, moduli, strict=True))
        return math.sqrt(stiff / sum(x.thickness * x.density for x in self.layers))

    def fastest_wave(self, max_wavenumber: float) -> float:
        """Return the speed of the fastest pressure wave of any layer."""
        return max(math.sqrt(x.stiffness[AXIAL][AXIAL] / x.density) for x in self.layers)

    @property
    def crossing_order(self) -> float:
        """R sqrt(12)/t, about where stretching and bending frequencies of a thin wall of one layer would cross."""
        return self.radius * math.sqrt(12.0) / (self.faces[1] - self.faces[0])

    def passive(self, modes: Modes, s: ComplexArray) -> WallOperator:
        """Refuse: two faces have no one impedance."""
        raise NotImplementedError("the faces of an elastic wall move differently: it answers by receptances")

    def energy(self, motion: WallMotion) -> WallEnergy:
        """Refuse: the energy of a solid wall needs its motion through the thickness."""
        raise NotImplementedError("the energy of an elastic wall is that of its shapes")
