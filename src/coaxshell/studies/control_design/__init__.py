"""The design of a control law for the electronics that there are."""

from coaxshell.studies.control_design.design import Alternative, ControlDesign, Reduction, design_control
from coaxshell.studies.control_design.fitted_orders import FittedOrders, OrderModel
from coaxshell.studies.control_design.lqg import LqgController, LqgDesign
from coaxshell.studies.control_design.state_space import StateSpaceModel, to_state_space

__all__ = [
    "Alternative",
    "ControlDesign",
    "FittedOrders",
    "LqgController",
    "LqgDesign",
    "OrderModel",
    "Reduction",
    "StateSpaceModel",
    "design_control",
    "to_state_space",
]
