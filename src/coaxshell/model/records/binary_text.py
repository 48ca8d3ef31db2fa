"""Samples as a text that holds every bit: base64 of little-endian doubles, with a checksum."""

from __future__ import annotations

import base64
import binascii
import hashlib

import numpy as np

from coaxshell.errors import InputError
from coaxshell.limits import RECORD_SAMPLES
from coaxshell.numerics.arrays import FloatArray


def _content(time: FloatArray, pressure: FloatArray) -> bytes:
    # Adding 0 makes -0.0 the 0.0 that it equals.
    return (np.concatenate([time, pressure]) + 0.0).astype("<f8").tobytes()


def digest(time: FloatArray, pressure: FloatArray) -> str:
    """Return the SHA-256 of samples, in hexadecimal."""
    return hashlib.sha256(_content(time, pressure)).hexdigest()


def packed(time: FloatArray, pressure: FloatArray) -> str:
    """Return samples as base64: all times, then all pressures."""
    return base64.b64encode(_content(time, pressure)).decode()


def unpacked(text: str) -> tuple[FloatArray, FloatArray]:
    """Return the samples of a text made by :func:`packed`; InputError if it is none."""
    RECORD_SAMPLES.check(len(text) * 3 // 64, "")
    try:
        content = base64.b64decode(text, validate=True)
    except (binascii.Error, ValueError):
        content = b"?"
    if len(content) % 16 or not content:
        raise InputError("", "is no packed record", "it is cut short or damaged: write it again")
    values = np.frombuffer(content, "<f8").astype(float)
    return values[: values.size // 2], values[values.size // 2 :]
