"""What a wall is at an axial wavenumber is found once for all blocks of Laplace nodes, and let go with the modes."""

from __future__ import annotations

import gc

import numpy as np

from coaxshell.model import presets
from coaxshell.numerics import modes as kept
from coaxshell.numerics.modes import Modes
from coaxshell.solver.scaling import dimensionless
from coaxshell.structure.axial import axial_stiffness


def test_a_stiffness_is_kept_as_long_as_its_modes():
    gc.collect()
    before = len(kept._kept)
    inner, outer = (wall.section for wall in dimensionless(presets.load("bare"), dimensions=3).shells)
    modes, alike = Modes.up_to(5, 2.0), Modes.up_to(5, 2.0)
    assert axial_stiffness(inner, modes) is axial_stiffness(inner, modes)
    np.testing.assert_array_equal(axial_stiffness(inner, modes), axial_stiffness(inner, alike))
    assert not np.array_equal(axial_stiffness(inner, modes), axial_stiffness(outer, modes))
    for_each_node = Modes.up_to(5, np.array([2.0 + 0j, 1.0j]))
    assert axial_stiffness(inner, for_each_node) is not axial_stiffness(inner, for_each_node)
    assert len(kept._kept) == before + 2
    del modes, alike
    gc.collect()
    assert len(kept._kept) == before
