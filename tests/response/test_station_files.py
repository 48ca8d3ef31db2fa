"""Runs in three dimensions as files: all stations bit by bit there and back, thinned, forged; and guarded against NaN."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.response import info, load_response
from coaxshell.response.spatial import SpatialResponse
from coaxshell.response.storage import save
from coaxshell.solver.axial.solution import SpatialSolution, StationSpectra
from coaxshell.solver.axial.solve import station_spectra

QUICK = {"duration": 1.0, "time_step": 5e-2, "modes": 5, "dimensions": 3, "stations": [0.0, 0.7]}
CONTROLLED = cx.presets.load("active").replace(absorbers=())


@pytest.fixture(scope="module")
def whole() -> SpatialResponse:
    found = cx.simulate(CONTROLLED, **QUICK)
    assert isinstance(found, SpatialResponse)
    return found


@pytest.fixture(scope="module")
def content(whole: SpatialResponse, tmp_path_factory: pytest.TempPathFactory) -> bytes:
    return whole.save(tmp_path_factory.mktemp("saved") / "run.nc").read_bytes()


@pytest.fixture
def saved(content: bytes, tmp_path: Path) -> Path:
    (tmp_path / "run.nc").write_bytes(content)
    return tmp_path / "run.nc"


def loaded(path: Path) -> SpatialResponse:
    found = load_response(path)
    assert isinstance(found, SpatialResponse)
    return found


@pytest.mark.parametrize("compression", [False, True])
def test_a_run_is_read_back_bit_by_bit(whole: SpatialResponse, tmp_path: Path, compression: bool) -> None:
    found = loaded(whole.save(tmp_path / "run.nc", compression=compression)).spatial
    true = whole.spatial
    assert found.fields.keys() == true.fields.keys()
    for name, values in true.fields.items():
        np.testing.assert_array_equal(found.fields[name], values, err_msg=name)
    np.testing.assert_array_equal(found.stations, true.stations)
    np.testing.assert_array_equal(found.time, true.time)
    np.testing.assert_array_equal(found.estimates.by_cause(), true.estimates.by_cause())
    assert found.estimates.axial is not None
    assert (found.sampling.period, found.sampling.max_order, found.sampling.highest) == (true.sampling.period, 5, 5.0)
    assert (found.problem, found.settings, found.warnings, found.timings) == (true.problem, true.settings, true.warnings, true.timings)
    assert found.spectra is not None
    assert true.spectra is not None
    np.testing.assert_array_equal(found.spectra.normal, true.spectra.normal)
    np.testing.assert_array_equal(found.spectra.tangential, true.spectra.tangential)


def test_a_loaded_run_answers_as_the_run_did(whole: SpatialResponse, saved: Path) -> None:
    found = loaded(saved)
    assert str(found.summary()) == str(whole.summary())
    for read in (
        lambda r: r.stress("inner", [0, 60], depth="outer", component="von_mises"),
        lambda r: r.displacement("outer", [40], component="axial"),
        lambda r: r.shell_acceleration("outer", [0], station=0.7),
        lambda r: r.actuator_voltage("inner", [0, 90]),
        lambda r: r.errors(),
    ):
        xr.testing.assert_identical(read(found), read(whole))


def test_a_file_of_three_dimensions_has_a_format_of_its_own(saved: Path, tmp_path: Path) -> None:
    with xr.open_dataset(saved, engine="h5netcdf") as dataset:
        assert dataset["normal"].dims == ("station", "shell", "half", "mode", "time")
        assert dataset["station"].values.tolist() == [0.0, 0.7]
        assert dataset["station"].attrs["units"] == "m"
        assert dataset["cause"].values.tolist() == ["orders", "time step", "march", "axial wavenumbers"]
        assert dataset.attrs["coaxshell_format_version"] == 3
    assert "stations 2, shells 2, orders 0 to 5, instants 21" in info(saved)
    flat = cx.simulate("bare", duration=1.0, time_step=5e-2, modes=3).save(tmp_path / "flat.nc")
    with h5py.File(flat, "r+") as file:
        assert file.attrs["coaxshell_format_version"] == 2
        settings = json.loads(file.attrs["settings"])
        file.attrs["settings"] = json.dumps({**settings, "dimensions": 3})
    with pytest.raises(InputError, match="stations of three dimensions in a format of two"):
        load_response(flat)


def test_a_copy_by_xarray_is_the_same_run(whole: SpatialResponse, saved: Path) -> None:
    with xr.open_dataset(saved, engine="h5netcdf") as dataset:
        dataset.load().to_netcdf(saved.with_name("copy.nc"), engine="h5netcdf")
        dataset["axial_z"][1, 0, 0, 2, 3] *= 1.001
        dataset.to_netcdf(saved.with_name("changed.nc"), engine="h5netcdf")
    np.testing.assert_array_equal(loaded(saved.with_name("copy.nc")).spatial.fields["u_z"], whole.spatial.fields["u_z"])
    with pytest.raises(InputError, match="its checksum is another"):
        load_response(saved.with_name("changed.nc"))


def test_thin_keeps_what_can_be_kept(whole: SpatialResponse, tmp_path: Path) -> None:
    thin = whole.thin(every=4, window=(0.2, 0.9))
    found = loaded(thin.save(tmp_path / "thin.nc"))
    kept = slice(4, 19, 4)
    np.testing.assert_array_equal(found.time, whole.time[kept])
    for quantity in ("stress", "axial_stress", "displacement", "sensor_voltage", "actuator_voltage"):
        ours, theirs = (np.asarray(one.history("outer", quantity=quantity)) for one in (found, whole))
        np.testing.assert_allclose(ours, theirs[kept], rtol=1e-12, atol=1e-12 * abs(theirs).max())
    assert "4 of the run's 21 instants are held" in found.warnings[-1]
    assert "shell_velocity" not in found.summary().largest[0]
    with pytest.raises(InputError, match="holds 4 instants where its run had 21"):
        found.shell_velocity("inner")
    with pytest.raises(InputError, match="21 leaves fewer than two instants"):
        whole.thin(21)


def test_point_absorbers_are_kept(tmp_path: Path) -> None:
    ring = cx.absorber_ring(2, z=[0.0, 0.4], mass=20.0, damping=1e4, linear_stiffness=1e8, cubic_stiffness=1e17, footprint=0.2)
    run = cx.simulate(cx.presets.load("bare").replace(absorbers=ring), **QUICK)
    found = loaded(run.save(tmp_path / "run.nc"))
    xr.testing.assert_identical(found.absorber_displacement(), run.absorber_displacement())
    xr.testing.assert_identical(found.absorber_force(), run.absorber_force())
    assert str(found.summary()) == str(run.summary())
    thin = loaded(found.thin(5).save(tmp_path / "thin.nc"))
    np.testing.assert_array_equal(thin.absorber_force(), run.absorber_force()[..., ::5])
    np.testing.assert_array_equal(run.to_dataframe()["absorber 3 displacement (m)"], run.absorber_displacement()[3])
    assert "absorber_force (absorber 4, side 2, time 21)" in info(tmp_path / "run.nc")
    with h5py.File(tmp_path / "run.nc", "r+") as file:
        del file["absorber_force"]
    with pytest.raises(InputError, match="0 point absorbers in the arrays, 4 in the scenario"):
        load_response(tmp_path / "run.nc")
    force = run.spatial.absorber_force.copy()  # type: ignore[attr-defined]
    force[1, 0, 4] = np.inf
    with pytest.raises(InputError, match="the force of the absorbers is inf first at absorber 1, side 0, t = 0"):
        SpatialResponse(replace(run.spatial, absorber_force=force))  # type: ignore[attr-defined]


def test_stations_alone_are_those_of_the_run(whole: SpatialResponse, tmp_path: Path) -> None:
    alone = whole.at("70 cm")
    assert alone.stations.tolist() == [0.7]
    xr.testing.assert_identical(alone.stress("inner", station=0.7), whole.stress("inner", station=0.7))
    xr.testing.assert_identical(alone.shell_velocity("inner", station=0.7), whole.shell_velocity("inner", station=0.7))
    assert alone.summary().each[0].to_dict()["shells"] == whole.summary().at(0.7).to_dict()["shells"]
    assert loaded(alone.save(tmp_path / "alone.nc")).stations.tolist() == [0.7]
    with pytest.raises(InputError, match=r"station: 0\.3 m is none of the run's"):
        whole.at(0.3)


def test_transforms_that_were_not_kept_are_made_once_for_all_stations(whole: SpatialResponse, monkeypatch: pytest.MonkeyPatch) -> None:
    bare = whole.without_transforms()
    assert "shell_velocity" not in bare.summary().largest[0]
    made, expected = [], whole.shell_velocity("outer")

    def again(spatial: SpatialSolution) -> StationSpectra:
        made.append(spatial)
        return station_spectra(spatial)

    monkeypatch.setattr("coaxshell.response.stations.station_spectra", again)
    np.testing.assert_array_equal(bare.shell_velocity("outer"), expected)
    assert len(made) == 1
    assert str(bare.summary()) == str(whole.summary())


def change(attribute: str, **entries: object) -> Callable[[h5py.File], None]:
    def changed(file: h5py.File) -> None:
        file.attrs[attribute] = json.dumps({**json.loads(file.attrs[attribute]), **entries})

    return changed


def without(name: str) -> Callable[[h5py.File], None]:
    def changed(file: h5py.File) -> None:
        del (file.attrs if name in file.attrs else file)[name]

    return changed


@pytest.mark.parametrize(
    ("forge", "message"),
    [
        (change("axial_sampling", period=1e300), "an axial period that is not that of its settings"),
        (change("axial_sampling", max_order=4), "axial wavenumbers that are not those of its settings"),
        (change("axial_sampling", highest="many"), "is not a finite number"),
        (change("settings", stations=[0.0, 0.8]), "its stations are not those of its settings"),
        (change("settings", stations=[0.0, 0.7, 1.0]), "2 stations in the arrays, 3 in the settings"),
        (change("settings", refinement=20), "257 Laplace nodes in the arrays, 406 in the settings"),
        (change("settings", modes=6), "those of its settings"),
        (without("axial_sampling"), "damaged"),
        (without("normal"), "damaged"),
        (without("potential_1"), "1 voltages of piezoelectric layers in the arrays, 2 in the scenario"),
        (without("station"), "damaged"),
    ],
)
def test_forged_files_are_refused_in_one_line(saved: Path, forge: Callable[[h5py.File], None], message: str) -> None:
    with h5py.File(saved, "r+") as file:
        forge(file)
    with pytest.raises(InputError, match=message) as caught:
        load_response(saved)
    assert "\n" not in str(caught.value)


def test_no_field_with_nan_becomes_a_response(whole: SpatialResponse, tmp_path: Path) -> None:
    fields = {name: values.copy() for name, values in whole.spatial.fields.items()}
    fields["u_z"][1, 0, 0, 2, 3] = np.nan
    spoilt = replace(whole.spatial, fields=fields)
    with pytest.raises(InputError, match=r"the field u_z is nan first at station 1, shell 0, half 0, order 2, t = 0\.15"):
        SpatialResponse(spoilt)
    with pytest.raises(InputError, match=r"run\.nc: the field u_z is nan first at station 1"):
        load_response(save(spoilt, tmp_path / "run.nc"))


def test_more_wavenumbers_than_any_run_needs_are_refused() -> None:
    with pytest.raises(InputError, match=r"stations: an axial period of .* asks for .* axial wavenumbers, at most 100,000 are solved"):
        cx.simulate("bare", **{**QUICK, "stations": ["1000 km"]})
    with pytest.raises(InputError, match="axial_period: an axial period of"):
        cx.simulate("bare", **{**QUICK, "modes": "auto"}, axial_period="100 km")


def test_axial_wavenumbers_left_out_are_warned_of() -> None:
    found = cx.simulate("bare", duration=1.0, time_step=5e-2, modes=20, axial_modes=3, dimensions=3)
    assert any("axial wavenumbers above 3 (times a) would change the" in text and "axial_modes=6" in text for text in found.warnings)
