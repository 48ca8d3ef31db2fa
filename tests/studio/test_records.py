"""Pressure records sent by a page: read as the library reads them, within bounds, and never from a path of this machine."""

from __future__ import annotations

import random

import numpy as np
import pytest
from asking import described

from coaxshell.model import Sampled, System

HEADER = {"Content-Type": "application/octet-stream"}
TEXT = b"time (ms);p1 (kPa);p2 (kPa)\n-0,1;1;2\n0;250;3\n0,1;100;1\n1;5;0\n"


@pytest.fixture
def send(client):
    """Return a function that sends a record and returns the answer."""

    def call(content, **options):
        return client.post("/api/record", params=options, content=content, headers=HEADER)

    return call


def test_a_record_becomes_a_pulse(send, client):
    answer = send(TEXT, name="../../etc/gauge.csv", pressure_column="p1 (kPa)", baseline="pre-trigger", taper="0.1 ms").json()
    assert answer["ok"], answer
    assert answer["columns"] == ["time (ms)", "p1 (kPa)", "p2 (kPa)"]
    options = {"pressure_column": 2, "baseline": "pre-trigger", "taper": "0.1 ms"}
    assert Sampled.model_validate(answer["pulse"]) == Sampled.from_bytes(TEXT, **options)
    assert answer["pulse"]["reference"].startswith("gauge.csv: time 'time' in ms")
    system = {**described("bare"), "source": {"type": "plane-wave", "pulse": answer["pulse"]}}
    again = client.post("/api/validate", json={"system": system}).json()
    assert again["ok"]
    assert System.model_validate(again["system"]).sources[0].pulse == Sampled.model_validate(answer["pulse"])


def test_what_is_wrong_is_told_with_the_columns(send, client):
    told = send(TEXT, name="gauge.csv").json()
    assert not told["ok"]
    assert "pressure_column" in told["problem"]["remedy"]
    assert told["columns"] == ["time (ms)", "p1 (kPa)", "p2 (kPa)"]
    assert send(TEXT, file="/etc/passwd").json()["problem"]["where"] == "file"
    assert send(TEXT, sha256="0").json()["problem"]["where"] == "sha256"
    assert send(TEXT, time_unit="x" * 300).status_code == 400
    assert send(b"\x00" * 100).json()["problem"]["problem"] == "cannot be read (not a text file)"
    assert client.post("/api/record", content=TEXT, headers={"Content-Type": "text/plain"}).status_code == 415


def test_many_samples_are_resampled_and_it_is_said(send):
    time = np.arange(60_000) * 1e-6
    rows = "\n".join(f"{t:.6f},{p:.3f}" for t, p in zip(time, 1e5 * np.exp(-time / 5e-3), strict=True))
    pulse = send(b"t (s),p (Pa)\n" + rows.encode()).json()["pulse"]
    assert len(pulse["time"]) <= 20_000
    assert "60,000 samples resampled to" in pulse["reference"]
    assert np.trapezoid(pulse["pressure"], pulse["time"]) == pytest.approx(1e5 * 5e-3, rel=1e-3)


def test_hostile_records(send):
    random_ = random.Random(1)
    for _ in range(60):
        content = bytearray(TEXT)
        for _ in range(random_.randrange(1, 30)):
            content[random_.randrange(len(content))] = random_.randrange(256)
        options = {
            "name": random_.choice(["", "x" * 900, "\ud7ff", "a\nb", "/dev/zero"]),
            "scale": random_.choice(["1", "1e999", "9**9**9", "nan"]),
        }
        answer = send(bytes(content), **options, pressure_column="2")
        assert answer.status_code in (200, 400), answer.text
        assert "Traceback" not in answer.text
