"""Records in files of MATLAB (version 5 to 7) and in sound files, judged by their headers before anything is unpacked."""

from __future__ import annotations

import io
import warnings
from collections.abc import Mapping
from typing import Any, cast

import numpy as np

from coaxshell.errors import InputError
from coaxshell.limits import RECORD_COLUMNS, RECORD_SAMPLES
from coaxshell.model.records.columns import Column, Table, column

RATES = ("fs", "samplerate", "samplingrate", "rate")
INTERVALS = ("dt", "ts", "interval", "samplinginterval")


def mat_table(content: bytes, name: str) -> Table:
    """Return the series of equal length in a MATLAB file as columns; a scalar ``fs`` (Hz) or ``dt`` (s) tells the interval.

    Raises
    ------
    InputError
        Naming the file: it is damaged, too large, or holds no series.
    """
    from scipy.io import loadmat, whosmat

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            listed = whosmat(cast(Any, io.BytesIO(content)))
            wanted = [
                key for key, shape, kind in listed if kind not in ("cell", "struct", "object", "char", "function", "opaque", "sparse")
            ]
            for key, shape, _ in listed:
                if key in wanted:
                    RECORD_SAMPLES.check(max(shape, default=0), f"{name}, {key}")
                    RECORD_COLUMNS.check(min(shape, default=0), f"{name}, {key}")
            found = loadmat(cast(Any, io.BytesIO(content)), variable_names=wanted)
        except InputError:
            raise
        except Exception as error:  # noqa: BLE001 - the reader raises many kinds for a damaged file
            raise InputError(name, f"cannot be read as a MATLAB file ({str(error)[:80]})", "save it with -v7, or as CSV") from None
    return _of_arrays({key: found[key] for key in wanted if key in found}, name)


def _of_arrays(arrays: Mapping[str, Any], name: str) -> Table:
    columns: list[Column] = []
    interval: float | None = None
    for key, array in arrays.items():
        if array.dtype.kind not in "iufb" or array.ndim > 2 or array.size == 0:
            continue
        if array.size == 1:
            interval = _interval(key, float(array.flat[0])) or interval
            continue
        series = array.reshape(array.shape[0], -1) if array.ndim == 2 and array.shape[0] >= array.shape[1] else np.atleast_2d(array).T
        label = key if series.shape[1] == 1 else f"{key}:{{}}"
        columns += [column(label.format(k + 1), np.ascontiguousarray(one, dtype=float)) for k, one in enumerate(series.T)]
    if not columns:
        raise InputError(name, "holds no series of numbers", "give variables of time and pressure, one number for each sample")
    longest = max(len(one.values) for one in columns)
    return Table(tuple(one for one in columns if len(one.values) == longest), interval=interval)


def _interval(key: str, value: float) -> float | None:
    plain = "".join(letter for letter in key.lower() if letter.isalnum())
    if plain in RATES and value > 0:
        return 1 / value
    return value if plain in INTERVALS and value > 0 else None


def wav_table(content: bytes, name: str) -> Table:
    """Return the channels of a sound file as columns of numbers between -1 and 1, shares of its full scale."""
    from scipy.io import wavfile

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            rate, data = wavfile.read(io.BytesIO(content))
        except Exception as error:  # noqa: BLE001 - the reader raises many kinds for a damaged file
            raise InputError(
                name, f"cannot be read as a sound file ({str(error)[:80]})", "give a .wav file with PCM or float samples"
            ) from None
    samples = np.atleast_2d(data.T).T
    RECORD_SAMPLES.check(len(samples), name)
    RECORD_COLUMNS.check(samples.shape[1], name)
    if rate <= 0 or len(samples) < 2:
        raise InputError(name, "holds no samples, or no sampling rate", "give a .wav file with PCM or float samples")
    if samples.dtype.kind == "u":
        samples = (samples.astype(float) - 128) / 128
    elif samples.dtype.kind == "i":
        samples = samples / -float(np.iinfo(samples.dtype).min)
    channels = tuple(column(f"channel {k + 1}", np.ascontiguousarray(one, dtype=float)) for k, one in enumerate(samples.T))
    return Table(channels, interval=1 / rate, full_scale=True)
