"""CSV and MATLAB files hold what the response says, with names and units."""

from __future__ import annotations

import csv

import numpy as np
import pytest
from scipy.io import loadmat

from coaxshell import InputError, System, simulate
from coaxshell.export import export_csv, export_mat, history_table, tables


def read(path):
    with path.open(encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    return dict(zip(header, np.array(rows, dtype=float).T, strict=True))


def test_csv_holds_the_histories_with_their_units(hybrid, tmp_path):
    columns = read(export_csv(hybrid, tmp_path / "run.csv"))
    np.testing.assert_allclose(columns["time (a/c)"], hybrid.time, rtol=1e-11)
    np.testing.assert_allclose(columns["time (s)"], hybrid.time_seconds, rtol=1e-11)
    for shell in ("inner", "outer"):
        for method, unit in (("stress", "Pa"), ("displacement", "m"), ("sensor_voltage", "V"), ("actuator_voltage", "V")):
            values = getattr(hybrid, method)(shell, angle=[0, 180]).to_numpy()
            for column, point in enumerate(("head", "tail")):
                name = f"{shell} {method.replace('_', ' ')} {point} ({unit})"
                np.testing.assert_allclose(columns[name], values[:, column], rtol=1e-11, atol=1e-300)
    np.testing.assert_allclose(columns["absorber 24 displacement (m)"], hybrid.absorber_displacement()[24], rtol=1e-11, atol=1e-300)
    assert len(columns) == 2 + 2 * 12 + 25


def test_what_a_system_does_not_have_is_left_out(rigid_core):
    names = list(history_table(rigid_core))
    assert not any(word in name for name in names for word in ("inner", "actuator", "absorber"))
    assert "outer stress head (Pa)" in names


def test_head_follows_the_source(hybrid):
    turned = simulate(hybrid.system.with_overrides({"source.angle": 90}), modes=6, time_step=0.05, duration=1)
    found = history_table(turned)
    ends = np.transpose([found[f"outer stress {point} (Pa)"] for point in ("head", "tail")])
    np.testing.assert_array_equal(ends, turned.stress("outer", [90, 270]))


def test_mat_holds_histories_and_modal_amplitudes(hybrid, tmp_path):
    content = loadmat(export_mat(hybrid, tmp_path / "run.mat"), simplify_cells=True)
    np.testing.assert_array_equal(content["time"], hybrid.time)
    assert System.from_toml_string(content["scenario"]) == hybrid.system
    inner, outer = content["shells"]
    assert (inner["radius"], outer["radius"]) == (0.5, 1.0)
    np.testing.assert_array_equal(outer["stress"], hybrid.stress("outer").to_numpy())
    np.testing.assert_array_equal(inner["actuator_voltage"], hybrid.actuator_voltage("inner").to_numpy())
    np.testing.assert_array_equal(np.squeeze(inner["modal_normal"]), np.squeeze(hybrid.modal("inner").to_numpy()))
    np.testing.assert_array_equal(np.squeeze(outer["modal_tangential"]), np.squeeze(hybrid.modal("outer", "tangential").to_numpy()))
    np.testing.assert_array_equal(content["absorber_displacement"], hybrid.absorber_displacement().to_numpy())


def test_mat_of_a_rigid_core(rigid_core, tmp_path):
    inner, outer = loadmat(export_mat(rigid_core, tmp_path / "run.mat"), simplify_cells=True)["shells"]
    assert inner["rigid"]
    assert inner["stress"].size == 0
    assert outer["sensor_voltage"].shape == (len(rigid_core.time), 2)
    assert outer["actuator_voltage"].size == 0


@pytest.mark.parametrize(("write", "suffix"), [(export_csv, ".csv"), (export_mat, ".mat")])
def test_refusals_leave_nothing(hybrid, tmp_path, write, suffix):
    with pytest.raises(InputError, match=f"no known ending; allowed: \\{suffix}"):
        write(hybrid, tmp_path / "run.txt")
    with pytest.raises(InputError, match="cannot write"):
        write(hybrid, tmp_path / "nowhere" / f"run{suffix}")
    assert list(tmp_path.iterdir()) == []


def test_mat_refuses_what_the_format_cannot_hold(hybrid, tmp_path, monkeypatch):
    monkeypatch.setattr(tables, "_LARGEST", 1000)
    with pytest.raises(InputError, match=r"do not fit a \.mat file"):
        export_mat(hybrid, tmp_path / "run.mat")
    assert list(tmp_path.iterdir()) == []
