"""Bodies that a careless or hostile program might send: two thousand and more, the same ones every time."""

from __future__ import annotations

import copy
import json
import random

import grave
from asking import SMALL, described

from coaxshell.model import System, presets

VALUES = [
    None,
    True,
    False,
    0,
    -1,
    1,
    -0.0,
    1e-320,
    1e308,
    -1e308,
    10**30,
    10**400,
    2**53,
    0.5,
    1e20,
    "",
    " ",
    "NaN",
    "inf",
    "1e999 m",
    "6 mm",
    "-3 kg",
    "9**9**9**9",
    "1 9**9**9**9",
    "../../etc/passwd",
    "/etc/passwd",
    "file:///etc/passwd",
    "\x00",
    "\ud800",
    "é" * 40,
    "x" * 5000,
    "{}",
    "__class__",
    "${7*7}",
    "'; drop table",
    "<script>alert(1)</script>",
    [],
    {},
    [[]],
    [None],
    [1, 2, 3],
    {"": 1},
    {"type": "spherical-shock"},
    {"count": 1},
    {"count": 10**12},
    {"count": 1e9, "mass": 1},
    {"count": "1000000", "mass": "1 kg"},
    [{"mass": 1}] * 300,
    float("inf"),
    "1e9999999999 kg",
    "1e-9999999999 m",
    "1" + " " * 4000 + "y",
    "\udc80name",
    {"__proto__": 1},
    {"rigid": True},
    {"file": "/dev/zero"},
    {"type": "sampled", "file": "/dev/zero"},
    [{"type": "plane-wave"}],
    "vacuum",
    "all",
    "none",
]

RAW = [
    b"",
    b"{",
    b"null",
    b"[]",
    b"1",
    b'"x"',
    b"\xff\xfe\x00",
    b"{'a': 1}",
    b'{"system": NaN}',
    b'{"system": {"a": Infinity}}',
    b'{"a": 1e999999}',
    b'{"v": 1, "system": {"name": 1e999}}',
    b'{"v": 1, "view": [-1e999]}',
    b'{"v": 1, "view": "\\udfff"}',
    b'{"\\ud83d": 1}',
    b'{"client": "tab", "kind": "solve", "slot": "fuzz", "revision": 1, "title": "\\ud800", "system": {}}',
    b"[" * 100_000,
    b'{"a":' * 100_000,
    b'{"a":' * 30 + b"1" + b"}" * 30,
    b'{"a": ' + b"9" * 9000 + b"}",
    b'{"toml": "' + b"a." * 20_000 + b'b = 1"}',
    json.dumps({"toml": "a = " + "[" * 5000}).encode(),
    json.dumps({"toml": "[" + ".".join("a" * 5000) + "]"}).encode(),
    json.dumps({"toml": "x = 1\n" * 3}).encode(),
    json.dumps({"toml": "a = {" * 900}).encode(),
    json.dumps({"toml": "\x00"}).encode(),
    b"\x1f\x8b\x08\x00",
    json.dumps({"toml": "a" * 900_000}).encode(),
    json.dumps({"toml": 'fluids = ["' + "w" * 90_000 + '"]'}).encode(),
    b'{"toml": "\\ud800"}',
    b"\n" * 1000,
    json.dumps({"toml": "a = " + "9" * 10_000}).encode(),
    b'{"a": "\\u0000"}',
    b'{"system": {}, "system": {}}',
]

SPACE = {
    "duration": 1.0,
    "time_step": 0.02,
    "modes": 4,
    "dimensions": 3,
    "stations": [0.0, "40 cm"],
    "axial_modes": 4,
    "axial_period": "20 m",
}
POINT = {"mass": 5.0, "linear_stiffness": 1e8, "z": "20 cm", "footprint": 0.02}
"""A run in three dimensions and an absorber at a point, to be spoilt."""

CUT = {"transducers": "electrodes", "segments": 8, "dead": [3]}
LAWS = [
    {"proportional": 0.0, "derivative": 2.0, "shells": [0], "segment_gap": "2 mm", **CUT},
    {"numerator": [1e-4, 1], "denominator": [1], "delay": "5 us", "shells": ["outer"], **CUT},
]
"""A law for each shell, to be spoilt."""

CROSSED = {"numerator": [1.0], "matrix": [[1, 0.3], [0.6, 1]], "weights": [0, 1, 1], "transducers": "electrodes"}
BELTS = {**CROSSED, "segment_pitch": "80 cm", "segment_length": "80 cm"}

LIMITED = {
    "numerator": [1e-3],
    "denominator": [1],
    "transducers": "electrodes",
    "segments": 8,
    "current_limit": "20 A/m^2",
    "current_saturation": True,
    "bridge_imbalance": 0.01,
}
BROKEN = {name: value for name, value in BELTS.items() if name != "weights"}
BROKEN |= {"segments": 8, "dead_belts": [2, -1], "dead_electrodes": [[0, 3], [-1, 5]]}
AT_SEA = {"sea": {"depth": "30 m", "up": "90 deg", "bottom": "10 m", "hydrostatic": True, "surface": True}}
PIECES = [
    {"type": "gap", "clearance": "1 mm", "stiffness": 1e9, "restitution": 0.5},
    {"type": "friction", "force": 1e4, "stiffness": 1e9},
    {"type": "table", "stretch": [-1e-3, 0.0, 1e-3], "force": [-1e5, 0.0, 1e5]},
    {"type": "maxwell", "stiffness": 1e8, "relaxation_time": "1 ms"},
]
SPRUNG = {"mass": 5.0, "angle": 10.0, "law": {"type": "parallel", "laws": PIECES}, "inertance": 2.0}
"""Dead belts, planes of the sea and an absorber of many laws, to be spoilt."""
FITTED = {"mass": 5.0, "linear_stiffness": 1e8, "angle": 10.0, "inner_shell": 0, "outer_shell": 2, "footprint": "1 cm"}
BELTED = (
    *(("control", name) for name in (*BELTS, "segments", "segment_gap", "delay", "saturation", "dead_belts", "dead_electrodes")),
    *(("source", name) for name in ("z", "inclination", "pulse")),
    *(("shells", 0, name) for name in ("theory", "wetted", "layers")),
    *(("resolution", name) for name in ("dimensions", "stations", "axial_modes", "axial_period")),
)
CROWDED = (
    *(("control", name) for name in LIMITED),
    *(("absorbers", 0, name) for name in (*FITTED, "inertance", "law", "z")),
    *(("shells", 0, "layers", 0, name) for name in ("material", "role", "loss_factor")),
)
SUNK = (*(("sea", name) for name in AT_SEA["sea"]), *(("absorbers", 0, "law", "laws", place) for place in range(len(PIECES))))
"""Entries of belts in three dimensions, of limits of current and absorbers past a shell, of the sea and laws; not all are there."""


def past_a_shell():
    """Return a system of three shells with an absorber from the first to the last, under a law with limits of current."""
    system = described("electrodes")
    inner, outer = system["shells"]
    shells = [inner, outer, {**outer, "radius": 1.5 * outer["radius"]}]
    return {**system, "shells": shells, "fluids": [*system["fluids"], system["fluids"][-1]], "absorbers": [FITTED], "control": LIMITED}


def spoilt_entries(random_, values):
    """Yield bodies in which one of the entries is something else than it may be."""
    belted = {"system": {**described("electrodes"), "control": BELTS}, "resolution": SPACE, "preview": SPACE, "choices": True}
    sprung = {"system": {**described("bare"), **AT_SEA, "absorbers": [SPRUNG]}, "resolution": SMALL}
    for whole, entries in ((belted, BELTED), ({"system": past_a_shell(), "resolution": SMALL}, CROWDED), (sprung, SUNK)):
        yield whole
        for path in entries:
            for value in random_.sample(VALUES, values):
                body = copy.deepcopy(whole)
                owner = body if path[0] == "resolution" else body["system"]
                for key in path[:-1]:
                    owner = owner[key]
                owner[path[-1]] = copy.deepcopy(value)
                yield body


STUDY = {
    "over": {"absorbers.mass": {"from": 1, "to": 2, "count": 2}},
    "metrics": ["inner.peak_stress"],
    "variables": {"absorbers.mass": {"from": 1, "to": "20 kg", "scale": "log"}, "control.derivative": [-10, 0]},
    "objectives": [{"metric": "inner.peak_stress", "maximise": False}, "absorbers.mass"],
    "constraints": ["absorbers.mass <= 400 kg/m"],
    "evaluations": 3,
    "population": 4,
    "seed": 1,
}
"""A sweep and an optimisation, to be spoilt."""


def places(value, path=()):
    """Yield the paths of all entries."""
    yield path
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in items:
        yield from places(item, (*path, key))


def mutated(random_, base, changes):
    """Return a copy with some entries replaced, removed or added."""
    body = copy.deepcopy(base)
    for _ in range(changes):
        path = random_.choice(list(places(body))[1:] or [()])
        if not path:
            continue
        owner = body
        for key in path[:-1]:
            owner = owner[key]
        match random_.randrange(5):
            case 0:
                del owner[path[-1]]
            case 1 if isinstance(owner, dict):
                owner[random_.choice(["colour", "", "__init__", "file", "count", "type", "x" * 300])] = random_.choice(VALUES)
            case 2 if isinstance(owner, list):
                owner.extend([owner[path[-1]]] * random_.choice([1, 3, 300]))
            case _:
                owner[path[-1]] = copy.deepcopy(random_.choice(VALUES))
    return body


def from_schema(random_, schema, definitions, depth=0):
    """Return a value that is nearly one of the schema."""
    if random_.random() < 0.06 or depth > 7:
        return copy.deepcopy(random_.choice(VALUES))
    if "$ref" in schema:
        return from_schema(random_, definitions[schema["$ref"].rsplit("/", 1)[1]], definitions, depth + 1)
    if "anyOf" in schema:
        return from_schema(random_, random_.choice(schema["anyOf"]), definitions, depth + 1)
    if "const" in schema:
        return schema["const"]
    if "enum" in schema:
        return random_.choice(schema["enum"])
    match schema.get("type"):
        case "object":
            required = schema.get("required", ())
            chosen = [name for name in schema.get("properties", {}) if name in required or random_.random() < 0.6]
            return {name: from_schema(random_, schema["properties"][name], definitions, depth + 1) for name in chosen}
        case "array":
            return [from_schema(random_, schema.get("items", {}), definitions, depth + 1) for _ in range(random_.randrange(4))]
        case "number":
            return random_.choice([1e-3, 0.5, 1.0, 1000.0, 1e6, random_.uniform(-1e3, 1e3), *schema.get("examples", [])])
        case "integer":
            return random_.choice([0, 1, 2, 25, -1, 10**6])
        case "string":
            return random_.choice(["water-1400", "aluminium", "pzt-4", "TNT", ""])
        case _:
            return random_.choice(VALUES)


def requests(seed=1, count=1100):
    """Yield (method, path, body as bytes) of *count* requests, the raw ones and the grave ones."""
    random_ = random.Random(seed)
    schema = System.model_json_schema()
    systems = [described(name) for name in presets.names()]
    systems += [{**described("bare"), "absorbers": [POINT]}, {**described("bare"), "source": {**described("bare")["source"], "z": 0.3}}]
    systems += [{**described("electrodes"), "control": law} for law in (LAWS, LAWS, CROSSED, BELTS, BROKEN)]
    systems += [{**described("absorbers"), **AT_SEA}, {**described("bare"), "absorbers": [SPRUNG]}]
    for raw in RAW:
        for path in ("/api/validate", "/api/solve", "/api/jobs", "/api/studies", "/api/link", "/api/link/open", "/api/project"):
            yield "POST", path, raw
    for body in spoilt_entries(random_, 1 if count < 1000 else 20):
        yield "POST", "/api/validate", encoded(body)
    for path, body in grave.requests(random_, systems, VALUES):
        yield "POST", path, encoded(body)
    for number in range(count):
        base = random_.choice(systems)
        if number % 3 == 0:
            yield "POST", "/api/validate", encoded({"system": from_schema(random_, schema, schema["$defs"])})
        elif number % 3 == 1:
            body = {"system": base, **({"resolution": SPACE, "preview": SPACE} if number % 2 else {})}
            yield "POST", "/api/validate", encoded(mutated(random_, body, random_.randrange(1, 5)))
        else:
            kind = random_.choice(
                ["solve", "field", "film", "unrolled", "energy", "loops", "spectra", "stressed", "report", "sweep", "optimise", "optimise"]
            )
            path = random_.choice(
                ["/api/solve", "/api/jobs", "/api/jobs", "/api/study", "/api/studies", "/api/link", "/api/link/open", "/api/project"]
            )
            body = {
                "client": "tab",
                "slot": "fuzz",
                "revision": number,
                "system": base,
                "resolution": SPACE if number % 2 else {**SMALL, "modes": 4},
                "shell": 0,
                "plane": "along",
                "station": number % 3,
                "every": 5,
                "size": 32,
                "half_width": 3.0,
                "quantity": "stress",
                "frames": 3,
                "kind": kind,
                "title": "fuzz",
                "designs": [{"name": "A", "system": base, "resolution": SPACE if number % 2 else SMALL}] * (1 + number % 3),
                **STUDY,
            }
            yield (
                "POST",
                path,
                encoded(mutated(random_, {**body, "run": "x", "runs": ["x"], "v": 1, "fragment": "s=AAAA"}, random_.randrange(1, 6))),
            )


def encoded(body):
    """Return JSON as a careless program writes it: NaN and lone surrogates included."""
    return json.dumps(body).encode()
