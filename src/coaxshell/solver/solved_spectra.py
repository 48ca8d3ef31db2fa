"""The answer of a structure with absorbers and limited actuators: transforms of its motion, and what links and actuators did."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.interface.absorbers import AbsorberSet
from coaxshell.solver.interface.link_motion import LinkMotion, exact_motion, marched_motion, motion_of_laws
from coaxshell.solver.links.histories import LawHistories
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solid_spectra import SolidSpectra
from coaxshell.solver.structure_spectra import StructureSpectra


class FaceSpectra(NamedTuple):
    """Transforms of the displacements of the inner and the outer faces of all walls, each (shells, parities, M + 1, nodes)."""

    inner: ComplexArray
    outer: ComplexArray


@dataclass(frozen=True)
class SolvedSpectra:
    """Transforms of the motion of a run, with the histories of its links and of its actuators' pressure.

    Attributes
    ----------
    structure : StructureSpectra
        With its feedback.
    absorbers : AbsorberSet
        Those that acted, maybe none.
    normal, tangential : ndarray, shape (shells, parities, M + 1, nodes)
        W and V.
    solid : SolidSpectra or None
        All that walls do whose faces move differently; None where there are none.
    force : ndarray, shape (N, 2, T)
        Line forces on the inner [.., 0] and outer [.., 1] shell, for every absorber of the description.
    displacement : ndarray, shape (N, T)
        q of every absorber of the description.
    actuation : ndarray, shape (shells, parities, M + 1, T), or None
        Modal pressure that saturating actuators gave, None where the linear law held throughout.
    iterations : int
        Of all steps of a march, 0 if nothing was marched.
    exact : tuple of ndarray, shapes (2 N, nodes) and (N, nodes), or None
        Transforms of force and displacement of the absorbers carried, where they were solved exactly.
    laws : LawHistories or None
        What links of any law did, where there are such.
    voltage : ndarray, shape (shells, parities, M + 1, nodes), or None
        Transforms of the voltages of actuators, V, where they are given to the structure without feedback.
    asked : ndarray, same shape, or None
        Those that the laws ask for, where a limit was reached.
    segments : ndarray, shape (shells, N, T), or None
        Voltages of the segments of electrodes as they are asked for, where these are cut.
    defect : tuple of ndarray, or None
        Transforms of W and V, of what the march of limited voltages leaves unsolved.
    held : tuple of int
        Walls whose amplifiers were held at the limit of electrodes' voltage or of their current.
    seen : StructureSpectra or None
        What marched, where anything did: the structure, or what its absorbers see of it (:mod:`coaxshell.solver.interface.seen`).
    """

    structure: StructureSpectra
    absorbers: AbsorberSet
    normal: ComplexArray
    tangential: ComplexArray
    solid: SolidSpectra | None
    force: FloatArray
    displacement: FloatArray
    actuation: FloatArray | None = None
    iterations: int = 0
    exact: tuple[ComplexArray, ComplexArray] | None = None
    laws: LawHistories | None = None
    voltage: ComplexArray | None = None
    asked: ComplexArray | None = None
    segments: FloatArray | None = None
    defect: tuple[ComplexArray, ComplexArray] | None = None
    held: tuple[int, ...] = ()
    seen: StructureSpectra | None = None

    @property
    def problem(self) -> Problem:
        """The structure's problem; the absorbers that acted are ``absorbers``, whatever its description has."""
        return self.structure.problem

    @property
    def grid(self) -> LaplaceGrid:
        """The grid of the run: its ``time`` has ``refinement`` steps to one that the run kept; ``invert`` gives histories on it."""
        return self.structure.grid

    @property
    def modes(self) -> Modes:
        """Orders 0 to M."""
        return self.structure.modes

    @property
    def face_motion(self) -> FaceSpectra:
        """W of the inner and of the outer face of every wall: what the fluids feel."""
        return FaceSpectra(self.normal, self.normal) if self.solid is None else FaceSpectra(*self.solid.faces)

    @property
    def passive(self) -> StructureSpectra:
        """What the forces moved: the structure, without feedback where saturating actuators acted as forces."""
        return self.structure if self.actuation is None and self.voltage is None else self.structure.open_loop

    @property
    def marched(self) -> bool:
        """Whether steps were taken, or everything solved exactly."""
        return self.iterations > 0

    @property
    def nbytes(self) -> int:
        """Bytes of all transforms, those of the structure that forces need included."""
        driven = self.passive is not self.structure and not self.problem.two_faced  # of whose walls voltages are no loads on surfaces
        structure = self.passive if self.absorbers.count or driven else None
        unit = 0 if structure is None else structure.unit_bytes
        solid = 0 if self.solid is None else self.solid.nbytes
        return self.normal.nbytes + self.tangential.nbytes + unit + solid

    @cached_property
    def links(self) -> LinkMotion | None:
        """Histories of the absorbers; None if there are none."""
        if not self.absorbers.count:
            return None
        if self.exact is not None:
            return exact_motion(self.absorbers, self.grid, *self.exact)
        if self.laws is not None:
            return motion_of_laws(self.absorbers, self.laws, self.force, self.displacement)
        return marched_motion(self.absorbers, self.grid.time_step, self.force, self.displacement)
