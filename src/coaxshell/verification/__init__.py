"""The conformance suite: checks of the package against theory, reference values and independent methods, and other codes against it."""

from coaxshell.verification.files import write_report
from coaxshell.verification.registry import Check, check, checks, chosen
from coaxshell.verification.rows import Curve, Panel, Row, Sheet
from coaxshell.verification.suite import Report, Result, run

__all__ = ["Check", "Curve", "Panel", "Report", "Result", "Row", "Sheet", "check", "checks", "chosen", "run", "write_report"]
