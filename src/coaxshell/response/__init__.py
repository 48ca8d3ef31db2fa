"""The labelled answer: histories, summary, storage."""

from coaxshell.response.loading import load_response
from coaxshell.response.response import Response
from coaxshell.response.simulation import PreparedSystem, prepare, simulate
from coaxshell.response.storage import info
from coaxshell.response.summary import ShellSummary, Summary

__all__ = ["PreparedSystem", "Response", "ShellSummary", "Summary", "info", "load_response", "prepare", "simulate"]
