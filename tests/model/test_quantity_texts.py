"""Quantities as people type them, and texts made to be slow: understood, or refused with what was probably meant, in no time."""

from __future__ import annotations

from time import process_time

import pytest

from coaxshell.errors import InputError
from coaxshell.model import presets
from coaxshell.model.naming import suggestion
from coaxshell.model.system import System
from coaxshell.model.units import to_si
from coaxshell.studies.optimisation.targets import targets_of
from coaxshell.studies.varied_fields import field_of

UNDERSTOOD = [
    ("6,5 mm", "length", 6.5e-3),
    ("0,025 km", "length", 25.0),
    ("1,5e3 mm", "length", 1.5),
    ("-6,25 kPa", "pressure", -6250.0),
    ("−6 mm", "length", -6e-3),
    ("6\u00a0mm", "length", 6e-3),
    ("6\u202fmm", "length", 6e-3),
    ("6 µm", "length", 6e-6),
    ("6 μm", "length", 6e-6),
    ("６ mm", "length", 6e-3),
    ("25 kpa", "pressure", 25e3),
    ("25 KPa", "pressure", 25e3),
    ("25 Mpa", "pressure", 25e6),
    ("25 gpa", "stress", 25e9),
    ("1 PSI", "pressure", 6894.757293),
    ("1 psig", "pressure", 6894.757293),
    ("1 Bar", "pressure", 1e5),
    ("25 N/mm²", "pressure", 25e6),
    ("25 N/mm2", "pressure", 25e6),
    ("25 N/mm**2", "pressure", 25e6),
    ("25 N/mm^2", "pressure", 25e6),
    ("3 lbm", "mass", 1.36077711),
    ("3 KG", "mass", 3.0),
    ("2 Ns/m", "line damping", 2.0),
    ("2 kNs/m²", "line damping", 2e3),
    ("2 MN·s/m²", "line damping", 2e6),
    ("7850 kg·m⁻³", "density", 7850.0),
    ("7.85 g/cc", "density", 7850.0),
    ("0.3 lbm/in³", "density", 0.3 * 0.45359237 / 0.0254**3),
    ("2.5×10^5 Pa", "pressure", 2.5e5),
    ("2.5·10⁻³ m", "length", 2.5e-3),
    ("2.5*10**3 mm", "length", 2.5),
    ("5 usec", "time", 5e-6),
]
REFUSED = [
    ("1,500 mm", "length", "two ways"),
    ("1,234,567 Pa", "pressure", "two ways"),
    ("1.234,5 mm", "length", "two ways"),
    ("1 000 mm", "length", "two ways"),
    ("1'000 mm", "length", "two ways"),
    ("1.000.000 Pa", "pressure", "two ways"),
    ("25 mpa", "pressure", "mPa (a thousandth) or MPa (a million)"),
    ("25 MPA", "pressure", "mPa (a thousandth) or MPa (a million)"),
    ("6 MM", "length", "mm (a thousandth) or Mm (a million)"),
    ("25 psia", "pressure", "subtract the pressure at rest"),
    ("3 dB", "number", "plain number"),
    ("6 degC", "length", "not a length"),
    ("1e9999999999 kg", "mass", "not finite"),
    ("1e99999999999999999999999 kg", "mass", "not finite"),
    ("6 Ym**99", "length", "not a length"),
    ("0 kg", "length", "not a length"),
    ("6 mm;s", "length", "unknown unit"),
    ("1mm0 mm", "length", "unknown unit"),
    ("1e9999999999 kg", "length", "not a length"),
]
LONG = 300_000
SLOW = [
    *(
        head + piece * LONG + "x"
        for head in ("", "1", "1 ", "1x", "1e", "1 m")
        for piece in (" ", "1", "1,", "1.", "(", "*m", "²", "−", "µ")
    ),
    "1 000" * LONG,
    "1 " + "\u00a0" * LONG + "m",
]


@pytest.mark.parametrize(("text", "kind", "value"), UNDERSTOOD)
def test_spellings_of_every_keyboard(text, kind, value):
    assert to_si(text, kind) == pytest.approx(value, rel=1e-9)


@pytest.mark.parametrize(("text", "kind", "word"), REFUSED)
def test_what_could_mean_two_things_is_asked_back(text, kind, word):
    with pytest.raises(InputError) as caught:
        to_si(text, kind)
    assert word in str(caught.value)


def test_long_texts_are_refused_at_once_and_not_repeated():
    start = process_time()
    for value in [*SLOW, [0] * LONG, {"a": SLOW[0]}, 10**5000, b"1" * LONG]:
        with pytest.raises(InputError) as caught:
            to_si(value, "length")
        assert len(str(caught.value)) < 400
    assert process_time() - start < 1.0


@pytest.mark.parametrize(
    "text", ["a" * LONG, "shells" + "[0]" * LONG, "." * LONG, "a." * LONG, "[" * LONG, " " * LONG + "a", "shells[²].radius"]
)
def test_long_paths_are_refused_at_once(text):
    bare = presets.load("bare")
    start = process_time()
    for work in (
        lambda: bare.replace_path(text, 1.0),
        lambda: field_of(bare, text),
        lambda: suggestion(text, ["mass", "radius"]) and 1 / 0,
    ):
        with pytest.raises((InputError, ZeroDivisionError)) as caught:
            work()
        assert len(str(caught.value)) < 400
    for material in (text, {"type": text}):
        with pytest.raises(InputError) as caught:
            System.model_validate({**bare.model_dump(), "source": material, "fluids": [text, "water", "water"]})
        assert len(str(caught.value)) < 700
    assert process_time() - start < 1.0


@pytest.mark.parametrize(
    "text", ["inner.peak_stress" + " " * LONG + "x", "x" + " " * LONG, "mean(" * LONG, "shells[" + "1" * LONG + "].x", "<=" * LONG]
)
def test_long_metrics_and_constraints_are_refused_at_once(text):
    start = process_time()
    for objectives, constraints in ((text, None), ("inner.peak_stress", text)):
        with pytest.raises(InputError) as caught:
            targets_of(objectives, constraints, presets.load("bare"))
        assert len(str(caught.value)) < 600
    assert process_time() - start < 0.5
