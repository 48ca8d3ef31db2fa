"""The design of a control law for the electronics that there are."""

from coaxshell.studies.control_design.design import Alternative, ControlDesign, Reduction, design_control

__all__ = ["Alternative", "ControlDesign", "Reduction", "design_control"]
