"""Loops of self-sensing electrodes on elastic walls as one voltage and one reading, against those of all layers."""

from __future__ import annotations

import numpy as np
import pytest

from coaxshell.structure.solid_ports import under_volts
from coaxshell.structure.solid_transducers import Circuits, OpenCircuits, Transducers, Unanswered, closed_loop

RANDOM = np.random.default_rng(5)
ORDERS, NODES = 3, 4


def complex_of(*shape: int) -> np.ndarray:
    return RANDOM.normal(size=(*shape, ORDERS, NODES)) + 1j * RANDOM.normal(size=(*shape, ORDERS, NODES))


@pytest.mark.parametrize("sensors", [(0, 2), (2,)])
def test_layers_that_all_act_are_one_circuit(sensors: tuple[int, ...]) -> None:
    """Sensors are among the actuators: the law's voltage is on all, and it reads the mean of some."""
    transducers = Transducers(electrodes=True, sensors=sensors, actuators=(0, 2))
    moved, read, answer, law = complex_of(2, 2), complex_of(2, 2), complex_of(2, 2), complex_of()
    one, count = transducers.circuits, len(transducers.driven)
    assert one.shares.shape == (2, 1)
    layers = Circuits(np.eye(count), np.eye(count), transducers.opened, transducers.acting, transducers.sensing)

    def looped(circuits: Circuits):
        joined = circuits.shares, circuits.reading
        return closed_loop(
            Unanswered(
                np.einsum("ajmk,jc->acmk", moved, joined[0]),
                np.einsum("cj,jbmk->cbmk", joined[1], read),
                np.einsum("di,ijmk,jc->dcmk", joined[1], answer, joined[0]),
                None,
            ),
            circuits,
            law,
        )

    found, expected = looped(one), looped(layers)
    for name in ("sensed", "heard", "characteristic"):
        np.testing.assert_allclose(getattr(found, name), getattr(expected, name), rtol=1e-11, err_msg=name)
    np.testing.assert_allclose(np.tensordot(found.shares, found.volts, axes=1), expected.volts, rtol=1e-11)
    np.testing.assert_allclose(np.tensordot(found.shares, found.given, axes=1), expected.given, rtol=1e-11)
    np.testing.assert_allclose(under_volts(found.moved, found.volts), under_volts(expected.moved, expected.volts), rtol=1e-11)


def test_open_circuits_keep_their_own_and_the_law_hears_what_moves_along_the_wall() -> None:
    """u = O (y + Y u) + a H h and h by hand, y and Y of all that moves, h of the motion along the wall and an open circuit's own charge."""
    transducers = Transducers(electrodes=True, sensors=(0, 1, 2), actuators=(2,), shorted=(1,))
    circuits, count = transducers.circuits, 3
    np.testing.assert_array_equal(circuits.opened, [1.0, 0.0, 0.0])
    moved, heard, of_volts, charged, law = (complex_of(*shape) for shape in ((2, 3), (3, 2), (3, 3), (3, 2), ()))
    at_once = RANDOM.normal(size=(3, 3, ORDERS, 1))
    found = closed_loop(Unanswered(moved, heard, of_volts, OpenCircuits(charged, of_volts + at_once, at_once)), circuits, law)
    for m, k in np.ndindex(ORDERS, NODES):
        y, y_l, all_y = of_volts[:, :, m, k], heard[:, :, m, k], charged[:, :, m, k]
        own = np.diag([1.0 / (1.0 - at_once[0, 0, m, 0]), 1.0, 1.0])  # of one open circuit
        hears, o, a = (np.ones(3) / 3.0) @ own, np.diag([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
        volts, given = found.volts[..., m, k], found.given[:, m, k]
        sensed = hears @ (y_l + y @ volts)
        np.testing.assert_allclose(found.sensed[:, m, k], sensed, rtol=1e-9)
        every = y + at_once[..., m, 0]
        np.testing.assert_allclose(volts, o @ (all_y + every @ volts) + np.outer(a, law[m, k] * sensed), rtol=1e-9, atol=1e-12)
        np.testing.assert_allclose(found.heard[m, k], hears @ y @ given, rtol=1e-9)
        np.testing.assert_allclose(given, o @ every @ given + a * (1.0 + law[m, k] * found.heard[m, k]), rtol=1e-9, atol=1e-12)
    assert Transducers(electrodes=True, sensors=(0,), actuators=(2,), shorted=(0,)).circuits.shares.shape == (2, 1)
    assert count == len(transducers.driven)
