"""Files and folders appear whole or not at all, whatever happens while they are written."""

from __future__ import annotations

import os
import resource
import signal
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from coaxshell.errors import InputError
from coaxshell.numerics import scratch
from coaxshell.numerics.files import free_file, free_folder, replacing, replacing_folder, write_text

PARTS = ("one.txt", "deeper")


def fill(folder: Path, text: str) -> None:
    with replacing_folder(folder, PARTS, force=True) as made:
        (made / "one.txt").write_text(text)
        (made / "deeper").mkdir()
        (made / "deeper" / "two.txt").write_text(text)


def held(folder: Path) -> list[str]:
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*"))


def test_a_new_file_has_the_mode_of_the_umask(tmp_path: Path) -> None:
    before = os.umask(0o027)
    try:
        write_text(tmp_path / "a.txt", "new")
        fill(tmp_path / "folder", "new")
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "a.txt").stat().st_mode) == 0o640
    assert stat.S_IMODE((tmp_path / "folder").stat().st_mode) == 0o750


def test_modes_are_kept(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("old")
    (tmp_path / "a.txt").chmod(0o600)
    fill(tmp_path / "folder", "old")
    (tmp_path / "folder").chmod(0o700)
    write_text(tmp_path / "a.txt", "new")
    fill(tmp_path / "folder", "new")
    assert (tmp_path / "a.txt").read_text() == "new"
    assert stat.S_IMODE((tmp_path / "a.txt").stat().st_mode) == 0o600
    assert stat.S_IMODE((tmp_path / "folder").stat().st_mode) == 0o700
    assert held(tmp_path) == ["a.txt", "folder", "folder/deeper", "folder/deeper/two.txt", "folder/one.txt"]


def test_links_stay_and_what_they_point_to_is_replaced(tmp_path: Path) -> None:
    store = tmp_path / "store"
    store.mkdir()
    (store / "a.txt").write_text("old")
    fill(store / "folder", "old")
    for name, target in (("a.txt", store / "a.txt"), ("folder", Path("store/folder")), ("fresh.txt", Path("store/fresh.txt"))):
        (tmp_path / name).symlink_to(target)
    (tmp_path / "twice.txt").symlink_to("a.txt")
    write_text(tmp_path / "twice.txt", "new")
    write_text(tmp_path / "fresh.txt", "fresh")
    fill(tmp_path / "folder", "new")
    assert all((tmp_path / name).is_symlink() for name in ("a.txt", "folder", "fresh.txt", "twice.txt"))
    assert (store / "a.txt").read_text() == "new"
    assert (store / "fresh.txt").read_text() == "fresh"
    assert (store / "folder" / "deeper" / "two.txt").read_text() == "new"


def test_names_of_any_length_that_the_system_allows(tmp_path: Path) -> None:
    name = "x" * 251 + ".txt"
    write_text(tmp_path / name, "whole")
    assert held(tmp_path) == [name]


def refusals(folder: Path) -> dict[str, Path]:
    (folder / "file").write_text("a file")
    (folder / "folder").mkdir()
    os.mkfifo(folder / "pipe")
    (folder / "round").symlink_to("round")
    (folder / "device").symlink_to("/dev/null")
    return {
        "nowhere' does not exist; make it first": folder / "nowhere" / "a.txt",
        "file' is a file; make it first": folder / "file" / "a.txt",
        "it is a folder": folder / "folder",
        "file name too long": folder / ("x" * 300),
        "is not the name of a file": folder / "a\0b",
        "is not the name of a file ": folder / "\ud800",
        "it is a device or a pipe": folder / "pipe",
        "it is a device or a pipe ": folder / "device",
        "too many levels of symbolic links": folder / "round",
    }


def test_one_line_for_whatever_cannot_be_written(tmp_path: Path) -> None:
    for problem, path in refusals(tmp_path).items():
        for call in (lambda path=path: write_text(path, "new", "--output"), lambda path=path: free_file(path, "--output")):
            with pytest.raises(InputError) as caught:
                call()
            text = str(caught.value)
            assert text.startswith("--output: ")
            assert problem.strip() in text
            assert repr(str(path)) in text
            assert "; " in text
    assert not list(tmp_path.glob(".*"))


def test_folders_that_are_not_ours_to_replace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fill(tmp_path / "run", "old")
    with pytest.raises(InputError, match="exists already and is not empty; give another name, or replace it with --force"):
        free_folder(tmp_path / "run", PARTS)
    (tmp_path / "run" / "notes.txt").write_text("mine")
    with pytest.raises(InputError, match=r"holds something else than a result \('notes.txt'\)"):
        fill(tmp_path / "run", "new")
    (tmp_path / "empty").mkdir()
    monkeypatch.chdir(tmp_path / "empty")
    with pytest.raises(InputError, match="is the folder that you are in"):
        fill(Path(), "new")
    (tmp_path / "file").write_text("a file")
    with pytest.raises(InputError, match="is a file"):
        fill(tmp_path / "file", "new")
    assert not list(tmp_path.glob(".*"))


@pytest.mark.parametrize("failure", [OSError(28, "No space left on device"), KeyboardInterrupt(), ValueError("a bug")])
def test_a_failure_in_mid_write_leaves_the_old_result(tmp_path: Path, failure: BaseException) -> None:
    (tmp_path / "a.txt").write_text("old")
    fill(tmp_path / "folder", "old")
    expected = InputError if isinstance(failure, OSError) else type(failure)

    def half_a_file() -> None:
        with replacing(tmp_path / "a.txt") as made:
            made.write_text("half")
            raise failure

    def half_a_folder() -> None:
        with replacing_folder(tmp_path / "folder", PARTS, force=True) as made:
            (made / "one.txt").write_text("half")
            raise failure

    for write in (half_a_file, half_a_folder):
        with pytest.raises(expected):
            write()
    assert (tmp_path / "a.txt").read_text() == "old"
    assert (tmp_path / "folder" / "one.txt").read_text() == "old"
    assert not list(tmp_path.glob(".*"))


def test_a_full_disk_is_told_in_one_line(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("old")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, before[1]))  # a write beyond fails as one on a full disk does
    try:
        with pytest.raises(InputError, match=r"a.txt': file too large; make room, or choose another place"):
            write_text(tmp_path / "a.txt", "x" * 5000)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert held(tmp_path) == ["a.txt"]
    assert (tmp_path / "a.txt").read_text() == "old"


HOLDING = """
import signal, sys, time
from pathlib import Path
from coaxshell.numerics.files import replacing
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background job ignores it, and so would its children
with replacing(Path(sys.argv[1])) as made:
    made.write_text("half")
    print("begun", flush=True)
    time.sleep(60)
"""


def test_what_a_killed_writer_left_is_reclaimed_and_a_living_one_left_alone(tmp_path: Path) -> None:
    command = [sys.executable, "-c", HOLDING]
    dead, alive = (subprocess.Popen([*command, str(tmp_path / name)], stdout=subprocess.PIPE) for name in ("dead.txt", "alive.txt"))
    try:
        for writer in (dead, alive):
            assert writer.stdout is not None
            assert writer.stdout.readline() == b"begun\n"
        dead.kill()
        dead.wait()
        assert len(list(tmp_path.glob(".*"))) == 2
        write_text(tmp_path / "another.txt", "new")
        (left,) = tmp_path.glob(".*")
        assert (left / "alive.txt").is_file()
    finally:
        alive.kill()
        alive.wait()
        for writer in (dead, alive):
            assert writer.stdout is not None
            writer.stdout.close()
    write_text(tmp_path / "another.txt", "new")
    assert held(tmp_path) == ["another.txt"]


def test_two_writers_at_once_leave_one_whole_result(tmp_path: Path) -> None:
    with replacing(tmp_path / "a.txt") as first, replacing(tmp_path / "a.txt") as second:
        first.write_text("first")
        second.write_text("second")
    assert held(tmp_path) == ["a.txt"]
    assert (tmp_path / "a.txt").read_text() == "first"  # the one that ended last


def test_a_killed_exchange_without_the_system_s_own_is_made_good(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Between the two renames the name is free: whoever writes there next completes them."""
    fill(tmp_path / "run", "old")
    renames, rename = [], os.rename

    def killed(one: object, other: object) -> None:
        renames.append(one)
        if len(renames) == 3:
            raise SystemExit  # stands for a kill: what follows is not run
        rename(one, other)

    monkeypatch.setattr(scratch, "exchange", lambda one, other: False)
    with monkeypatch.context() as patch:
        patch.setattr(os, "rename", killed)
        patch.setattr(scratch.shutil, "rmtree", lambda *arguments, **options: None)
        patch.setattr(Path, "exists", lambda path: True)
        with pytest.raises(SystemExit):
            fill(tmp_path / "run", "new")
    assert not (tmp_path / "run").exists()
    scratch.reclaim(tmp_path)
    assert (tmp_path / "run" / "deeper" / "two.txt").read_text() == "new"
    assert [path.name for path in tmp_path.iterdir()] == ["run"]
    fill(tmp_path / "run", "newer")
    assert (tmp_path / "run" / "one.txt").read_text() == "newer"


def test_folders_are_exchanged_in_one_step_here(tmp_path: Path) -> None:
    (tmp_path / "one").mkdir()
    (tmp_path / "other").mkdir()
    (tmp_path / "one" / "a").touch()
    if not scratch.exchange(tmp_path / "one", tmp_path / "other"):
        assert sys.platform not in ("linux", "darwin") or not os.environ.get("CI")
        return
    assert held(tmp_path) == ["one", "other", "other/a"]
    assert not scratch.exchange(tmp_path / "one", tmp_path / "nowhere")


def test_an_interrupted_writer_leaves_nothing(tmp_path: Path) -> None:
    writer = subprocess.Popen([sys.executable, "-c", HOLDING, str(tmp_path / "a.txt")], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    assert writer.stdout is not None
    with writer.stdout:
        assert writer.stdout.readline() == b"begun\n"
        writer.send_signal(signal.SIGINT)
        writer.wait()
    assert held(tmp_path) == []
