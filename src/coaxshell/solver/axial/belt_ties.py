"""What electrodes cut along the axis tie, for the count of poles: the waves of each class, those left out included."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.belts import classes_of, left_over
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.scaling import Problem
from coaxshell.solver.tied_stability import Tied
from coaxshell.solver.voltage_response import VoltageResponse


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
        """False."""
        return False

    def response(self, passive: Problem, controls: Problem, s: ComplexArray) -> VoltageResponse:
        """Return what voltages of the class are read as: C_c of the orders."""
        far = VoltageResponse.at(passive, controls, self.modes, s)
        read = far.read * self.left_over[:, None]
        for modes, share in zip(self.waves, self.shares, strict=True):
            read[:, :, : modes.count] += share * VoltageResponse.at(passive, controls, modes, s).read
        return VoltageResponse.of_faces(far.shells, read)

    @property
    def place(self) -> str:
        """Where along the axis, for a message."""
        k = float(self.waves[0].wavenumber)
        return f" at the axial wavenumber {k:.3g}/a and those that the electrodes cannot tell from it"


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
