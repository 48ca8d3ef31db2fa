"""Acoustic fields of a finished run: pressure, particle velocity and intensity on grids, and their means over a region."""

from coaxshell.response.fields.evaluate import intensity, pressure, velocity
from coaxshell.response.fields.request import FieldOptions, PartOptions, PressureOptions, RmsOptions
from coaxshell.response.fields.rms import pressure_rms

__all__ = ["FieldOptions", "PartOptions", "PressureOptions", "RmsOptions", "intensity", "pressure", "pressure_rms", "velocity"]
