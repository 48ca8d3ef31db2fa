"""The time series for ParaView: read back by a parser of our own, and by VTK itself where it is installed."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import numpy as np
import pytest

from coaxshell import InputError, System
from coaxshell.export import export_paraview

DTYPES = {"Float32": "<f4", "Float64": "<f8", "Int32": "<i4", "Int64": "<i8"}
TIMES = [0.0, 0.5, 1.0]


def arrays(path):
    """Return (attributes of the data set's element, {name: array}) of a file with appended raw arrays."""
    head, _, rest = path.read_bytes().partition(b'<AppendedData encoding="raw">\n_')
    root = ElementTree.fromstring(head + b"</VTKFile>")
    found = {}
    for element in root.iter("DataArray"):
        start = int(element.get("offset"))
        size = int(np.frombuffer(rest[start : start + 8], "<u8")[0])
        values = np.frombuffer(rest[start + 8 : start + 8 + size], DTYPES[element.get("type")])
        components = int(element.get("NumberOfComponents"))
        found[element.get("Name")] = values.reshape(-1, components) if components > 1 else values
    assert rest.endswith(b"\n</AppendedData>\n</VTKFile>\n")
    return root[0].attrib, found


@pytest.fixture(scope="module")
def folder(hybrid, tmp_path_factory):
    return export_paraview(hybrid, tmp_path_factory.mktemp("out") / "run", times=TIMES, points=21, displaced=1e3)


def series(folder, name):
    root = ElementTree.parse(folder / name).getroot()
    return [(float(item.get("timestep")), folder / item.get("file")) for item in root.iter("DataSet")]


@pytest.mark.parametrize("name", ["field.pvd", "shells.pvd"])
def test_the_series_names_files_that_exist_at_times_in_seconds(folder, hybrid, name):
    times, files = zip(*series(folder, name), strict=True)
    np.testing.assert_allclose(times, np.array(TIMES) / 1400, rtol=1e-12)
    assert all(file.is_file() for file in files)


def test_field(folder):
    _, path = series(folder, "field.pvd")[1]
    attributes, found = arrays(path)
    assert attributes["WholeExtent"] == "0 20 0 20 0 0"
    np.testing.assert_allclose([float(v) for v in attributes["Spacing"].split()], [0.3, 0.3, 1.0], rtol=1e-12)
    np.testing.assert_allclose([float(v) for v in attributes["Origin"].split()], [-3.0, -3.0, 0.0], rtol=1e-12)
    x = np.linspace(-3, 3, 21)
    expected = x[None, :] + 10 * x[:, None] + 50  # x runs fastest
    np.testing.assert_allclose(found["pressure"], expected.ravel(), rtol=1e-6)


def test_shells_carry_stress_and_displacement_and_are_drawn_displaced(folder, hybrid):
    _, path = series(folder, "shells.pvd")[2]
    _, found = arrays(path)
    angle = np.arange(0, 360, 0.5)
    theta = np.radians(angle)
    radial = np.stack([np.cos(theta), np.sin(theta)], axis=1)
    around = np.stack([-np.sin(theta), np.cos(theta)], axis=1)
    for shell, rows in ((0, slice(0, 720)), (1, slice(720, 1440))):
        np.testing.assert_allclose(found["hoop_stress"][rows], hybrid.stress(shell, angle).to_numpy()[-1], rtol=1e-12)
        w, v = (hybrid.displacement(shell, angle, component).to_numpy()[-1][:, None] for component in ("normal", "tangential"))
        np.testing.assert_allclose(found["displacement"][rows, :2], v * around - w * radial, rtol=1e-9, atol=1e-18)
        at = hybrid.system.shells[shell].radius * radial + 1e3 * (v * around - w * radial)
        np.testing.assert_allclose(found["Points"][rows, :2], at, rtol=1e-9)
    assert found["offsets"].tolist() == [721, 1442]
    assert found["connectivity"][[0, 720, 721, 1441]].tolist() == [0, 0, 720, 720]  # closed
    assert found["shell"].tolist() == [0, 1]


def test_the_folder_reproduces_itself(folder, hybrid):
    assert System.from_toml(folder / "system.toml") == hybrid.system


def test_a_rigid_core_stays_where_it_is(rigid_core, tmp_path):
    folder = export_paraview(rigid_core, tmp_path / "run", times=[1.0], points=5, displaced=1e6)
    _, found = arrays(series(folder, "shells.pvd")[0][1])
    np.testing.assert_allclose(np.hypot(*found["Points"][:720, :2].T), 0.5, rtol=1e-12)
    assert not found["hoop_stress"][:720].any()
    assert found["hoop_stress"][720:].any()


def test_an_existing_folder_is_replaced_only_when_told_to(hybrid, tmp_path):
    target = tmp_path / "run"
    target.mkdir()
    (target / "mine.txt").write_text("mine")
    with pytest.raises(InputError, match="holds something else"):
        export_paraview(hybrid, target, times=[1.0], points=5)
    assert (target / "mine.txt").exists()
    with pytest.raises(InputError, match=r"holds something else than a result \('mine.txt'\)"):
        export_paraview(hybrid, target, times=[1.0], points=5, force=True)
    (target / "mine.txt").rename(target / "field.pvd")
    export_paraview(hybrid, target, times=[1.0], points=5, force=True)
    assert sorted(path.name for path in target.iterdir()) == ["data", "field.pvd", "shells.pvd", "system.toml"]
    assert [path.name for path in tmp_path.iterdir()] == ["run"]


def test_nothing_is_left_of_an_export_that_is_interrupted(hybrid, tmp_path):
    def stop(part, stage):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        export_paraview(hybrid, tmp_path / "run", times=[1.0], points=5, progress=stop)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"times": [3.0]}, "3 is outside the run"),
        ({"points": 1}, "points: 1 is not allowed"),
        ({"half_width": -1.0}, "width: -2 is not allowed"),
        ({"displaced": float("inf")}, "displaced: inf"),
    ],
)
def test_refusals(hybrid, tmp_path, options, message):
    with pytest.raises(InputError, match=re.escape(message)):
        export_paraview(hybrid, tmp_path / "run", **options)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_vtk_reads_it_back(folder):
    """VTK's own readers find the same arrays on the same points."""
    pytest.importorskip("vtk")
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLPolyDataReader

    for (_, field), (_, shells) in zip(series(folder, "field.pvd"), series(folder, "shells.pvd"), strict=True):
        reader = vtkXMLImageDataReader()
        reader.SetFileName(str(field))
        reader.Update()
        image = reader.GetOutput()
        assert image.GetDimensions() == (21, 21, 1)
        np.testing.assert_allclose(image.GetBounds(), (-3, 3, -3, 3, 0, 0), rtol=1e-12)
        pressure = vtk_to_numpy(image.GetPointData().GetScalars())
        np.testing.assert_array_equal(pressure, arrays(field)[1]["pressure"])
        assert pressure[image.FindPoint(2.7, -1.5, 0)] == pytest.approx(2.7 - 15 + pressure[image.FindPoint(0, 0, 0)], rel=1e-5)

        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(shells))
        reader.Update()
        lines = reader.GetOutput()
        assert (lines.GetNumberOfPoints(), lines.GetNumberOfLines()) == (1440, 2)
        ours = arrays(shells)[1]
        np.testing.assert_array_equal(vtk_to_numpy(lines.GetPoints().GetData()), ours["Points"])
        for name in ("hoop_stress", "displacement", "normal_displacement"):
            np.testing.assert_array_equal(vtk_to_numpy(lines.GetPointData().GetArray(name)), ours[name])
        assert lines.GetCell(0).GetNumberOfPoints() == 721
