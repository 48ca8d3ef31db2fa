"""What one output of a shell is: its gain, or its values at angles, and where it is shown."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

from coaxshell.model import Shell, System
from coaxshell.model.gains import law_of
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.modal import combined
from coaxshell.response.peaks import Amplitudes, Peak
from coaxshell.response.relaxing import Relaxing
from coaxshell.response.synthesis import angle_basis, at_angles
from coaxshell.response.wall_motion import WallMotion
from coaxshell.response.wall_stress import searchable
from coaxshell.solver.solution import ModalSolution
from coaxshell.structure.shell_model import FieldGain, Gain

Where = Literal["head", "tail", "anywhere", "rms"]
Needs = Literal["", "elastic", "sensor", "control", "electrodes"]

_DRIVEN = ("sensor", "actuator")
_ROLES: dict[Needs, tuple[str, ...]] = {"": (), "elastic": (), "sensor": ("sensor",), "control": _DRIVEN, "electrodes": _DRIVEN}
PLACES: dict[Where, str] = {"head": "at head", "tail": "at tail", "anywhere": "anywhere", "rms": "RMS"}
_SUFFIXES: dict[Where, str] = {"head": "_head", "tail": "_tail", "anywhere": "", "rms": "_rms"}


class Largest(Protocol):
    """The largest magnitude of a quantity within a window of time, as a mean over a segment of the wall."""

    def __call__(self, solution: ModalSolution, shell: int, window: slice, length: float, *, halved: bool = True) -> Peak:
        """Return the largest magnitude, the length in m; and what the lower half of the orders gives, where that is told and ``halved``."""


@dataclass(frozen=True, kw_only=True)
class Quantity:
    """One output of a shell.

    Attributes
    ----------
    name : str
        By which it is asked for.
    label : str
        What an axis says, without the unit.
    noun : str
        What a row of a table says before the place, as in "stress at head".
    long_name, unit, sign : str
        Attributes of its histories: what it is, in which SI unit, which direction counts positive.
    gain : callable (solution, shell), or None
        Value per unit V and W of each order; None for what is no linear combination of them.
    modal : callable (motion, shell), or None
        Its amplitudes, (parities, M + 1, T), where they are more than a gain's: of what needs the transforms, so that ``rate`` is 1.
    values : callable (motion, shell, angles in degrees), or None
        Values at angles, shape (T, A); None where the gain gives them.
    largest : callable, or None
        Where the summary shows means over a segment of the wall.
    rate : int
        Order of the time derivative, 0, 1 or 2, of what the gain gives; from the transforms (:mod:`coaxshell.response.wall_motion`).
    needs : str
        What a shell must have: "" nothing, "elastic" a wall that is not rigid, "sensor" that layer, "control" both layers and gains,
        "electrodes" those by electrodes, in two dimensions.
    component : str
        "normal" for what has cos(m theta) in parity 0, "tangential" for sin(m theta).
    partner : str
        Name of the tangential component, for what is a vector.
    shown : tuple (str, float)
        Unit in which it is drawn, and how many of these one SI unit is.
    colour : str
        Of its curve, a name of :data:`coaxshell.plotting.COLOURS`.
    column : bool
        Whether tables, exports, comparisons and the studio hold it at head and tail.
    drifts : bool
        Whether it holds the translation of the section, which grows for as long as water flows past.
    array : str
        Name of its labelled arrays, where that is another.
    relaxes : bool
        Whether losses of a wall's layers are in it.
    through : bool
        Whether the depths of a wall are searched, which thin walls tell alone.
    summary, metrics : tuple of str
        Where the summary shows its largest magnitude, and where a study can ask for it: "head", "tail", "anywhere"; "rms".
    dimensions : int
        3 for what only a station of a three-dimensional run has.
    """

    name: str
    label: str
    noun: str
    long_name: str
    unit: str
    sign: str
    gain: Callable[[ModalSolution, int], Gain | FieldGain | Relaxing] | None = None
    modal: Callable[[WallMotion, int], FloatArray] | None = None
    values: Callable[[WallMotion, int, FloatArray], FloatArray] | None = None
    largest: Largest | None = None
    rate: int = 0
    needs: Needs = "elastic"
    component: str = "normal"
    partner: str = ""
    shown: tuple[str, float] = ("", 1.0)
    colour: str = "blue"
    column: bool = False
    drifts: bool = False
    array: str = ""
    relaxes: bool = False
    through: bool = False
    summary: tuple[Where, ...] = ()
    metrics: tuple[Where, ...] = ()
    dimensions: int = 2

    @property
    def stem(self) -> str:
        """Name of the quantity within the names of metrics."""
        return self.name.removeprefix("shell_")

    def key(self, where: Where) -> str:
        """Return the name of its largest magnitude at a place in the summary."""
        return self.name + _SUFFIXES[where]

    def metric(self, where: Where) -> str:
        """Return the name by which a study asks for it at a place."""
        return f"rms_{self.stem}" if where == "rms" else f"peak_{self.stem}{_SUFFIXES[where]}"

    @property
    def summary_keys(self) -> list[str]:
        """Names of all that the summary shows of it."""
        return [self.key(where) for where in self.summary]

    @property
    def words(self) -> str:
        """Name of the quantity in headings."""
        return self.name.replace("_", " ")

    @property
    def axis(self) -> str:
        """Label of an axis, with the unit drawn."""
        return f"{self.label} ({self.shown[0] or self.unit})"

    @property
    def roles(self) -> tuple[str, ...]:
        """Layers that a shell must have, by their roles."""
        return _ROLES[self.needs]

    def lack(self, system: System, shell: int) -> str | None:
        """Return what a shell would have to be for it to have this quantity, as in "is not rigid"; None if it has."""
        wall = system.shells[shell]
        if not self.needs:
            return None
        if not isinstance(wall, Shell):
            return "is not rigid"
        missing = next((role for role in self.roles if getattr(wall, role) is None), None)
        if missing is not None:
            return f"has a layer with the role {missing!r}"
        if self.needs not in ("control", "electrodes"):
            return None
        if shell not in system.controlled_shells:
            return "is controlled"
        law = law_of(system, shell)
        paper = law is not None and law.transducers == "paper"
        return "is controlled by electrodes" if self.needs == "electrodes" and paper else None

    def at(self, motion: WallMotion, shell: int, theta: FloatArray) -> FloatArray:
        """Return its values at angles (degrees), SI, shape (T, A)."""
        if self.values is not None:
            return self.values(motion, shell, theta)
        if self.modal is not None:
            modal = self.modal(motion, shell)
            return at_angles(modal, angle_basis(np.atleast_1d(theta), modal.shape[1], modal.shape[0], self.component))
        assert self.gain is not None
        if self.rate:
            parities, modes = motion.solution.normal.shape[1:3]
            basis = angle_basis(np.atleast_1d(theta), modes, parities, self.component)
            gain = self.gain(motion.solution, shell)
            assert not isinstance(gain, Relaxing)  # no rate of a stress is a quantity
            return motion.rates_at(shell, gain, self.rate, basis)
        return combined(motion.solution, shell, self.gain(motion.solution, shell), theta, self.component)

    def amplitudes(self, motion: WallMotion, shell: int) -> Amplitudes:
        """Return what gives its modal amplitudes, SI, at a slice of time indices."""
        if self.modal is not None:
            modal = self.modal(motion, shell)
            return lambda window: modal[..., window]
        assert self.gain is not None
        return motion.amplitudes(shell, self.gain(motion.solution, shell), self.rate)

    def given(self, motion: WallMotion, shell: int) -> bool:
        """Return whether a run gives it for a shell: the shell has it, and where its transform is needed the run all its instants."""
        solution = motion.solution
        wall = solution.problem.shells[shell]
        along = solution.along is not None
        there = (
            (along or self.dimensions == 2)
            and not (along and self.needs == "electrodes")
            and (not self.through or searchable(solution, shell))
        )
        needed = self.rate or int(self.relaxes and wall.relaxes)
        return there and motion.has_rate(needed) and self.lack(solution.problem.system, shell) is None
