"""Section integrals: the paper's Table 1 figures, layups added by hand, and what symmetry implies."""

from __future__ import annotations

import math

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.structure.section import Section, plane_modulus, reduced_coupling, reduced_permittivity, section

ALUMINIUM = cx.Elastic(name="aluminium", density=2700, youngs_modulus=70e9, poisson_ratio=0.33)
STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=200e9, poisson_ratio=0.3)


@pytest.fixture(scope="module")
def paper() -> list[Section]:
    return [section(shell) for shell in cx.presets.load("bare").shells]


def test_the_papers_numbers(paper: list[Section]) -> None:
    for ring in paper:
        np.testing.assert_allclose(ring.mass, 61.2, rtol=1e-12)
        np.testing.assert_allclose(ring.membrane, 9.852e8, rtol=1e-4)
        np.testing.assert_allclose(ring.bending, 1.221e4, rtol=1e-3)
        assert ring.cross == 0.0
    total = sum(2 * math.pi * ring.radius * ring.mass for ring in paper)
    np.testing.assert_allclose(total, 576.8, rtol=1e-4)


def test_reduced_constants_of_pzt4() -> None:
    pzt = cx.materials.PZT4
    np.testing.assert_allclose(plane_modulus(pzt), 132e9 - 73e9**2 / 115e9, rtol=1e-14)
    np.testing.assert_allclose(reduced_coupling(pzt), -4.1 - 73 / 115 * 14.1, rtol=1e-14)
    np.testing.assert_allclose(reduced_permittivity(pzt), 5.841e-9 - 14.1**2 / 115e9, rtol=1e-14)  # as printed
    np.testing.assert_allclose(reduced_permittivity(cx.materials.PZT4_STANDARD), 5.841e-9 + 14.1**2 / 115e9, rtol=1e-14)


def test_one_layer() -> None:
    ring = section(cx.Shell(radius=1.0, layers=[cx.Layer(STEEL, 1e-2)]))
    modulus = 200e9 / (1 - 0.3**2)
    np.testing.assert_allclose([ring.mass, ring.membrane, ring.bending], [78.0, modulus * 1e-2, modulus * 1e-6 / 12], rtol=1e-13)


@pytest.mark.parametrize("cuts", [2, 5])
def test_cutting_a_layer_changes_nothing(cuts: int) -> None:
    whole = section(cx.Shell(radius=1.0, layers=[cx.Layer(STEEL, 1e-2)]))
    cut = section(cx.Shell(radius=1.0, layers=[cx.Layer(STEEL, 1e-2 / cuts)] * cuts))
    for name in ("mass", "membrane", "bending"):
        np.testing.assert_allclose(getattr(cut, name), getattr(whole, name), rtol=1e-13)
    assert cut.cross == 0.0


def test_unsymmetric_layup_by_hand() -> None:
    # 4 mm of aluminium inside 2 mm of steel: z from -3 to 1 and from 1 to 3 mm.
    ring = section(cx.Shell(radius=1.0, layers=[cx.Layer(ALUMINIUM, 4e-3), cx.Layer(STEEL, 2e-3)]))
    al, st = 70e9 / (1 - 0.33**2), 200e9 / (1 - 0.3**2)
    np.testing.assert_allclose(ring.mass, 2700 * 4e-3 + 7800 * 2e-3, rtol=1e-14)
    np.testing.assert_allclose(ring.membrane, al * 4e-3 + st * 2e-3, rtol=1e-14)
    np.testing.assert_allclose(ring.cross, al * (1 - 9) / 2 * 1e-6 + st * (9 - 1) / 2 * 1e-6, rtol=1e-12)
    np.testing.assert_allclose(ring.bending, al * (1 + 27) / 3 * 1e-9 + st * (27 - 1) / 3 * 1e-9, rtol=1e-12)
    turned = section(cx.Shell(radius=1.0, layers=[cx.Layer(STEEL, 2e-3), cx.Layer(ALUMINIUM, 4e-3)]))
    np.testing.assert_allclose(turned.cross, -ring.cross, rtol=1e-12)
    np.testing.assert_allclose(turned.bending, ring.bending, rtol=1e-12)
