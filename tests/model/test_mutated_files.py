"""Spoilt records and scenarios: read as an independent reader reads them, or refused in one line; never another meaning."""

from __future__ import annotations

import numpy as np
import pytest
from mutated_files import RECORD_PIECES, SCENARIO_PIECES, differences, loose_reading, plain_reading, record, scenario, seeded, spoilt

from coaxshell.errors import InputError
from coaxshell.model import Sampled, System

COUNTS = [pytest.param(60, id="60"), pytest.param(2000, id="2000", marks=pytest.mark.slow)]


def _read(content):
    try:
        return Sampled.from_bytes(content, "spoilt.csv")
    except InputError as error:
        assert "\n" not in str(error)  # noqa: PT017 - refused is right, if on one line
        return None


@pytest.mark.parametrize("count", COUNTS)
def test_whole_records_are_what_they_say(count):
    for seed in range(count // 2):
        text, separator, decimal = record(seeded(seed))
        found, wanted = _read(text.encode()), plain_reading(text.encode(), separator, decimal)
        if wanted[0][-1] <= 0:
            continue
        assert found is not None, text
        np.testing.assert_allclose([found.time, found.pressure], wanted, rtol=1e-12)


@pytest.mark.parametrize("count", COUNTS)
def test_spoilt_records_change_their_meaning_never(count):
    told = 0
    for seed in range(count):
        random_ = seeded(seed)
        text, separator, decimal = record(random_)
        content = spoilt(random_, text.encode(), RECORD_PIECES)
        found, wanted = _read(content), plain_reading(content, separator, decimal)
        if found is None:
            told += 1
        else:
            wanted = wanted or loose_reading(content, separator, decimal)
            assert wanted is not None, content
            np.testing.assert_allclose([found.time, found.pressure], wanted, rtol=1e-12, err_msg=repr(content))
    assert told > count / 4


@pytest.mark.parametrize("count", COUNTS)
def test_spoilt_scenarios_change_their_meaning_never(count):
    read = 0
    for seed in range(count if count > 100 else 20):
        random_ = seeded(seed)
        content = spoilt(random_, scenario(random_), SCENARIO_PIECES, gently=seed % 4 > 0)
        try:
            text = content.decode()
            system = System.from_toml_string(text)
        except UnicodeError:
            continue
        except InputError as error:
            assert "\n" not in str(error)  # noqa: PT017 - refused is right, if on one line
            continue
        read += 1
        assert list(differences(system, text)) == [], text
        assert System.from_toml_string(system.to_toml_string()) == system
    assert read > 0
