"""Peaks and RMS against a search over every instant on a much finer circle."""

from __future__ import annotations

import json
import math
from collections.abc import Callable

import numpy as np
import pytest

from coaxshell.errors import InputError
from coaxshell.model.prefixes import engineering
from coaxshell.response import Response, synthesis
from coaxshell.response.peaks import folded
from coaxshell.solver.solution import ModalSolution

FINE = np.arange(-180.0, 180.0, 0.025) + 0.025


@pytest.mark.slow_for("None-2", "window1-2")
@pytest.mark.parametrize("parities", [1, 2])
@pytest.mark.parametrize("window", [None, (0.5, 1.2)])
def test_peaks_and_rms(make: Callable[..., ModalSolution], parities: int, window: tuple[float, float] | None) -> None:
    response = Response(make(parities=parities))
    summary, means = response.summary(window, segment="point"), response.summary(window, segment="90 mm")
    for i, shell in enumerate(summary.shells):
        field = response.stress(i, FINE).sel(time=slice(*(-1, 9) if window is None else (window[0] - 1e-9, window[1] + 1e-9)))
        assert shell.stress.value == pytest.approx(float(abs(field).max()), rel=1e-9)
        there = response.stress(i, shell.stress.angle).sel(time=shell.stress.time, method="nearest")
        assert abs(float(there)) == pytest.approx(shell.stress.value, rel=1e-9)
        mean = (field**2).mean("angle").values
        span = field.time.values
        assert shell.stress_rms == pytest.approx(math.sqrt(np.trapezoid(mean, span) / (span[-1] - span[0])), rel=1e-9)
        for peak, angle in ((shell.stress_head, 0.0), (shell.stress_tail, 180.0)):
            at = abs(field.sel(angle=angle, method="nearest"))
            assert peak.value == pytest.approx(float(at.max()), rel=1e-9)
            assert peak.time == pytest.approx(float(at.time[int(at.values.argmax())]))
            assert peak.angle == angle
        shifted = abs(response.displacement(i, 0).sel(time=field.time))
        assert shell.displacement_head.value == pytest.approx(float(shifted.max()), rel=1e-12)
        voltage = abs(response.sensor_voltage(i, FINE).sel(time=field.time))
        assert shell.sensor_voltage.value == pytest.approx(float(voltage.max()), rel=1e-9)
        volts = abs(response.actuator_voltage(i, FINE).sel(time=field.time))
        assert shell.actuator_voltage.value == pytest.approx(float(volts.max()), rel=1e-9)
        for name in ("sensor_voltage", "actuator_voltage"):
            over = getattr(response, name)(i, FINE, segment=0.09).sel(time=field.time)
            assert getattr(means.shells[i], name).value == pytest.approx(float(abs(over).max()), rel=1e-9)
        assert (shell.segment, means.shells[i].segment) == (0.0, 0.09)
        deformed = abs(response.displacement(i, FINE, relative=True).sel(time=field.time))
        assert shell.relative_displacement.value == pytest.approx(float(deformed.max()), rel=1e-9)


def test_blocks_do_not_change_the_answer(response: Response, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = response.summary().to_dict()
    monkeypatch.setattr(synthesis, "BLOCK", 2000)
    assert json.dumps(response.summary().to_dict()) == pytest.approx(json.dumps(whole))


def test_head_is_where_the_first_source_is(make: Callable[..., ModalSolution], response: Response) -> None:
    turned = response.system.replace(source=response.system.sources[0].replace(angle=120.0))
    shell = Response(make(turned)).summary().shells[0]
    assert shell.stress_head.angle == 120.0
    assert shell.stress_tail.angle == -60.0
    assert shell.stress_head.value == pytest.approx(float(abs(response.stress(0, 120)).max()), rel=1e-12)


def test_symmetric_peaks_are_told_between_head_and_tail(make: Callable[..., ModalSolution]) -> None:
    solution = make(parities=1)
    solution.tangential[:] = 0.0
    solution.normal[:, :, 1:] = 0.0
    assert all(0.0 <= shell.stress.angle <= 180.0 for shell in Response(solution).summary().shells)


@pytest.mark.parametrize(("angle", "expected"), [(0, 0), (180, 180), (-180, 180), (190, -170), (540, 180), (-90, -90), (360, 0)])
def test_folded(angle: float, expected: float) -> None:
    assert folded(angle) == expected


def test_plain_form_and_absorbers(response: Response) -> None:
    summary = response.summary((0, 1))
    plain = json.loads(json.dumps(summary.to_dict()))
    assert plain["shells"][0]["stress"]["value"] == summary.shells[0].stress.value
    assert plain["settings"]["modes"] == 12
    assert plain["window"] == [0.0, 1.0]
    assert plain["shells"][1]["stress_truncation"] == response.estimates.modal_stress[1]
    assert summary.absorber_force == pytest.approx(float(response.absorber_force().sel(time=slice(0, 1 + 1e-9)).max()))
    assert summary.absorber_displacement == pytest.approx(float(response.absorber_displacement().sel(time=slice(0, 1 + 1e-9)).max()))


def test_table(response: Response) -> None:
    summary = response.summary()
    text = str(summary)
    lines = text.splitlines()
    assert lines[0] == "by hand"
    assert "spectral engine, 12 modes, time step 0.025, t = 0 to 2 transits (0 s to 1.786 ms)" in lines[1]
    table = [line for line in text.split("estimated relative errors")[0].splitlines() if line.startswith(("inner", "outer", "shell"))]
    assert len({line.index("stress") for line in table if "stress" in line}) == 1
    assert "warning: the drive is hot (3 > 2); rest" in text
    assert engineering(summary.shells[0].stress.value, "Pa") in text


@pytest.mark.parametrize(
    ("value", "expected"),
    [(771e6, "771.0 MPa"), (1234.56, "1.235 kPa"), (999.96, "1.000 kPa"), (-2.5e-7, "-250.0 nPa"), (0.0, "0 Pa"), (math.nan, "nan Pa")],
)
def test_engineering(value: float, expected: str) -> None:
    assert engineering(value, "Pa") == expected


def test_rigid_shells_are_left_out(rigid_core: Response) -> None:
    summary = rigid_core.summary()
    assert [shell.name for shell in summary.shells] == ["outer"]
    assert summary.shells[0].sensor_voltage is None
    assert summary.absorber_force is None
    assert "outer" in str(summary)


@pytest.mark.parametrize("window", [(3, 4), (1, 0.5), (math.nan, 1), (1,), "now", 5])
def test_bad_windows(response: Response, window: object) -> None:
    with pytest.raises(InputError, match="window"):
        response.summary(window)
