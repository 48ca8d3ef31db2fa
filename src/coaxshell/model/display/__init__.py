"""How a system shows itself in a notebook: a cross-section to scale beside a small table. Text only, no numerics."""

from coaxshell.model.display.card import card, system_card, system_line
from coaxshell.model.display.drawing import cross_section

__all__ = ["card", "cross_section", "system_card", "system_line"]
