"""Thin walls whose layers have losses: stiffness by hand, the elastic limit, and the decay of a free ring."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.apps.verification.independent.walls import Wall
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.structure.lossy_wall import LossyWall
from coaxshell.structure.thin_wall import ThinWall

RUBBER = cx.Viscoelastic(density=1100, long_term_modulus="50 MPa", poisson_ratio=0.48, prony=[("200 MPa", "1e-4 s"), ("30 MPa", "2 ms")])
BARE = cx.presets.load("bare")
BARE_MASS = dimensionless(BARE).shells[1].mass


def problem_of(change, *layers, dimensions=2, settings=None):
    """Return the problem of the paper's shells with each material changed, and layers more on the outside of the outer one."""
    shells = [shell.replace(layers=[layer.replace(material=change(layer.material)) for layer in shell.layers]) for shell in BARE.shells]
    shells[-1] = shells[-1].replace(layers=[*shells[-1].layers, *layers])
    return dimensionless(BARE.replace(shells=shells), dimensions, settings)


def lossy(eta, **options):
    return lambda material: material.replace(loss_factor=eta, **options)


def by_hand(problem, shell: int, m: int, k: float, s: complex) -> np.ndarray:
    """Return Z, V/W and U/W from the independent wall's integrals, each layer's moduli times its own g(s): real and imaginary part."""
    described, wall = problem.system.shells[shell], problem.shells[shell]
    hand, scales = Wall.of(described), problem.scales
    per_layer = len(hand.points) // len(described.layers)
    total = np.zeros((3, 3), complex)
    for number in range(len(described.layers)):
        at, constituents = hand.points[number * per_layer :][:per_layer], wall.parts
        for factor, section in constituents:
            q = section.laminate.layers[number].matrix * scales.pressure
            g = 1.0 if factor is None else factor.at(np.array([s]))[0]
            for part, weight in ((1.0, g.real), (1j, np.imag(g))):
                only = replace(hand, points=[point._replace(moduli=weight * q) for point in at], piezo=[])
                total += part * only.stiffness(m, k / scales.length)
    open_circuit = replace(hand, points=[]).stiffness(m, k / scales.length)
    stiffness = (total + open_circuit) * scales.length / scales.pressure + wall.mass * s * s * np.eye(3)
    kept = [i for i in range(3) if not (i == 0 and m == 0) and not (i == 2 and k == 0)]  # V drops out of order 0, U at k = 0
    answer = np.zeros(3, complex)
    answer[kept] = np.linalg.solve(stiffness[np.ix_(kept, kept)], np.eye(3)[1, kept])
    return np.array([1.0 / answer[1], answer[0] / answer[1], answer[2] / answer[1]])


@pytest.mark.parametrize(("m", "k"), [(0, 0.0), (2, 0.0), (7, 0.0), (0, 1.3), (3, 1.3), (9, 4.0)])
def test_impedance_by_hand(m, k):
    problem = problem_of(lossy(0.2), cx.Layer(RUBBER, "8 mm"), dimensions=3)
    s = np.array([0.5 + 3j, 40j + 0.5])
    for shell in (0, 1):
        found = problem.shells[shell].passive(Modes(np.array([float(m)]), k), s)
        for n, node in enumerate(s):
            impedance, tangential, axial = by_hand(problem, shell, m, k, node)
            assert found.impedance[0, n] == pytest.approx(impedance, rel=1e-9)
            assert found.tangential[0, n] == pytest.approx(tangential if m else found.tangential[0, n], rel=1e-9, abs=1e-12)
            if k:
                assert found.axial[0, n] == pytest.approx(axial, rel=1e-9)


def test_a_wall_without_losses_is_the_elastic_one_and_small_losses_tend_to_it():
    assert type(problem_of(lossy(0.0)).shells[1]) is ThinWall
    s, modes, changes = np.array([0.5 + 3j, 40j + 0.5]), Modes.up_to(6), []
    elastic = problem_of(lossy(0.0)).shells[1].passive(modes, s).impedance
    for eta in (1e-3, 1e-4):
        wall = problem_of(lossy(eta)).shells[1]
        assert type(wall) is LossyWall
        changes.append(np.abs(wall.passive(modes, s).impedance / elastic - 1.0).max())
    assert changes[0] < 0.02
    assert changes[0] / changes[1] == pytest.approx(10.0, rel=0.02)


def test_its_parts_make_the_whole_again():
    wall = problem_of(lossy(0.1, loss_model="constant-q"), cx.Layer(RUBBER, "8 mm"), dimensions=3).shells[1]
    for name in ("membrane", "cross", "bending", "core_modulus"):
        assert sum(getattr(section, name) for _, section in wall.parts) == pytest.approx(getattr(wall.section, name), rel=1e-9)
    whole = sum(section.laminate.moments[2].matrix for _, section in wall.parts)
    np.testing.assert_allclose(whole, wall.section.laminate.moments[2].matrix, rtol=1e-9)
    assert [bool(section.piezoelectric) for _, section in wall.parts] == [True] + [False] * (len(wall.parts) - 1)
    modes = Modes.up_to(4, 1.0)
    elastic = ThinWall.of(wall.section)
    assert np.all(wall.highest_frequency(modes) > elastic.highest_frequency(modes))
    assert wall.fastest_wave(3.0) > elastic.fastest_wave(3.0)


@pytest.mark.parametrize("loss_model", ["prony", "constant-q"])
@pytest.mark.parametrize("order", [0, 2, 6])
def test_the_loss_factor_comes_back_from_the_decay_of_a_free_ring(order, loss_model):
    # An impulse in vacuo: of the logarithm of the maxima the decay, of their distance the frequency, eta = tan(2 arctan(decay/frequency)).
    eta, modes = 0.1, Modes(np.array([float(order)]))
    k = problem_of(lossy(0.0)).shells[1].stiffness(modes)
    period = 2 * np.pi / float(np.sqrt(np.linalg.eigvalsh([[k.vv[0], k.vw[0]], [k.vw[0], k.ww[0]]])[int(order == 0)] / BARE_MASS))
    settings = Settings(duration=12 * period, time_step=period / 100)
    wall = problem_of(lossy(eta, loss_model=loss_model), settings=settings).shells[1]
    grid = LaplaceGrid(settings.time_step, settings.steps)
    motion = grid.invert(1.0 / wall.passive(modes, grid.nodes).impedance[0])
    peaks = np.flatnonzero((motion[1:-1] > motion[:-2]) & (motion[1:-1] > motion[2:]) & (motion[1:-1] > 0.02 * motion.max())) + 1
    y0, y1, y2 = motion[peaks - 1], motion[peaks], motion[peaks + 1]
    shift = 0.5 * (y0 - y2) / (y0 - 2 * y1 + y2)
    instants, heights = grid.time[peaks] + shift * grid.time_step, y1 - 0.25 * (y0 - y2) * shift
    assert peaks.size > 4
    decay, frequency = -np.polyfit(instants[1:], np.log(heights[1:]), 1)[0], 2 * np.pi / np.diff(instants[1:]).mean()
    # The modulus is complex where the pole is, not on the imaginary axis: a part eta^2; Prony's own ripple is 2 %.
    assert np.tan(2 * np.arctan(decay / frequency)) == pytest.approx(eta, rel=0.04)


def test_the_direct_engine_refuses_it_before_it_begins():
    shells = [shell.replace(layers=[layer.replace(material=lossy(0.1)(layer.material)) for layer in shell.layers]) for shell in BARE.shells]
    with pytest.raises(cx.InputError, match="losses"):
        cx.simulate(BARE.replace(shells=shells), engine="direct", duration=1.0, modes=4)
