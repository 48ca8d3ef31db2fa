"""The whole reproduction: parts carried out on all cores, finished ones kept, one report."""

from __future__ import annotations

from coaxshell.paper.reproduction.page import write
from coaxshell.paper.reproduction.plan import QUICK, VARIANTS
from coaxshell.paper.reproduction.results import Results
from coaxshell.paper.reproduction.run import TOPICS, reproduce

__all__ = ["QUICK", "TOPICS", "VARIANTS", "Results", "reproduce", "write"]
