"""Descriptions of feedback by any rational law: its forms, what is refused, files and overrides."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import signal

import coaxshell as cx
from coaxshell.errors import InputError

BARE = cx.presets.load("bare")
LEAD = cx.Feedback(numerator=[2e-4, 3.0], denominator=[1e-6, 1.0], delay="5 us", transducers="electrodes", weights=40)


def test_zeros_poles_and_gain():
    law = cx.Feedback.from_zeros([-1e3 + 2e3j, -1e3 - 2e3j], [-5e3, -1e4, -2e4], 3e4, amplifier_corner="50 kHz")
    s = 2j * np.pi * 700.0
    asked = 3e4 * ((s + 1e3) ** 2 + 4e6) / ((s + 5e3) * (s + 1e4) * (s + 2e4)) / (1 + 1j * 700.0 / 5e4)
    assert law.response(700.0) == pytest.approx(asked, rel=1e-12)
    with pytest.raises(InputError, match=r"zeros: .*a complex one alone; give its conjugate"):
        cx.Feedback.from_zeros([1j], [-1.0], 1.0)


def test_response_has_corners_and_delay():
    law = cx.Feedback(numerator=[4.0], delay=1e-5, sensor_corner=1e3, amplifier_corner="2 kHz")
    at = 500.0
    assert law.response([at, 0.0])[1] == 4.0
    expected = 4.0 / ((1 + 0.5j) * (1 + 0.25j)) * np.exp(-2j * math.pi * at * 1e-5)
    assert law.response(at) == pytest.approx(expected, rel=1e-13)


def test_from_other_packages():
    of_scipy = cx.Feedback.from_transfer_function(signal.TransferFunction([2e-4, 3.0], [1e-6, 1.0]), transducers="electrodes")
    assert (of_scipy.numerator, of_scipy.denominator) == ((2e-4 / 1e-6, 3.0 / 1e-6), (1.0, 1e6))  # scipy divides by what leads
    control = SimpleNamespace(num=[[np.array([0.0, 2e-4, 3.0])]], den=[[np.array([1e-6, 1.0])]], dt=0)  # as python-control keeps it
    assert cx.Feedback.from_transfer_function(control).numerator == (2e-4, 3.0)
    states = signal.TransferFunction([1.0, 5.0], [1.0, 2.0, 3.0]).to_ss()
    found = cx.Feedback.from_transfer_function(SimpleNamespace(A=states.A, B=states.B, C=states.C, D=states.D, dt=None))
    assert found.response(0.3) == pytest.approx(cx.Feedback(numerator=[1, 5], denominator=[1, 2, 3]).response(0.3), rel=1e-12)
    for bad, words in (
        (SimpleNamespace(num=[1.0], den=[1.0, 1.0], dt=1e-5), "discrete time"),
        (SimpleNamespace(num=[[[1.0], [2.0]]], den=[[[1.0], [1.0]]], dt=0), "2 rows"),
        (3.0, "float is no transfer function"),
    ):
        with pytest.raises(InputError, match=words):
            cx.Feedback.from_transfer_function(bad)


@pytest.mark.parametrize(
    ("entries", "words"),
    [
        ({"numerator": [1, 0, 0]}, ("numerator:", "degree 2 over a denominator of degree 0", "amplifier_corner")),
        ({"numerator": [1, 0, 0], "denominator": [1, 1]}, ("numerator:", "degree 2", "degree 1", "[k_d, k_p]")),
        ({"numerator": [1, 0, 0], "amplifier_corner": 1e4}, ("numerator:",)),
        ({"numerator": [1], "delay": -1e-6}, ("delay:", "at least 0")),
        ({"numerator": [1], "denominator": [0, 0]}, ("denominator:", "is zero", "[1]")),
        ({"numerator": [1], "denominator": [1, -2]}, ("denominator:", "pole at 2 ± 0i 1/s", "no positive real part")),
        ({"numerator": []}, ("numerator:", "empty", "highest power first")),
        ({"numerator": [1, "x"]}, ("numerator[1]:", "'x'", "plain number")),
        ({"numerator": [1], "weights": -1}, ("weights:", "-1", "highest order")),
        ({"numerator": [1], "weights": []}, ("weights:", "empty")),
        ({"numerator": [1], "weights": [1, None]}, ("weights[1]:",)),
        ({"numerator": [1], "sensor_corner": 0}, ("sensor_corner:", "greater than 0")),
        ({"numerator": [1], "shells": []}, ("shells:", "at least one")),
        ({"numerator": [1], "segments": 4, "dead": [1], "weights": 2, "transducers": "electrodes"}, ("weights:", "modal filter")),
        ({"delay": 0}, ("numerator:", "is missing")),
    ],
    ids=str,
)
def test_refused_in_one_line(entries, words):
    with pytest.raises(InputError) as alone:
        cx.Feedback(**entries)
    with pytest.raises(InputError) as within:
        BARE.replace(control=entries if "numerator" in entries else {**entries, "weights": 3})
    assert str(within.value) == f"control.{alone.value}"
    for word in words:
        assert word in str(alone.value)


def test_what_is_allowed():
    assert cx.Feedback(numerator=[0, 0, 2]).numerator == (2.0,)
    cx.Feedback(numerator=[1, 0, 0], denominator=[1, 1], sensor_corner=1e4)
    cx.Feedback(numerator=[1], denominator=[1, 0])  # an integrator
    cx.Feedback(numerator=[1], denominator=np.poly([-3j, 3j, -3j, 3j]).real)  # twofold on the axis, as far as roots are known
    assert cx.Feedback(numerator=7, denominator=2).denominator == (2.0,)


def test_files_overrides_and_words():
    system = BARE.replace(control=LEAD)
    assert cx.System.from_toml_string(system.to_toml_string()) == system
    paper = BARE.replace(control=cx.Feedback(numerator=[-1.0]))
    assert cx.System.from_toml_string(paper.to_toml_string()) == paper
    changed = system.with_overrides({"control.numerator[1]": 4.0, "control.delay": "2 us", "control.weights": None})
    assert (changed.control.numerator, changed.control.delay, changed.control.weights) == ((2e-4, 4.0), 2e-6, None)
    assert system.canonical()["control"]["shells"] == [0, 1]
    assert system.canonical() == BARE.replace(control=LEAD.replace(shells=["outer", "inner"])).canonical()
    card = system._repr_html_()
    for words in ("H(s) of degree 1 over 1", "delay 5.000 µs", "orders up to 40", "by electrodes"):
        assert words in card
    assert "control by electrodes" in repr(system)
    with pytest.raises(InputError, match=r"control: 3 is not a control law; give a PDControl, a Feedback"):
        BARE.replace(control=3)
