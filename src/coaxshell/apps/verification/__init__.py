"""The conformance suite: checks of the package against theory, reference values and independent methods, and other codes against it."""

from coaxshell.apps.verification.checks import checks, chosen
from coaxshell.apps.verification.files import write_report
from coaxshell.apps.verification.registry import Check, check
from coaxshell.apps.verification.rows import Curve, Panel, Row, Sheet
from coaxshell.apps.verification.suite import Report, Result, run

__all__ = ["Check", "Curve", "Panel", "Report", "Result", "Row", "Sheet", "check", "checks", "chosen", "run", "write_report"]
