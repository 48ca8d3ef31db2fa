"""Pressure records as people have them: whatever the dialect, the same numbers; whatever could be read in two ways, an error."""

from __future__ import annotations

import io
import os
import pickle
from time import process_time

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from scipy.io import savemat, wavfile

import coaxshell.model as cx
from coaxshell.errors import InputError
from coaxshell.model import Sampled, presets

TIME, PRESSURE = (0.0, 1e-4, 2.5e-4), (250e3, 100e3, -5e3)
DIALECTS = {
    "brackets": "time (ms),pressure (kPa)\n0,250\n0.1,100\n0.25,-5\n",
    "square brackets": "t [ms]; p [kPa]\n0;250\n0.1;100\n0.25;-5",
    "decimal comma": "Zeit [ms];Druck [bar]\n0;2,5\n0,1;1\n0,25;-0,05\n",
    "decimal comma and tabs": "t/ms\tp/kPa\n0\t250,0\n0,1\t1,0E2\n0,25\t-5\n",
    "decimal comma and blanks": "t/ms p/kPa\n0,0 250,0\n0,1 100,0\n0,25 -5,0\n",
    "quotes": '"time (ms)","p (kPa)"\r\n"0","250"\r\n"0.1","100"\r\n"0.25","-5"\r\n',
    "quotes and decimal comma": '"time (ms)","p (kPa)"\n"0,0","250"\n"0,1","100"\n"0,25","-5"\n',
    "units in a line of their own": "time,pressure\nms,kPa\n0,250\n0.1,100\n0.25,-5",
    "units in brackets in a line of their own": "time\tpressure\n[ms]\t[kPa]\n0\t250\n0.1\t100\n0.25\t-5",
    "blanks": "time (ms)   p (kPa)\n 0   250\n 0.1 100\n 0.25 -5\n",
    "a comment as numpy writes it": "# time (ms), pressure (kPa)\n0 250\n0.1 100\n0.25 -5",
    "comments of MATLAB": "% gauge 3\n% t/ms p/kPa\n0 250\n% a note\n0.1 100\n\n0.25 -5\n",
    "an oscilloscope's preamble": "Model,XY-100\nRecord Length,3\n\nTime (ms),Ampl (kPa)\n0,250\n0.1,100\n0.25,-5\n",
    "in words": "time in ms;pressure in kPa\n0;250\n0.1;100\n0.25;-5\n",
    "underscores": "time_ms,pressure_kPa\n0,250\n0.1,100\n0.25,-5",
    "plain units": "ms kPa\n0 250\n0.1 100\n0.25 -5",
    "pressure first": "p (kPa),t (ms)\n250,0\n100,0.1\n-5,0.25",
    "Fortran": "t (ms) p (kPa)\n 0.0D0 2.5D+2\n 1.0D-1 1.0D2\n 2.5D-1 -5.0D0\n",
    "micro": "t (µs),p (MPa)\n0,.25\n100,.1\n250,-.005",
    "a typographic minus": "t (μs),p (kPa)\n0,250\n100,100\n250,−5",
    "a separator at the end": "t (ms),p (kPa),\n0,250,\n0.1,100,\n0.25,-5,\n",
}
REFUSED = {
    "two decimal signs": ("t (ms);p (kPa)\n0;1,5\n0.1;2\n", "read in two ways"),
    "thousands": ("t (ms);p (kPa)\n0;1.234,5\n0,1;2\n", "read in two ways"),
    "volts": ("t (s),out (V)\n0,1\n1,2\n", "for volts"),
    "a gauge's number for a unit": ("t (s),p (gauge 3)\n0,1\n1,2\n", "'gauge 3' is no unit of pressure"),
    "a spoilt first line": ("t (ms),p (kPa)\n0,1O\n1,2\n2,3\n", "line 2: pressure '1O'"),
    "a first line cut short": ("t (ms),p (kPa)\n0\n1,2\n2,3\n", "line 3: '1,2' may be read in two ways"),
    "words below the headings": ("t (ms),p (kPa)\nx,y\n1,2\n2,3\n", "line 2: 'x'"),
    "headings too many": ("t (ms),p (kPa),note\n0,1\n1,2\n", "3 headings for 2 columns"),
    "headings apart": ("t (ms),p (kPa)\nrecorded in May\n0,1\n1,2\n", "headings stand apart"),
    "several pressures": ("t (s),p1 (kPa),p2 (kPa)\n0,1,2\n1,3,4\n", "give pressure_column"),
    "two times": ("t (s),time (ms),p\n0,0,2\n1,1,4\n", "columns hold times"),
    "no times": ("p (kPa)\n1\n2\n", "give interval"),
    "a missing value": ("t (s),p (Pa)\n0,1\n1,\n2,3\n", "line 3: the p (Pa) is missing"),
    "no number": ("t,p\n0,nan\n1,2\n", "line 2"),
    "underscores in numbers": ("t,p\n0,1\n1_0,2\n", "line 3"),
    "a semicolon within a number": ("t (ms) p (kPa)\n0,0 1,5\n0,1;2 2,5\n0,3 1,0\n", "line 3: t (ms) '0,1;2'"),
    "a control character within a number": ("t (ms),p (kPa)\n0,1\n0.1,\x1e89\n0.3,1\n", "line 3: '\\x1e' is no part of a text"),
    "a spoilt prefix": ("t (ms) p (\x91Pa)\n0.0 1.5\n0.1 2.5\n", "is no unit of pressure"),
    "times that fall": ("t (ms),p\n0,1\n# c\n2,2\n1,3\n", "line 5: time 0.001 s does not follow 0.002 s"),
}


@pytest.mark.parametrize("name", DIALECTS)
def test_one_record_in_many_dialects(name):
    found = Sampled.from_bytes(DIALECTS[name].encode(), "gauge.csv")
    assert found.time == pytest.approx(TIME, rel=1e-14)
    assert found.pressure == pytest.approx(PRESSURE, rel=1e-14)
    assert found.reference.startswith("gauge.csv: time")
    assert "taken" not in found.reference


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "cp1252", "utf-32"])
def test_encodings(encoding):
    found = Sampled.from_bytes(DIALECTS["micro"].encode(encoding))
    assert (found.time, found.pressure) == (TIME, PRESSURE)


@pytest.mark.parametrize("name", REFUSED)
def test_what_can_be_read_in_two_ways_is_refused(name):
    text, told = REFUSED[name]
    with pytest.raises(InputError) as caught:
        Sampled.from_bytes(text.encode(), "gauge.csv")
    assert told in str(caught.value)


def test_units_that_were_taken_are_told_and_absurd_ones_remarked():
    taken = Sampled.from_bytes(b"time,pressure\n0,250\n3600,100\n7200,0")
    assert "time 'time' without a unit, taken as s, pressure 'pressure' without a unit, taken as Pa" in taken.reference
    assert "lasts 7200 s" in " ".join(taken.remarks)
    assert "0.25 Pa" in " ".join(Sampled.from_bytes(b"t (ms),p (mPa)\n0,250\n1,0").remarks)
    assert Sampled.from_bytes(b"t (ms),p (kPa)\n0,250\n1,0").remarks == ()
    told = Sampled.from_bytes(b"t,p\n0,250\n1,0", time_unit="ms", pressure_unit="kPa")
    assert (told.time, told.pressure) == ((0.0, 1e-3), (250e3, 0.0))
    assert "40 % of its peak" in " ".join(Sampled.from_bytes(b"t (ms),p (kPa)\n0,250\n1,100").remarks)


def test_columns_by_name_and_number():
    text = b"t (s),p1 (kPa),p2 (kPa)\n0,1,2\n1,3,4\n"
    assert [Sampled.from_bytes(text, pressure_column=c).pressure[0] for c in (2, "2", "p2", "p2 (kPa)", 3)] == [
        1e3,
        1e3,
        2e3,
        2e3,
        2e3,
    ]
    assert Sampled.from_bytes(text, interval="1 ms", pressure_column=2).time == (0.0, 1e-3)
    for column, told in (
        (1, "is the column of times"),
        (4, "no column 4"),
        ("p3", "allowed: t"),
        (True, "is no column"),
        (0, "no column 0"),
    ):
        with pytest.raises(InputError, match=told):
            Sampled.from_bytes(text, pressure_column=column)


def test_matlab_and_sound(tmp_path):
    path = tmp_path / "r.mat"
    savemat(
        path, {"t_ms": np.array([0, 0.1, 0.25]), "p_kPa": np.array([[250.0], [100], [-5]]), "note": "x", "c": [{}]}, do_compression=True
    )
    found = cx.Sampled.from_file(path)
    assert found.time == pytest.approx(TIME)
    assert found.pressure == PRESSURE
    savemat(path, {"fs": 1e6, "pressure": np.arange(5.0)})
    assert cx.Sampled.from_file(path).time == pytest.approx(np.arange(5) * 1e-6)
    sound = io.BytesIO()
    wavfile.write(sound, 1000, np.array([[0, 1], [16384, 2], [-32768, 3]], np.int16))
    with pytest.raises(InputError, match="scale: is missing"):
        Sampled.from_bytes(sound.getvalue(), pressure_column=1)
    found = Sampled.from_bytes(sound.getvalue(), scale=2e5, pressure_column="channel 1")
    np.testing.assert_array_equal(found.curve[1], [0, 1e5, -2e5])
    np.testing.assert_allclose(found.curve[0], [0, 1e-3, 2e-3])
    for content in (b"MATLAB 5.0" + b"x" * 300, path.read_bytes()[:150], sound.getvalue()[:30], b"PK\x03\x04", b"\x89HDF", b"\x00" * 50):
        with pytest.raises(InputError):
            Sampled.from_bytes(content, scale=1.0)


def test_objects_of_other_libraries():
    frames = [
        pd.DataFrame({"time (ms)": [0, 0.1, 0.25], "p (kPa)": [250, 100, -5]}),
        pd.Series(PRESSURE, index=pd.Index(TIME, name="t (s)"), name="p (Pa)"),
        pd.Series([250, 100, -5], index=pd.to_timedelta([0, 100, 250], unit="us"), name="p (kPa)"),
        xr.DataArray([250.0, 100, -5], coords={"time": ("time", [0, 0.1, 0.25], {"units": "ms"})}, dims="time", attrs={"units": "kPa"}),
        xr.Dataset({"p": ("t", [250.0, 100, -5], {"units": "kPa"})}, coords={"t": ("t", [0, 100, 250], {"units": "us"})}),
        np.stack([TIME, PRESSURE], axis=1),
    ]
    for data in frames:
        found = cx.Sampled.from_data(data)
        assert found.time == pytest.approx(TIME)
        assert found.pressure == PRESSURE
    for bad in ([1, 2], "x", pd.Series([1.0, 2]), pd.DataFrame({"t": [0, 1], "p": ["a", "b"]}), xr.DataArray(np.ones((2, 2))), None):
        with pytest.raises(InputError):
            Sampled.from_data(bad)


def test_what_is_made_of_a_record():
    time, pressure = np.linspace(-1e-3, 9e-3, 1001), np.full(1001, 4e3)
    pressure[time >= 0] += 1e5 * np.exp(-time[time >= 0] / 2e-3)
    record = cx.Sampled(time=time, pressure=pressure)
    assert "4.000 kPa" in " ".join(record.remarks)
    clean = record.replace(baseline="pre-trigger", scale=2.0, end="6 ms", taper="1 ms")
    times, values = clean.curve
    assert times[0] == 0
    assert values[0] == pytest.approx(2e5, rel=1e-9)
    assert (times[-1], values[-1]) == (pytest.approx(6e-3), 0)
    np.testing.assert_allclose(values[times <= 5e-3], 2e5 * np.exp(-times[times <= 5e-3] / 2e-3), rtol=1e-9)
    kept = record.replace(start=time[0], baseline="0.5 ms").curve
    np.testing.assert_allclose(kept[0], time - time[0], atol=1e-18)
    moved = record.replace(shift="2 ms").curve[0]
    assert (moved[0], moved[-1]) == (pytest.approx(1e-3), pytest.approx(11e-3))
    coarse = clean.replace(resample="50 us").curve
    assert np.trapezoid(coarse[1], coarse[0]) == pytest.approx(np.trapezoid(values, times), rel=1e-4)
    fine = cx.Sampled(time=[0, 1, 2], pressure=[1, 3, 2], resample=0.25).curve
    np.testing.assert_allclose(fine[1], np.interp(fine[0], [0, 1, 2], [1, 3, 2]))
    for options, told in (
        ({"start": 1}, "start: nothing"),
        ({"end": -1e-3}, "end: nothing"),
        ({"taper": 1}, "taper"),
        ({"resample": 1}, "resample"),
        ({"resample": 1e-12}, "at most"),
        ({"baseline": -1}, "baseline"),
        ({"shift": -1}, "shift: nothing"),
        ({"scale": 0}, "scale"),
        ({"scale": 1e308}, "scale"),
    ):
        with pytest.raises(InputError, match=told):
            record.replace(**options)
    with pytest.raises(InputError, match="no samples before"):
        cx.Sampled(time=[0, 1], pressure=[1, 1], baseline="pre-trigger")


def _system(record):
    return presets.load("iakovlev-filled").replace(source=[cx.PlaneWave(pulse=record), cx.SphericalWave(pulse=record, distance=9)])


@pytest.mark.parametrize("count", [3, 1200])
def test_records_go_through_files_without_loss(tmp_path, count):
    generator = np.random.default_rng(1)
    time = np.cumsum(generator.uniform(1e-7, 1e-6, count)) - 1e-6
    record = cx.Sampled(time=time, pressure=generator.normal(size=count) * 1e5, scale=1.25, taper=1e-9, reference='gauge "3", µ')
    system = _system(record)
    again = cx.System.from_toml_string(system.to_toml_string())
    assert again == system
    assert [source.pulse.reference for source in again.sources] == ['gauge "3", µ'] * 2
    path = system.to_toml(tmp_path / "case.toml")
    assert cx.System.from_toml(path) == system
    beside = [file for file in tmp_path.iterdir() if file.suffix == ".csv"]
    assert len(beside) == (count > 1000)
    assert len(path.read_text()) < 20_000
    for file in beside:
        file.write_bytes(file.read_bytes().replace(b"\n0.", b"\n0.0", 1) + b"1.0,2\n")
        with pytest.raises(InputError, match="sha256: the file is not the one"):
            cx.System.from_toml(path)
    assert system.canonical() == _system(record.replace(reference="")).canonical()
    assert system.canonical() != _system(record.replace(scale=1.5)).canonical()


def test_a_damaged_text_of_samples_is_refused():
    text = _system(cx.Sampled(time=np.arange(1001.0), pressure=np.ones(1001))).to_toml_string()
    for bad in (
        text.replace("AAAA", "AAAB", 1),
        text.replace("AAAA", "", 1),
        text.replace("AAAA", "A!AA", 1),
        text.replace("sha256", "sha257", 1),
    ):
        with pytest.raises(InputError, match="source"):
            cx.System.from_toml_string(bad)


@pytest.mark.parametrize(
    ("entries", "told"),
    [
        ({"file": "rec.csv", "scale": "kPa", "pressure": [1, 2]}, "pressure: has no effect beside file"),
        ({"file": "rec.csv", "colour": 1}, "colour: is not an entry"),
        ({"file": "rec.csv", "samples": "AA"}, "samples: has no effect"),
        ({"file": "rec.csv", "scale": "kPa"}, "scale"),
        ({"file": "rec.csv", "time_unit": "kPa"}, "time_unit: 'kPa' is no unit of time"),
        ({"file": 3}, "file: 3 is no file"),
        ({"file": "rec.csv", "interval": 1, "time_column": 1}, "interval: has no effect"),
        ({"file": "rec.csv", "sha256": "0"}, "SHA-256"),
        ({"time": [0, 1], "pressure": [1, 2], "time_unit": "ms"}, "time_unit: is not an entry"),
        ({"samples": "AA", "time_unit": "ms"}, "time_unit: is not an entry"),
        ({"samples": 3}, "samples: 3"),
    ],
)
def test_no_entry_of_a_record_is_swallowed(tmp_path, monkeypatch, entries, told):
    (tmp_path / "rec.csv").write_text("time (ms),p (kPa)\n0,1\n1,0\n")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError) as caught:
        cx.PlaneWave.model_validate({"pulse": {"type": "sampled", **entries}})
    assert told in str(caught.value)


def test_only_regular_files_are_read(tmp_path):
    os.mkfifo(tmp_path / "pipe.csv")
    with (tmp_path / "large.csv").open("wb") as file:
        file.truncate(300_000_000)
    for path, told in (
        (tmp_path / "pipe.csv", "a pipe"),
        ("/dev/zero", "a device"),
        (tmp_path, "a folder"),
        (tmp_path / "large.csv", "at most"),
    ):
        with pytest.raises(InputError, match=told):
            cx.Sampled.from_file(path)


def test_many_samples_are_read_and_described_fast():
    time = np.linspace(-1e-3, 29e-3, 100_000)
    rows = map("%r,%r".__mod__, zip(time.tolist(), (1e5 * np.exp(-np.abs(time) / 1e-3)).tolist(), strict=True))
    content = ("time (s),pressure (Pa)\n" + "\n".join(rows)).encode()
    cells = content.split(b"\n", 1)[1].replace(b"\n", b",").split(b",")
    start = process_time()
    _ = list(map(float, cells))
    floor = process_time() - start  # what the machine needs for the numbers alone
    start = process_time()
    record = Sampled.from_bytes(content)
    again = pickle.loads(pickle.dumps(record))
    system = _system(record).with_overrides({"source[0].pulse.scale": 2.0})
    assert again == record
    assert hash(again) == hash(record)
    assert "100,000 numbers" in repr(record)
    assert system.canonical()
    assert process_time() - start < 8 * floor + 0.2
