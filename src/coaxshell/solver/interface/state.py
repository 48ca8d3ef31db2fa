"""All that a march has become by some step: with the plan and the motion without the interface, it decides everything after it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.convolution import History
from coaxshell.solver.interface.newton import NewtonState
from coaxshell.solver.interface.plan import MarchPlan


@dataclass(frozen=True)
class LinkState:
    """State of the links: forces, forced displacement and velocity at the points (2, N), displacement and velocity of the masses (N,)."""

    force: FloatArray
    displacement: FloatArray
    velocity: FloatArray
    mass_displacement: FloatArray
    mass_velocity: FloatArray

    def moved(self, velocity: FloatArray, integral: FloatArray) -> LinkState:
        """Return the state with the velocities (steps, 2, N) that the block's own forces give to the points."""
        displacement = self.displacement + (integral @ velocity.reshape(integral.size, -1)).reshape(self.velocity.shape)
        return replace(self, displacement=displacement, velocity=self.velocity + velocity[-1])


@dataclass(frozen=True)
class MarchState:
    """The state between two blocks.

    Attributes
    ----------
    step : int
        Number of the next block's first step; 0 is at rest.
    links : LinkState
    history : History
        Modal pressures so far.
    newton : NewtonState
        Where the next step begins.
    relaxed : ndarray, shape (steps, unknowns), or None
        z of the steps last solved together; None once that does not pay.
    iterations : int
        Of all steps so far.
    saturated : bool
        Whether any actuator has reached its limit.
    """

    step: int
    links: LinkState
    history: History
    newton: NewtonState
    relaxed: FloatArray | None
    iterations: int
    saturated: bool

    @classmethod
    def at_rest(cls, plan: MarchPlan) -> MarchState:
        """Return the state before the first block."""
        n = plan.count
        loose = bool(plan.links.auxiliary_stiffness.any())  # what a singular tangent leaves open, an iteration does not show
        together = plan.relaxation.steps > 1 and not plan.actuators.controlled and not loose
        relaxed = np.empty((0, plan.unknowns)) if together else None
        return cls(1, LinkState(*np.zeros((3, 2, n)), *np.zeros((2, n))), History(), plan.newton.at_rest(), relaxed, 0, False)

    def to_arrays(self) -> dict[str, FloatArray]:
        """Return the state as named arrays, for a file; what follows from the plan is left out."""
        arrays = {f"links.{name}": value for name, value in vars(self.links).items()}
        arrays |= {f"history.input.{k}": block for k, block in enumerate(self.history.inputs)}
        arrays |= {f"history.pending.{k}.{start}": block for k, (start, block) in enumerate(self.history.pending)}
        newton = self.newton
        arrays |= {"newton.last": newton.last, "newton.before": newton.before, "newton.oldest": newton.oldest}
        arrays |= {"newton.tangent_at": newton.kept.at, "newton.rate": np.array(newton.rate)}
        if self.relaxed is not None:
            arrays["relaxed"] = self.relaxed
        counts = [self.step, self.history.step, self.iterations, float(self.saturated)]
        return arrays | {"counts": np.array(counts, dtype=np.float64)}

    @classmethod
    def from_arrays(cls, plan: MarchPlan, arrays: Mapping[str, FloatArray]) -> MarchState:
        """Return the state that :meth:`to_arrays` gave, of a march by the same plan."""
        step, pushed, iterations, saturated = (int(x) for x in arrays["counts"])
        links = LinkState(*(np.asarray(arrays[f"links.{name}"]) for name in LinkState.__dataclass_fields__))
        inputs = [name for name in arrays if name.startswith("history.input.")]
        pending = sorted((int(name.split(".")[2]), int(name.split(".")[3]), name) for name in arrays if name.startswith("history.pending."))
        history = History(
            pushed,
            tuple(np.asarray(arrays[f"history.input.{k}"]) for k in range(len(inputs))),
            tuple((start, np.asarray(arrays[name])) for _, start, name in pending),
        )
        last, before, oldest, at = (np.asarray(arrays[f"newton.{name}"]) for name in ("last", "before", "oldest", "tangent_at"))
        newton = NewtonState(last, before, oldest, plan.newton.tangent_at(at), float(arrays["newton.rate"]))
        relaxed = np.asarray(arrays["relaxed"]) if "relaxed" in arrays else None
        return cls(step, links, history, newton, relaxed, iterations, bool(saturated))
