"""Oscillators on a moving base against another program's spectra and closed forms."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from coaxshell.numerics.oscillators import KINDS, Oscillators

REFERENCE = json.loads((Path(__file__).parent / "data" / "shock_spectra.json").read_text(encoding="utf-8"))
STEP = 1e-4
TIME = STEP * np.arange(1500)
RECORD = 1e3 * (np.sin(2 * np.pi * 180 * TIME) * np.exp(-40 * TIME) + 0.3 * np.sin(2 * np.pi * 1100 * TIME) * np.exp(-200 * TIME))


@pytest.mark.parametrize("entry", REFERENCE["spectra"], ids=lambda e: f"{e['kind']}-{e['extreme']}-{e['quality_factor']}")
def test_samples_are_those_of_another_program(entry):
    found = Oscillators(np.array(REFERENCE["frequency"]), entry["quality_factor"], STEP)
    rows, sign = found.reads(entry["kind"]), {"positive": 1.0, "negative": -1.0}[entry["extreme"]]
    peaks = [max(0.0, (sign * found.history(RECORD[None], row, i)).max()) for i, row in enumerate(rows)]
    np.testing.assert_allclose(peaks, entry["values"], rtol=1e-6)


def half_sine(duration):
    count = round(duration / 1e-5)
    return np.sin(np.pi * np.arange(count + 1) / count)[None], 1e-5


@pytest.mark.parametrize("ratio", [0.3, 0.9, 1.7, 3.3])
def test_half_sine(ratio):
    """Without damping z'' + a = A/(1 - b^2) (sin W t - b sin w t) while it lasts, b = W/w, and A 2 b cos(pi/(2 b))/(1 - b^2) after it."""
    duration = 5e-3
    acceleration, step = half_sine(duration)
    frequency = ratio / (2 * duration)
    found = Oscillators(np.array([frequency]), 1e12, step)
    t, b = np.linspace(0.0, duration, 100_001), 1.0 / ratio
    during = (np.sin(np.pi * t / duration) - b * np.sin(2 * np.pi * frequency * t)) / (1 - b * b)
    end = found.at_the_end(acceleration)
    extremes = found.during(acceleration, end, "absolute-acceleration")
    np.testing.assert_allclose(extremes.largest[0, 0], during.max(), rtol=5e-5)  # parabolas between looks
    np.testing.assert_allclose(extremes.smallest[0, 0], min(during.min(), 0.0), atol=5e-5)
    after = found.after(end, "absolute-acceleration")
    amplitude = abs(2 * b * np.cos(np.pi / (2 * b)) / (1 - b * b))
    np.testing.assert_allclose([after.largest[0, 0], -after.smallest[0, 0]], amplitude, rtol=5e-6)  # chords of the sine, (pi/500)^2/12


def test_a_step_is_felt_from_its_first_sample():
    """An acceleration that begins at once at A moves the mass by A (1 - cos w t): twice, at half a cycle."""
    found = Oscillators(np.array([100.0]), 1e12, 1e-4)
    acceleration = np.full((1, 400), 3.0)
    end = found.at_the_end(acceleration)
    np.testing.assert_allclose(found.during(acceleration, end, "absolute-acceleration").largest, 6.0, rtol=1e-6)
    history = found.history(acceleration, found.reads("absolute-acceleration")[0], 0)[0]
    np.testing.assert_allclose(history, 3.0 * (1.0 - np.cos(2 * np.pi * 100.0 * 1e-4 * np.arange(400))), atol=1e-10)


@pytest.mark.parametrize("quality", [0.6, 10.0])
def test_free_vibration_has_no_other_crests(quality):
    """After the end the closed form sees the largest of what the same recursion gives under zeros."""
    rng = np.random.default_rng(5)
    series = rng.standard_normal((3, 150)).cumsum(axis=1)
    found = Oscillators(np.array([40.0, 350.0, 1200.0]), quality, STEP)
    for kind in KINDS:
        after, rows = found.after(found.at_the_end(series), kind), found.reads(kind)
        for i in range(3):
            fine = Oscillators(found.frequency[i : i + 1], quality, 1e-6)
            state = found.at_the_end(series)[i] * [[1e4], [1e2]]  # in steps of the finer one
            states = np.einsum("tab,bs->ats", fine.powers(60_000)[0], state)
            values = np.einsum("a,ats->ts", fine.reads(kind)[0], states)
            np.testing.assert_allclose(after.largest[i], np.maximum(values.max(axis=0), 0.0), rtol=1e-5, atol=1e-12 * abs(rows).max())
            np.testing.assert_allclose(after.smallest[i], np.minimum(values.min(axis=0), 0.0), rtol=1e-5, atol=1e-12 * abs(rows).max())


def test_slow_oscillators_are_looked_at_less_often_and_see_the_same():
    found = Oscillators(np.geomspace(5.0, 300.0, 9), 10.0, STEP)
    assert found.stride(32.0).max() == 32
    for kind in KINDS:
        seen, rows = found.during(RECORD[None], found.at_the_end(RECORD[None]), kind), found.reads(kind)
        every = [found.history(RECORD[None], row, i)[0] for i, row in enumerate(rows)]
        scale = np.array([abs(values).max() for values in every])
        np.testing.assert_allclose(seen.largest[:, 0] / scale, [max(0, x.max()) / y for x, y in zip(every, scale, strict=True)], atol=1e-3)
        np.testing.assert_allclose(seen.smallest[:, 0] / scale, [min(0, x.min()) / y for x, y in zip(every, scale, strict=True)], atol=1e-3)
