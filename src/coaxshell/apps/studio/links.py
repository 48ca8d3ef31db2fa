"""A system in the fragment of a link: base64url of raw deflate of JSON."""

from __future__ import annotations

import base64
import binascii
import json
import zlib
from typing import Any

from coaxshell.apps.studio import limits
from coaxshell.apps.studio.bodies import bad, parse_table

PREFIX = "s="
ENTRIES = ("v", "system", "resolution", "view")
VERSION = 1


def fragment(content: dict[str, Any]) -> str:
    """Return the fragment of a link that holds *content*."""
    text = json.dumps(content, separators=(",", ":"), allow_nan=False).encode()
    packer = zlib.compressobj(9, wbits=-15)
    return PREFIX + base64.urlsafe_b64encode(packer.compress(text) + packer.flush()).rstrip(b"=").decode()


def opened(text: object) -> dict[str, Any]:
    """Return what a fragment holds; RefusedError if it is not one of ours, or unpacks to more than a body may be."""
    if not isinstance(text, str) or not text.removeprefix("#").startswith(PREFIX):
        raise bad("fragment", text, "give what follows # in a link of this page")
    raw = text.removeprefix("#").removeprefix(PREFIX)
    try:
        data = base64.b64decode(raw + "=" * (-len(raw) % 4), altchars=b"-_", validate=True)
        unpacker = zlib.decompressobj(wbits=-15)
        content = unpacker.decompress(data, limits.BODY_BYTES)
        whole = unpacker.eof and not unpacker.unconsumed_tail
    except (binascii.Error, ValueError, zlib.error):
        whole = False
    if not whole:
        raise bad("fragment", raw, "the link is cut short, damaged or too large: copy it again")
    table = parse_table(content)
    if table.get("v") != VERSION or any(entry not in ENTRIES for entry in table):
        raise bad("fragment", table.get("v"), f"must be a link of version {VERSION}")
    return table
