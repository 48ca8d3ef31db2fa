"""A thin wall whose layers have losses: elastic walls, one for each factor g(s), that share one motion.

    K(s) = sum_f g_f(s) K_f,      sigma = sum_f g_f(s) sigma_f,

K_f and sigma_f stiffness and stress of the constituents under the factor g_f (:mod:`coaxshell.structure.constituents`), at any depth;
the first of them, under no factor, has the elastic layers and all potentials. Kernels keep the wall's mass as their leading term: with
Prony series K stays bounded as s grows, with constant Q it grows like s^{2 gamma}, far less than I s^2.

Each arm of a series holds g_i K_f of the wall as a spring on what its damper has left of the motion, x_i = (s tau_i/(1 + s tau_i)) x: it
stores (1/2) g_i x_i K_f x_i and turns g_i x_i K_f x_i/tau_i, the square of its stress over its stiffness and time, into heat.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from typing import Self

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.structure.axial import ENTRIES, AxialStiffness, axial_stiffness
from coaxshell.structure.constituents import Constituent, weighted
from coaxshell.structure.control_law import ControlLaw
from coaxshell.structure.losses import Relaxation
from coaxshell.structure.section import Section
from coaxshell.structure.shell_model import Arm, FieldGain, Gain, WallEnergy, WallMotion, WallStiffness
from coaxshell.structure.thin import wall_stiffness
from coaxshell.structure.thin_wall import ThinWall, strain_energy


@dataclass(frozen=True, kw_only=True)
class LossyWall(ThinWall):
    """A wall of thin layers of which some have losses.

    Attributes
    ----------
    parts : tuple of (Relaxation or None, Section)
        Sections of the constituents under each factor, None first.
    stiffest : Section
        With every constituent as stiff as it ever is within the run: what steps, contours and causality have to follow.
    """

    parts: tuple[tuple[Relaxation | None, Section], ...]
    stiffest: Section

    @classmethod
    def with_losses(
        cls,
        section: Section,
        constituents: tuple[Constituent, ...],
        core: int,
        gains: ControlLaw | None = None,
        *,
        wetted_faces: bool = False,
    ) -> Self:
        """Return the wall of a dimensionless section and its constituents; *core* is the number of the layer whose stress is reported."""
        factors: list[Relaxation | None] = [None, *dict.fromkeys(one.factor for one in constituents if one.factor is not None)]
        of = partial(weighted, section, constituents, core)
        parts = tuple((factor, of(lambda other, factor=factor: float(other == factor))) for factor in factors)  # type: ignore[misc]
        stiffest = of(lambda factor: 1.0 if factor is None else factor.stiffest)
        return cls(
            radius=section.radius,
            mass=section.mass,
            gains=gains,
            section=section,
            wetted_faces=wetted_faces,
            parts=parts,
            stiffest=stiffest,
        )

    @property
    def _stiffest(self) -> ThinWall:
        return ThinWall.of(self.stiffest)

    def stiffness(self, modes: Modes) -> WallStiffness:
        """Refuse: with losses a wall has no stiffness that steps could be taken with."""
        raise InputError("engine", "'direct' cannot step a wall whose layers have losses", 'use engine="spectral", or loss_factor = 0')

    def _factors(self, s: ComplexArray) -> ComplexArray:
        """Return g(s) of each part, shape (parts, nodes)."""
        return np.stack([np.ones_like(s) if factor is None else factor.at(s) for factor, _ in self.parts])

    def dynamic_stiffness(self, modes: Modes, s: ComplexArray) -> WallStiffness:
        """Return K(s) in two dimensions, each entry of shape (orders, nodes)."""
        rows = np.stack([np.stack(wall_stiffness(section, modes.orders)) for _, section in self.parts])
        return WallStiffness(*_summed(rows, self._factors(s)))

    def dynamic_axial_stiffness(self, modes: Modes, s: ComplexArray) -> AxialStiffness:
        """Return K(s) at an axial wavenumber, each entry of shape (orders, nodes)."""
        each = [axial_stiffness(section, modes) for _, section in self.parts]
        rows = np.stack([np.stack([k[a, b] for a, b in ENTRIES]) for k in each])
        return AxialStiffness(*_summed(rows, self._factors(s)))

    def highest_frequency(self, modes: Modes) -> FloatArray:
        """Return that of the wall at its stiffest."""
        return self._stiffest.highest_frequency(modes)

    def _stiffness_along(self, modes: Modes) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return those of the wall at its stiffest."""
        return self._stiffest._stiffness_along(modes)

    def fastest_wave(self, max_wavenumber: float) -> float:
        """Return that of the wall at its stiffest."""
        return self._stiffest.fastest_wave(max_wavenumber)

    @property
    def relaxes(self) -> bool:
        """True."""
        return True

    def stress_parts(self, modes: Modes, depth: float | None = None, component: str = "hoop") -> tuple[tuple[Relaxation | None, Gain], ...]:
        """Return the stress of each part, with its factor."""
        found = ((factor, ThinWall.of(section).stress_gain(modes, depth, component)) for factor, section in self.parts)
        return tuple((factor, gain) for factor, gain in found if any(np.any(x) for x in gain if x is not None))

    def field_parts(
        self, orders: FloatArray, depth: float | None = None, component: str = "hoop"
    ) -> tuple[tuple[Relaxation | None, FieldGain], ...]:
        """Return the stress of each part at a station, with its factor."""
        found = ((factor, ThinWall.of(section).field_gain(orders, depth, component)) for factor, section in self.parts)
        return tuple((factor, gain) for factor, gain in found if gain.layer is not None or any(map(np.any, gain.fields.values())))

    def energy(self, motion: WallMotion) -> WallEnergy:
        """Return the energies of a motion without what arms store: springs beside them, open-circuit stiffening, motion."""
        found = ThinWall.of(self.parts[0][1]).energy(motion)
        at_rest = (factor.series.at_rest * strain_energy(section, motion) for factor, section in self.parts if factor is not None)
        return found._replace(strain=sum(at_rest, found.strain))

    @property
    def dissipates(self) -> bool:
        """True."""
        return True

    def arms(self) -> Iterator[Arm]:
        """Yield the arms of all series."""
        for factor, section in self.parts:
            series = None if factor is None else factor.series
            for strength, time in () if series is None else zip(series.strengths, series.times, strict=True):
                yield Arm(time, partial(_stored, section, strength))


def _stored(section: Section, strength: float, motion: WallMotion) -> FloatArray:
    """Return the energy in the spring of an arm, shape (T,)."""
    return np.asarray(strength * strain_energy(section, motion))


def _summed(rows: FloatArray, factors: ComplexArray) -> ComplexArray:
    """Return sum over factors of g(s) times rows (factors, entries, orders) or (..., nodes): (entries, orders, nodes).

    Nodes may be those of each order, factors (factors, orders, nodes).
    """
    if factors.ndim == 3:
        return np.asarray(np.einsum("fem,fmn->emn", rows, factors))
    if rows.ndim == 4 or np.iscomplexobj(rows):
        return np.asarray(np.einsum("fe...n,fn->e...n", rows if rows.ndim == 4 else rows[..., None], factors))
    flat = rows.reshape(len(rows), -1).T @ np.ascontiguousarray(factors).view(np.float64)
    return np.ascontiguousarray(flat).view(np.complex128).reshape(*rows.shape[1:], factors.shape[1])
