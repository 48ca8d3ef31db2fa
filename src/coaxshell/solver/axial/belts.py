"""Electrodes cut along the axis: belts, whose loops tie the waves of a class to each other (theory manual, "Belts").

What is not odd and even about z = 0 alike is taken apart into both. In class c of :class:`coaxshell.structure.belts.BeltClasses` the belts
read phi_c of the motion without feedback, and what voltages move is read back, over all waves q of the class,

    U_c = (1 - H K C_c)^-1 H K phi_c,      C_c = sum_q r_q C(k_q) + (1 - sum_q r_q) C(k_far),

in the orders, or in the patterns of segments, of :mod:`coaxshell.solver.electrode_loops`. C does not fade with k, as a voltage stretches
what lies under it however short that is: the waves left out, whose r_q fall as 1/k^2, are met by one at k_far = sqrt 3 k_max, which is
exact for the parts of C that go with 1 and with 1/k^2.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.broken_belts import DeadElectrodes
from coaxshell.solver.axial.faced import FacedWave
from coaxshell.solver.axial.families import Family, Named, WaveSet, wave_sets
from coaxshell.solver.axial.forces import WallForces
from coaxshell.solver.axial.open_waves import Answers, FacedAnswers, ThinAnswers
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.axial.tied_faces import Closed
from coaxshell.solver.axial.tied_wave import motion_parities
from coaxshell.solver.electrode_loops import ElectrodeLoops
from coaxshell.solver.electrode_patterns import Patterns, patterns_of
from coaxshell.solver.scaling import Problem
from coaxshell.solver.voltage_response import VoltageResponse, controlled
from coaxshell.structure.belts import BeltClasses, Belts
from coaxshell.structure.tied_wall import TiedWall


def driven_sets(
    problem: Problem, sampling: AxialSampling, stations: FloatArray, grid: LaplaceGrid, block: slice, forces: WallForces | None = None
) -> list[WaveSet]:
    """Return all waves of the sources of a problem at a slice of the nodes, those of the voltages of belts and of absorbers' forces too.

    Parameters are those of :func:`coaxshell.solver.axial.families.wave_sets`, ``forces`` at the nodes of the slice.
    """
    sets = wave_sets(problem, sampling, stations, grid.nodes[block], forces)
    belts = problem.belts
    if belts is None:
        return sets
    nearest, over = belts.over(stations)
    classes, s = classes_of(belts, sampling), grid.nodes[block]
    families = _families(problem, sampling, stations, sets)
    middles, zero = (_families(problem, sampling, z, wave_sets(problem, sampling, z, s)) for z in (nearest * belts.pitch, np.zeros(1)))
    under = [np.real(family.even) * classes.read[0] * over[:, None] for family in middles]
    about_zero = np.array([[np.real(family.even[0]), -np.real(family.odd[0])] for family in zero])
    driver = BeltDriver(problem, sampling, classes, families, about_zero, under, (nearest, over), grid, block)
    return [WaveSet(sampling.modes, families, sampling.fluids, driver)]


def classes_of(belts: Belts, sampling: AxialSampling) -> BeltClasses:
    """Return the classes of the waves of a run."""
    return BeltClasses(belts, belts.count(sampling.period), sampling.wavenumbers)


def charged(problem: Problem, sampling: AxialSampling, wave: int) -> FloatArray | None:
    """Return by what voltages of a wave charge the layers' capacitance more than they move walls, (orders,), None without belts.

    The field is that of the voltages themselves, whose waves do not end at k_max: with (l/p) |U_c|^2 for the sum of |A_q|^2 over a class
    each kept wave counts 1/sum_q r_q times.
    """
    if problem.belts is None:
        return None
    classes, orders = classes_of(problem.belts, sampling), sampling.modes[wave].orders
    kept = classes.kept(sampling.tops, orders)[int(classes.of[wave])]
    return np.asarray(np.sqrt(1.0 / kept))


def left_over(classes: BeltClasses, sampling: AxialSampling) -> FloatArray:
    """Return what the waves left out read of what they are given, 1 - sum_q r_q, of each class and order, (classes, M + 1)."""
    return 1.0 - classes.kept(sampling.tops, np.arange(sampling.max_order + 1.0))


def _families(problem: Problem, sampling: AxialSampling, stations: FloatArray, sets: list[WaveSet]) -> list[Family]:
    """Return the sources of all sets as families of one, uniform ones in k = 0 alone, and the voltages of belts, even and odd in z."""
    k, around = sampling.wavenumbers, motion_parities(problem)
    first = np.where(k == 0.0, 1.0, 0.0)
    found = []
    for waves in sets:
        for family in waves.families:
            alone = waves.modes is not sampling.modes
            even = np.ones((stations.size, 1)) * first
            found.append(Family(family.groups, even, 0.0 * even, first, family.parities) if alone else family)
    phase = np.multiply.outer(stations, k)
    cosine, sine = np.cos(phase), np.sin(phase)
    voltages = [Family([], cosine, sine, np.where(k == 0.0, 1.0, 0.5), around, of_voltages=0)]
    assert problem.belts is not None
    if any(family.origin for family in found) or problem.belts.lopsided:
        voltages.append(Family([], sine, -cosine, np.where(k == 0.0, 0.0, 0.5), around, of_voltages=1))
    return [*found, *voltages]


class BeltDriver:
    """The loops of all classes at a block of nodes.

    Parameters
    ----------
    problem : Problem
    sampling : AxialSampling
    classes : BeltClasses
    families : list of Family
        Sources, then voltages.
    about_zero : ndarray, shape (families, 2, waves)
        By what a wave of each family counts in the one along cos kz, and in that along sin kz.
    under : list of ndarray, shape (stations, waves)
        By what each wave of a family counts in the mean under the belt over each station, 0 between belts.
    places : tuple of ndarray, shape (stations,)
        The number of the belt next to each station, and 1 where it lies over it, else 0.
    grid : LaplaceGrid
    block : slice
    """

    def __init__(
        self,
        problem: Problem,
        sampling: AxialSampling,
        classes: BeltClasses,
        families: list[Family],
        about_zero: FloatArray,
        under: list[FloatArray],
        places: tuple[FloatArray, FloatArray],
        grid: LaplaceGrid,
        block: slice,
    ) -> None:
        self._problem, self._sampling, self._classes, self._families = problem, sampling, classes, families
        self._about_zero, self._under, self._places, self._grid, self._block = about_zero, under, places, grid, block
        self._shells = controlled(problem)
        self._voltages: dict[int, ComplexArray] = {}
        self._answers = FacedAnswers if problem.two_faced else ThinAnswers
        self._solved: tuple[int, dict[int, tuple[Answers[Any], list[Any]]]] = (-1, {})

    @property
    def order(self) -> list[int]:
        """All waves by number, those of a class side by side."""
        return [wave for number in range(self._classes.classes) for wave in self._classes.waves_of(number)]

    def amplitudes(self, wave: int) -> list[ComplexArray]:
        """Return what walls are read for in a wave, one array a family, (3 or 9 + layers, shells, parities, orders, nodes)."""
        opened, _ = self._open_wave(wave)
        return [opened.shown(motion) for motion in self._motions(wave)]

    def wave(self, wave: int) -> FacedWave:
        """Return a wave of walls with two faces without feedback."""
        opened, _ = self._open_wave(wave)
        assert isinstance(opened, FacedAnswers)
        return opened.wave

    def closed(self, wave: int) -> list[Closed]:
        """Return what the faces of all walls do in a wave, and the voltages that make it, one a family."""
        return self._motions(wave)

    def _motions(self, wave: int) -> list[Any]:
        """Return the motion of each family."""
        voltage = self.voltages(int(self._classes.of[wave]))
        opened, free = self._open_wave(wave)
        found = []
        for place, family in enumerate(self._families):
            if family.of_voltages is None:
                found.append(free[place])
                continue
            given = voltage[family.of_voltages][:, :, : opened.modes.count]
            found.append(opened.under(self._classes.push[family.of_voltages, wave] * given))
        return found

    def voltages(self, number: int) -> ComplexArray:
        """Return U_c and U'_c of a class in orders, (1 or 2, walls, parities, M + 1, nodes), made once."""
        if number in self._voltages:
            return self._voltages[number]
        if not self._classes.belts.broken:
            loops, volts = self._healthy(number)
            self._voltages[number] = self._in_orders(loops, volts)
        else:  # which tie all classes
            each = [self._healthy(one) for one in range(self._classes.classes)]
            dead = DeadElectrodes(self._classes, each[0][0].patterns)
            given = dead.voltages([loops for loops, _ in each], [volts for _, volts in each])
            self._voltages = {one: self._in_orders(each[one][0], volts) for one, volts in enumerate(given)}
        return self._voltages[number]

    def _in_orders(self, loops: ElectrodeLoops, volts: ComplexArray) -> ComplexArray:
        return np.stack([loops.patterns.in_orders(one) for one in volts])

    def _healthy(self, number: int) -> tuple[ElectrodeLoops, ComplexArray]:
        """Return the loops of a class and what they give with every belt alive, in patterns, (1 or 2, walls, patterns, nodes)."""
        s, walls = self._grid.nodes[self._block], len(self._shells)
        orders = np.arange(self._sampling.max_order + 1.0)
        patterns = self._patterns(orders)
        read = self._far.read * self._left_over[number][:, None]
        phi = np.zeros((self._along, walls, motion_parities(self._problem), orders.size, s.size), np.complex128)
        for wave, (opened, free) in self._open_waves(number).items():
            count = opened.modes.count
            read[:, :, :count] += self._classes.loop_shares[wave] * opened.read
            for place, motion in enumerate(free):
                seen = opened.readings(motion)
                for parity in range(self._along):
                    share = self._classes.read[parity, wave] * self._about_zero[place, parity, wave]
                    phi[parity, :, : seen.shape[1], :count] += share * seen
        loops = ElectrodeLoops.of(self._problem, VoltageResponse.of_faces(self._shells, read), patterns, s)
        return loops, np.stack([loops.voltages(patterns.readings(one)) for one in phi])

    @property
    def _along(self) -> int:
        """How many parities there are along the axis."""
        return 1 + sum(family.of_voltages == 1 for family in self._families)

    def _patterns(self, orders: FloatArray) -> Patterns:
        return patterns_of(self._problem, self._shells, orders, motion_parities(self._problem))

    def _open_waves(self, number: int) -> dict[int, tuple[Answers[Any], list[Any]]]:
        """Return the waves of a class without feedback and what sources move in them, by family; those opened last are kept."""
        if set(self._solved[1]) != set(self._classes.waves_of(number)):
            self._solved = number, {wave: self._opened(wave) for wave in self._classes.waves_of(number)}
        return self._solved[1]

    def _open_wave(self, wave: int) -> tuple[Answers[Any], list[Any]]:
        """Return a wave of a class whose voltages are known: alone, if the others are no longer kept."""
        if wave not in self._solved[1]:
            self.voltages(int(self._classes.of[wave]))
        if wave not in self._solved[1]:
            self._solved = -1, {wave: self._opened(wave)}
        return self._solved[1][wave]

    def _opened(self, wave: int) -> tuple[Answers[Any], list[Any]]:
        opened = self._answers(self._problem, self._grid.nodes[self._block], self._sampling.modes[wave])
        sources = (family for family in self._families if family.of_voltages is None)
        return opened, [opened.free(family, self._grid, self._block, acts=family.acts_in(wave)) for family in sources]

    @cached_property
    def _far(self) -> Answers[Any]:
        """The wave that stands for those left out."""
        return self._answers(self._problem, self._grid.nodes[self._block], self._sampling.far)

    @cached_property
    def _left_over(self) -> FloatArray:
        return left_over(self._classes, self._sampling)

    def together(self, amplitudes: list[ComplexArray], some: list[int]) -> list[tuple[FloatArray, ComplexArray]]:
        """Return mean squares along the axis, (waves,), and what all families make of some waves together: along cos kz, and along sin kz.

        Amplitudes have the shape (names, waves, shells, parities, M + 1, nodes).
        """
        k, found = self._sampling.wavenumbers[some], []
        for parity, constant in enumerate((1.0, 0.0)[: self._along]):
            share = self._about_zero[:, parity, some]
            whole = sum(one[:, None, None, None, None] * each for one, each in zip(share, amplitudes, strict=True))
            found.append((np.where(k == 0.0, constant, 0.5), whole))
        return found

    def squares_beyond(self, modes: Modes) -> FloatArray:
        """Return |W|^2 and the strains' squares, all nodes added up, (shells, 2, orders), that voltages move in a wave left out.

        It may be of any class: their mean square is taken.
        """
        k = float(modes.wavenumber)
        weight = np.where(np.arange(self._classes.classes) * 2 % self._classes.count == 0, 4.0, 2.0)  # of g_q^2, and of how many waves
        each = np.stack([np.abs(self.voltages(number)) ** 2 for number in range(self._classes.classes)])
        push = self._classes.belts.covered * float(self._classes.belts.share(np.array([k]))[0])
        volts = push * np.sqrt(np.einsum("c,cawpmk->wpmk", weight / self._classes.count, each))
        known = modes.orders <= self._sampling.max_order
        given = np.zeros((*volts.shape[:2], modes.count, volts.shape[-1]), np.complex128)
        given[:, :, known] = volts[:, :, modes.orders[known].astype(int)]
        opened: Answers[Any] = self._answers(self._problem, self._grid.nodes[self._block], modes)
        w, v, u = opened.shown(opened.under(given))[:3]
        strain = np.abs(modes.column * v - w) ** 2 + np.abs(k * u) ** 2
        return np.stack([(np.abs(w) ** 2).sum(axis=(1, 3)), strain.sum(axis=(1, 3))], axis=1)

    # At stations

    def take_under(self, fields: dict[str, ComplexArray], shape: tuple[int, ...], number: int, some: list[int], of: Named) -> None:
        """Add to the fields at stations what belts over them read of some waves of a family, and take it out of their amplitudes.

        Parameters
        ----------
        fields : dict of str to ndarray of *shape*
        shape : tuple
            (stations, shells, parities, M + 1, nodes).
        number : int
            Of the family.
        some : list of int
            Waves.
        of : dict of str to ndarray, shape (waves, shells, parities, M + 1, nodes)
            Amplitudes of these waves; those of charge, reading and voltage are 0 afterwards.
        """
        share = self._under[number][:, some]
        for i in self._shells:
            last = self._problem.shells[i].shown_potentials - 1
            for back in self._read_back(i):
                total = fields.setdefault(f"potential {last - back}", np.zeros(shape, np.complex128))
                total[:, i] += np.tensordot(share, of[f"potential {last - back}"][:, i], 1)
                of[f"potential {last - back}"][:, i] = 0.0
            of[f"potential {last}"][:, i] = 0.0

    def _read_back(self, shell: int) -> tuple[int, ...]:
        """Return how far before its voltage stations show what a wall reads, and charges where any are kept."""
        return (1, 2) if isinstance(self._problem.shells[shell], TiedWall) else (1,)

    def add_given(self, fields: dict[str, ComplexArray], shape: tuple[int, ...]) -> None:
        """Add to the fields at stations what belts over them give, and what they read of it in the waves left out."""
        belt, over = self._places
        patterns = self._classes.patterns(belt) * over[:, None]
        far = {1: self._far.read, 2: self._far.charges_per_volt()}
        for number in range(self._classes.classes):
            volts = np.tensordot(np.moveaxis(patterns[..., number], 0, 1)[:, : len(self.voltages(number))], self.voltages(number), 1)
            for place, i in enumerate(self._shells):
                last = self._problem.shells[i].shown_potentials - 1
                left = [(one, self._left(number, far[one][place], volts)) for one in self._read_back(i)]
                for back, values in [(0, volts[:, place]), *left]:
                    fields.setdefault(f"potential {last - back}", np.zeros(shape, np.complex128))[:, i] += values

    def _left(self, number: int, per: ComplexArray, volts: ComplexArray) -> ComplexArray:
        """Return what the waves left out of a class show per volt, *per*, (walls, orders, nodes), of voltages (stations, walls, ...)."""
        return np.asarray(np.einsum("wmk,zwpmk,m->zpmk", per, volts, self._left_over[number]))
