"""Answers at given frequencies without any time step: of shells, fluids and absorbers, far away, and through the walls."""

from coaxshell.response.frequency.answer import frequency_response

__all__ = ["frequency_response"]
