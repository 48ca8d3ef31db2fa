"""Walls and fluids in one wave along the axis while no feedback acts, as belts of electrodes ask of them: thin walls, or two faces each.

What sources move is read, what voltages move is read back, and either is shown at stations
(:mod:`coaxshell.solver.axial.belts`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Generic, TypeVar

import numpy as np

from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.faced import FacedWave
from coaxshell.solver.axial.families import Family
from coaxshell.solver.axial.normals import motions_of, piezoelectric_layers, shown_of
from coaxshell.solver.axial.tied_faces import Closed, OpenFaces
from coaxshell.solver.axial.tied_wave import OpenWave
from coaxshell.solver.cascade import FaceMotion
from coaxshell.solver.scaling import Problem

Motion = TypeVar("Motion")


class Answers(ABC, Generic[Motion]):
    """What walls do in one wave, at a block of Laplace nodes.

    Attributes
    ----------
    modes : Modes
    """

    modes: Modes

    @property
    @abstractmethod
    def read(self) -> ComplexArray:
        """Volts read on one wall under control per volt on another, (walls, walls, orders, nodes)."""

    @abstractmethod
    def charges_per_volt(self) -> ComplexArray:
        """Return the charge that strain brings over the capacitance, V, likewise; 0 of walls of which no station keeps it."""

    @abstractmethod
    def free(self, family: Family, grid: LaplaceGrid, block: slice, *, acts: bool) -> Motion:
        """Return what the sources of a family move, nothing unless they *act* in this wave."""

    @abstractmethod
    def readings(self, motion: Motion) -> ComplexArray:
        """Return what is read of it, (walls, parities, orders, nodes)."""

    @abstractmethod
    def under(self, voltage: ComplexArray) -> Motion:
        """Return what voltages move alone, (walls, parities, orders, nodes)."""

    @abstractmethod
    def shown(self, motion: Motion) -> ComplexArray:
        """Return what walls are read for, (names, shells, parities, orders, nodes)."""


class ThinAnswers(Answers[ComplexArray]):
    """Answers of thin walls, whose motion is what they are read for."""

    def __init__(self, problem: Problem, s: ComplexArray, modes: Modes) -> None:
        self.modes, self._problem, self._wave = modes, problem, OpenWave(problem, s, modes)

    @property
    def read(self) -> ComplexArray:
        """Volts read of mid-surfaces per volt."""
        return self._wave.response.read

    def charges_per_volt(self) -> ComplexArray:
        """Return it of all walls."""
        return self._wave.charges_per_volt()

    def free(self, family: Family, grid: LaplaceGrid, block: slice, *, acts: bool) -> ComplexArray:
        """Return W, V, U and potentials."""
        if acts:
            return motions_of(self._problem, self._wave.bare, family, grid, block)
        names, shells = 3 + piezoelectric_layers(self._problem), len(self._problem.shells)
        return np.zeros((names, shells, family.parities, self.modes.count, self._wave.bare.s.size), np.complex128)

    def readings(self, motion: ComplexArray) -> ComplexArray:
        """Return what is read of W."""
        return self._wave.readings(motion[0])

    def under(self, voltage: ComplexArray) -> ComplexArray:
        """Return W, V, U and potentials, the voltage itself last."""
        return shown_of(self._problem, self._wave, self._wave.moved(voltage))

    def shown(self, motion: ComplexArray) -> ComplexArray:
        """Return it as it is."""
        return motion


class FacedAnswers(Answers[Closed]):
    """Answers of walls with two faces, whose motion is that of the faces, with the voltages that make it.

    Attributes
    ----------
    wave : FacedWave
    """

    def __init__(self, problem: Problem, s: ComplexArray, modes: Modes) -> None:
        self.modes, self._problem, self.wave = modes, problem, FacedWave(problem, s, modes)
        self._open = OpenFaces(self.wave)

    @property
    def read(self) -> ComplexArray:
        """Volts read of faces per volt."""
        return self._open.response.read

    def charges_per_volt(self) -> ComplexArray:
        """Return it of thin walls, 0 of elastic ones."""
        return self._open.charges_per_volt()

    def free(self, family: Family, grid: LaplaceGrid, block: slice, *, acts: bool) -> Closed:
        """Return the motion of all faces, without any voltage."""
        count, shape = len(self._problem.shells), (self.modes.count, self.wave.s.size)
        rest = np.zeros((count, family.parities, *shape), np.complex128)
        if acts:
            return Closed(self.wave.faces(family, grid, block), rest)
        still = FaceMotion(*(np.zeros(shape, np.complex128) for _ in FaceMotion._fields))
        return Closed([[still] * count for _ in range(family.parities)], rest)

    def readings(self, motion: Closed) -> ComplexArray:
        """Return what is read of the loads on the faces."""
        return self._open.readings(motion.faces)

    def under(self, voltage: ComplexArray) -> Closed:
        """Return the motion of all faces under voltages alone, and these."""
        return self._open.moved(voltage)

    def shown(self, motion: Closed) -> ComplexArray:
        """Return what :meth:`FacedWave.read` does, with all potentials."""
        return motion.read(self.wave, piezoelectric_layers(self._problem))
