"""The stacked areas of the energy balance."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.plotting.energy import energy_groups, plot_energy
from coaxshell.plotting.style import new_figure


@pytest.fixture(scope="module")
def balance():
    return cx.simulate(cx.presets.load("active"), duration=2.0, time_step=1e-2, modes=12).energy()


def test_groups_add_up_to_the_work(balance) -> None:
    groups = energy_groups(balance)
    assert list(groups) == ["interior fluid", "gap fluid", "inner shell", "outer shell", "actuators"]
    work = 1e3 * balance["exterior_work"].to_numpy()
    np.testing.assert_allclose(sum(groups.values()), work, rtol=0, atol=1e-5 * work.max())


def test_areas_reach_from_zero_to_the_work(balance) -> None:
    ax = new_figure().add_subplot()
    assert plot_energy(balance, ax) is ax
    legend = [text.get_text() for text in ax.get_legend().get_texts()]
    assert legend == ["work of the exterior pressure", "actuators", "outer shell", "inner shell", "gap fluid", "interior fluid"]
    tops = [area.get_paths()[0].vertices[:, 1].max() for area in ax.collections]
    np.testing.assert_allclose(max(tops), 1e3 * float(balance["exterior_work"].max()), rtol=1e-6)
    assert "mJ/m" in ax.get_ylabel()


def test_a_new_figure_is_made_when_none_is_given(balance) -> None:
    assert plot_energy(balance).figure is not None


def test_three_dimensions_are_drawn_in_joules() -> None:
    balance = cx.simulate("bare", duration=1.0, time_step=2e-2, modes=4, dimensions=3).energy()
    ax = plot_energy(balance)
    assert ax.get_ylabel() == "energy over the whole length (mJ)"
    assert sum(energy_groups(balance).values())[-1] == pytest.approx(1e3 * float(balance["exterior_work"][-1]), rel=1e-5)
