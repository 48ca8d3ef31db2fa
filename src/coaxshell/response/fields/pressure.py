"""Pressure on Cartesian and polar grids."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.progress import Progress
from coaxshell.response.fields.evaluate import evaluate, settled
from coaxshell.response.fields.grids import grid_of, labelled
from coaxshell.response.fields.request import request, require_room, when_of
from coaxshell.solver.recompute import SolvedSpectra

LONG_NAMES = {
    "total": "pressure",
    "incident": "incident pressure",
    "diffracted": "rigidly diffracted pressure",
    "radiated": "pressure radiated by the shells",
    "scattered": "scattered pressure (diffracted and radiated)",
}


def pressure(
    spectra: SolvedSpectra,
    x: npt.ArrayLike | None = None,
    y: npt.ArrayLike | None = None,
    *,
    radius: npt.ArrayLike | None = None,
    angle: npt.ArrayLike | None = None,
    time: npt.ArrayLike | None = None,
    part: str = "total",
    front: str = "sharp",
    filter: str | None = None,
    time_resolution: float | None = None,
    memory: float = 1e9,
    progress: Progress | None = None,
) -> xr.DataArray:
    """Return the acoustic pressure, Pa, dims (time, y, x) or (time, radius, angle); no time dimension for a single instant.

    Walls have no thickness: a point inside a mid-surface belongs to the fluid within, one on it or beyond to the fluid without. In a
    vacuum, and inside a rigid core, the pressure is 0.

    Parameters
    ----------
    spectra : SolvedSpectra
    x, y : array_like, optional
        Axes of a Cartesian grid in units of a; x points to theta = 0 (the source), y to theta = 90 degrees.
    radius, angle : array_like, optional
        Axes of a polar grid, in units of a and degrees, instead.
    time : float or array_like
        Instants in transits within the run; any, not only steps of the run.
    part : str
        "total", "incident" (the sources alone, exact in space and time), "diffracted" (scattered by the outermost surface as if rigid),
        "radiated" (by the motion of the shells) or "scattered" (the latter two). Inside the outermost shell all is radiated.
    front : str
        "sharp": incident fronts are jumps. "matched": they rise over the scattered part's time resolution, so that the two cancel in the
        shadow, where a sharp one leaves a line about a pixel wide; for pictures.
    filter : str, optional
        Weight of the circumferential orders of the scattered part against Gibbs artefacts: "lanczos", sinc(m/(M + 1)), or
        "exponential", exp(-36 (m/(M + 1))^6); none by default.
    time_resolution : float, optional
        Transits; frequencies up to pi/time_resolution make up the scattered part, under a window that halves them at 0.43 of that.
        By default the run's step on polar grids and on Cartesian ones of few distinct radii, which are evaluated radius by radius;
        0.005 (or the run's step, if coarser) on larger Cartesian grids, which are interpolated from a polar raster. The choice is
        stated in the attributes. Finer costs as the square of it on large grids.
    memory : float
        Bytes that working arrays may take beside the result, at least 64e6; what is larger is worked through in blocks.
    progress : callable, optional
        Called with the fraction done and the name of the stage.

    Raises
    ------
    InputError
        If an argument is not allowed; it names the argument.
    """
    step = spectra.grid.time_step
    asked = request(part=part, filter=filter, time_resolution=time_resolution, memory=memory, progress=progress, step=step, front=front)
    when = when_of(time, spectra)
    require_room("pressure", (x, y, radius, angle), when)
    grid = grid_of(x, y, radius, angle)
    asked = settled(spectra, asked, grid)
    values = evaluate(spectra, asked, grid, np.atleast_1d(when), ("pressure",))[0]
    values *= spectra.problem.scales.pressure
    return labelled(
        spectra, grid, when, values, asked, name="pressure", long_name=LONG_NAMES[part], units="Pa", sign="positive in compression"
    )
