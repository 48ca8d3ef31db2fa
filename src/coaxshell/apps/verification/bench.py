"""What checks work with: solutions shared between them, the reference data, and the choice between quick and full."""

from __future__ import annotations

import tomllib
import warnings
from importlib import resources
from typing import Any, TypeVar

import numpy as np

from coaxshell.errors import PhysicsWarning
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.cache import ByteBoundedCache, held_bytes
from coaxshell.numerics.progress import ShareDone
from coaxshell.response.response import Response
from coaxshell.response.simulation import simulate
from coaxshell.solver.settings import Settings

T = TypeVar("T")

_KEPT_BYTES = 200_000_000


class Bench:
    """The workplace of one run of the suite.

    Parameters
    ----------
    quick : bool
        Whether checks shall choose their smaller version.
    progress : callable, optional
        Called with the fraction done of the check at work.
    """

    def __init__(self, *, quick: bool = False, progress: ShareDone | None = None) -> None:
        self.quick = quick
        self._progress = progress
        self._responses: ByteBoundedCache[Response] = ByteBoundedCache(_KEPT_BYTES, held_bytes)

    def choose(self, quick: T, full: T) -> T:
        """Return the value for a quick run or the one for a full run."""
        return quick if self.quick else full

    def done(self, fraction: float) -> None:
        """Tell how much of the check is done."""
        if self._progress is not None:
            self._progress(fraction)

    def simulate(self, system: System, **settings: Any) -> Response:
        """Return the response of a system; the last few are kept, so that checks that ask alike share the work."""
        asked = Settings.asked(system, settings)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", PhysicsWarning)
            key = system.to_toml_string(), asked
            kept = self._responses.get(key)
            if kept is not None:
                return kept
            response = simulate(system, settings=asked)
        self._responses.put(key, response.without_transforms())
        return response


def tables() -> dict[str, Any]:
    """Return the tables of high-precision values (reference/README.md, two values corrected; see the file)."""
    return tomllib.loads(_data("tables.toml").read_text(encoding="utf-8"))


def bare_double_shell() -> dict[str, FloatArray]:
    """Return the histories of reference/bare_double_shell.npz."""
    with _data("bare_double_shell.npz").open("rb") as file, np.load(file) as stored:
        return dict(stored)


def spherical_bare() -> dict[str, FloatArray]:
    """Return the histories of reference/spherical_bare.npz: t, and hoop, axial (Pa), w (m), each (shell, station, angle, time)."""
    with _data("spherical_bare.npz").open("rb") as file, np.load(file) as stored:
        return dict(stored)


def elastic_thick() -> dict[str, FloatArray]:
    """Return the histories of reference/elastic_thick_plane.npz: t, and hoop, axial (Pa), w (m), each (shell, 1, angle, time)."""
    with _data("elastic_thick_plane.npz").open("rb") as file, np.load(file) as stored:
        return dict(stored)


def _data(name: str) -> Any:
    return resources.files("coaxshell.apps.verification").joinpath("data").joinpath(name)
