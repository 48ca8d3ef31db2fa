"""The motion of the walls of a finished run: what every quantity of a shell is read from."""

from __future__ import annotations

from functools import cached_property

from coaxshell.response.modal import amplitudes
from coaxshell.response.peaks import Amplitudes
from coaxshell.solver.recompute import SolvedSpectra, spectra_of
from coaxshell.solver.solution import ModalSolution
from coaxshell.structure.shell_model import Gain


class WallMotion:
    """W and V of all walls by modes: their histories and, made when first needed and kept, their transforms.

    Parameters
    ----------
    solution : ModalSolution
    """

    def __init__(self, solution: ModalSolution) -> None:
        self.solution = solution

    @cached_property
    def spectra(self) -> SolvedSpectra:
        """Transforms of W and V; InputError if instants of the run are missing."""
        return spectra_of(self.solution)

    def amplitudes(self, shell: int, gain: Gain) -> Amplitudes:
        """Return what gives the modal amplitudes gain.v V + gain.w W of a shell, SI, at a slice of time indices."""
        return lambda window: amplitudes(self.solution, shell, gain, window)
