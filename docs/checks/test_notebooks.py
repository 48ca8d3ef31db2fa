"""Every example is a notebook too, made from the script by the gallery, and runs as one; figures and systems show themselves."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nbformat
import pytest
from nbclient import NotebookClient

TUTORIALS = Path(__file__).parents[1] / "tutorials"
EXAMPLES = sorted(path.stem for path in (Path(__file__).parents[2] / "examples").glob("*.py"))


def shown(notebook: Any) -> list[str]:
    """Return the kinds of everything that the cells showed."""
    return [kind for cell in notebook.cells for output in cell.get("outputs", ()) for kind in output.get("data", ())]


def executed(name: str, folder: Path) -> Any:
    notebook = nbformat.read(TUTORIALS / f"{name}.ipynb", as_version=4)
    NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(folder)}}).execute()
    return notebook


# The kernel's own sockets and loops are not ours to judge.
@pytest.mark.filterwarnings("ignore")
def test_the_first_tutorial_runs_as_a_notebook(tmp_path):
    kinds = shown(executed(EXAMPLES[0], tmp_path))
    assert kinds.count("image/png") == 2
    assert "text/html" in kinds  # the system's drawing


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", EXAMPLES[1:])
def test_tutorials_run_as_notebooks(name, tmp_path):
    executed(name, tmp_path)


def test_every_example_became_a_notebook():
    assert EXAMPLES
    assert [name for name in EXAMPLES if not (TUTORIALS / f"{name}.ipynb").exists()] == []
