"""TOML texts made to be slow or large are refused by their line before the parser meets them; what people write is read as ever."""

from __future__ import annotations

import os
import tomllib
from time import process_time

import pytest

from coaxshell.errors import InputError
from coaxshell.limits import TOML_BYTES, TOML_DOTS, TOML_ENTRIES, TOML_LISTS, TOML_NESTING, TOML_VALUES
from coaxshell.model import System, presets, toml
from coaxshell.model.toml_text import parsed

N = 200_000
HOSTILE = {
    "dotted key": "a." * N + "b = 1",
    "dotted key in a line below": "x = 1\n" + "a." * N + "b = 1",
    "quoted parts": '"a".' * N + "b = 1",
    "spaced parts": "a . " * N + "b = 1",
    "dotted key in a table": "x = {" + "a." * N + "b = 1}",
    "dotted key after a text with a hash": 'x = "#"\n' + "a." * N + "b = 1",
    "name of a table": "[" + "a." * N + "b]",
    "nested lists": "x = " + "[" * N,
    "nested tables": "a = {" * N,
    "keys": "".join(f"a{i} = 1\n" for i in range(TOML_ENTRIES.value + 1)),
    "parts of keys": "".join(f"a{i}.b.c.d.e.f.g.h.i.j.k.l.m = 1\n" for i in range(TOML_ENTRIES.value // 12)),
    "tables": "[[a]]\n" * TOML_LISTS.value,
    "empty tables": "x = [" + "{}," * TOML_LISTS.value + "]",
    "values": "x = [" + "1," * (TOML_VALUES.value + 1) + "]",
    "bytes": "#" * (TOML_BYTES.value + 1),
    "an open string": 'x = "' + "a" * N,
    "an open long string": 'x = """' + 'a"' * N,
    "backslashes": 'x = "' + "\\\\" * N,
    "digits": "y = 1\nx = " + "9" * N,
    "spaces": " " * N + "x",
    "half a character": 'x = "\ud800"',
}
FINE = [
    "",
    'a = "[[[[ a.b.c.d.e.f.g.h.i.j.k.l.m.n.o = {{{"  # a.b.c.d.e.f.g.h.i.j.k.l.m.n.o.p [[',
    'a = \'\'\'[["""\n.......................\'\'\'\nb = """\\"""\\"\'\'\' ...................."""',
    "x = [" + "1.5, -2.25e-3, " * 3000 + "]",
    "a.b.c = 1\na.b.d = 2\n[t.'quoted.part'.u]\nv = 1979-05-27T07:32:00.999999Z",
    "a = 1\r\nb = 2\r\n",
]


@pytest.mark.parametrize("name", HOSTILE)
def test_what_no_person_writes_is_refused_at_once(name):
    start = process_time()
    with pytest.raises(InputError) as caught:
        parsed(HOSTILE[name], "case.toml")
    assert process_time() - start < 2.0
    assert str(caught.value).startswith("case.toml")
    assert len(str(caught.value)) < 400


def test_the_line_is_told():
    deep = "x = 1\n# [[[\ny = '''\n'''\nz = " + "[" * (TOML_NESTING.value + 1)
    for text in (deep, "x = 1\n\n\n\n" + "a." * (TOML_DOTS.value + 1) + "b = 1", "\n\n\n\nx = " + "9" * 5000, '\n\n\n\nx = "\ud800"'):
        with pytest.raises(InputError, match="line 5"):
            parsed(text)


@pytest.mark.parametrize("text", FINE)
def test_what_people_write_is_what_the_parser_reads(text):
    assert parsed(text) == tomllib.loads(text)


@pytest.mark.parametrize("limit", [TOML_DOTS, TOML_NESTING], ids=lambda limit: limit.unit)
def test_the_bound_itself_is_read(limit):
    text = "a." * limit.value + "b = 1" if limit is TOML_DOTS else "x = " + "[" * limit.value + "]" * limit.value
    assert parsed(text) == tomllib.loads(text)


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-8"])
@pytest.mark.parametrize("ends", ["\n", "\r\n", "\r"])
def test_files_of_any_editor_are_read(tmp_path, encoding, ends):
    path = tmp_path / "case.txt"
    path.write_bytes(presets.text("bare").replace("\n", ends).encode(encoding))
    assert System.from_toml(path) == presets.load("bare")


def test_only_regular_files_are_opened(tmp_path):
    os.mkfifo(tmp_path / "pipe.toml")
    large = tmp_path / "large.toml"
    with large.open("wb") as file:
        file.truncate(10 * TOML_BYTES.value)
    (tmp_path / "latin.toml").write_bytes("name = 'é'".encode("latin-1"))
    for path, words in (
        (tmp_path / "pipe.toml", "a pipe or a device"),
        ("/dev/zero", "a pipe or a device"),
        (tmp_path, "a folder"),
        (large, "at most 32,000,000"),
        (tmp_path / "none.toml", "no such file"),
        ("nul\0.toml", "cannot be read"),
        (tmp_path / "latin.toml", "not text in UTF-8"),
    ):
        with pytest.raises(InputError) as caught:
            System.from_toml(path)
        assert words in str(caught.value)


def _tables(value, path=()):
    if isinstance(value, dict):
        yield path
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in items:
        yield from _tables(item, (*path, key))


@pytest.mark.parametrize("name", presets.names())
def test_no_table_swallows_an_entry(name):
    base = tomllib.loads(presets.text(name))
    for path in _tables(base):
        if path == ("materials",):
            continue  # its entries are the user's own names
        data = tomllib.loads(presets.text(name))
        table = data
        for key in path:
            table = table[key]
        table["colour"] = "blue"
        with pytest.raises(InputError, match="colour"):
            System.model_validate(toml.resolved(data))
