"""Slips of the incident wave (Eq. 2) and of its diffraction (Eqs. B.3, B.7): the radial velocity that the shell reflects."""

from __future__ import annotations

from dataclasses import dataclass, replace

from coaxshell.acoustics.sources import SourceGeometry, SphericalGeometry
from coaxshell.errors import InputError
from coaxshell.model.pulses import Exponential
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.solver.scaling import Problem


@dataclass(frozen=True, kw_only=True)
class ReversedDiffraction(SphericalGeometry):
    """The wave whose diffracted part has the wrong sign: its velocity is doubled at the shell instead of cancelled (B.3 with B.7)."""

    carried: SphericalGeometry

    def acceleration(self, front: ComplexArray, afterflow: ComplexArray, s: ComplexArray) -> ComplexArray:
        """Return minus the acceleration of the wave that is carried."""
        return -self.carried.acceleration(front, afterflow, s)


@dataclass(frozen=True, kw_only=True)
class PrintedPotential(SphericalGeometry):
    """The wave with the velocity of the printed potential, -(lambda p S/R) e^{-x/lambda} H(x).

    Its radial derivative is (p S/R)(dR/dr)(-1 + lambda/R) e^{-x/lambda} H(x) behind the front, and an impulse lambda (p S/R)(dR/dr)
    delta(x) at the front, which a program that evaluates the formula at points behind the front never sees. With the impulse it is
    lambda times the time derivative of the true velocity.
    """

    decay: float
    impulse: bool

    def acceleration(self, front: ComplexArray, afterflow: ComplexArray, s: ComplexArray) -> ComplexArray:
        """Return s v0 per unit pulse."""
        if self.impulse:
            return self.decay * s * (front * s + afterflow)
        return s * (self.decay * afterflow - front)


def reversed_diffraction(problem: Problem) -> Problem:
    """Return the problem with psi_d = +B Xi_e and Xi_e = K_m/(s K_m') as printed: the diffracted pressure changes its sign."""
    waves = (_spherical(geometry) for geometry in problem.sources)
    return replace(problem, sources=tuple(ReversedDiffraction(wave.distance, wave.head, carried=wave) for wave in waves))


def printed_potential(problem: Problem, impulse: bool) -> Problem:
    """Return the problem with the printed potential of the incident wave (Eq. 2), with or without the impulse at its front."""
    sources = []
    for source, geometry in zip(problem.emitters, problem.sources, strict=True):
        wave = _spherical(geometry)
        if not isinstance(source.pulse, Exponential):
            raise InputError("source", "has no decay time, and the printed potential is that of a decaying exponential", "give a shock")
        sources.append(PrintedPotential(wave.distance, wave.head, decay=source.pulse.decay_time / problem.scales.time, impulse=impulse))
    return replace(problem, sources=tuple(sources))


def _spherical(wave: SourceGeometry) -> SphericalGeometry:
    if not isinstance(wave, SphericalGeometry):
        raise InputError("source", "is not the paper's spherical shock, whose printed formulas are in question", "use SphericalShock")
    return wave
