"""``coaxshell init`` and ``coaxshell presets``."""

from __future__ import annotations

import pytest

import coaxshell as cx
from coaxshell.apps.cli.template import scenario_text
from coaxshell.model import Described
from coaxshell.model.explanations import explanations


def test_presets_are_listed_with_a_sentence_each(run):
    outcome = run("presets")
    assert outcome.code == 0
    lines = outcome.out.splitlines()
    assert [line.split()[0] for line in lines] == list(cx.presets.names())
    assert all(len(line.split()) > 4 and line.endswith(".") and len(line) < 160 for line in lines)


@pytest.mark.parametrize("preset", cx.presets.names())
def test_writes_a_file_that_reads_back_as_the_preset(run, tmp_path, preset):
    outcome = run("init", "mine.toml", "--preset", preset)
    assert outcome.code == 0
    assert outcome.files == ["mine.toml"]
    assert cx.System.from_toml(tmp_path / "mine.toml") == cx.presets.load(preset)


def test_default_name_and_preset(run, tmp_path):
    assert run("init").files == ["scenario.toml"]
    assert cx.System.from_toml(tmp_path / "scenario.toml") == cx.presets.load("bare")


def concrete(cls):
    for child in cls.__subclasses__():
        yield from concrete(child)
        if not child.__name__.startswith("_") and child.__module__.startswith("coaxshell.model"):
            yield child


def test_every_entry_of_every_part_is_explained():
    text = " ".join(scenario_text("bare").split())
    left_out = {"System", "SystemParts", "Vacuum", "Source"}
    for part in concrete(Described):
        if part.__name__ in left_out:
            continue
        for name in part.model_fields:
            assert name in text
            if name not in ("type", "rigid", "angle"):
                assert " ".join(explanations(part).get(name, "no description").split()).split(" # ")[0] in text.replace(" # ", " "), (
                    part.__name__,
                    name,
                )


def test_refuses_to_overwrite(refused, run, tmp_path):
    (tmp_path / "mine.toml").write_text("precious")
    message = refused("init", "mine.toml", left=["mine.toml"])
    assert "'mine.toml' exists already" in message
    assert "--force" in message
    assert (tmp_path / "mine.toml").read_text() == "precious"
    assert run("init", "mine.toml", "--force").code == 0
    assert cx.System.from_toml(tmp_path / "mine.toml") == cx.presets.load("bare")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--preset", "bear"], ["error: --preset:", "bear", "bare"]),
        (["mine.yaml"], ["'mine.yaml'", ".toml"]),
        (["nowhere/mine.toml"], ["'nowhere'", "does not exist"]),
        (["/proc/mine.toml"], ["'/proc/mine.toml'"]),
    ],
    ids=" ".join,
)
def test_bad_input(refused, arguments, words):
    message = refused("init", *arguments)
    for word in words:
        assert word in message, message
