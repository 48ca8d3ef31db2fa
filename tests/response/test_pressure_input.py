"""Bad requests for a field are refused in one line that names the argument."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx


@pytest.fixture(scope="module")
def answer(double):
    return cx.simulate(double, duration=0.5, time_step=0.01, modes=4)


PLACE = {"x": [0.0], "y": [1.5], "time": 0.3}

BAD = [
    ({"time": 0.6}, "time: 0.6 lies outside the run; give times from 0 to 0.5"),
    ({"time": -0.1}, "time: -0.1 lies outside the run"),
    ({"time": [0.1, np.nan]}, "time: nan lies outside the run"),
    ({"time": None}, "time: is missing"),
    ({"time": []}, "time: "),
    ({"time": "now"}, "time: 'now' is not a number"),
    ({"part": "reflected"}, "part: 'reflected' is unknown; allowed: total, incident"),
    ({"filter": "hann"}, "filter: 'hann' is unknown; allowed: lanczos, exponential"),
    ({"memory": 1e3}, "memory: 1000 bytes are too few; give at least"),
    ({"memory": "1 GB"}, "memory: '1 GB' is not allowed"),
    ({"time_resolution": 0.0}, "time_resolution: 0.0 is not allowed"),
    ({"x": [np.nan]}, "x: nan is not finite"),
    ({"y": [1j]}, "y: complex128 is not real"),
    ({"x": [[0.0]]}, "x: an array of shape (1, 1) is not allowed"),
    ({"x": []}, "x: an array of shape (0,) is not allowed"),
    ({"y": None}, "y: is missing"),
    ({"x": None}, "x: is missing"),
    ({"x": None, "y": None}, "x: is missing; give x and y, or radius and angle"),
    ({"radius": [1.0]}, "x: is given together with radius or angle"),
    ({"x": None, "y": None, "radius": [1.0]}, "angle: is missing"),
    ({"x": None, "y": None, "angle": [1.0]}, "radius: is missing"),
    ({"x": None, "y": None, "radius": [-1.0], "angle": 0}, "radius: -1 is not allowed; give numbers of at least 0"),
]


# Intensity is that of the total field: it takes no part.
REQUESTS = [(q, *bad) for q in ("pressure", "velocity", "intensity") for bad in BAD if not (q == "intensity" and "part" in bad[0])]


@pytest.mark.parametrize(("quantity", "change", "message"), REQUESTS)
def test_bad_requests_name_the_argument(answer, quantity, change, message):
    with pytest.raises(cx.InputError) as error:
        getattr(answer, quantity)(**(PLACE | change))
    assert str(error.value).startswith(message)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("outside",), "region: 'outside' is unknown; allowed: "),
        ((3,), "region: 3 is unknown"),
        ((True,), "region: True is unknown"),
        (("gap", 2.0), "radius: 2.0 is not allowed for the region 'gap'"),
        (("exterior", 1.0), "radius: 1 is not outside the outermost shell"),
        (("exterior", float("nan")), "radius: nan is not allowed"),
    ],
)
def test_bad_regions(answer, arguments, message):
    with pytest.raises(cx.InputError) as error:
        answer.pressure_rms(*arguments)
    assert str(error.value).startswith(message)


def test_gaps_that_are_not_one(ring, water, shock):
    three = cx.System(shells=[ring(0.4), ring(0.7), ring(1.0)], fluids=[water] * 4, source=shock)
    one = cx.System(shells=[ring(1.0)], fluids=[water] * 2, source=shock)
    runs = [cx.simulate(system, duration=0.5, time_step=0.01, modes=4) for system in (three, one)]
    with pytest.raises(cx.InputError, match="region: 2 gaps lie between 3 shells; name the fluid by its number, 1 to 2"):
        runs[0].pressure_rms("gap")
    with pytest.raises(cx.InputError, match="region: no gaps lie"):
        runs[1].pressure_rms("gap")
    inner, outer = (runs[0].pressure_rms(number) for number in (1, 2))
    assert [float(gap.attrs["outer_radius"]) for gap in (inner, outer)] == [0.7, 1.0]


def test_an_unknown_keyword_is_a_type_error(answer):
    with pytest.raises(TypeError, match="colour"):
        answer.pressure(colour="red", **PLACE)


def test_a_front_of_another_kind_is_refused(answer):
    with pytest.raises(cx.InputError, match="front: 'soft' is unknown; allowed: sharp, matched"):
        answer.pressure(**PLACE, front="soft")


@pytest.mark.parametrize("unit", ["ns", "us"])
def test_durations_are_real_time(answer, unit):
    transit = float(answer.time_seconds[-1] / answer.time[-1])
    late = np.array([0.1, 0.3]) * transit
    durations = np.round(late / {"ns": 1e-9, "us": 1e-6}[unit]).astype(f"timedelta64[{unit}]")
    wanted = answer.pressure(x=0.0, y=1.5, time=durations / np.timedelta64(1, "s") / transit)
    np.testing.assert_allclose(answer.pressure(x=0.0, y=1.5, time=durations), wanted, rtol=1e-12)
    with pytest.raises(cx.InputError, match="time: nan lies outside the run"):
        answer.pressure(x=0.0, y=1.5, time=np.timedelta64("NaT"))
