"""Electrodes cut along the axis on walls of elastic solids: all belts in one matrix, thin walls, whole electrodes, balances, poles."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from electrode_pairs import BOTH, PAIRS, pairs
from numpy.testing import assert_allclose
from scipy.special import sici

import coaxshell as cx
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.belt_edges import part_off
from coaxshell.solver.axial.belt_ties import ties_of_belts
from coaxshell.solver.axial.belts import classes_of, driven_sets
from coaxshell.solver.axial.faced import FacedWave
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.axial.through import stresses_through
from coaxshell.solver.faced_voltages import readings_per_volt
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.tied_stability import fastest_growth_of, growing_of
from coaxshell.structure.belts import BeltClasses, Belts
from coaxshell.structure.elastic_wall import Asked, ElasticWall

A = PAIRS.reference_radius
MIXED = [[1.0, 0.5], [0.3, 0.8]]
SMALL: dict[str, Any] = {"duration": 0.12, "time_step": 3e-2, "modes": 2, "dimensions": 3, "axial_modes": 2.2, "axial_period": 8.0}


@cache
def broken() -> cx.SpatialResponse:
    law = {"matrix": MIXED, "segments": 2, "segment_gap": 0.02, "segment_pitch": 1.6, "segment_length": 1.5}
    return cx.simulate(pairs(("thin", "elastic"), **law), stations=[0.0, 0.8], **SMALL)


@pytest.mark.parametrize("dead", [[], [1]])
def test_belts_are_all_waves_and_all_belts_at_once(dead: list[int]) -> None:
    """Three belts of a period, means over each taken numerically, by what waves read of forces on their faces and of volts."""
    problem = dimensionless(
        pairs(("thin", "elastic"), matrix=MIXED, segment_pitch=1.0, segment_length=0.7, dead_belts=dead).with_overrides({"source.z": 0.3}),
        3,
    )
    sampling, grid, block, top, count = AxialSampling(3.0 / A, 2, 5.5), LaplaceGrid(0.02, 25), slice(3, 4), 3, 3
    belts, s = problem.belts, grid.nodes[block]
    assert belts is not None
    (waves,) = driven_sets(problem, sampling, np.zeros(1), grid, block)
    source = waves.families[0]
    z = np.add.outer(belts.pitch * np.arange(count), belts.length * ((np.arange(4000) + 0.5) / 4000 - 0.5))
    law = problem.shells[0].gains.at(s, Modes(np.zeros(1))).ravel()[0]  # type: ignore[union-attr]
    fed = np.array(MIXED) * law
    loops = np.einsum("nm,ij,o->oinjm", np.eye(count), np.eye(2), np.ones(top)).astype(complex)
    kept, right = np.zeros((top, count, count)), np.zeros((top, 2, count), complex)
    for q in range(1 - len(sampling.modes), len(sampling.modes)):
        modes, k = sampling.modes[abs(q)], sampling.spacing * q
        seen = np.exp(1j * k * z).mean(axis=1)
        held = np.multiply.outer(seen, seen.conj()) * belts.length / sampling.period
        read = readings_per_volt(problem.open_loop, (0, 1), modes, s)[..., 0]
        loops[: modes.count] -= np.einsum("nm,il,ljo->oinjm", held, fed, read)
        kept[: modes.count] += np.real(held)
        wave = FacedWave(problem, s, modes)
        (faces,) = wave.faces(source, grid, block)
        phi = np.array([wave.sensed(i, faces[i])[:, 0] for i in (0, 1)])
        share = (1.0 if q == 0 else 0.5) * sampling.weights[abs(q)] * np.exp(-0.3j * k / A)
        right[: modes.count] += share * np.einsum("n,il,lo->oin", seen, fed, phi)
    read = readings_per_volt(problem.open_loop, (0, 1), sampling.far, s)[..., 0]
    loops -= np.einsum("onm,il,ljo->oinjm", np.eye(count) - kept, fed, read)
    loops[:, :, dead], right[:, :, dead] = np.eye(6).reshape(2, 3, 2, 3)[:, dead], 0.0
    volts = np.stack([np.linalg.solve(one.reshape(6, 6), b.ravel()).reshape(2, 3) for one, b in zip(loops, right, strict=True)])
    classes = classes_of(belts, sampling)
    patterns, told = classes.patterns(np.arange(3.0)), np.zeros((top, 2, count), complex)
    for number in range(classes.classes):
        told += np.einsum("an,awo->own", patterns[..., number], waves.belts.voltages(number)[:, :, 0, :, 0])  # type: ignore[union-attr]
    assert np.abs(volts).max() > 0.0
    assert_allclose(told, volts, rtol=0, atol=1e-8 * np.abs(volts).max())


def test_loops_of_classes_tend_to_those_of_thin_walls() -> None:
    s, errors = np.array([2.5 + 6.0j]), []
    for scale in (1.0, 0.25):
        read = []
        for theories in (BOTH, ("thin", "thin")):
            problem = dimensionless(pairs(theories, scale=scale, segment_pitch=0.8), 3)
            ties = ties_of_belts(problem, AxialSampling(4 * 0.8 / A, 2, 6.0))
            read.append(np.stack([tie.response(problem.open_loop, problem, s).read for tie in ties]))
        errors.append(np.linalg.norm(read[0] - read[1]) / np.linalg.norm(read[1]))
    assert errors[1] < 1e-3
    assert errors[0] / errors[1] > 3.0


def test_stress_that_swings_about_edges_is_told() -> None:
    """What a sum of waves is off by beside a jump, by the sine integral; the electrode's edge is at 0.75, the other station in its gap."""
    for x in np.geomspace(0.01, 100.0, 60):
        assert abs(sici(x)[0] - np.pi / 2) / np.pi <= part_off(x / 7.0, 7.0)
    (told,) = (text for text in broken().warnings if "stress within its ceramics" in text)
    assert told.startswith("outer shell: ")
    assert "at z = 0.8 m, 50.00 mm from one; use axial_modes=4.4, or stations farther off" in told


def test_short_belts_without_gaps_are_a_whole_electrode() -> None:
    problem, sampling, s, errors = dimensionless(pairs(segment_pitch=0.8), 3), AxialSampling(8.0, 1, 24.0), np.array([3.0 + 4.0j]), []
    waves = [readings_per_volt(problem.open_loop, (0, 1), Modes.up_to(0, float(one.wavenumber)), s)[:, :, 0, 0] for one in sampling.modes]
    law = problem.shells[0].gains.at(s, Modes(np.zeros(1))).ravel()[0]  # type: ignore[union-attr]
    for count in (5, 10):
        classes = BeltClasses(Belts(8.0 / count, 8.0 / count), count, sampling.wavenumbers)
        worst = 0.0
        for wave in range(3):
            read = sum((classes.loop_shares[q] * waves[q] for q in classes.waves_of(wave)), np.zeros_like(waves[0]))
            given, whole = (np.linalg.inv(np.eye(2) - law * one) for one in (read, waves[wave]))
            worst = max(worst, np.abs(classes.read[0, wave] ** 2 * given - whole).max() / np.abs(whole).max())
        errors.append(worst)
    assert errors[0] / errors[1] > 3.0


def test_balances_close_and_stations_know_belts() -> None:
    energy = broken().energy(every=4)
    assert np.abs(energy.closure_relative).max() < 1e-4
    electrical = energy.amplifier_work - (energy.actuator_field - energy.actuator_work)
    assert np.abs(electrical).max() < 1e-9 * np.abs(energy.actuator_work).max()
    over, between = (broken().spatial.at(place).segment_voltage for place in (0, 1))
    assert over.shape == (2, 2, 5)
    assert np.abs(over[1]).max() > 1.0
    assert not between.any()
    effort = broken().control_effort().at(0.0)["outer"]
    assert effort.voltage == pytest.approx(np.abs(over[1]).max())
    assert effort.charge is None  # that no station keeps of solids


def test_stresses_through_a_wall_are_those_of_its_stations() -> None:
    solution = broken().spatial
    wall = solution.problem.shells[1]
    assert isinstance(wall, ElasticWall)
    found = stresses_through(solution, 1, [Asked("hoop", wall.design_depth)], [0])[0, 0]
    assert_allclose(found, solution.fields["hoop"][0, 1] * solution.problem.scales.pressure, rtol=0, atol=1e-9 * np.abs(found).max())


@pytest.mark.slow
def test_poles_of_classes_are_those_of_thin_walls() -> None:
    law = {"numerator": [1.4e-3, 0], "amplifier_corner": 5e3, "delay": "14 us", "segment_pitch": 0.6, "weights": 1}
    grown = []
    for theories in (BOTH, ("thin", "thin")):
        problem = dimensionless(pairs(theories, scale=0.25, **law), 3)
        tie = ties_of_belts(problem, AxialSampling(4 * 0.6 / A, 2, 6.0))[1]
        found, _ = growing_of(problem, tie, 1.0)
        assert found is not None
        grown.append(fastest_growth_of(problem, tie, found, 1.0))
    assert grown[0].pattern == grown[1].pattern
    assert grown[0].rate == pytest.approx(grown[1].rate, rel=2e-2)
    assert grown[0].frequency == pytest.approx(grown[1].frequency, rel=2e-3)
