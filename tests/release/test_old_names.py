"""Modules at the places where the version before had them."""

from __future__ import annotations

import subprocess
import sys

import pytest

from coaxshell._moved import MOVED


@pytest.mark.slow_for("paper")
@pytest.mark.parametrize("room", MOVED)
def test_the_old_name_is_the_same_module_and_says_where_it_went(room: str) -> None:
    code = (
        "import importlib, warnings\n"
        "with warnings.catch_warnings(record=True) as told:\n"
        "    warnings.simplefilter('always')\n"
        f"    old = importlib.import_module('coaxshell.{room}')\n"
        f"assert [str(w.message) for w in told if w.category is DeprecationWarning] == "
        f"['coaxshell.{room} is coaxshell.apps.{room}; the old name goes with the version after this'], told\n"
        f"new = importlib.import_module('coaxshell.apps.{room}')\n"
        "assert old is new and new.__name__ == new.__spec__.name\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.slow
def test_modules_inside_are_the_same_objects() -> None:
    code = (
        "import warnings\nwarnings.simplefilter('ignore')\n"
        "import coaxshell.paper.slips.switches as old\nimport coaxshell.apps.paper.slips.switches as new\n"
        "from coaxshell.verification import suite\nfrom coaxshell.apps.verification.suite import Report\n"
        "assert old is new and suite.Report is Report\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_a_name_that_never_was_is_not_found() -> None:
    with (
        pytest.warns(DeprecationWarning, match="coaxshell.apps.paper"),
        pytest.raises(ModuleNotFoundError, match=r"coaxshell\.apps\.paper\.nothing"),
    ):
        __import__("coaxshell.paper.nothing")
