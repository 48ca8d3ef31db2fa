"""The picture of an optimisation: what stands under a variable can be read."""

from __future__ import annotations

import matplotlib.pyplot as plt

import coaxshell as cx
from coaxshell.plotting import plot_convergence, plot_parallel
from coaxshell.plotting.units import raised


def test_name_range_and_unit_of_a_variable_stand_on_lines_of_their_own():
    found = cx.optimise(
        "absorbers",
        variables={"absorbers.damping": cx.Range(1e4, 1e8, scale="log"), "absorbers.count": cx.Range(5, 10)},
        objectives="absorbers.mass",  # of the description alone: nothing is solved
        evaluations=12,
        seed=1,
        workers=1,
        modes=4,
        duration=1.0,
        time_step=0.02,
    )
    figure, ax = plt.subplots()
    plot_parallel(found, ax)
    labels = [label.get_text() for label in ax.get_xticklabels()]
    plt.close(figure)
    assert labels == ["absorbers.\ndamping\n10⁴ to 10⁸\nN s/m²", "absorbers.\ncount\n5 to 10"]


def test_powers_of_ten_are_raised():
    assert [raised(value) for value in (350.0, 2.5e-7, 1e10, -1e-6, 0.02)] == ["350", "2.5×10⁻⁷", "10¹⁰", "-10⁻⁶", "0.02"]


def test_designs_are_drawn_where_none_keeps_the_limits():
    found = cx.optimise(
        "absorbers",
        variables={"absorbers.count": cx.Range(5, 10)},
        objectives="absorbers.mass",
        constraints=["absorbers.mass <= 65 kg/m", "absorbers.count >= 9"],
        evaluations=6,
        seed=1,
        workers=1,
        modes=4,
        duration=1.0,
        time_step=0.02,
    )
    figure, ax = plt.subplots()
    plot_convergence(found, ax)
    plt.close(figure)
    (designs, _) = ax.lines
    assert designs.get_label() == "design beyond a limit (all are)"
    assert sorted(designs.get_ydata()) == sorted(one.targets["absorbers.mass"] for one in found.history)
    assert ax.get_ylim()[0] < min(designs.get_ydata())
