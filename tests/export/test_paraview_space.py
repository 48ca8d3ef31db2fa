"""ParaView's series of three-dimensional runs: read back by a parser of our own, and by VTK itself where it is installed."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.export import export_paraview
from coaxshell.export.paraview import paraview_cost
from coaxshell.response.spatial import SpatialResponse

DTYPES = {"Float32": "<f4", "Float64": "<f8"}
TIMES = [0.4, 0.8]
A = 1.0
"""Outermost radius, m."""


def arrays(path: Path) -> tuple[dict[str, str], dict[str, np.ndarray]]:
    """Return (attributes of the data set's element, {name: array}) of a file with appended raw arrays."""
    head, _, rest = path.read_bytes().partition(b'<AppendedData encoding="raw">\n_')
    root = ElementTree.fromstring(head + b"</VTKFile>")
    found = {}
    for element in root.iter("DataArray"):
        start = int(element.attrib["offset"])
        size = int(np.frombuffer(rest[start : start + 8], "<u8")[0])
        values = np.frombuffer(rest[start + 8 : start + 8 + size], DTYPES[element.attrib["type"]])
        components = int(element.attrib["NumberOfComponents"])
        found[element.attrib["Name"]] = values.reshape(-1, components) if components > 1 else values
    return root[0].attrib, found


def series(folder: Path, name: str) -> dict[float, list[Path]]:
    """Return the files of a collection by its times, parts in order."""
    found: dict[float, list[Path]] = {}
    for item in ElementTree.parse(folder / f"{name}.pvd").getroot().iter("DataSet"):
        files = found.setdefault(float(item.attrib["timestep"]), [])
        assert int(item.attrib["part"]) == len(files)
        files.append(folder / item.attrib["file"])
    return found


@pytest.fixture(scope="module")
def response() -> SpatialResponse:
    found = cx.simulate("bare", duration=1.0, time_step=5e-2, modes=5, dimensions=3, stations=[0.0, 0.5])
    assert isinstance(found, SpatialResponse)
    assert found.system.reference_radius == A
    return found


@pytest.fixture(scope="module")
def folder(response: SpatialResponse, tmp_path_factory: pytest.TempPathFactory) -> Path:
    target = tmp_path_factory.mktemp("out") / "run"
    options: dict[str, Any] = {"half_width": 1.5, "points": 7, "volume": 7, "velocity": True, "station": "30 cm"}
    return export_paraview(response, target, times=TIMES, displaced=1e3, **options)


@pytest.mark.parametrize(("name", "parts"), [("across", 1), ("along", 1), ("volume", 3), ("shells", 2)])
def test_the_series_name_their_parts_at_times_in_seconds(folder: Path, name: str, parts: int) -> None:
    found = series(folder, name)
    np.testing.assert_allclose(list(found), np.array(TIMES) / 1400, rtol=1e-12)
    assert all(len(files) == parts and all(file.is_file() for file in files) for files in found.values())


def test_cuts_lie_where_they_are(folder: Path, response: SpatialResponse) -> None:
    x = np.linspace(-1.5, 1.5, 7)
    planes: dict[str, tuple[dict[str, Any], str, str]] = {
        "across": ({"x": x, "y": x, "z": 0.3}, "0 6 0 6 0 0", "-1.5 -1.5 0.3"),
        "along": ({"x": x, "z": x, "y": 0.0}, "0 6 0 0 0 6", "-1.5 0.0 -1.5"),
    }
    for name, (cut, extent, origin) in planes.items():
        attributes, found = arrays(list(series(folder, name).values())[1][0])
        assert attributes["WholeExtent"] == extent
        assert attributes["Origin"] == origin
        expected = response.pressure(**cut, time=TIMES).isel(time=1).to_numpy()
        np.testing.assert_allclose(found["pressure"], expected.ravel(), rtol=1e-6, atol=1e-6 * float(abs(expected).max()))
        flow = response.velocity(**cut, time=TIMES).isel(time=1).to_numpy()
        np.testing.assert_allclose(found["velocity"], flow.reshape(3, -1).T, rtol=0, atol=1e-6 * float(abs(flow).max()))


def test_the_volume_has_a_grid_for_each_fluid(folder: Path, response: SpatialResponse) -> None:
    z, reached = np.linspace(-1.5, 1.5, 7), []
    for number, file in enumerate(next(iter(series(folder, "volume").values()))):
        attributes, found = arrays(file)
        last = [int(each) for each in attributes["WholeExtent"].split()[1::2]]
        place = found["Points"].reshape(last[2] + 1, last[1] + 1, last[0] + 1, 3)
        np.testing.assert_allclose(place[:, 0, 0, 2], z, rtol=1e-6)
        np.testing.assert_allclose(place[..., 0, :], place[..., -1, :], rtol=0, atol=1e-6)  # closed around
        radius, angle = np.hypot(place[0, :, 0, 0], place[0, :, 0, 1]), np.linspace(0.0, 360.0, last[0] + 1)
        reached += [radius[0], radius[-1]]
        inside = np.minimum(radius.astype(np.float64), {0: 0.5, 1: 1.0}.get(number, 9.0) * (1.0 - 1e-9))
        keys: dict[str, Any] = {"radius": inside, "angle": angle, "z": z, "time": TIMES}
        expected = response.pressure(**keys).isel(time=0).to_numpy()
        np.testing.assert_allclose(found["pressure"], expected.ravel(), rtol=0, atol=1e-5 * 2e4)
        flow, turn = response.velocity(**keys).isel(time=0).to_numpy(), np.radians(angle)
        along_x = np.cos(turn) * flow[0] - np.sin(turn) * flow[1]
        np.testing.assert_allclose(found["velocity"][:, 0], along_x.ravel(), rtol=0, atol=1e-4 * float(abs(flow).max()))
        np.testing.assert_allclose(found["velocity"][:, 2], flow[2].ravel(), rtol=0, atol=1e-4 * float(abs(flow).max()))
    np.testing.assert_allclose(reached, [0.0, 0.5, 0.5, 1.0, 1.0, 1.5], rtol=1e-6)


def test_shells_are_surfaces_mirrored_in_the_sources_plane(folder: Path, response: SpatialResponse) -> None:
    angle = np.arange(0.0, 361.0, 2.0)
    for shell, file in enumerate(list(series(folder, "shells").values())[1]):
        attributes, found = arrays(file)
        assert attributes["WholeExtent"] == "0 180 0 2 0 0"
        values = {name: each.reshape(3, 181, *each.shape[1:]) for name, each in found.items()}
        for row, station, sign in ((0, 0.5, -1.0), (1, 0.0, 1.0), (2, 0.5, 1.0)):

            def read(name: str, shell: int = shell, station: float = station) -> np.ndarray:
                return response.history(shell, angle, name, station=station).sel(time=0.8, method="nearest").to_numpy()

            np.testing.assert_allclose(values["hoop_stress"][row], read("stress"), rtol=1e-12)
            np.testing.assert_allclose(values["shear_stress"][row], sign * read("shear_stress"), rtol=1e-12)
            np.testing.assert_allclose(values["von_mises_stress"][row], read("von_mises_stress"), rtol=1e-12)
            np.testing.assert_allclose(values["normal_shell_velocity"][row], read("shell_velocity"), rtol=1e-12)
            theta, w, v = np.radians(angle), read("displacement"), read("tangential_displacement")
            moved = np.stack([-v * np.sin(theta) - w * np.cos(theta), v * np.cos(theta) - w * np.sin(theta)], axis=1)
            moved = np.concatenate([moved, sign * read("axial_displacement")[:, None]], axis=1)
            np.testing.assert_allclose(values["displacement"][row], moved, rtol=1e-9, atol=1e-20)
            radius = response.system.shells[shell].radius
            rest = np.stack([radius * np.cos(theta), radius * np.sin(theta), np.full(181, sign * station)], axis=1)
            np.testing.assert_allclose(values["Points"][row], rest + 1e3 * moved, rtol=1e-9, atol=1e-12)


def test_what_is_not_asked_for_is_not_written(response: SpatialResponse, tmp_path: Path) -> None:
    told: list[float] = []
    thin = export_paraview(
        response.thin(2), tmp_path / "run", times=[1.0], cuts=False, progress=lambda share, _: told.append(share)
    )  # fields need every instant, surfaces do not
    assert sorted(path.name for path in thin.iterdir()) == ["data", "shells.pvd", "system.toml"]
    _, found = arrays(next(iter(series(thin, "shells").values()))[0])
    assert "normal_shell_velocity" not in found
    assert told[-1] == 1.0


def test_the_cost_of_fields_is_told(response: SpatialResponse) -> None:
    fields: dict[str, Any] = {"cuts": True, "volume": None, "velocity": False, "station": None}
    plain = paraview_cost(response, TIMES, 1.5, 31, **fields)
    assert 0.0 < plain.seconds < paraview_cost(response, TIMES, 1.5, 31, **{**fields, "volume": 31, "velocity": True}).seconds


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"volume": 2}, "volume: 2 is not allowed; give a whole number of points from 5 to 400"),
        ({"cuts": False, "velocity": True}, "velocity: is of cuts or of a volume, and neither is written"),
        ({"station": "far"}, "stations"),
        ({"times": [3.0]}, "3 is outside the run"),
    ],
)
def test_refusals(response: SpatialResponse, tmp_path: Path, options: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        export_paraview(response, tmp_path / "run", **options)
    assert list(tmp_path.iterdir()) == []


def test_a_volume_is_not_of_two_dimensions(tmp_path: Path) -> None:
    flat = cx.simulate("bare", duration=0.2, time_step=5e-2, modes=2)
    with pytest.raises(InputError, match="volume: 41 belongs to three dimensions"):
        export_paraview(flat, tmp_path / "run", volume=41)


@pytest.mark.slow
def test_vtk_reads_it_back(folder: Path) -> None:
    """VTK's own readers find the same arrays on the same points."""
    pytest.importorskip("vtk")
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLStructuredGridReader

    for name in ("along", "volume", "shells"):
        for file in (file for files in series(folder, name).values() for file in files):
            reader = vtkXMLImageDataReader() if name == "along" else vtkXMLStructuredGridReader()
            reader.SetFileName(str(file))
            reader.Update()
            grid, ours = reader.GetOutput(), arrays(file)[1]
            if name == "along":
                np.testing.assert_allclose(grid.GetBounds(), (-1.5, 1.5, 0, 0, -1.5, 1.5), rtol=1e-12)
            else:
                np.testing.assert_array_equal(vtk_to_numpy(grid.GetPoints().GetData()), ours["Points"])
            for label, values in ours.items():
                if label != "Points":
                    np.testing.assert_array_equal(vtk_to_numpy(grid.GetPointData().GetArray(label)), values)
