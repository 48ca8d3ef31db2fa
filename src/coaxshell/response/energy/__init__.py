"""Where the energy goes: every store, flow and loss of a run, and how well they balance."""

from coaxshell.response.energy.balance import energy

__all__ = ["energy"]
