"""Files: bit by bit there and back, whole or not at all, and one clear line for whatever is wrong."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.model import absorber_ring
from coaxshell.response import Response, info, load_response
from coaxshell.response.storage import save
from coaxshell.solver.solution import ModalSolution


def assert_equal(found: ModalSolution, expected: ModalSolution) -> None:
    for field in fields(ModalSolution):
        one, two = getattr(found, field.name), getattr(expected, field.name)
        if field.name == "estimates":
            np.testing.assert_array_equal(one.modal_displacement, two.modal_displacement)
            np.testing.assert_array_equal(one.modal_stress, two.modal_stress)
            assert one.time_window == two.time_window
        elif isinstance(two, np.ndarray):
            assert one.dtype == np.float64
            np.testing.assert_array_equal(one, two)
        else:
            assert one == two, field.name


@pytest.mark.parametrize("compression", [False, True])
def test_round_trip(response: Response, tmp_path: Path, compression: bool) -> None:
    path = response.save(tmp_path / "run.nc", compression=compression)
    assert path == tmp_path / "run.nc"
    assert [entry.name for entry in tmp_path.iterdir()] == ["run.nc"]
    loaded = load_response(path)
    assert_equal(loaded.solution, response.solution)
    assert str(loaded.summary()) == str(response.summary())


def test_round_trip_without_absorbers(make: Callable[..., ModalSolution], rigid_core: Response, tmp_path: Path) -> None:
    solution = make(rigid_core.system, parities=1)
    solution.normal[0, 0, 1, 4] = -0.0
    path = Response(solution).save(str(tmp_path / "run.nc"))
    loaded = load_response(str(path)).solution
    assert_equal(loaded, solution)
    assert np.signbit(loaded.normal[0, 0, 1, 4])


def test_a_file_with_nan_is_refused(make: Callable[..., ModalSolution], rigid_core: Response, tmp_path: Path) -> None:
    solution = make(rigid_core.system, parities=1)
    solution.normal[0, 0, 1, 3] = np.nan
    path = save(solution, tmp_path / "run.nc")
    with pytest.raises(InputError, match=r"run.nc: the normal displacement is nan first at shell 0, half 0, order 1, t = "):
        load_response(path)


def test_a_long_scenario_fits(make: Callable[..., ModalSolution], response: Response, tmp_path: Path) -> None:
    many = tuple(absorber_ring(600, mass=1.0, linear_stiffness=1e9, damping=1.23456789).absorbers)
    solution = make(response.system.replace(absorbers=many))
    assert len(solution.problem.system.to_toml_string()) > 70_000
    path = Response(solution).save(tmp_path / "run.nc")
    assert_equal(load_response(path).solution, solution)


def test_the_file_tells_about_itself(response: Response, tmp_path: Path) -> None:
    path = response.save(tmp_path / "run.nc")
    with xr.open_dataset(path) as found:
        assert found["normal"].dims == ("shell", "half", "mode", "time")
        assert found["normal"].attrs["units"] == "a"
        assert found["absorber_force"].dims == ("absorber", "side", "time")
        np.testing.assert_array_equal(found["time_seconds"], response.time_seconds)
        assert found["scenario"].item() == response.system.to_toml_string()
        assert found.attrs["length_scale"] == 1.25
        for name in ("coaxshell", "numpy", "scipy", "python"):
            assert found.attrs[f"{name}_version"]
        assert found.attrs["created"].endswith("+00:00")
    text = info(path)
    for part in (
        "by hand",
        "orders 0 to 12",
        "time_step 0.025",
        "the drive is hot",
        "absorber_force (absorber 2, side 2, time 81)",
        "[[shells]]",
    ):
        assert part in text


@pytest.mark.parametrize("failure", [OSError(28, "No space left on device"), KeyboardInterrupt()])
def test_a_failure_in_mid_write_leaves_nothing(
    response: Response, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, failure: BaseException
) -> None:
    path = tmp_path / "run.nc"
    path.write_text("an older file")

    def half_written(dataset: xr.Dataset, store: object, **options: object) -> None:
        raise failure

    monkeypatch.setattr(xr.Dataset, "dump_to_store", half_written)
    expected = InputError if isinstance(failure, OSError) else KeyboardInterrupt
    with pytest.raises(expected, match="no space left on device; make room" if isinstance(failure, OSError) else None):
        response.save(path)
    assert [entry.name for entry in tmp_path.iterdir()] == ["run.nc"]
    assert path.read_text() == "an older file"


def test_places_that_cannot_be_written(response: Response, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="missing' does not exist"):
        response.save(tmp_path / "missing" / "run.nc")
    with pytest.raises(InputError, match="it is a folder"):
        response.save(tmp_path)
    with pytest.raises(InputError, match="cannot write"):
        response.save("/proc/run.nc")


@pytest.fixture
def saved(response: Response, tmp_path: Path) -> Path:
    return response.save(tmp_path / "run.nc")


def told(call: Callable[[Path], object], path: Path) -> str:
    with pytest.raises(InputError) as caught:
        call(path)
    text = str(caught.value)
    assert "\n" not in text
    assert str(path) in text
    return text


@pytest.mark.parametrize("call", [load_response, info])
def test_files_that_cannot_be_read(call: Callable[[Path], object], saved: Path, tmp_path: Path) -> None:
    assert "does not exist" in told(call, tmp_path / "none.nc")
    assert "is a folder" in told(call, tmp_path)
    text = tmp_path / "text.nc"
    text.write_text("shells and fluids\n" * 100)
    assert "is not a NetCDF file" in told(call, text)
    content = saved.read_bytes()
    for kept in (0, 10, 1000, len(content) // 2, len(content) - 1):
        short = tmp_path / "short.nc"
        short.write_bytes(content[:kept])
        assert "cut short or damaged" in told(call, short)
    other = tmp_path / "other.nc"
    xr.Dataset({"x": ("t", [1.0])}).to_netcdf(other, engine="h5netcdf")
    assert "was not written by coaxshell" in told(call, other)


def test_a_newer_format(saved: Path) -> None:
    with h5py.File(saved, "r+") as file:
        file.attrs["coaxshell_format_version"] = 99
        file.attrs["coaxshell_version"] = "8.0"
    assert "has format 99 of coaxshell 8.0, beyond 3 of this version; update coaxshell" in told(load_response, saved)


@pytest.mark.parametrize("lost", ["normal", "scenario"])
def test_a_lost_part(saved: Path, lost: str) -> None:
    with h5py.File(saved, "r+") as file:
        del file[lost]
    assert "is damaged" in told(load_response, saved)


def test_a_scenario_that_is_none(saved: Path) -> None:
    with h5py.File(saved, "r+") as file:
        file["scenario"][()] = "name = "
    assert "holds a scenario that this version does not accept" in told(load_response, saved)


def test_shells_that_do_not_fit(saved: Path, response: Response) -> None:
    with h5py.File(saved, "r+") as file:
        system = response.system
        one = system.replace(shells=system.shells[1:], fluids=system.fluids[1:], absorbers=())
        file["scenario"][()] = one.to_toml_string()
    assert "2 shells in the arrays, 1 in the scenario" in told(load_response, saved)


def test_rates_are_kept_if_the_solution_has_them(make: Callable[..., ModalSolution], tmp_path: Path) -> None:
    path = Response(make(rates=True)).save(tmp_path / "run.nc")
    with xr.open_dataset(path) as found:
        assert found["normal_rate"].attrs["units"] == "c_e"


def test_settings_survive(make: Callable[..., ModalSolution], tmp_path: Path) -> None:
    solution = make()
    solution = replace(solution, settings=replace(solution.settings, tolerance=1 / 3))
    assert load_response(Response(solution).save(tmp_path / "run.nc")).settings == solution.settings


def test_every_array_of_a_solution_is_kept(tmp_path):
    control = cx.PDControl(proportional=-2e4, derivative=-150, saturation=True)
    system = cx.presets.load("absorbers").replace(control=control)
    response = cx.simulate(system, modes=30, time_step=0.01, duration=1.0)
    assert np.abs(response.solution.control_correction).max() > 0
    response.save(tmp_path / "run.nc")
    loaded = cx.load_response(tmp_path / "run.nc")
    for field in dataclasses.fields(response.solution):
        value = getattr(response.solution, field.name)
        if isinstance(value, np.ndarray):
            np.testing.assert_array_equal(getattr(loaded.solution, field.name), value, err_msg=field.name)
