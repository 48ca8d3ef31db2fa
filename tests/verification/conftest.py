"""A small suite of made-up checks, and a report of them."""

from __future__ import annotations

import numpy as np
import pytest

from coaxshell.apps.verification import Check, Curve, Panel, Sheet, run
from coaxshell.apps.verification.rows import at_least, close, skipped, within


def good(bench):
    yield close("a number", "closed form", 2.0, 2.0 + 1e-9, 1e-6, unit="m")
    yield at_least("an order", "theory 10", 1.9, 2.0)
    x = np.linspace(0, 1, 50)
    curves = [Curve("ours", x, x**2), Curve("theirs", x[::5], x[::5] ** 2, "points", colour="orange")]
    logarithmic = Panel("log", "x", "y", [Curve("", x + 1, x + 1)], logarithmic=True)
    yield Sheet("A parabola <b>", "Ours & theirs.", [Panel("", "x", "y", curves), logarithmic])


def bad(bench):
    yield within("a | history", "reference", "the <other's>", 0.3, 0.1)
    yield within("not a number", "reference", "0", float("nan"), 1.0)
    yield skipped("a thing", "reference", "there is no such thing here")
    yield at_least("an order", "theory 10", 1.9, 1.5)


def broken(bench):
    yield close("before it breaks", "closed form", 1.0, 1.0, 1e-6)
    raise ValueError("it broke")


def check(work, name):
    return Check(name, name.capitalize(), "About it.", work, True)


@pytest.fixture
def report():
    return run([check(good, "good"), check(bad, "bad"), check(broken, "broken"), check(lambda bench: iter(()), "empty")])


@pytest.fixture
def good_report():
    return run([check(good, "good")])
