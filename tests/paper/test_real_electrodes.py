"""The paper's statements on control under the whole actuation and with electrodes: coarse runs of Figure 11."""

from __future__ import annotations

from itertools import takewhile

import pytest

import coaxshell as cx
from coaxshell.apps.paper import cases
from coaxshell.apps.paper.real_electrodes import judged, with_electrodes
from coaxshell.solver.settings import Settings

COARSE = Settings(duration=2.0, time_step=2e-2, modes=6)


def test_gains_of_electrodes_stand_for_the_papers():
    both = list(cases.gains(cx.presets.load("bare")).values())[-1]
    found = with_electrodes(both)
    assert (found.control.proportional, found.control.derivative, found.control.transducers) == (100.0, 10.0, "electrodes")
    assert [layer.role for layer in found.shells[0].layers] == ["self-sensing", "core", "self-sensing"]
    assert with_electrodes(cx.presets.load("bare")) == cx.presets.load("bare")


@pytest.mark.parametrize(
    ("name", "verdicts"),
    [("whole actuation", ["does not hold", "does not hold"]), ("electrodes", ["holds", "holds", "holds", "does not hold"])],
)
def test_statements_on_the_gains(name, verdicts):
    # As at the resolution of the page: the whole actuation multiplies the stress; with electrodes k_d is not marginal.
    found = list(takewhile(lambda one: one.number < 60, judged(name, COARSE)))
    assert [one.number for one in found] == [56, 57, 58, 59]
    told = found if name == "electrodes" else found[1:3]
    assert [one.verdict for one in told] == verdicts
