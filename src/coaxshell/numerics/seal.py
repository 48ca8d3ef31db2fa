"""A seal behind the end of an HDF5 file: a digest of all its bytes, so that not one flipped bit goes unnoticed.

HDF5 states in its first block where a file ends, and reads nothing beyond; whoever writes the file anew leaves the seal out.
"""

from __future__ import annotations

import hashlib
import struct
from typing import IO

_HEAD, _TAIL = b"\ncoaxshell sha256 ", b"\n"
_LENGTH = len(_HEAD) + 64 + len(_TAIL)
"""No power of two: no flipped bit in the stated end of the file can hide a seal."""
_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_PLACES = {0: (13, 24, 40), 1: (13, 28, 44), 2: (9, 12, 28), 3: (9, 12, 28)}
"""By version of the first block: where the size of an address, the base address and the end of the file stand."""
_BLOCK = 1 << 20


def add_seal(file: IO[bytes]) -> None:
    """Put the seal behind a complete file."""
    file.seek(0, 2)
    digest = _digest(file, file.tell())
    file.seek(0, 2)
    file.write(_HEAD + digest + _TAIL)


def is_sealed(file: IO[bytes]) -> bool:
    """Return whether a file has a seal; one written anew by another program has none.

    Raises
    ------
    ValueError
        It is no HDF5 file, cut short, or not what was sealed.
    """
    end = _stated_end(file)
    file.seek(0, 2)
    beyond = file.tell() - end
    if beyond == 0:
        return False
    file.seek(end if beyond == _LENGTH else 0)
    if file.read(_LENGTH) != _HEAD + _digest(file, end) + _TAIL:
        raise ValueError("its checksum is another")
    return True


def _digest(file: IO[bytes], size: int) -> bytes:
    digest = hashlib.sha256()
    file.seek(0)
    while size > 0 and (block := file.read(min(size, _BLOCK))):
        digest.update(block)
        size -= len(block)
    return digest.hexdigest().encode()


def _stated_end(file: IO[bytes]) -> int:
    """Return where the file ends by its own account."""
    file.seek(0)
    first = file.read(64)
    if len(first) < 64 or not first.startswith(_SIGNATURE):
        raise ValueError("it is not a NetCDF file")
    size, base, end = _PLACES.get(first[8], (8, 12, 28))
    if first[8] not in _PLACES or first[size] != 8 or first[base : base + 8] != bytes(8):
        raise ValueError("its first block is another than ours")
    return int(struct.unpack_from("<Q", first, end)[0])
