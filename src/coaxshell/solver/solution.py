"""What every engine returns: modal histories in dimensionless form, and how far to trust them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.scaling import Problem
from coaxshell.solver.settings import Settings

if TYPE_CHECKING:
    from coaxshell.solver.solved_spectra import SolvedSpectra

QUANTITIES = ("displacement", "stress")
CAUSES = ("orders", "time step", "march")
"""Where errors of two-dimensional runs come from, in the order of :meth:`Estimates.by_cause`."""
AXIAL_CAUSE = "axial wavenumbers"
"""What comes to them in three dimensions."""

KEPT_BYTES = 512 * 1024 * 1024
"""Most bytes of the transforms that a solution keeps."""


@dataclass(frozen=True)
class Estimates:
    """Relative errors estimated by the engine itself, of displacement [:, 0] and mid-surface stress [:, 1] of each shell.

    Each is relative to the answer, both in the L2 norm over the surface and the whole time; NaN where an engine does not estimate it.

    Attributes
    ----------
    orders : ndarray, shape (shells, 2)
        What the orders above M would add and, through absorbers, change.
    time_step : ndarray, shape (shells, 2)
        Band limit of the inverse Laplace transform.
    march : ndarray, shape (shells, 2)
        Steps of nonlinear absorbers and saturating actuators; 0 without them.
    axial : ndarray, shape (shells, 2), or None
        What axial wavenumbers left out would add, in three dimensions.
    """

    orders: FloatArray
    time_step: FloatArray
    march: FloatArray
    axial: FloatArray | None = None

    @classmethod
    def unknown(cls, shells: int) -> Estimates:
        """Return those of a run of which nothing has been estimated."""
        return cls(*np.full((3, shells, 2), np.nan))

    @property
    def combined(self) -> FloatArray:
        """Sum of the errors by all causes, shape (shells, 2)."""
        total = self.orders + self.time_step + self.march
        return total if self.axial is None else total + self.axial

    @property
    def causes(self) -> tuple[str, ...]:
        """Names of the causes."""
        return CAUSES if self.axial is None else (*CAUSES, AXIAL_CAUSE)

    def by_cause(self) -> FloatArray:
        """Return the errors by each cause, shape (shells, 2, causes)."""
        parts = [self.orders, self.time_step, self.march]
        return np.stack(parts if self.axial is None else [*parts, self.axial], axis=-1)

    @property
    def modal_displacement(self) -> FloatArray:
        """What the orders left out change in the displacement of each shell."""
        return self.orders[:, 0]

    @property
    def modal_stress(self) -> FloatArray:
        """What the orders left out change in the stress of each shell."""
        return self.orders[:, 1]

    @property
    def time_window(self) -> float:
        """The largest error by the time step, march included, of any displacement."""
        return float((self.time_step + self.march)[:, 0].max(initial=0.0))


class Judgement(NamedTuple):
    """How far a run can be trusted: its estimates, and its physics warnings, one sentence each."""

    estimates: Estimates
    warnings: tuple[str, ...]


class JudgedLate:
    """A run whose estimates and warnings may be made when either is first read; they never change afterwards."""

    def judge_when_read(self, judge: Callable[[Any], Judgement]) -> None:
        """Leave estimates and warnings to be made, of the run itself, when either is first read; a copy is made of a run that is judged.

        Of runs that follow a slider, and of most runs of studies, nobody ever reads them.
        """
        for name in Judgement._fields:
            del vars(self)[name]
        vars(self)["_judge"] = judge

    def __getattr__(self, name: str) -> Any:
        """Return what is not here until it is read."""
        here, judge = vars(self), vars(self).get("_judge")
        if name in Judgement._fields and name not in here and judge is not None:
            here.update(judge(self)._asdict())
            here.pop("_judge", None)  # with all that it needs
        if name not in here:
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
        return here[name]

    def _judged(self) -> dict[str, Any]:
        """Return what a copy takes over of a run that is judged for it."""
        judged = {name: getattr(self, name) for name in Judgement._fields}
        return {**vars(self), **judged}


def is_whole(time: FloatArray, settings: Settings) -> bool:
    """Return whether some instants are all those of the run that some settings describe."""
    step, steps = settings.time_step, settings.steps
    return time.size == steps + 1 and bool(np.all(np.abs(time - step * np.arange(steps + 1)) <= 1e-6 * step))


class AxialMotion(NamedTuple):
    """What the walls of a three-dimensional run do along the axis at a station, each (shells, parities, M + 1, T).

    Attributes
    ----------
    u : ndarray
        Axial displacement: u = sum_m u[.,0,m] cos(m theta) + u[.,1,m] sin(m theta).
    w_z, w_zz, v_z, u_z : ndarray
        Derivatives along z of W, V and u.
    potentials : tuple of ndarray
        Open-circuit voltages of the walls' piezoelectric layers, V, by their number from the inside out; 0 of walls with fewer.
    potential_rates : tuple of ndarray
        Their derivatives by time, V per transit, where there is feedback; else none.
    stresses : dict of str to ndarray
        Those of elastic walls at their design depths, in rho_e c_e^2, by name; 0 of other walls, none where there is no elastic one.
    dead : tuple of int
        Segments that are dead in the belt over it alone.
    """

    u: FloatArray
    w_z: FloatArray
    w_zz: FloatArray
    v_z: FloatArray
    u_z: FloatArray
    potentials: tuple[FloatArray, ...]
    potential_rates: tuple[FloatArray, ...] = ()
    stresses: dict[str, FloatArray] = {}  # noqa: RUF012 - nobody changes it
    dead: tuple[int, ...] = ()


@dataclass(frozen=True)
class ModalSolution(JudgedLate):
    """Modal histories of one run; all arrays dimensionless (lengths in a, times in a/c_e).

    Attributes
    ----------
    problem : Problem
        The dimensionless problem that was solved, with its scales.
    settings : Settings
        Resolution, with ``modes`` resolved to a number.
    time : ndarray, shape (T,)
        Times from 0 in steps of the time step.
    normal : ndarray, shape (shells, parities, M + 1, T)
        W: w = sum_m W[.,0,m] cos(m theta) + W[.,1,m] sin(m theta), positive inward. ``parities`` is 1 when the sines vanish.
    tangential : ndarray, same shape
        V: v = sum_m V[.,0,m] sin(m theta) - V[.,1,m] cos(m theta), so that dv/dtheta = sum m (V0 cos + V1 sin).
    estimates : Estimates
    warnings : tuple of str
        Physics warnings, one sentence each with both numbers and the remedy. Both may be made when first read (:meth:`judge_when_read`).
    timings : dict
        Seconds by stage.
    hoop : ndarray, same shape, or None
        Hoop stress of elastic walls at their design depths, in rho_e c_e^2, 0 of others; None without elastic walls.
    potentials : ndarray, shape (layers, shells, parities, M + 1, T), or None
        Open-circuit voltages of the piezoelectric layers of elastic walls, V, by their number from the inside out; 0 of walls with fewer.
    normal_rate, tangential_rate : ndarray, same shape, or None
        dW/dt and dV/dt, kept where feedback needs them.
    absorber_displacement : ndarray, shape (absorbers, T)
        q_n.
    absorber_force : ndarray, shape (absorbers, 2, T)
        Line force f_n^(i)/(rho_e c_e^2 a) on the inner [0] and outer [1] of the shells it links, positive inward on the shell.
    control_correction : ndarray, shape (shells, parities, M + 1, T), or None
        Modal pressure of the saturated minus that of the linear control law, where saturation is on.
    control_voltage : ndarray, same shape, or None
        Voltage that the law asks for, V, kept where it is no sum of phi_s and its rate; 0 of shells without feedback.
    segment_voltage : ndarray, shape (shells, segments, T), or None
        Voltages of the segments of electrodes, V, where these are cut; ``control_voltage`` has them in orders.
    along : AxialMotion or None
        At a station of a three-dimensional run.
    spectra : SolvedSpectra or None
        The transforms that it was made from, as long as it is in the process that solved it. They belong to these very histories: a
        copy (:func:`dataclasses.replace`, :mod:`copy`, pickle) has none, and nothing is different without them but the time it takes.
    """

    problem: Problem
    settings: Settings
    time: FloatArray
    normal: FloatArray
    tangential: FloatArray
    estimates: Estimates
    warnings: tuple[str, ...] = field(default_factory=tuple)
    timings: dict[str, float] = field(default_factory=dict)
    hoop: FloatArray | None = field(default_factory=type(None))  # no default of the class: it may be read later
    potentials: FloatArray | None = field(default_factory=type(None))
    normal_rate: FloatArray | None = None
    tangential_rate: FloatArray | None = None
    absorber_displacement: FloatArray | None = None
    absorber_force: FloatArray | None = None
    control_correction: FloatArray | None = None
    control_voltage: FloatArray | None = None
    segment_voltage: FloatArray | None = None
    along: AxialMotion | None = None
    spectra: SolvedSpectra | None = field(default=None, init=False, repr=False, compare=False)

    def keep(self, spectra: SolvedSpectra) -> None:
        """Keep the transforms that the histories were made from; nothing larger than half a gigabyte."""
        if spectra.nbytes <= KEPT_BYTES:
            object.__setattr__(self, "spectra", spectra)

    def judge_when_read(self, judge: Callable[[ModalSolution], Judgement]) -> None:
        """Leave estimates and warnings to be made when either is first read: of runs that follow a slider they hardly ever are.

        A judgement reads the transforms: where those are not kept, it is made now, and a copy is made of a run that has been judged.
        """
        if self.spectra is None:
            vars(self).update(judge(self)._asdict())
            return
        super().judge_when_read(judge)

    def judge_as(self, run: JudgedLate) -> None:
        """Take over estimates and warnings of the run that this is a part of, when either is first read."""
        super().judge_when_read(lambda _: Judgement(run.estimates, run.warnings))

    def make_when_read(self, name: str, make: Callable[[], FloatArray]) -> None:
        """Leave a history to be made of the transforms when it is first read: now where they are not kept, and of a run that is copied."""
        here = vars(self)
        if self.spectra is None:
            here[name] = make()
            return
        here.pop(name, None)
        here["_later"] = {**self._left, name: make}

    @property
    def _left(self) -> dict[str, Callable[[], FloatArray]]:
        found: dict[str, Callable[[], FloatArray]] = vars(self).get("_later", {})
        return found

    def here(self, name: str) -> bool:
        """Whether a history need not be made yet."""
        return name in vars(self)

    def __getattr__(self, name: str) -> Any:
        """Return what is not here until it is read."""
        if name in (left := vars(self).get("_later", {})):
            vars(self)[name] = left[name]()
            left.pop(name, None)  # with all that it needs
            return vars(self)[name]
        return super().__getattr__(name)

    def __getstate__(self) -> dict[str, Any]:
        """Return what a copy takes over: all but the transforms."""
        for name in tuple(self._left):
            getattr(self, name)
        return {**self._judged(), "spectra": None}

    def field(self, name: str) -> FloatArray:
        """Return one of :data:`coaxshell.structure.shell_model.FIELDS`: W and V, the hoop stress of elastic walls, or what a station has.

        Shape (shells, parities, M + 1, T).
        """
        if name in ("w", "v"):
            return self.normal if name == "w" else self.tangential
        if self.along is not None and name in self.along.stresses:
            return self.along.stresses[name]
        if name == "hoop":
            assert self.hoop is not None
            return self.hoop
        found: FloatArray = getattr(self.along, name)
        return found

    def potential(self, layer: int) -> FloatArray:
        """Return the open-circuit voltages of a piezoelectric layer, V, (shells, parities, M + 1, T), of elastic walls or at a station."""
        found = self.potentials if self.along is None else self.along.potentials
        assert found is not None
        return found[layer]

    @property
    def whole(self) -> bool:
        """Whether the history has every instant of the run: a saved one may have been thinned, cut or interpolated since."""
        return is_whole(self.time, self.settings)

    def need_every_instant(self, what: str) -> None:
        """Refuse *what* is asked for where instants are missing; InputError."""
        if not self.whole:
            found = f"holds {self.time.size} instants where its run had {self.settings.steps + 1} (it was thinned, cut or interpolated)"
            raise InputError("response", found, f"{what} needs every one of them: use the run as it was saved, or solve it again")
