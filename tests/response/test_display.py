"""What a response shows in a notebook is its summary."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree

import coaxshell as cx
from coaxshell.model.prefixes import engineering


def test_a_response_shows_its_peaks_errors_and_warnings():
    response = cx.simulate(cx.presets.load("active"), duration=1.0, time_step=1e-2, modes=12)
    text = response._repr_html_()
    ElementTree.fromstring(f"<page>{text}</page>")
    summary = response.summary()
    assert "<svg" in text
    for shell in summary.shells:
        assert engineering(shell.stress.value, "Pa") in text
        assert f"{shell.name} {shell.stress_truncation:.1e}" in text
    assert summary.warnings
    assert all(warning[:40] in text for warning in summary.warnings)
    assert "12 modes" in text
