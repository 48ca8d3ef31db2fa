"""The one way to march an interface: cubic springs and saturating actuators by their own march, links of other laws by theirs."""

from __future__ import annotations

from coaxshell.numerics.progress import Progress
from coaxshell.solver.interface.absorbers import AbsorberSet
from coaxshell.solver.interface.march import MarchResult, march
from coaxshell.solver.links.march import march_links
from coaxshell.solver.structure_spectra import StructureSpectra


def march_interface(
    structure: StructureSpectra, absorbers: AbsorberSet, *, saturate: bool = False, progress: Progress | None = None
) -> MarchResult:
    """March absorbers over all times of the linear response; see :func:`coaxshell.solver.interface.march.march`.

    Raises
    ------
    InputError
        If a step does not converge, or actuators are to saturate beside absorbers with laws.
    """
    marched = march_links if absorbers.of_any_law else march
    return marched(structure, absorbers, saturate=saturate, progress=progress)
