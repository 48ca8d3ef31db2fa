"""What the stiffness of a layered wall consists of where layers have losses: elastic parts, each under one factor g(s).

    Q(s) = sum over constituents of g(s) Q,      K(s) = sum over factors of g(s) K,

K the stiffness of a wall of all constituents under one factor, which neither knows losses nor s. A layer with a loss factor is one
constituent, all of its moduli together. A rubber, whose shear modulus G relaxes and whose bulk modulus K_b does not, is two: free of
radial stress

    Q_11 = Q_22 = G + h,      Q_12 = h - G,      Q_66 = G,      h = 9 K_b G/(3 K_b + 4 G),

both of which are Prony series, G by description and h = (9/4) K_b - (27/4) K_b^2/(3 K_b + 4 G) with poles of its own.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from coaxshell.model.elastic import Elastic
from coaxshell.model.layers import Shell
from coaxshell.model.materials import Material
from coaxshell.model.piezoelectric import Piezoelectric
from coaxshell.model.viscoelastic import Viscoelastic
from coaxshell.structure.laminate import Laminate, PlaneStiffness, missing_constants, plane_stiffness
from coaxshell.structure.losses import Band, Prony, Relaxation, constant_q, prony_fit, relaxing_sum
from coaxshell.structure.section import Section, plane_modulus

NOTHING = PlaneStiffness(0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Constituent:
    """A part of the stiffness of one layer.

    Attributes
    ----------
    layer : int
        Its number from the inside out.
    factor : Relaxation or None
        g(s); None for 1.
    stiffness : PlaneStiffness
        Q, Pa or in units of its own; constants along the axis that a material lacks are NaN.
    """

    layer: int
    factor: Relaxation | None
    stiffness: PlaneStiffness

    def in_units(self, pressure: float) -> Constituent:
        """Return it in units of a pressure (Pa)."""
        return replace(self, stiffness=self.stiffness.times(1.0 / pressure))


def loses(material: Material) -> bool:
    """Return whether a material has losses."""
    return isinstance(material, Viscoelastic) or material.loss_factor > 0.0


def constituents(shell: Shell, transit_time: float, band: Band) -> tuple[Constituent, ...]:
    """Return the constituents of all layers, in SI, their factors dimensionless.

    Parameters
    ----------
    shell : Shell
    transit_time : float
        Seconds in a transit.
    band : Band
        Of the run.
    """
    return tuple(
        Constituent(number, factor, stiffness)
        for number, layer in enumerate(shell.layers)
        for factor, stiffness in _of_material(layer.material, transit_time, band)
    )


def _of_material(material: Material, transit_time: float, band: Band) -> list[tuple[Relaxation | None, PlaneStiffness]]:
    if isinstance(material, Viscoelastic):
        return _of_rubber(material, transit_time)
    if missing_constants(material):
        whole = PlaneStiffness(math.nan, math.nan, plane_modulus(material), math.nan)
    else:
        whole = plane_stiffness(material)
    return [(relaxation_of(material, transit_time, band), whole)]


def relaxation_of(material: Elastic | Piezoelectric, transit_time: float, band: Band) -> Relaxation | None:
    """Return the factor g(s) on all moduli of a material with a loss factor, dimensionless; None without one."""
    if material.loss_factor == 0.0:
        return None
    reference = 2.0 * math.pi * material.reference_frequency * transit_time
    if material.loss_model == "constant-q":
        return constant_q(material.loss_factor, reference, band)
    return prony_fit(material.loss_factor, reference, band.with_frequency(reference))


def shear_relaxation(material: Viscoelastic, transit_time: float) -> Prony:
    """Return the factor g(s) on the shear modulus of a rubber, dimensionless, 1 at rest."""
    arms = ((modulus / material.long_term_modulus, time / transit_time) for modulus, time in material.prony)
    strengths, times = zip(*arms, strict=True)
    return Prony(1.0, strengths, times)


def _of_rubber(material: Viscoelastic, transit_time: float) -> list[tuple[Relaxation | None, PlaneStiffness]]:
    """Return G and h of a rubber; their factors are 1 at rest."""
    shear = material.long_term_modulus / (2.0 * (1.0 + material.poisson_ratio))
    bulk = material.long_term_modulus / (3.0 * (1.0 - 2.0 * material.poisson_ratio))
    shear_series = shear_relaxation(material, transit_time)
    arms = relaxing_sum(3.0 * bulk, 4.0 * shear, 4.0 * shear * np.array(shear_series.strengths), np.array(shear_series.times))
    plane = 9.0 * bulk * shear / (3.0 * bulk + 4.0 * shear)
    plane_series = Prony(1.0, tuple(6.75 * bulk**2 / plane * x for x in arms.strengths), arms.times)
    return [
        (shear_series, PlaneStiffness(shear, -shear, shear, shear)),
        (plane_series, PlaneStiffness(plane, plane, plane, 0.0)),
    ]


def weighted(section: Section, parts: tuple[Constituent, ...], core: int, weight: Callable[[Relaxation | None], float]) -> Section:
    """Return a section whose layers have sum of weight(factor) Q of their constituents; its potentials where weight(None) is not 0.

    Parameters
    ----------
    section : Section
        Of the whole wall, in the units of the constituents.
    parts : tuple of Constituent
    core : int
        Number of the layer whose stress is reported.
    weight : callable
    """
    layers = [NOTHING] * len(section.layers)
    for part in parts:
        if (factor := weight(part.factor)) != 0.0:
            layers[part.layer] = PlaneStiffness(
                *(have + factor * more for have, more in zip(layers[part.layer], part.stiffness, strict=True))
            )
    moments = np.zeros((3, 4))
    for (bottom, top, _), stiffness in zip(section.layers, layers, strict=True):
        moments += np.outer([(top**n - bottom**n) / n for n in (1, 2, 3)], stiffness)
    thickness = section.layers[-1][1] - section.layers[0][0]
    moments[1, np.abs(moments[1]) < 1e-12 * np.abs(moments[0]) * thickness] = 0.0  # a symmetric layup, up to rounding
    membrane, cross, bending = (PlaneStiffness(*map(float, row)) for row in moments)
    return replace(
        section,
        membrane=membrane.q22,
        cross=cross.q22,
        bending=bending.q22,
        core_modulus=layers[core].q22,
        layers=tuple((bottom, top, q.q22) for (bottom, top, _), q in zip(section.layers, layers, strict=True)),
        piezoelectric=section.piezoelectric if weight(None) != 0.0 else (),
        laminate=None if section.laminate is None else Laminate((membrane, cross, bending), layers[core], tuple(layers)),
    )
