"""Loops of self-sensing electrodes on elastic walls as one voltage and one reading, against those of all layers."""

from __future__ import annotations

import numpy as np
import pytest

from coaxshell.structure.solid_ports import under_volts
from coaxshell.structure.solid_transducers import Circuits, Transducers, closed_loop

RANDOM = np.random.default_rng(5)
ORDERS, NODES = 3, 4


def complex_of(*shape: int) -> np.ndarray:
    return RANDOM.normal(size=(*shape, ORDERS, NODES)) + 1j * RANDOM.normal(size=(*shape, ORDERS, NODES))


@pytest.mark.parametrize("sensors", [(0, 2), (2,)])
def test_layers_that_all_act_are_one_circuit(sensors: tuple[int, ...]) -> None:
    """Sensors are among the actuators: the law's voltage is on all, and it reads the mean of some."""
    transducers = Transducers(electrodes=True, sensors=sensors, actuators=(0, 2))
    moved, read, answer, law = complex_of(2, 2), complex_of(2, 2), complex_of(2, 2), complex_of()
    at_once = RANDOM.normal(size=(ORDERS, 2, 2))
    one, count = transducers.circuits, len(transducers.driven)
    assert one.shares.shape == (2, 1)
    layers = Circuits(np.eye(count), np.eye(count), transducers.opened, transducers.acting, transducers.sensing, transducers.listening)

    def looped(circuits: Circuits):
        joined = circuits.shares, circuits.reading
        rows = [
            np.einsum("ajmk,jc->acmk", moved, joined[0]),
            np.einsum("cj,jbmk->cbmk", joined[1], read),
            np.einsum("di,ijmk,jc->dcmk", joined[1], answer, joined[0]),
        ]
        resting = at_once @ joined[0], joined[1] @ at_once @ joined[0]
        return closed_loop(np.concatenate([each.reshape(-1, ORDERS, NODES) for each in rows]), resting, circuits, law)

    found, expected = looped(one), looped(layers)
    for name in ("sensed", "heard", "characteristic"):
        np.testing.assert_allclose(getattr(found, name), getattr(expected, name), rtol=1e-11, err_msg=name)
    np.testing.assert_allclose(np.tensordot(found.shares, found.volts, axes=1), expected.volts, rtol=1e-11)
    np.testing.assert_allclose(np.tensordot(found.shares, found.given, axes=1), expected.given, rtol=1e-11)
    np.testing.assert_allclose(under_volts(found.moved, found.volts), under_volts(expected.moved, expected.volts), rtol=1e-11)


def test_a_layer_that_only_reads_keeps_its_own_circuit() -> None:
    """It reads motions through the thickness too, and may charge itself."""
    assert Transducers(electrodes=True, sensors=(0,), actuators=(2,)).circuits.shares.shape == (2, 2)
