"""Currents of amplifiers that stop at a limit, marched beside the linear answer (theory manual, "Limited currents").

The charge per area of the actuators under a segment is q = m + C u, m that of the strain and C u that of the voltage; the current dq/dt. An
amplifier gives what its law asks for, a, as far as the current I allows: over a step dt, with alpha = a + m/C the charge asked for and
beta = u + m/C that given, over C,

    beta_n = beta_(n-1) + clip(alpha_n - beta_(n-1)),      |clip| <= I dt/C.

The lack delta = u - a = beta - alpha acts as that of voltages does (:mod:`coaxshell.solver.limited_voltages`),

    alpha = alpha_0 + K * delta,      K = T - 1 + Q T/C,      T = (1 - H K C)^-1,

Q the charge of strain per volt. Each step is one of limited voltages whose limits move with beta. Any C serves that is about what a volt
puts in at once, all else belongs to m and Q: of walls of elastic solids it is that of a free thickness in order 0, so that Q holds what
orders differ in and what holds the thickness.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import NamedTuple

import numpy as np

from coaxshell.model.gains import law_of
from coaxshell.model.places import shell_phrase
from coaxshell.model.prefixes import engineering
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.circle import peak_on_circle
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.progress import Progress
from coaxshell.solver.actuation import voltage_asked
from coaxshell.solver.electrode_loops import ElectrodeLoops
from coaxshell.solver.electrode_patterns import Patterns, patterns_of
from coaxshell.solver.electrodes import segment_length, segment_mean
from coaxshell.solver.faced_charges import charge_in_motion, charge_of, per_volt, per_volt_of_grid
from coaxshell.solver.interface.absorbers import AbsorberSet
from coaxshell.solver.limited_voltages import LimitedMarch, VoltageLimits, at_points, inverted_weights, may_stop, require_fine, solve_alone
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.solver.structure_spectra import Moved, StructureSpectra
from coaxshell.solver.voltage_response import VoltageResponse, controlled, read_of, read_without, response_of
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.shell_model import ShellModel
from coaxshell.structure.solid_charges import free_capacity


def capacities(problem: Problem) -> FloatArray:
    """Return C of each wall under control, charge per area and volt; 1 of one without actuators, whose voltage is 0."""
    found = []
    for wall in (problem.shells[i] for i in controlled(problem)):
        solid = free_capacity(wall) if isinstance(wall, ElasticWall) else None
        found.append(sum(held for _, held in wall.charges(Modes.up_to(0))) if solid is None else solid)
    return np.array([one or 1.0 for one in found])


def largest_steps(problem: Problem, step: float) -> FloatArray:
    """Return I dt/C of each wall under control, V, for a step in transits."""
    scales, found = problem.scales, []
    for i, held in zip(controlled(problem), capacities(problem), strict=True):
        law = law_of(problem.system, i)
        assert law is not None
        assert law.current_limit is not None
        found.append(law.current_limit * scales.time / (scales.pressure * scales.length) * step / held)
    return np.array(found)


def _acts(wall: ShellModel) -> bool:
    """Return whether a wall has actuators whose charge is known."""
    return bool(wall.transducers and wall.transducers.actuators) if isinstance(wall, ElasticWall) else bool(wall.charges(Modes.up_to(0)))


def _held(limit: float) -> str:
    return f"the current was held at {engineering(limit, 'A/m^2')}; lower the gains to stay within it"


def warnings_of_held(problem: Problem, held: Sequence[int]) -> list[str]:
    """Return the warnings of a run in which some walls were held at a limit: where it is that of the current."""
    laws = [(i, law_of(problem.system, i)) for i in held if _acts(problem.shells[i])]
    limits = [(i, law.current_limit) for i, law in laws if law is not None and law.current_saturation]
    return [f"{shell_phrase(i, len(problem.shells))}: {_held(limit)}" for i, limit in limits if limit is not None]


def warning_beyond(problem: Problem, shell: int, asked: float, length: float) -> list[str]:
    """Return the warning of a shell whose amplifier is asked for a current (A/m^2, mean over a length in m) beyond its limit, if it is."""
    law = law_of(problem.system, shell)
    if law is None or law.current_limit is None or asked <= law.current_limit:
        return []
    told = f"the control law asks for {engineering(asked, 'A/m^2')} (mean over {engineering(length, 'm')} of the wall), "
    told += f"{asked / law.current_limit:.3g} times the {engineering(law.current_limit, 'A/m^2')} of its amplifier; "
    stops = law.segments is not None and not law.dead and not law.saturation and may_stop(problem)
    see = "set control.current_saturation = true to see what it can really do, or " if stops else ""
    remedy = "means over a time step stay within it: use a shorter time_step" if law.current_saturation else f"{see}lower the gains"
    return [f"{shell_phrase(shell, len(problem.shells))}: {told}{remedy}"]


def warnings_of(solved: SolvedSpectra) -> list[str]:
    """Return the warnings about amplifiers held at their current, or asked for more, means over a segment."""
    problem, found = solved.problem, []
    for i in controlled(problem):
        law, wall = law_of(problem.system, i), problem.shells[i]
        if law is None or law.current_limit is None or not _acts(wall):
            continue
        volts = voltage_asked(solved)[i]
        moved = Moved(solved.normal, solved.tangential, solved.solid)
        charge = charge_in_motion(solved.structure.open_loop.problem.shells[i], i, moved, solved.modes, solved.grid, volts)
        length = segment_length(problem, i)
        share = segment_mean(solved.modes.orders, length / problem.system.shells[i].radius)[:, None]
        peak = peak_on_circle(solved.grid.invert(share * charge * solved.grid.nodes))
        per_area = problem.scales.pressure * problem.scales.length / problem.scales.time
        asked = 0.0 if peak is None else abs(peak.value) * per_area
        if law.current_saturation and i in solved.held:
            found += warnings_of_held(problem, [i])
        else:
            found += warning_beyond(problem, i, asked, length)
    return found


class _Answers(NamedTuple):
    """What walls under control read and hold: per volt, m as without C, and under the sources alone.

    Attributes
    ----------
    response : VoltageResponse
    charge : ndarray, shape (controlled, controlled, orders, nodes)
        Q.
    read, held : ndarray, shape (controlled, parities, orders, nodes)
        Volts and charge without voltages.
    """

    response: VoltageResponse
    charge: ComplexArray
    read: ComplexArray
    held: ComplexArray

    @classmethod
    def of(cls, structure: StructureSpectra) -> _Answers:
        """Return it at the orders and nodes of a run."""
        read, bare = read_without(structure), structure.open_loop
        if bare.solid is None:
            by_volts = response_of(structure, charge_of).read
            return cls(response_of(structure), by_volts, read, read_without(structure, charge_of))
        problem, shells = bare.problem, controlled(structure.problem)
        found = per_volt_of_grid(problem, shells, bare.modes, bare.grid)
        held = np.stack([charge_in_motion(problem.shells[i], i, bare.solid, bare.modes, bare.grid) for i in shells])
        return cls(VoltageResponse.of_faces(shells, found.read), _strained(structure.problem, found.charge), read, held)


def _strained(problem: Problem, charge: ComplexArray) -> ComplexArray:
    """Return Q from the whole charge per volt, less C."""
    own = np.einsum("ij,j->ij", np.eye(len(charge)), capacities(problem))
    return np.asarray(charge - own[..., None, None])


def _kernel(structure: StructureSpectra, patterns: Patterns, s: ComplexArray) -> ComplexArray:
    """Return K at some nodes, (walls, walls, patterns, nodes)."""
    problem, modes = structure.problem, structure.modes
    if problem.two_faced:
        both = per_volt(problem.open_loop, controlled(problem), modes, s)
        response, charge = VoltageResponse.of_faces(controlled(problem), both.read), _strained(problem, both.charge)
    else:
        answers = partial(VoltageResponse.at, problem.open_loop, problem, modes, s)
        response, charge = answers(), answers(charge_of).read
    inverse = ElectrodeLoops.of(problem, response, patterns, s).inverse
    strained = np.moveaxis(patterns.responses(charge), (0, 1), (2, 3)) / capacities(problem)[:, None]
    return np.asarray(np.moveaxis(inverse - np.eye(inverse.shape[-1]) + strained @ inverse, (2, 3), (0, 1)))


@dataclass(frozen=True, eq=False)
class CurrentLimits(VoltageLimits):
    """Amplifiers whose currents are limited, in patterns: what is held against the limits is the change of the charge within a step.

    Attributes
    ----------
    strained : ndarray, shape (walls, walls, patterns, nodes)
        Q.
    """

    strained: ComplexArray

    @cached_property
    def limits(self) -> FloatArray:
        """I dt/C at each point, V, (walls, points)."""
        return largest_steps(self.structure.problem, self.structure.grid.time_step)[:, None] * np.ones(len(self.patterns.evaluate))

    def held(self, free: Moved) -> ComplexArray:
        """Return m of a motion without voltages, in patterns."""
        return self.patterns.readings(charge_without(self.structure, free))

    def demanded(self, asked: ComplexArray, held: ComplexArray | float) -> FloatArray:
        """Return the charge over C, u + m/C, under voltages and what moves without them."""
        capacity = capacities(self.structure.problem)[:, None, None]
        return self.structure.grid.invert(asked + (held + np.einsum("ijqk,jqk->iqk", self.strained, asked)) / capacity)

    def reached(self, voltage: ComplexArray, held: ComplexArray | float) -> bool:
        """Return whether any step of the charge is longer than its limit."""
        steps = np.abs(np.diff(at_points(self.patterns, self.demanded(voltage, held)), axis=-1, prepend=0.0))
        return bool((steps > self.limits[..., None] * (1.0 + 1e-9)).any())

    def march(self) -> LimitedMarch:
        """Return the march of what is lacking."""
        kernel = partial(_kernel, self.structure, self.patterns)
        march = LimitedMarch(self.patterns, self.limits, inverted_weights(self.structure, kernel), moving=True)
        require_fine(self.structure.grid, march.weights)
        return march

    def off(self, given: ComplexArray, asked: ComplexArray, lack: FloatArray, held: ComplexArray | float) -> FloatArray:
        """Return by how much what is cut off an answer differs from what was marched, in patterns."""
        beta = self.demanded(given, held)
        return self._cut_off(beta - lack - np.concatenate([np.zeros_like(beta[..., :1]), beta[..., :-1]], axis=-1)) - lack

    def shown(self, given: ComplexArray, asked: ComplexArray) -> tuple[ComplexArray, FloatArray]:
        """Return the voltages given, in patterns and at points."""
        return given, at_points(self.patterns, self.structure.grid.invert(given))


def charge_per_volt(structure: StructureSpectra) -> ComplexArray:
    """Return Q at the orders and nodes of a run, (controlled, controlled, orders, nodes)."""
    bare = structure.open_loop
    if not bare.problem.two_faced:
        return response_of(structure, charge_of).read
    return _strained(structure.problem, per_volt_of_grid(bare.problem, controlled(structure.problem), bare.modes, bare.grid).charge)


def charge_without(structure: StructureSpectra, free: Moved) -> ComplexArray:
    """Return the charge of strain in a motion without voltages, (controlled, parities, orders, nodes)."""
    if free.solid is None:
        return read_of(structure, free, charge_of)
    bare, shells = structure.open_loop, controlled(structure.problem)
    return np.stack([charge_in_motion(bare.problem.shells[i], i, free, bare.modes, bare.grid) for i in shells])


def solve_limited_currents(structure: StructureSpectra, absorbers: AbsorberSet, progress: Progress | None = None) -> SolvedSpectra | None:
    """Return the answer of a structure whose amplifiers' currents stop at their limit; None where none reaches it.

    Raises
    ------
    InputError
        If feedback is so strong within a step that its limit cannot be found.
    """
    answers = _Answers.of(structure)
    patterns = patterns_of(structure.problem, answers.response.shells, structure.modes.orders, answers.read.shape[1])
    limits = CurrentLimits(structure, patterns, patterns.responses(answers.charge))
    read, held = patterns.readings(answers.read), patterns.readings(answers.held)
    return solve_alone(structure, absorbers, answers.response, limits, read, held, progress)
