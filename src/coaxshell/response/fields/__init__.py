"""Acoustic fields of a finished run: pressure, particle velocity and intensity on grids, and their means over a region."""

from coaxshell.response.fields.evaluate import intensity, pressure, velocity
from coaxshell.response.fields.request import FieldOptions, PartOptions, PressureOptions, RmsOptions
from coaxshell.response.fields.rms import pressure_rms
from coaxshell.response.fields.spatial_pressure import SpatialPressureOptions, spatial_pressure

__all__ = [
    "FieldOptions",
    "PartOptions",
    "PressureOptions",
    "RmsOptions",
    "SpatialPressureOptions",
    "intensity",
    "pressure",
    "pressure_rms",
    "spatial_pressure",
    "velocity",
]
