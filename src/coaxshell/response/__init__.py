"""The labelled answer: histories, summary, storage."""

from coaxshell.response.equipment import mounted_spectrum
from coaxshell.response.frequency import frequency_response
from coaxshell.response.margins import stability_margins
from coaxshell.response.resonances import natural_frequencies
from coaxshell.response.response import Response
from coaxshell.response.simulation import PreparedSystem, load_response, prepare, simulate
from coaxshell.response.storage import info
from coaxshell.response.summary import ShellSummary, Summary

__all__ = [
    "PreparedSystem",
    "Response",
    "ShellSummary",
    "Summary",
    "frequency_response",
    "info",
    "load_response",
    "mounted_spectrum",
    "natural_frequencies",
    "prepare",
    "simulate",
    "stability_margins",
]
