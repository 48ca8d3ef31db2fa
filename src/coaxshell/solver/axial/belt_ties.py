"""What electrodes cut along the axis tie, for the count of poles: the waves of each class, those left out included."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.belts import classes_of, left_over
from coaxshell.solver.axial.broken_belts import DeadElectrodes
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.electrode_loops import ElectrodeLoops
from coaxshell.solver.electrode_patterns import Patterns
from coaxshell.solver.scaling import Problem
from coaxshell.solver.tied_stability import Tied
from coaxshell.solver.voltage_response import VoltageResponse
from coaxshell.structure.belts import BeltClasses


@dataclass(frozen=True)
class TiedClass(Tied):
    """The waves of one class.

    Attributes
    ----------
    modes : Modes
        All orders, at the wavenumber that stands for the waves left out.
    waves : tuple of Modes
    shares : ndarray, shape (waves,)
        r_q of each.
    left_over : ndarray, shape (orders,)
        1 - sum_q r_q of each order.
    """

    waves: tuple[Modes, ...]
    shares: FloatArray
    left_over: FloatArray

    @property
    def alone(self) -> bool:
        """Whether it is one wave: never."""
        return False

    def response(self, passive: Problem, controls: Problem, s: ComplexArray) -> VoltageResponse:
        """Return what voltages of the class are read as: C_c of the orders."""
        return self.with_far(VoltageResponse.at(passive, controls, self.modes, s), passive, controls, s)

    def with_far(self, far: VoltageResponse, passive: Problem, controls: Problem, s: ComplexArray) -> VoltageResponse:
        """Return the same, the response of the wave that stands for those left out being known."""
        read = far.read * self.left_over[:, None]
        for modes, share in zip(self.waves, self.shares, strict=True):
            read[:, :, : modes.count] += share * VoltageResponse.at(passive, controls, modes, s).read
        return VoltageResponse.of_faces(far.shells, read)

    @property
    def place(self) -> str:
        """Where along the axis, for a message."""
        k = float(self.waves[0].wavenumber)
        return f" at the axial wavenumber {k:.3g}/a and those that the electrodes cannot tell from it"


@dataclass(frozen=True)
class BrokenTie(Tied):
    """The waves of all classes, which single dead electrodes tie.

    Attributes
    ----------
    modes : Modes
        As of each class.
    classes : BeltClasses
    each : tuple of TiedClass
    """

    classes: BeltClasses
    each: tuple[TiedClass, ...]

    @property
    def alone(self) -> bool:
        """Whether it is one wave: never."""
        return False

    @property
    def whole(self) -> bool:
        """Whether all patterns are one determinant: as one dead electrode ties all."""
        return True

    def factors(self, passive: Problem, controls: Problem, patterns: Patterns, s: ComplexArray) -> ComplexArray:
        """Return what the determinant of all is the product of: that of each class, twice where +c and -c are two, and of the dead."""
        far, loops, found = VoltageResponse.at(passive, controls, self.modes, s), [], []
        for number, one in enumerate(self.each):
            loops.append(ElectrodeLoops.of(controls, one.with_far(far, passive, controls, s), patterns, s))
            alone = 2 * number % self.classes.count == 0
            found += [loops[-1].factors()] * (1 if alone else 2)
        return np.concatenate([*found, DeadElectrodes(self.classes, patterns).determinants(loops)])

    @property
    def place(self) -> str:
        """What is told of, for a message."""
        return " with its dead belts"


def tie_of_broken(problem: Problem, sampling: AxialSampling) -> BrokenTie:
    """Return what a run with single dead electrodes ties."""
    assert problem.belts is not None
    return BrokenTie(sampling.far, classes_of(problem.belts, sampling), tuple(ties_of_belts(problem, sampling)))


def ties_of_belts(problem: Problem, sampling: AxialSampling) -> list[TiedClass]:
    """Return what each class of waves of a run ties, ascending from the belts that all do the same to neighbours that do the opposite."""
    assert problem.belts is not None
    classes, far = classes_of(problem.belts, sampling), sampling.far
    missing, found = left_over(classes, sampling), []
    for number in range(classes.classes):
        waves = classes.waves_of(number)
        shares = classes.loop_shares[np.array(waves, dtype=int)]
        found.append(TiedClass(far, tuple(sampling.modes[wave] for wave in waves), shares, missing[number]))
    return found
