"""``coaxshell response-function``."""

from __future__ import annotations

import numpy as np
import pytest

from coaxshell.acoustics.response_functions import exterior, gap, interior

SHORT = ("--duration", "1.2", "--time-step", "0.01")


@pytest.mark.slow_for(
    "gap --inner-radius 0.9 --modes 0,1,2,3,4,5,70-five.pdf",
    "gap --radius 0.75-six.png",
    "interior --inner-radius 0.3 --slowness 0.9-three.png",
)
@pytest.mark.parametrize(
    ("arguments", "file"),
    [
        (["exterior"], "one.png"),
        (["exterior", "--radius", "2.5", "--modes", "3"], "two.svg"),
        (["interior", "--inner-radius", "0.3", "--slowness", "0.9"], "three.png"),
        (["interior", "--radius", "0"], "four.png"),
        (["gap", "--inner-radius", "0.9", "--modes", "0,1,2,3,4,5,70"], "five.pdf"),
        (["gap", "--radius", "0.75"], "six.png"),
    ],
    ids=lambda value: value if isinstance(value, str) else " ".join(value),
)
def test_figures(run, arguments, file):
    outcome = run("response-function", *arguments, *SHORT, "--output", file)
    assert outcome.code == 0, outcome.err
    assert outcome.files == [file]
    assert outcome.out.startswith(f"wrote {file}: {arguments[0]} response function")
    assert outcome.err == ""


def test_tables(run, tmp_path):
    times = np.linspace(0.0, 1.2, 121)
    expected = {
        "exterior": ["m0", "m4"],
        "interior": ["m0", "m4"],
        "gap": ["inner_m0", "inner_m4", "outer_m0", "outer_m4"],
    }
    for region, names in expected.items():
        assert run("response-function", region, *SHORT, "--modes", "4,0", "-o", f"{region}.csv").code == 0
        with (tmp_path / f"{region}.csv").open() as stream:
            assert stream.readline().strip() == ",".join(["time", *names])
            numbers = np.loadtxt(stream, delimiter=",").T
        np.testing.assert_allclose(numbers[0], times, atol=1e-12)
        values = {
            "exterior": lambda: exterior([0, 4], times),
            "interior": lambda: interior([0, 4], times, disc_radius=0.5),
            "gap": lambda: np.concatenate(
                [gap([0, 4], times, inner=0.5, outer=1.0), gap([0, 4], times, inner=0.5, outer=1.0, driven="outer")]
            ),
        }[region]()
        np.testing.assert_allclose(numbers[1:], values, rtol=1e-10, atol=1e-10)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["outside", "-o", "x.png"], ["'outside'", "exterior, interior, gap"]),
        (["gap", "-o", "x.gif"], ["--output", "'x.gif'", ".csv"]),
        (["gap", "-o", "nowhere/x.png"], ["--output", "'nowhere'"]),
        (["gap"], ["--output"]),
        (["gap", "-o", "x.png", "--modes", "0,one"], ["--modes", "'0,one'"]),
        (["gap", "-o", "x.png", "--modes", "-1"], ["--modes", "0 to 300"]),
        (["gap", "-o", "x.png", "--modes", "0,1,2,3,4,5,6,7"], ["--modes", "at most 7", ".csv"]),
        (["gap", "-o", "x.png", "--inner-radius", "1.5"], ["--outer-radius", "1.5"]),
        (["gap", "-o", "x.png", "--inner-radius", "wide"], ["--inner-radius", "'wide'"]),
        (["gap", "-o", "x.png", "--radius", "0.2"], ["--radius", "0.2", "0.5 or more", "at most 1"]),
        (["interior", "-o", "x.png", "--radius", "0.6"], ["--radius", "0.6"]),
        (["interior", "-o", "x.png", "--slowness", "0"], ["--slowness", "above 0"]),
        (["interior", "-o", "x.png", "--inner-radius", "-1"], ["--inner-radius", "above 0"]),
        (["exterior", "-o", "x.png", "--radius", "nan"], ["--radius", "nan"]),
        (["exterior", "-o", "x.png", "--duration", "0"], ["--duration", "above 0"]),
        (["exterior", "-o", "x.png", "--duration", "21"], ["--duration", "at most 20"]),
        (["exterior", "-o", "x.png", "--time-step", "1"], ["--time-step", "0.5"]),
        (["exterior", "-o", "x.png", "--time-step", "1e-9"], ["--time-step", "200000"]),
    ],
    ids=lambda value: " ".join(value),
)
def test_bad_input(refused, arguments, words):
    message = refused("response-function", *arguments)
    for word in words:
        assert word in message, message
