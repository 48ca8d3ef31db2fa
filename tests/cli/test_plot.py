"""``coaxshell plot`` and what Python has of it: any quantity, any run."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.plotting import QUANTITIES, figure_curves
from coaxshell.response import quantities as outputs
from coaxshell.response.quantities import summary_rows


@pytest.fixture(scope="module")
def hybrid():
    return cx.simulate("hybrid", modes=6, time_step=0.02, duration=1)


@pytest.mark.slow_except("stress", "actuator_voltage", "relative_displacement")
@pytest.mark.parametrize("quantity", QUANTITIES)
def test_every_quantity_at_every_angle(hybrid, quantity):
    if outputs.QUANTITIES[quantity].dimensions == 3:
        with pytest.raises(InputError, match=rf"quantity: '{quantity}' belongs to three dimensions"):
            hybrid.plot(quantity)
        return
    figure = hybrid.plot(quantity, angle=[0, 45, 180])
    assert len(figure.axes) == 2
    for ax, shell in zip(figure.axes, ("inner", "outer"), strict=True):
        curves = [line for line in ax.lines if len(line.get_xdata()) == len(hybrid.time)]
        assert len(curves) == 3
        drawn = QUANTITIES[quantity]
        values = getattr(hybrid, drawn.method)(shell, 45, **drawn.options)
        np.testing.assert_allclose(curves[1].get_ydata(), drawn.per_si * values)
        assert drawn.unit in ax.get_ylabel()
    assert figure._repr_png_().startswith(b"\x89PNG")


def test_two_runs_of_one_shell(hybrid):
    figure = figure_curves({"a": hybrid, "b": cx.simulate("bare", modes=6, time_step=0.02, duration=1)}, shells="inner", angle=0)
    (ax,) = figure.axes
    assert len({line.get_linestyle() for line in ax.lines[:3]}) >= 2
    assert ax.get_title(loc="left") == "Inner shell"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"quantity": "strain"}, "'strain'"),
        ({"shell": "middle"}, "middle"),
        ({"angle": list(range(9))}, "9 cannot be drawn"),
        ({"angle": []}, "angle"),
        ({"angle": ["head"]}, "angle"),
    ],
)
def test_bad_plots(hybrid, arguments, words):
    with pytest.raises(InputError, match=words):
        hybrid.plot(**arguments)


def test_dataframe(hybrid):
    table = hybrid.to_dataframe()
    assert len(table) == len(hybrid.time)
    np.testing.assert_allclose(table.index, hybrid.time)
    np.testing.assert_allclose(table["inner stress head (Pa)"], hybrid.stress("inner", 0))
    assert "absorber 3 displacement (m)" in table


def test_summary_in_a_notebook_is_a_table(hybrid):
    html = hybrid.summary()._repr_html_()
    values = [getattr(shell, key) for shell in hybrid.summary().shells for key, _, _ in summary_rows()]
    assert html.count("<tr>") == 1 + sum(value is not None for value in values)
    for words in ("relative displacement at head", "t [a/c_e]", "voltages: means over"):
        assert words in html
    titled = cx.simulate(hybrid.system.replace(name="<b>"), modes=6, time_step=0.02, duration=1)
    assert "&lt;b&gt;" in titled.summary()._repr_html_()


def test_command(run, small):
    outcome = run("plot", "hybrid", "--quantity", "relative-displacement", "--shell", "outer", "--angle", "0,90", *small, "-q")
    assert outcome.code == 0, outcome.err
    assert outcome.files == ["relative_displacement.png"]
    outcome = run("plot", "hybrid", "--compare", "bare", "-o", "both.svg", *small, "-q")
    assert outcome.code == 0, outcome.err
    assert "both.svg" in outcome.files
    assert "wrote both.svg" in outcome.out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("bare", "--quantity", "strain"), ("--quantity", "'strain'", "relative_displacement")),
        (("bare", "--angle", "head"), ("--angle", "'head'")),
        (("bear",), ("'bear'", "did you mean")),
        (("bare", "-o", "x.jpeg"), ("--output", ".png")),
    ],
)
def test_refusals_come_before_the_work(refused, monkeypatch, arguments, words):
    monkeypatch.setattr("coaxshell.solver.solve", lambda *_, **__: pytest.fail("the work was started"))
    message = refused("plot", *arguments)
    assert all(word in message for word in words), message
