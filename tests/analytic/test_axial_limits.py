"""What an axial wavenumber must leave as it is: closer than the check asks, which is to pass on any machine; and that it can fail."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from coaxshell.acoustics.sources import SphericalFrontGeometry
from coaxshell.apps.verification.checks import axial_limits
from coaxshell.apps.verification.rows import Row
from coaxshell.apps.verification.systems import SMOOTH_SPHERE
from coaxshell.model import presets
from coaxshell.numerics.modes import Modes


@pytest.fixture(scope="module")
def errors(quick_rows: Callable[[str], tuple[Row, ...]]) -> dict[str, float]:
    """Return the errors of the check, by what is compared."""
    return {row.what: row.error for row in quick_rows("axial-limits")}


@pytest.mark.parametrize(
    ("start", "limit"),
    [
        ("bare: ka = 1e-9 against k = 0", 1e-13),  # measured 1.5e-14
        ("active control: ka = 1e-9 against k = 0", 1e-13),
        ("load at k = 0", 1e-13),  # 1.8e-15
        ("massless walls, ka = 0:", 1e-11),  # 1.7e-13, as at all k
        ("massless walls, ka = 0.3:", 1e-11),
        ("massless walls, ka = 2:", 1e-11),
        ("massless walls, ka = 15:", 1e-11),
        ("massless walls, ka = 60:", 1e-11),
        ("rigid cylinder", 1e-4),  # 7e-5: what 1/s² leaves
        ("reciprocity of a wall and a point at 3 a, ka = 0.4", 1e-13),  # 4e-15
        ("reciprocity of a wall and a point at 3 a, ka = 7", 1e-13),
        ("reciprocity of points at 3 a and 1.4 a, ka = 0.4", 1e-12),
        ("reciprocity of points at 3 a and 1.4 a, ka = 7", 1e-12),
    ],
)
def test_limits(errors: dict[str, float], start: str, limit: float) -> None:
    (error,) = (error for what, error in errors.items() if what.startswith(start))
    assert error < limit


def test_a_wavenumber_that_matters_would_show(monkeypatch: pytest.MonkeyPatch) -> None:
    # Waves of ka = 0.1 are no plane waves, and a source at another place is another source.
    bare = presets.load("bare").replace(source=SMOOTH_SPHERE)
    spectra = axial_limits.modal_spectra
    with monkeypatch.context() as patched:
        patched.setattr(
            axial_limits, "modal_spectra", lambda system, grid, modes: spectra(system, grid, Modes.up_to(40, 1e8 * modes.wavenumber))
        )
        assert axial_limits.vanishing(bare) > 1e-4
    monkeypatch.setattr(axial_limits, "SphericalFrontGeometry", lambda distance: SphericalFrontGeometry(1.001 * distance))
    assert axial_limits.line_source() > 1e-4
    assert axial_limits.reciprocity(bare, 0.4) > 1e-4
    assert axial_limits.reciprocity_outside(bare, 0.4) > 1e-4
