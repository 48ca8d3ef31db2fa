"""VTK's XML files, as ParaView reads them: images, lines and collections over time, arrays appended in raw binary."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.generic]

_TYPES = {"float32": "Float32", "float64": "Float64", "int32": "Int32", "int64": "Int64", "uint8": "UInt8"}


class _Appended:
    """Arrays gathered behind the XML part; each is announced by its size in bytes as a 64-bit number."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self._offset = 0

    def array(self, name: str, values: Array) -> str:
        """Keep an array, components along the last of two dimensions, and return the element that refers to it."""
        data = np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<")).tobytes()
        components = values.shape[1] if values.ndim == 2 else 1
        element = (
            f'<DataArray type="{_TYPES[values.dtype.name]}" Name={quoteattr(name)} NumberOfComponents="{components}" '
            f'format="appended" offset="{self._offset}"/>'
        )
        self._parts += [np.uint64(len(data)).astype("<u8").tobytes(), data]
        self._offset += 8 + len(data)
        return element

    def write(self, path: Path, kind: str, body: str) -> None:
        """Write the file: the XML of its body, then all arrays."""
        head = f'<?xml version="1.0"?>\n<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n{body}\n'
        with path.open("wb") as file:
            file.write(head.encode() + b'<AppendedData encoding="raw">\n_')
            file.writelines(self._parts)
            file.write(b"\n</AppendedData>\n</VTKFile>\n")


def write_image(
    path: Path, origin: Sequence[float], spacing: Sequence[float], arrays: Mapping[str, Array], *, axes: tuple[int, int] = (0, 1)
) -> None:
    """Write a .vti file of points on a Cartesian plane.

    Parameters
    ----------
    path : Path
    origin : sequence of float
        x and y, and z if it is not 0, of the first point, m.
    spacing : sequence of float
        The steps along columns and rows, m.
    arrays : mapping of name to ndarray, shape (rows, columns) or (rows, columns, components)
    axes : (int, int)
        Along which axis of space columns and rows are: x and y, or (0, 2) for x and z.
    """
    appended = _Appended()
    rows, columns = next(iter(arrays.values())).shape[:2]
    last, steps = [0, 0, 0], [1.0, 1.0, 1.0]
    for axis, count, step in zip(axes, (columns, rows), spacing, strict=True):
        last[axis], steps[axis] = count - 1, step
    first = [*origin, 0.0][:3]
    extent = " ".join(f"0 {end}" for end in last)
    elements = [appended.array(name, values.reshape(rows * columns, *values.shape[2:])) for name, values in arrays.items()]
    body = (
        f'<ImageData WholeExtent="{extent}" Origin="{_numbers(first)}" Spacing="{_numbers(steps)}">\n'
        f'<Piece Extent="{extent}">\n<PointData Scalars={quoteattr(next(iter(arrays)))}>\n'
        + "\n".join(elements)
        + "\n</PointData>\n</Piece>\n</ImageData>"
    )
    appended.write(path, "ImageData", body)


def _numbers(values: Sequence[float]) -> str:
    return " ".join(repr(float(value)) for value in values)


def write_surface(path: Path, points: Array, arrays: Mapping[str, Array]) -> None:
    """Write a .vts file of points that form a grid of three indices, one of which may stay the same on a surface.

    Parameters
    ----------
    path : Path
    points : ndarray, shape (layers, rows, columns, 3)
        m.
    arrays : mapping of name to ndarray, shape (layers, rows, columns) or (layers, rows, columns, components)
    """
    appended, shape = _Appended(), points.shape[:3]
    extent = " ".join(f"0 {count - 1}" for count in reversed(shape))
    count = points.size // 3
    place = appended.array("Points", points.reshape(count, 3))
    elements = [appended.array(name, values.reshape(count, *values.shape[3:])) for name, values in arrays.items()]
    body = (
        f'<StructuredGrid WholeExtent="{extent}">\n<Piece Extent="{extent}">\n<Points>\n{place}\n</Points>\n'
        f"<PointData Scalars={quoteattr(next(iter(arrays)))}>\n" + "\n".join(elements) + "\n</PointData>\n</Piece>\n</StructuredGrid>"
    )
    appended.write(path, "StructuredGrid", body)


def write_lines(path: Path, lines: Sequence[Array], point_data: Mapping[str, Array], line_data: Mapping[str, Array]) -> None:
    """Write a .vtp file of closed lines.

    Parameters
    ----------
    path : Path
    lines : sequence of ndarray, shape (points, 3)
        Points of each line, m, the first not repeated at the end.
    point_data : mapping of name to ndarray
        One row for each point, all lines joined.
    line_data : mapping of name to ndarray
        One value for each line.
    """
    appended = _Appended()
    starts = np.cumsum([0, *(len(line) for line in lines)])
    closed = [np.append(np.arange(start, end), start) for start, end in pairwise(starts.tolist())]
    points = appended.array("Points", np.concatenate(lines))
    links = appended.array("connectivity", np.concatenate(closed).astype(np.int64))
    ends = appended.array("offsets", np.cumsum([len(line) for line in closed]).astype(np.int64))
    data = "\n".join(appended.array(name, values) for name, values in point_data.items())
    cells = "\n".join(appended.array(name, values) for name, values in line_data.items())
    body = (
        f'<PolyData>\n<Piece NumberOfPoints="{starts[-1]}" NumberOfVerts="0" NumberOfLines="{len(lines)}" NumberOfStrips="0" '
        f'NumberOfPolys="0">\n<Points>\n{points}\n</Points>\n<Lines>\n{links}\n{ends}\n</Lines>\n'
        f"<PointData>\n{data}\n</PointData>\n<CellData>\n{cells}\n</CellData>\n</Piece>\n</PolyData>"
    )
    appended.write(path, "PolyData", body)


def write_collection(path: Path, times: Sequence[float], files: Sequence[Sequence[str]]) -> None:
    """Write a .pvd file: one file or several parts, named relative to it, for each time."""
    sets = "\n".join(
        f'<DataSet timestep="{float(time)!r}" group="" part="{part}" file={quoteattr(file)}/>'
        for time, parts in zip(times, files, strict=True)
        for part, file in enumerate(parts)
    )
    text = f'<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">\n<Collection>\n{sets}\n'
    path.write_text(text + "</Collection>\n</VTKFile>\n", encoding="utf-8")
