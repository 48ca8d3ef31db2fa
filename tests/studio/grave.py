"""Bodies made to cost the server dear, or to come back to it in what it answers."""

from __future__ import annotations

import base64
import copy
import zlib

from asking import SMALL

ASKED = {"client": "tab", "slot": "fuzz", "revision": 1, "resolution": {**SMALL, "modes": 4}}
METRICS = {"metrics": ["inner.peak_stress"], "objectives": ["inner.peak_stress"], "evaluations": 3, "population": 4}

INSIDE = [
    b'{"v":1,"view":1e999}',
    b'{"v":1,"system":{"name":"\\ud800"}}',
    b'{"v":1,"view":NaN}',
    b'{"v":1,"system":null}',
    b'{"v":1,"toml":"a = 1"}',
    b'{"v":1,"resolution":{"modes":1e400}}',
    b"[" * 50_000,
    b" " * 900_000,
    b'{"v":1,"view":"' + b"a" * 900_000 + b'"}',
]
TOML = [
    "a." * 30_000 + "b = 1",
    "[" + "a." * 16_000 + "b]",
    "a = " + "[" * 9_000 + "]" * 9_000,
    "a = " + "{a = " * 999,
    "x = 1\n" * 90_000,
    'a = """' + "x" * 900_000,
    "a = " + "1" * 900_000,
    'a = "1' + " " * 900_000 + 'y"',
    "[[a]]\n" * 90_000,
    "a = 1e999",
    "\ufeffa = 1",
]
NUMBERS = ["1e9999999999 kg", "-1e9999999999 kg", "1e-9999999999 kg", "1" * 150 + " kg", "1" + " " * 150_000 + "kg", "nan kg", "1e999"]
UPLOADED = [
    *(b"", b"\x89HDF\r\n\x1a\n", b"\x89HDF\r\n\x1a\n" + b"\xff" * 5_000, b"CDF\x01" + b"\xff" * 200),
    *(b"a = 1", b"\xff\xfe", b"\x00" * 9),
]


def packed(text):
    """Return the fragment of a link that holds any bytes."""
    packer = zlib.compressobj(wbits=-15)
    return "s=" + base64.urlsafe_b64encode(packer.compress(text) + packer.flush()).rstrip(b"=").decode()


def requests(random_, systems, values):
    """Yield (path, body)."""
    system, linked = systems[0], next(system for system in systems if system["absorbers"])
    for text in INSIDE:
        yield "/api/link/open", {"fragment": packed(text)}
        yield "/api/link/open", {"fragment": "#" + packed(text)[:-3]}
    for count in (201, 1e5, 1e9, "1e9", "100000", 10**18, 10**30, -1, 2.5, True, [7], "7"):
        ring = {"count": count, "mass": "10 kg", "linear_stiffness": 1e6}
        for path in ("/api/validate", "/api/solve", "/api/jobs", "/api/study"):
            yield path, {**ASKED, "kind": "solve", "system": {**system, "absorbers": ring}}
    for text in TOML:
        yield "/api/validate", {"toml": text}
        yield "/api/jobs", {**ASKED, "kind": "solve", "toml": text}
        yield "/api/project/open", {"toml": "version = 1\n" + text}
    for text in NUMBERS:
        for given in ([1, text], {"from": 1, "to": text, "count": 3}, text):
            varied = {"absorbers.mass": given}
            study = {**METRICS, "over": varied, "variables": varied, "constraints": [f"absorbers.mass <= {text}"]}
            for kind in ("sweep", "optimise"):
                yield "/api/study", {**ASKED, "kind": kind, "system": linked, **study}
                yield "/api/study", {**ASKED, "kind": kind, "system": linked, **study, "variables": {"absorbers.mass": [1, 2]}}
    yield from _long(system, linked)
    for _ in range(200):
        entry = random_.choice(["client", "slot", "title", "kind", "revision", "run", "runs", "fragment", "v", "view", "name"])
        body = {**ASKED, "kind": random_.choice(["solve", "film", "sweep"]), "system": system, entry: copy.deepcopy(random_.choice(values))}
        yield random_.choice(["/api/jobs", "/api/solve", "/api/studies", "/api/link"]), body


def _long(system, linked):
    many = [float(number) for number in range(30_000)]
    for time, pressure in ((many, many), (many[:9] * 3_000, [1e308] * 27_000), (many[:20_000], many[:20_000])):
        source = {"type": "plane-wave", "pulse": {"type": "sampled", "time": time, "pressure": pressure}}
        yield "/api/validate", {"system": {**system, "source": source}}
        yield "/api/solve", {**ASKED, "system": {**system, "source": source}}
    for design in ({}, {"name": "A", "system": {}}, {"name": "A", "system": {**system, "shells": [{}] * 300}}):
        yield "/api/project", {"designs": [design] * 4_000}
        yield "/api/project", {"designs": [design] * 5}
    for width in (1_000, 60_000):
        shell = {**system["shells"][0], "layers": [{}] * width}
        yield "/api/validate", {"system": {f"x{number}": 1 for number in range(width)}}
        yield "/api/validate", {"system": {**system, "shells": [{}] * width}}
        yield "/api/validate", {"system": {**system, "shells": [shell]}}
        yield "/api/jobs", {**ASKED, "kind": "film", "runs": ["x"] * width}
        for kind in ("sweep", "optimise"):
            varied = {"absorbers.mass": [1] * width}
            yield "/api/jobs", {**ASKED, "kind": kind, "system": linked, **METRICS, "over": varied, "variables": varied}


def uploads():
    """Yield (type, content) of files that are not what they say, or hold what no run holds."""
    for raw in UPLOADED:
        for kind in ("application/x-netcdf", "application/toml", "text/plain"):
            yield kind, raw
