"""Acoustic fields of a finished run: pressure, particle velocity and intensity on grids, and their means over a region."""

from coaxshell.response.fields.cavitation import CavitationOptions, cavitation, spatial_cavitation
from coaxshell.response.fields.evaluate import intensity, pressure, velocity
from coaxshell.response.fields.request import FieldOptions, PartOptions, PressureOptions, RmsOptions
from coaxshell.response.fields.rms import pressure_rms
from coaxshell.response.fields.spatial_pressure import (
    SpatialFieldOptions,
    SpatialPartOptions,
    SpatialPressureOptions,
    spatial_intensity,
    spatial_pressure,
    spatial_velocity,
)
from coaxshell.response.fields.spatial_rms import SpatialRmsOptions, spatial_pressure_rms

__all__ = [
    "CavitationOptions",
    "FieldOptions",
    "PartOptions",
    "PressureOptions",
    "RmsOptions",
    "SpatialFieldOptions",
    "SpatialPartOptions",
    "SpatialPressureOptions",
    "SpatialRmsOptions",
    "cavitation",
    "intensity",
    "pressure",
    "pressure_rms",
    "spatial_cavitation",
    "spatial_intensity",
    "spatial_pressure",
    "spatial_pressure_rms",
    "spatial_velocity",
    "velocity",
]
