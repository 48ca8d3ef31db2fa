"""A report of a run that an engineer can hand on: one HTML file, ten A4 pages at most when printed, every figure as data too."""

from __future__ import annotations

from coaxshell.apps.report.making import PARTS, parts_left, report, report_cost

__all__ = ["PARTS", "parts_left", "report", "report_cost"]
