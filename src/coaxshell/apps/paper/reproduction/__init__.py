"""The whole reproduction: parts carried out on all cores, finished ones kept, one report."""

from __future__ import annotations

from coaxshell.apps.paper.reproduction.page import write
from coaxshell.apps.paper.reproduction.plan import QUICK, VARIANTS
from coaxshell.apps.paper.reproduction.results import Results
from coaxshell.apps.paper.reproduction.run import TOPICS, reproduce

__all__ = ["QUICK", "TOPICS", "VARIANTS", "Results", "reproduce", "write"]
