"""Sums over the shapes of elastic walls at blocks of nodes, against each term written out."""

from __future__ import annotations

import numpy as np
import pytest

from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.faced_forces import trapezoidal_nodes
from coaxshell.structure.shape_sums import modal_sums

GRID = LaplaceGrid(0.01, 400)
SQUARES = np.stack([np.r_[0.0, np.geomspace(2.0, 4e4, 30) ** 2], np.linspace(30.0, 3e3, 31) ** 2])
NODES = {
    "low": GRID.nodes[:130],
    "middle": GRID.nodes[200:330],
    "with losses": GRID.nodes[200:330] / np.sqrt(1.0 + 0.05 * GRID.nodes[200:330] / (1.0 + GRID.nodes[200:330])),
    "trapezoidal": trapezoidal_nodes(GRID)[1][-200:],
    "one": GRID.nodes[7:8],
    "the same": np.full(80, 3.0 + 2.0j),
}


@pytest.mark.parametrize("rows", [3, 9])
@pytest.mark.parametrize("block", NODES)
def test_sums_are_those_of_all_terms(block, rows):
    """To the rounding of their largest term, few rows and many having polynomials of their own degree."""
    weights = np.random.default_rng(3).normal(size=(2, rows, SQUARES.shape[1]))
    s = NODES[block]
    terms = 1.0 / (SQUARES[:, :, None] + s * s)
    expected = np.einsum("mrn,mnk->rmk", weights, terms)
    largest = np.einsum("mrn,mnk->rmk", np.abs(weights), np.abs(terms))
    assert np.all(np.abs(modal_sums(weights, SQUARES, s) - expected) <= 2e-13 * largest.max(axis=2, keepdims=True))
