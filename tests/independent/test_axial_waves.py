"""Three dimensions wave by wave against spectral elements in r and implicit Gauss integration in t, under a true spherical wave."""

from __future__ import annotations

import numpy as np
import pytest

from coaxshell.apps.verification import chosen, run
from coaxshell.apps.verification.checks.axial_wavenumbers import compared, configurations
from coaxshell.apps.verification.independent import RadialElements


def test_bare_small():
    # Measured 2.4e-8.
    assert compared(configurations()["bare"], 3.0, modes=2, duration=1.2, step=4e-3).distance < 1e-7


def test_all_three_displacements_take_part():
    pair = compared(configurations()["bare"], 3.0, modes=1, duration=1.2, step=8e-3)
    sizes = np.linalg.norm(pair.theirs[:, :, 1], axis=-1)
    assert (sizes > 0.01 * sizes.max()).all()
    for which in range(3):
        assert np.linalg.norm(pair.ours[which] - pair.theirs[which]) < 1e-5 * np.linalg.norm(pair.theirs[which])


def test_lopsided_layup():
    # The sensor inside, the actuator thicker: membrane and bending couple along both directions.
    bare = configurations()["bare"]
    wall, outer = bare.shells
    sensor, core, actuator = wall.layers
    lopsided = bare.replace(shells=[wall.replace(layers=[sensor, core, actuator.replace(thickness=9e-3)]), outer])
    # Measured 2.3e-8.
    assert compared(lopsided, 3.0, modes=2, duration=1.2, step=4e-3).distance < 1e-7


def test_the_slice_is_another_wave():
    # k = 0 is the sphere integrated along the axis; without a wavenumber the source is the paper's slice.
    system = configurations()["bare"]
    sphere, plane = (RadialElements(system, 1, 0.8, wavenumber=k).solve(8e-3, 100).w for k in (0.0, None))
    assert np.linalg.norm(sphere - plane) > 0.1 * np.linalg.norm(plane)


@pytest.mark.slow
@pytest.mark.parametrize("k", [0.0, 0.5, 3.0, 8.0, 15.0])
@pytest.mark.parametrize("name", configurations())
def test_systems(name, k):
    # Measured 4.2e-8 or less up to ka = 8, 2.4e-7 at 15.
    assert compared(configurations()[name], k, modes=6, duration=2.0, step=2e-3).distance < (1e-7 if k < 10 else 5e-7)


def test_few_waves_added_up_at_stations(quick_rows):
    # Displacements, stresses, signs and weights of all parities, M = 4.
    assert len(quick_rows("independent-stations")) == 12
    assert max(row.error for row in quick_rows("independent-stations")) < 1e-7


@pytest.mark.slow
def test_waves_added_up_at_stations():
    # Measured 6.2e-9 or less.
    (result,) = run(chosen(["independent-stations"], quick=False), quick=False).results
    assert len(result.rows) == 12
    assert max(row.error for row in result.rows) < 2e-8
