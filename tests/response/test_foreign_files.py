"""Saved runs from elsewhere: thinned, flipped, forged. Every one is read as what it is, or refused in one line."""

from __future__ import annotations

import os
import random
import subprocess
import sys
import tomllib
import zlib
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
import tomli_w
import xarray as xr

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.response import Response, info, load_response
from coaxshell.response.storage import scenario

DATA = Path(__file__).parent / "data"


@pytest.fixture(scope="module")
def whole() -> Response:
    system = cx.presets.load("hybrid").with_overrides({"absorbers.count": 2})
    return cx.simulate(system, modes=3, time_step=0.05, duration=1.0)


@pytest.fixture(scope="module")
def content(whole: Response, tmp_path_factory: pytest.TempPathFactory) -> bytes:
    return whole.save(tmp_path_factory.mktemp("saved") / "run.nc", compression=True).read_bytes()


@pytest.fixture
def saved(content: bytes, tmp_path: Path) -> Path:
    (tmp_path / "run.nc").write_bytes(content)
    return tmp_path / "run.nc"


def rewritten(path: Path, change: Callable[[xr.Dataset], xr.Dataset]) -> Path:
    with xr.open_dataset(path, engine="h5netcdf") as dataset:
        change(dataset.load()).to_netcdf(path.with_name("changed.nc"), engine="h5netcdf")
    return path.with_name("changed.nc")


def refusal(call: Callable[[Path], object], path: Path) -> str:
    with pytest.raises(InputError) as caught:
        call(path)
    assert str(caught.value).startswith(str(path))
    return str(caught.value)


# -- history ------------------------------------------------------------------------------------------------------------------------


@pytest.mark.slow_for("every other")
@pytest.mark.parametrize(
    "change",
    [
        lambda dataset: dataset.isel(time=slice(None, None, 2)),
        lambda dataset: dataset.isel(time=slice(5, 15)),
        lambda dataset: dataset.isel(time=slice(None, -1)),
        lambda dataset: dataset.drop_vars("scenario").interp(time=np.linspace(0.0, 1.0, 21) ** 1.5).assign(scenario=dataset["scenario"]),
        lambda dataset: dataset.isel(time=[0, 3, 4, 20]),
    ],
    ids=["every other", "window", "one short", "interpolated", "chosen"],
)
def test_what_needs_the_whole_history_refuses_a_part_of_it(whole: Response, saved: Path, change: Callable[..., xr.Dataset]) -> None:
    part = load_response(rewritten(saved, change))
    assert part.stress("inner").sizes["time"] == part.time.size
    assert "a peak between them is missed" in part.warnings[-1]
    for ask in (
        lambda: part.pressure(x=[0.0], y=[0.0], time=0.5),
        lambda: part.velocity(x=[0.0], y=[0.0], time=0.5),
        lambda: part.pressure_rms("interior"),
        part.energy,
    ):
        with pytest.raises(InputError, match=rf"holds {part.time.size} instants where its run had 21 \(it was thinned, cut or interpol"):
            ask()


def test_a_rate_that_is_missing_is_not_made_from_a_part(saved: Path) -> None:
    rates = ["normal_rate", "tangential_rate"]
    part = load_response(rewritten(saved, lambda dataset: dataset.isel(time=slice(None, None, 2)).drop_vars(rates)))
    assert part.sensor_voltage("inner").sizes["time"] == 11
    with pytest.raises(InputError, match="a voltage of derivative control needs every one of them"):
        part.actuator_voltage("inner")


def test_thin_keeps_what_can_be_kept(whole: Response, tmp_path: Path) -> None:
    thin = whole.thin(every=4, window=(0.2, 0.9))
    loaded = load_response(thin.save(tmp_path / "thin.nc"))
    kept = slice(4, 19, 4)
    np.testing.assert_array_equal(loaded.time, whole.time[kept])
    for quantity in ("stress", "displacement", "sensor_voltage", "actuator_voltage"):
        ours, theirs = (np.asarray(getattr(one, quantity)("outer")) for one in (loaded, whole))
        np.testing.assert_allclose(ours, theirs[kept], rtol=1e-12, atol=1e-12 * abs(theirs).max())
    assert loaded.warnings == thin.warnings
    assert (tmp_path / "thin.nc").stat().st_size < whole.save(tmp_path / "whole.nc").stat().st_size
    with pytest.raises(InputError, match="4 instants where its run had 21"):
        loaded.energy()


@pytest.mark.parametrize(
    ("every", "window", "message"),
    [
        (0, None, "every: 0 is not allowed"),
        (2.0, None, "every: 2.0 is not allowed"),
        (True, None, "every: True is not allowed"),
        (21, None, "every: 21 leaves fewer than two instants; give at most 20"),
        (1, (2.0, 3.0), "window"),
    ],
)
def test_thinning_that_leaves_nothing_is_refused(whole: Response, every: int, window: tuple[float, float] | None, message: str) -> None:
    with pytest.raises(InputError, match=message):
        whole.thin(every, window)


# -- changed and damaged files ------------------------------------------------------------------------------------------------------


def test_a_file_of_the_version_before_is_read() -> None:
    response = load_response(DATA / "format-1.netcdf")
    assert response.system.name == "saved by the version before"
    assert response.solution.whole
    np.testing.assert_allclose(np.asarray(response.stress("inner"))[-1], [-684935.12087222, -174509.93243896], rtol=1e-12)
    assert "in format 1 by coaxshell" in info(DATA / "format-1.netcdf")
    again = cx.simulate(response.system, modes=3, time_step=0.1, duration=1.0)
    np.testing.assert_allclose(response.solution.normal, again.solution.normal, rtol=0, atol=1e-6 * abs(again.solution.normal).max())


def test_a_copy_by_xarray_is_the_same_run(whole: Response, saved: Path) -> None:
    copy = load_response(rewritten(saved, lambda dataset: dataset))
    np.testing.assert_array_equal(copy.solution.normal, whole.solution.normal)
    assert copy.solution.whole


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda dataset: dataset.assign(normal=2 * dataset["normal"]), "its checksum is another"),
        (lambda dataset: dataset.isel(shell=[1, 0]), "its checksum is another"),
        (lambda dataset: dataset.assign_attrs(settings=dataset.attrs["settings"].replace("0.001", "0.002")), "its checksum is another"),
        (lambda dataset: dataset.isel(mode=slice(3)), "2 as highest order in the arrays, 3 in the settings"),
        (lambda dataset: dataset.isel(shell=[0]), "1 shells in the arrays, 2 in the scenario"),
        (lambda dataset: dataset.isel(absorber=[0]), "1 absorbers in the arrays, 2 in the scenario"),
        (lambda dataset: dataset.drop_vars(["absorber_force", "absorber_displacement"]), "0 absorbers in the arrays, 2 in the scenario"),
        (lambda dataset: dataset.where(dataset.time != dataset.time[3]).assign(scenario=dataset.scenario), "is nan first at|has the shape"),
        (lambda dataset: dataset.assign(normal=dataset["normal"].astype("f4")), "normal does not hold numbers in double precision"),
        (
            lambda dataset: dataset.assign_coords(time=("time", (1e9 * dataset["time"].values).astype("m8[ns]"))),
            "time does not hold numbers",
        ),
        (lambda dataset: dataset.isel(time=slice(None, None, -1)), "its instants are not those of its settings"),
        (lambda dataset: dataset.assign_coords(time=dataset["time"] + 0.5), "its instants are not those of its settings"),
        (lambda dataset: dataset.transpose("time", ...), "has the shape"),
    ],
)
def test_what_was_changed_is_refused(saved: Path, change: Callable[..., xr.Dataset], message: str) -> None:
    with pytest.raises(InputError, match=message):
        load_response(rewritten(saved, change))


@pytest.mark.parametrize("compression", [False, True])
def test_every_flipped_bit_is_noticed(whole: Response, tmp_path: Path, compression: bool) -> None:
    saved = whole.save(tmp_path / "run.nc", compression=compression)
    content, chance = saved.read_bytes(), random.Random(1)
    for _ in range(60):
        bit = chance.randrange(8 * len(content))
        flipped = bytearray(content)
        flipped[bit // 8] ^= 1 << bit % 8
        saved.write_bytes(flipped)
        for call in (load_response, scenario, info):
            refusal(call, saved)


def test_values_that_are_not_finite_are_refused(saved: Path, whole: Response) -> None:
    path = rewritten(saved, lambda dataset: dataset.isel(time=slice(10)))
    for value in (np.nan, np.inf, -np.inf):
        with h5py.File(path, "r+") as file:
            file["tangential"][0, 0, 1, 3] = value
        assert f"the tangential displacement is {value} first at shell 0, half 0, order 1, t = 0.15" in refusal(load_response, path)


# -- forged files -------------------------------------------------------------------------------------------------------------------


def forged(saved: Path, name: str, make: Callable[[h5py.File], None]) -> Path:
    with h5py.File(saved, "r+") as file:
        if name in file:
            del file[name]
        make(file)
    return saved


def test_nothing_outside_the_file_is_opened(content: bytes, saved: Path, tmp_path: Path) -> None:
    secret = tmp_path / "secret.h5"
    with h5py.File(secret, "w") as file:
        file["normal"] = np.ones((2, 2, 4, 21))
        file["scenario"] = "a secret"
    (tmp_path / "raw").write_bytes(bytes(8 * 21))

    def virtual(file: h5py.File) -> None:
        layout = h5py.VirtualLayout((21,), "f8")
        layout[:] = h5py.VirtualSource(str(secret), "normal", (21,))
        file.create_virtual_dataset("time", layout)

    for name, make, message in (
        ("normal", lambda file: file.__setitem__("normal", h5py.ExternalLink(str(secret), "normal")), "normal is a link"),
        ("scenario", lambda file: file.__setitem__("scenario", h5py.ExternalLink(str(secret), "scenario")), "scenario is a link"),
        ("normal", lambda file: file.__setitem__("normal", h5py.SoftLink("/tangential")), "normal is a link"),
        ("time", virtual, "time lies in another file"),
        ("time", lambda file: file.create_dataset("time", (21,), "f8", external=[(str(tmp_path / "raw"), 0, 168)]), "time lies in another"),
        ("time", lambda file: file.create_group("time"), "time is not an array"),
        ("time", lambda file: file.create_dataset("time", (21,), h5py.ref_dtype), "time does not hold numbers"),
        ("time", lambda file: file.create_dataset("time", (21,), h5py.vlen_dtype(np.float64)), "time does not hold numbers"),
    ):
        saved.write_bytes(content)
        text = refusal(load_response, forged(saved, name, make))
        assert message in text
        assert "secret" not in text.removeprefix(str(saved))


def test_a_scenario_opens_no_file(saved: Path, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.csv")  # whoever opened it would wait for ever

    def other(file: h5py.File) -> None:
        data = tomllib.loads(cx.presets.load("hybrid").to_toml_string())
        data["source"]["pulse"] = {"type": "sampled", "file": str(tmp_path / "pipe.csv")}
        file["scenario"] = tomli_w.dumps(data)

    assert "names another file" in refusal(load_response, forged(saved, "scenario", other))
    assert "is a device or a pipe" in refusal(load_response, tmp_path / "pipe.csv")


MEASURED = """
import resource, sys
from coaxshell.errors import InputError
from coaxshell.response import load_response
import coaxshell.response.foreign, xarray
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
for path in sys.argv[1:]:
    try:
        load_response(path)
    except InputError as error:
        print(error)
print((resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) // 1024)
"""


def test_small_files_do_not_demand_memory(content: bytes, tmp_path: Path) -> None:
    huge = (2, 2, 4, 10**9)
    makes: dict[str, Callable[[h5py.File], object]] = {
        "never written": lambda file: file.create_dataset("normal", huge, "f8"),
        "chunked": lambda file: file.create_dataset("normal", huge, "f8", chunks=(1, 1, 1, 1000)),
        "one chunk": lambda file: file.create_dataset("normal", (2, 2, 4, 40_000_000), "f8", chunks=(2, 2, 4, 40_000_000), compression=9),
        "time": lambda file: file.create_dataset("time", (10**10,), "f8"),
        "estimate": lambda file: file.create_dataset("error_estimate", (10**10, 2, 3), "f8", fillvalue=1.0),
    }
    paths = []
    for number, (name, make) in enumerate(makes.items()):
        path = tmp_path / f"{number}.nc"
        path.write_bytes(content)
        paths.append(forged(path, {"time": "time", "estimate": "error_estimate"}.get(name, "normal"), make))
    for name in ("bomb.nc", "text.nc"):
        paths.append(tmp_path / name)
        paths[-1].write_bytes(content)
    with h5py.File(paths[-2], "r+") as file:  # chunks that unpack to a thousand times what they should hold
        shape = file["normal"].shape
        del file["normal"]
        bomb = file.create_dataset("normal", shape, "f8", chunks=shape, compression=9)
        bomb.id.write_direct_chunk((0, 0, 0, 0), zlib.compress(bytes(150_000_000), 1))
    with h5py.File(paths[-1], "r+") as file:
        file.attrs["settings"] = "x" * 7777
    claimed, found = (0x7FFFFFFF).to_bytes(4, "little"), (7777).to_bytes(4, "little")
    paths[-1].write_bytes(paths[-1].read_bytes().replace(found, claimed))  # one of them is the length of the text: two gigabytes
    outcome = subprocess.run([sys.executable, "-c", MEASURED, *map(str, paths)], capture_output=True, text=True, check=True, timeout=120)
    *told, grown = outcome.stdout.splitlines()
    assert len(told) == len(paths), outcome.stdout
    assert int(grown) < 120, outcome.stdout


FUZZ = """
import random, sys
import h5py, numpy as np
from pathlib import Path
from coaxshell.errors import InputError
from coaxshell.numerics.seal import add_seal, is_sealed
from coaxshell.response import info, load_response
from coaxshell.response.storage import scenario

original, folder, first, count = Path(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4])
content = original.read_bytes()
bare = content[: content.rindex(b"\\ncoaxshell sha256")]
VALUES = ["", "{}", "[]", "null", "NaN", "[" * 5000, '{"duration": 1e999}', '{"modes": 1e9}', '{"a": 1}', "x" * 100_000, 1.5, -1, 2**62,
          np.nan, np.arange(3), np.array([b"a", b"b"]), b"\\xff\\xfe", h5py.Empty("f8"), True, '[1]', '["\\\\ud800"]', "\\x1b[31m"]
refused = 0
for seed in range(first, first + count):
    chance = random.Random(seed)
    path = folder / "fuzz.nc"
    if seed % 3:
        data = bytearray(bare)
        for _ in range(chance.choice([1, 1, 2, 5, 40])):
            place = chance.randrange(len(data)) if chance.random() < 0.5 else chance.randrange(3000)
            data[place] = chance.choice([0, 255, 1, 127, 128, chance.randrange(256)])
        if chance.random() < 0.1:
            del data[chance.randrange(len(data)) :]
        path.write_bytes(data)
        if seed % 3 == 2:  # sealed anew, so that nothing but what it holds can give it away
            with path.open("r+b") as file:
                add_seal(file)
    else:
        path.write_bytes(bare)
        with h5py.File(path, "r+") as file:
            name = chance.choice(list(file.attrs)) if chance.random() < 0.7 else None
            value = chance.choice(VALUES)
            if name is not None:
                file.attrs[name] = value
            else:
                name = chance.choice(list(file))
                del file[name]
                if chance.random() < 0.8:
                    file[name] = value
    for call in (load_response, info, scenario):
        try:
            call(path)
        except InputError as error:
            refused += 1
            assert "\\n" not in str(error)
print(refused)
"""


def fuzzed(original: Path, folder: Path, first: int, count: int) -> None:
    command = [sys.executable, "-X", "faulthandler", "-c", FUZZ, str(original), str(folder), str(first), str(count)]
    outcome = subprocess.run(command, capture_output=True, text=True, timeout=900, check=False)
    assert outcome.returncode == 0, outcome.stderr[-3000:]
    assert int(outcome.stdout) > count  # of three calls each


def test_mutated_files_end_in_one_line(whole: Response, tmp_path: Path) -> None:
    fuzzed(whole.save(tmp_path / "run.nc"), tmp_path, 0, 36)


@pytest.mark.slow
@pytest.mark.parametrize("compression", [False, True])
def test_many_mutated_files_end_in_one_line(whole: Response, tmp_path: Path, compression: bool) -> None:
    fuzzed(whole.save(tmp_path / "run.nc", compression=compression), tmp_path, 1000, 300)
