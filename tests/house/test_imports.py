"""Each floor of the house imports only from the floors above it."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from house import PACKAGE, modules, named, tree

FLOORS = (
    "numerics",
    "model",
    "structure",
    "acoustics",
    "solver",
    "response",
    "studies",
    "plotting",
    "export",
    "apps.verification",
    "apps.paper",
    "apps.report",
    "apps.studio",
    "apps.cli",
)
FREE_FOR_ALL = {"errors", "limits", "_version", "_moved", "apps"}


def imported(module: ast.Module) -> Iterator[tuple[str, int]]:
    """Yield (name of the module, line) of every import, those inside functions and under TYPE_CHECKING too."""
    for node in ast.walk(module):
        if isinstance(node, ast.Import):
            yield from ((alias.name, node.lineno) for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module, node.lineno
            if node.module == PACKAGE.name:
                yield from ((f"{node.module}.{alias.name}", node.lineno) for alias in node.names)


def room_of(name: str) -> str | None:
    parts = name.split(".")
    if parts[0] != PACKAGE.name or len(parts) < 2:
        return None
    return ".".join(parts[1:3]) if parts[1] == "apps" and len(parts) > 2 else parts[1]


def wrong_ways(module: ast.Module, own: str) -> Iterator[str]:
    """Yield the imports of a file of a floor that lead below it, or elsewhere than to a floor."""
    for name, line in imported(module):
        room = room_of(name)
        if room is None or room in FREE_FOR_ALL:  # names of the root are checked one by one
            continue
        if room not in FLOORS:
            yield f"line {line} imports {name}: inside the package, import from the room itself"
        elif FLOORS.index(room) > FLOORS.index(own):
            yield f"line {line} imports {name}, which lies below {own}"


def floor_of(path: Path) -> str:
    inside = path.relative_to(PACKAGE).with_suffix("").parts
    return ".".join(inside[:2]) if inside[0] == "apps" else inside[0]


def test_no_import_runs_down_the_house():
    floors = {path: floor_of(path) for path in modules(inside_rooms=True) if floor_of(path) != "apps.__init__"}
    assert set(floors.values()) == set(FLOORS)
    assert {named(path): wrong for path, own in floors.items() if (wrong := list(wrong_ways(tree(path), own)))} == {}


def test_the_check_sees_an_arrow_that_runs_the_wrong_way():
    source = ast.parse(
        "def f():\n    from coaxshell.apps.cli import main\n    import coaxshell.response.summary\n    from coaxshell import plotting"
    )
    assert {room_of(name) for name, _ in imported(source)} >= {"apps.cli", "response", "plotting"}
    assert len(list(wrong_ways(source, "response"))) == 2
    assert len(list(wrong_ways(ast.parse("from coaxshell import simulate"), "response"))) == 1


def texts(path: Path) -> set[str]:
    """Return the texts in a file: what a module's name may be made of."""
    return {node.value for node in ast.walk(tree(path)) if isinstance(node, ast.Constant) and isinstance(node.value, str)}


@cache
def arrows_between_files() -> dict[str, set[str]]:
    """Return which files each file imports: at its top, in functions, for types alone, or by a name given to the import system.

    Names that a package gathers in its ``__init__`` come from there, its files from themselves.
    """
    files = {
        ".".join((PACKAGE.name, *path.relative_to(PACKAGE).with_suffix("").parts)).removesuffix(".__init__"): path for path in modules()
    }
    found: dict[str, set[str]] = {name: set() for name in files}
    for name, path in files.items():
        for node in ast.walk(tree(path)):
            if isinstance(node, ast.Import):
                found[name] |= {alias.name for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module:
                whole = {f"{node.module}.{alias.name}" for alias in node.names}
                found[name] |= whole & files.keys() | ({node.module} if whole - files.keys() else set())
            elif isinstance(node, ast.Call) and getattr(node.func, "id", "") in ("import_module", "__import__", "Late"):
                found[name] |= {argument.value for argument in node.args if isinstance(argument, ast.Constant)}
                begins = [argument.values[0].value for argument in node.args if isinstance(argument, ast.JoinedStr)]
                found[name] |= {f"{begin}{end}" for begin in begins for end in texts(path)}
    return {name: wanted & files.keys() - {name} for name, wanted in found.items()}


def circles(arrows: dict[str, set[str]]) -> list[list[str]]:
    """Return the groups of files that reach each other by arrows."""
    reached: dict[str, set[str]] = {}
    for start in arrows:
        reached[start], waiting = set(), [start]
        while waiting:
            fresh = arrows[waiting.pop()] - reached[start]
            reached[start] |= fresh
            waiting += fresh
    groups = {frozenset(one for one in ahead if start in reached[one]) for start, ahead in reached.items() if start in ahead}
    return sorted(map(sorted, groups))


def test_no_two_files_need_each_other():
    assert circles(arrows_between_files()) == []


def test_the_search_for_circles_finds_them():
    arrows = arrows_between_files()
    assert len(arrows) > 100
    assert "coaxshell.response.fields" in arrows["coaxshell.response.response"]  # a late one
    assert "coaxshell.apps.cli.run" in arrows["coaxshell.apps.cli.app"]  # by a name that is made
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"b", "d"}, "d": set()}) == [["b", "c"]]


# pydantic is left out: typer itself imports it to show the help of a command.
HEAVY = ("xarray", "matplotlib", "scipy", "numpy", "pandas", "pint", "h5py", "finufft", "numba")


@pytest.mark.parametrize("arguments", [["--help"], ["--version"], ["run", "--help"], ["figure", "--help"]], ids=" ".join)
def test_help_imports_nothing_heavy(arguments):
    code = (
        "import sys\nfrom coaxshell.apps.cli import main\n"
        f"assert main({arguments!r}) == 0\n"
        f"print('HEAVY', sorted(set(sys.modules) & {set(HEAVY)!r}))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "HEAVY []"


def test_importing_the_package_imports_nothing_heavy():
    code = f"import sys, coaxshell\nprint(sorted(set(sys.modules) & {set(HEAVY)!r}))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


# What a run does not use, seconds of imports: labels (xarray and pandas), units beyond the usual (pint, and dask through it), films,
# files, the rooms of our own that only fields, energies and the direct engine need, and those of scipy that only these, studies and
# saturation enter.
NOT_FOR_A_RUN = (
    *("xarray", "pandas", "pint", "dask", "jinja2", "yaml", "psutil", "matplotlib", "PIL", "h5py", "h5netcdf", "rich"),
    *(f"coaxshell.{room}" for room in ("response.fields", "response.energy", "solver.direct.solve", "cli.verify")),
    *(f"scipy.{room}" for room in ("signal", "stats", "optimize", "spatial", "interpolate", "integrate", "linalg", "ndimage")),
)


@pytest.mark.slow_for("command")
@pytest.mark.parametrize(
    "work",
    [
        "import coaxshell as cx; str(cx.simulate(cx.presets.load('hybrid'), modes=8, time_step=0.02).summary())",
        "from coaxshell.apps.cli import main; assert main(['run', 'bare', '--modes=8', '--time-step=0.02']) == 0",
    ],
    ids=["simulate", "command"],
)
def test_a_run_imports_only_what_it_uses(work):
    theirs = "import sys, scipy.fft, scipy.special\ntheirs = set(sys.modules)\n"  # from 1.18 on these two import scipy.linalg themselves
    code = f"{theirs}{work}\nprint(sorted((set(sys.modules) - theirs) & {set(NOT_FOR_A_RUN)!r}))"
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"
