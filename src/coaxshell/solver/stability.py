"""Whether the closed loop is stable: poles with a growth that would show within the duration, counted before any marching.

The modal determinants with and without feedback, D_m and D0_m, have the same leading behaviour, and D0_m has no zero in the
right half plane. By the argument principle the number of unstable poles of order m is minus the change of arg(D_m/D0_m) along
s = sigma_0 + i omega, omega from 0 to infinity, divided by pi. Orders whose walls stay passive with their feedback need no count, nor
does any other where laws take energy alone (:mod:`coaxshell.solver.taking_bands`).

D_m is that of V and W of all shells. Where V is eliminated first, of a shell with feedback H P S' (:mod:`.electroded_wall`) its entry of
the tridiagonal matrix of W, times the relative stiffness along the hoop that feedback leaves, 1 - H P_v S_v/A_vv, is

    D_i - H [(P_w + P_v V/W)(S_w + S_v V/W) + P_v S_v D_i/A_vv],

linear in H, as a change of rank one has to be; V/W and A_vv = M s^2 + K_vv are those without feedback.

An unstable loop cannot be seen in its answer: the inverse transform of poles right of its contour is smooth, plausible and wrong.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import NamedTuple

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.errors import InputError
from coaxshell.model.control import PDControl
from coaxshell.model.feedback import Feedback
from coaxshell.model.parts import laws_of, shells_under
from coaxshell.model.prefixes import engineering
from coaxshell.model.shells import Shell
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.texts import rounded
from coaxshell.solver.cascade import CascadeSystem, FluidOperator
from coaxshell.solver.contour import Contour, along_alone, fed_orders, few_of, turned
from coaxshell.solver.coupling import ModalSystem, determinant
from coaxshell.solver.passivity import passive_orders
from coaxshell.solver.scaling import Problem
from coaxshell.solver.shared_parts import SharedParts
from coaxshell.solver.taking_bands import asymmetry, held_in, taking_bands
from coaxshell.structure.control_law import ControlGains
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.shell_model import FaceReceptance, ShellModel

_ROUGHLY = 1.15
"""How far apart rates may be between which the fastest growth is, before Newton's method takes over."""
_ITERATIONS = 40
_STARTS = 12
"""Places that Newton's method is started from until one leads to a pole that grows."""


class UnstablePoles(NamedTuple):
    """Orders with unstable poles, how many each has, and the least |D_m/D0_m| met on the contour: infinite where nothing was counted."""

    orders: FloatArray
    counts: FloatArray
    nearest: float = np.inf


@dataclass(frozen=True)
class OpenLoop:
    """The system without feedback at some nodes, and what feedback adds to it per unit gain: the same for all gains.

    Attributes
    ----------
    diagonal, coupling : sequence of ndarray, shape (orders, nodes)
        Of its tridiagonal matrix; see :class:`coaxshell.solver.coupling.ModalSystem`.
    determinant : ndarray, shape (orders, nodes)
    fed_back : dict of int to ndarray
        By number of the controlled shell.
    along : dict of int to ndarray or float
        P_v S_v/A_vv of it; 0 where it is driven by a normal pressure.
    """

    diagonal: Sequence[ComplexArray]
    coupling: Sequence[ComplexArray | float]
    determinant: ComplexArray
    fed_back: dict[int, ComplexArray]
    along: dict[int, ComplexArray | float]

    @property
    def nbytes(self) -> int:
        """Bytes of all arrays."""
        arrays = [*self.diagonal, *self.coupling, self.determinant, *self.fed_back.values(), *self.along.values()]
        return sum(x.nbytes for x in arrays if isinstance(x, np.ndarray))

    @classmethod
    def of(cls, problem: Problem, nodes: ComplexArray, modes: Modes, shared: SharedParts | None) -> OpenLoop:
        """Return it for a problem, whose gains only tell which shells are controlled."""
        system = ModalSystem(problem.open_loop, nodes, modes, shared=shared)
        fed_back = {
            i: wall.fed_back(modes, operator)
            for i, (wall, operator) in enumerate(zip(problem.shells, system.shells, strict=True))
            if wall.gains is not None
        }
        along = {i: problem.shells[i].fed_back_along(modes, nodes) for i in fed_back}
        return cls(system.diagonal, system.coupling, determinant(system.diagonal, system.coupling), fed_back, along)

    def closed(self, problem: Problem, nodes: ComplexArray, modes: Modes) -> ComplexArray:
        """Return D_m/D0_m, the determinant with the feedback of a problem over that without."""
        diagonal, left = list(self.diagonal), [np.ones(1, np.complex128) for _ in self.diagonal]
        for i, pressure in self.fed_back.items():
            gains = problem.shells[i].gains
            if gains is not None:
                law = gains.at(nodes, modes)
                diagonal[i] = diagonal[i] - law * (pressure + self.along[i] * diagonal[i])
                left[i] = 1.0 - law * self.along[i]
        coupling = [x * left[i] * left[i + 1] for i, x in enumerate(self.coupling)]
        return np.asarray(determinant(diagonal, coupling) / self.determinant)


@dataclass(frozen=True)
class FacedLoop:
    """The system without feedback at some nodes where walls have two faces: its determinant, by the cascade, its walls and its fluids."""

    determinant: ComplexArray
    walls: Sequence[FaceReceptance]
    fluids: Sequence[FluidOperator]

    @classmethod
    def of(cls, passive: Problem, nodes: ComplexArray, modes: Modes) -> FacedLoop:
        """Return it for a problem without feedback."""
        with one_blas_thread():  # many small matrices
            system = CascadeSystem(passive, nodes, modes)
        return cls(system.determinant(), system.walls, system.fluids)

    @property
    def nbytes(self) -> int:
        """Bytes of all arrays."""
        kept = [x for wall in self.walls for x in vars(wall).values()] + [x for fluid in self.fluids for x in fluid]
        return self.determinant.nbytes + sum({id(x): x.nbytes for x in kept if isinstance(x, np.ndarray)}.values())

    def closed(self, problem: Problem, nodes: ComplexArray, modes: Modes) -> ComplexArray:
        """Return D_m/D0_m; of thin walls under electrodes with what feedback leaves along the hoop."""
        with one_blas_thread():
            walls = [_closed(wall, own, modes, nodes) for wall, own in zip(problem.shells, self.walls, strict=True)]
            ratio = CascadeSystem(problem, nodes, modes, walls=walls, fluids=self.fluids).determinant() / self.determinant
        for wall in problem.shells:
            if wall.faces_move_alike and wall.gains is not None:
                ratio = ratio * (1.0 - wall.gains.at(nodes, modes) * wall.fed_back_along(modes, nodes))
        return np.asarray(ratio)


def _closed(wall: ShellModel, own: FaceReceptance, modes: Modes, nodes: ComplexArray) -> FaceReceptance:
    """Return receptances of a wall with its feedback, of which ``own`` are those without."""
    if wall.gains is None:
        return own
    return wall.fed_back_from(own, modes, nodes) if isinstance(wall, ElasticWall) else wall.receptance(modes, nodes)


def opened(problem: Problem, passive: Problem, nodes: ComplexArray, modes: Modes, shared: SharedParts | None) -> OpenLoop | FacedLoop:
    """Return a problem without feedback; ``passive`` is it, made once for all nodes."""
    return FacedLoop.of(passive, nodes, modes) if problem.two_faced else OpenLoop.of(problem, nodes, modes, shared)


def with_gains(problem: Problem, proportional: float, derivative: float) -> Problem:
    """Return the problem with the gains of every shell under PD control scaled by 0 or 1 each."""
    shells = (
        wall.with_gains(wall.gains.scaled(proportional, derivative) if isinstance(wall.gains, ControlGains) else wall.gains)
        for wall in problem.shells
    )
    return replace(problem, shells=tuple(shells))


def unstable_poles(
    problem: Problem, max_order: int, duration: float, shared: SharedParts | None = None, wavenumber: float = 0.0
) -> UnstablePoles:
    """Return the orders whose response, at an axial wavenumber, would grow by more than a factor e within the duration."""
    return poles_beyond(problem, Modes.up_to(max_order, wavenumber), 1.0 / duration, shared)


def poles_beyond(problem: Problem, modes: Modes, least: float, shared: SharedParts | None = None) -> UnstablePoles:
    """Return the orders with poles that grow by more than a rate per transit.

    Those are counted that are fed back and whose walls it may make give energy (:mod:`coaxshell.solver.passivity`); no other has any.
    What laws take energy in is not followed (:mod:`coaxshell.solver.taking_bands`).
    """
    none = UnstablePoles(np.zeros(0), np.zeros(0))
    fed = few_of(modes, fed_orders(problem, modes))
    if not fed.count:
        return none
    contour, slow = Contour.of(problem, fed, least), along_alone(problem, fed)
    if asymmetry(problem, fed) is not None and taking_bands(slow, fed, contour).hold_all(contour):
        return none
    some = few_of(fed, fed.orders[~passive_orders(slow, fed, least)])
    if not some.count:
        return none
    if some.count < fed.count:
        contour = Contour.of(problem, some, least)
    known, held = (slow, shared, slow.open_loop), held_in(slow, some, contour)
    counts, nearest = np.zeros(some.count), np.inf
    for part in (held, ~held):  # of which the first have bands in common
        if part.any():
            own = few_of(some, some.orders[part])
            bands = taking_bands(slow, own, contour)
            if not bands.hold_all(contour):
                turn, near = turned(slow, own, contour, partial(_ratio, *known), bands, partial(_angle, *known))
                counts[part], nearest = np.rint(-turn / np.pi), min(nearest, near)
    return UnstablePoles(some.orders[counts > 0], counts[counts > 0], nearest)


def _ratio(problem: Problem, shared: SharedParts | None, passive: Problem, nodes: ComplexArray, modes: Modes) -> ComplexArray:
    """Return D_m/D0_m at some nodes; what is the same for all gains is found among the shared parts, or left there.

    ``passive`` is the problem without feedback.
    """
    return _opened(problem, shared, passive, nodes, modes).closed(problem, nodes, modes)


def _angle(problem: Problem, shared: SharedParts | None, passive: Problem, nodes: ComplexArray, modes: Modes) -> FloatArray:
    """Return the argument of D_m/D0_m as it is followed from no feedback, where the law of every wall takes energy alone: one by one."""
    open_loop = _opened(problem, shared, passive, nodes, modes)
    angle, before, shells = np.zeros((modes.count, nodes.size)), np.ones(1, np.complex128), passive.shells
    for i, wall in enumerate(problem.shells):
        if wall.gains is not None:
            shells = (*shells[:i], wall, *shells[i + 1 :])
            closed = open_loop.closed(replace(problem, shells=shells), nodes, modes)
            angle += np.angle(closed / before)
            before = closed
    return angle


def _opened(problem: Problem, shared: SharedParts | None, passive: Problem, nodes: ComplexArray, modes: Modes) -> OpenLoop | FacedLoop:
    make = partial(opened, problem, passive, nodes, modes, shared)
    if shared is None:
        return make()
    controlled = tuple(shell.gains is not None for shell in problem.shells)
    known = (passive.shells, controlled, problem.fluids, problem.scales, modes.key)
    found: OpenLoop | FacedLoop = shared.get_or_make(("open loop", *known, nodes.tobytes()), make)
    return found


def determinant_ratio(problem: Problem, passive: Problem, nodes: ComplexArray, modes: Modes) -> ComplexArray:
    """Return D_m/D0_m of some modes at any nodes, shape (orders, nodes); ``passive`` is the problem without feedback."""
    return _ratio(problem, None, passive, nodes, modes)


class Growth(NamedTuple):
    """The fastest growing motion: e^{(rate + i frequency) t} of an order, t in transits."""

    order: int
    rate: float
    frequency: float


def fastest_growth(problem: Problem, orders: FloatArray, least: float, wavenumber: float = 0.0) -> Growth:
    """Return the fastest growth among orders known to grow by more than a rate per transit.

    The rate is bisected roughly; Newton's method, from where on the contour beside it it has the shortest way, finds the pole itself.
    """
    low, high = least, 4.0 * least
    while (beyond := poles_beyond(problem, Modes(orders, wavenumber), high).orders).size:
        low, high, orders = high, 4.0 * high, beyond
    while high > _ROUGHLY * low:
        middle = float(np.sqrt(low * high))
        beyond = poles_beyond(problem, Modes(orders, wavenumber), middle).orders
        low, high = (middle, high) if beyond.size else (low, middle)
        orders = beyond if beyond.size else orders
    poles = {int(order): _pole(problem, Modes(np.array([order]), wavenumber), low) for order in orders}
    order = max(poles, key=lambda one: poles[one].real)
    return Growth(order, float(poles[order].real), abs(float(poles[order].imag)))


def _pole(problem: Problem, modes: Modes, least: float) -> complex:
    """Return a pole of one order near the contour of a rate, which it grows by at least."""
    slow = along_alone(problem, modes)
    passive = slow.open_loop

    def newton(s: ComplexArray) -> ComplexArray:
        """Return D_m/D0_m over its derivative: how far Newton's method goes from each place."""
        step = 1e-6 * np.abs(s)
        here, ahead = (opened(slow, passive, x, modes, None).closed(slow, x, modes)[0] for x in (s, s + step))
        return np.asarray(here * step / np.where(ahead == here, 1e-300, ahead - here))

    contour = Contour.of(problem, modes, least).nodes
    nearest = contour[np.argsort(np.abs(newton(contour)))[:_STARTS]]  # the pole is nearer to the contour than any that does not grow
    for start in nearest:
        s = np.array([start])
        for _ in range(_ITERATIONS):
            change = newton(s)
            s = np.maximum((s - change).real, 0.5 * least) + 1j * (s - change).imag
            if abs(change[0]) < 1e-9 * abs(s[0]) or abs(s[0]) > 2.0 * abs(contour[-1]):
                break
        if abs(change[0]) < 1e-6 * abs(s[0]) and s[0].real >= 0.999 * least:
            return complex(s[0])
    return complex(least, nearest[0].imag)


def nearest_ratio(problem: Problem, max_order: int, least: float, wavenumber: float = 0.0) -> float:
    """Return the least |D_m/D0_m| on the contour, infinite where nothing had to be counted; 0 where an order grows by more than a rate."""
    found = poles_beyond(problem, Modes.up_to(max_order, wavenumber), least)
    return 0.0 if found.orders.size else found.nearest


def growth_beyond(problem: Problem, max_order: int, rate: float, wavenumber: float = 0.0) -> float:
    """Return the rate of the fastest growth at an axial wavenumber, or the rate given where nothing grows faster."""
    found = poles_beyond(problem, Modes.up_to(max_order, wavenumber), rate)
    return fastest_growth(problem, found.orders, rate, wavenumber).rate if found.orders.size else rate


def require_stable(problem: Problem, max_order: int, duration: float, shared: SharedParts | None = None, wavenumber: float = 0.0) -> float:
    """Raise InputError, naming gain and order, if the closed loop is unstable at an axial wavenumber; else return how near it is.

    That is the least |D_m/D0_m| on the contour, infinite where nothing had to be counted.
    """
    if all(shell.gains is None for shell in problem.shells):
        return np.inf
    unstable = unstable_poles(problem, max_order, duration, shared, wavenumber)
    if unstable.orders.size == 0:
        return unstable.nearest
    fastest = fastest_growth(problem, unstable.orders, 1.0 / duration, wavenumber)
    names, said = _guilty(problem, max_order, duration, wavenumber)
    where = f" at the axial wavenumber {wavenumber:.3g}/a" if wavenumber else ""
    orders, grow = listed(unstable.orders)
    hertz = fastest.frequency / (2.0 * np.pi * problem.scales.time)
    told = f"order {fastest.order} by e^({rounded(fastest.rate, 3)} t), t in transits, at {engineering(hertz, 'Hz')}"
    raise InputError(
        " and ".join(names),
        f"{said} makes the closed loop unstable: {orders}{where} {grow} without bound, fastest {told}",
        remedy(problem),
    )


def listed(orders: FloatArray) -> tuple[str, str]:
    """Return orders as they are told, the first five and the last, and the verb that goes with them."""
    first = ", ".join(f"{order:.0f}" for order in orders[:5])
    rest = f", ..., {orders[-1]:.0f} ({orders.size} in all)" if orders.size > 5 else ""
    return (f"order {first}", "grows") if orders.size == 1 else (f"orders {first}{rest}", "grow")


def _guilty(problem: Problem, max_order: int, duration: float, wavenumber: float) -> tuple[list[str], str]:
    """Return which entries of the control make the loop unstable, and their values."""
    control = problem.system.control
    if isinstance(control, tuple):
        return _guilty_of(control, problem, max_order, duration, wavenumber)
    if isinstance(control, Feedback):
        if control.delay and not unstable_poles(_at_once(problem), max_order, duration, wavenumber=wavenumber).orders.size:
            return ["control.delay"], engineering(control.delay, "s")
        return ["control.numerator"], _shown(control.numerator)
    assert control is not None
    gains = {name: getattr(control, name) for name in ("proportional", "derivative")}
    alone = {
        "proportional": unstable_poles(with_gains(problem, 1.0, 0.0), max_order, duration, wavenumber=wavenumber).orders.size > 0,
        "derivative": unstable_poles(with_gains(problem, 0.0, 1.0), max_order, duration, wavenumber=wavenumber).orders.size > 0,
    }
    guilty = [name for name, bad in alone.items() if bad] or list(gains)
    return [f"control.{name}" for name in guilty], " and ".join(_shown(gains[name]) for name in guilty)


def _guilty_of(
    laws: Sequence[PDControl | Feedback], problem: Problem, max_order: int, duration: float, wavenumber: float
) -> tuple[list[str], str]:
    """Return which of several laws are unstable by themselves, all if none is."""
    found = []
    for place, law in enumerate(laws):
        shells = shells_under(problem.system, law)
        alone = (wall if i in shells else wall.with_gains(None) for i, wall in enumerate(problem.shells))
        if unstable_poles(replace(problem, shells=tuple(alone)), max_order, duration, wavenumber=wavenumber).orders.size:
            found.append(f"control[{place}]")
    return found or ["control"], "this law" if len(found) == 1 else "these laws together"


def _at_once(problem: Problem) -> Problem:
    """Return the problem whose feedback has no delay."""
    walls = tuple(wall.with_gains(None if wall.gains is None else wall.gains.late(-wall.gains.delay)) for wall in problem.shells)
    return replace(problem, shells=walls)


def _shown(gain: float | tuple[float, ...]) -> str:
    return f"{gain:g}" if not isinstance(gain, tuple) else f"[{', '.join(f'{one:g}' for one in gain)}]"


def remedy(problem: Problem) -> str:
    """Return what makes a loop stable: signs and sizes, and with electrodes where sensors and actuators are."""
    system = problem.system
    if any(isinstance(law, Feedback) and law.delay for law in laws_of(system)):
        return (
            "answer sooner, use less gain, feed fewer orders back (control.weights) or give the walls a loss_factor: "
            "without losses of the walls any delay is fatal to some order"
        )
    if all(law.transducers == "paper" for law in laws_of(system)):
        return "use a smaller magnitude or the other sign (negative gains stiffen and damp)"
    other = "use a smaller magnitude or the other sign (positive gains stiffen and damp)"
    for number in system.controlled_shells:
        shell = system.shells[number]
        if isinstance(shell, Shell) and set(shell.serving("sensor")) != set(shell.serving("actuator")):
            apart = f"sensors and actuators of shells[{number}] lie apart, which turns the sign of bending"
            return f'make one layer both, role = "self-sensing" ({apart}), or {other}'
    return other
