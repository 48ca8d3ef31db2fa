"""Never an old number under new code: whatever a function of the user's depends on changes its identity."""

from __future__ import annotations

import functools
import importlib
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.numerics import identity
from coaxshell.numerics.identity import difference, environment
from coaxshell.studies import executors
from coaxshell.studies.code_identity import code_identity
from coaxshell.studies.executors import Alike, OtherEnvironmentError, completed
from coaxshell.studies.user_functions import OtherCodeError, UserCode, from_callable, from_text


def _function(text: str, name: str = "f"):
    """Return a function from its text, as if it were typed at the prompt."""
    namespace: dict = {"__name__": "__main__"}
    exec(textwrap.dedent(text), namespace)
    return namespace[name]


SAME = "def f(r):\n    return 1.0\n"
CHANGED = {
    "its own text": (SAME, "def f(r):\n    return 2.0\n"),
    "a default": ("def f(r, k=1):\n    return k\n", "def f(r, k=2):\n    return k\n"),
    "a keyword's default": ("def f(r, *, k=1):\n    return k\n", "def f(r, *, k=2):\n    return k\n"),
    "a global": ("K = 1\ndef f(r):\n    return K\n", "K = 2\ndef f(r):\n    return K\n"),
    "a global list": ("K = [1, 2]\ndef f(r):\n    return K\n", "K = [1, 3]\ndef f(r):\n    return K\n"),
    "a helper": ("def g():\n    return 1\ndef f(r):\n    return g()\n", "def g():\n    return 2\ndef f(r):\n    return g()\n"),
    "a helper's helper": (
        "def h():\n    return 1\ndef g():\n    return h()\ndef f(r):\n    return g()\n",
        "def h():\n    return 2\ndef g():\n    return h()\ndef f(r):\n    return g()\n",
    ),
    "what it encloses": (
        "def make(k):\n    def f(r):\n        return k\n    return f\nf = make(1)\n",
        "def make(k):\n    def f(r):\n        return k\n    return f\nf = make(2)\n",
    ),
    "a function within": ("def f(r):\n    return (lambda: 1)()\n", "def f(r):\n    return (lambda: 2)()\n"),
    "a class": (
        "class A:\n    def g(self):\n        return 1\ndef f(r):\n    return A().g()\n",
        "class A:\n    def g(self):\n        return 2\ndef f(r):\n    return A().g()\n",
    ),
    "a base class": (
        "class B:\n    k = 1\nclass A(B):\n    pass\ndef f(r):\n    return A.k\n",
        "class B:\n    k = 2\nclass A(B):\n    pass\ndef f(r):\n    return A.k\n",
    ),
    "a bound instance": (
        "class A:\n    def __init__(self, k): self.k = k\n    def g(self, r): return self.k\nf = A(1).g\n",
        "class A:\n    def __init__(self, k): self.k = k\n    def g(self, r): return self.k\nf = A(2).g\n",
    ),
    "an instance that is called": (
        "class A:\n    def __init__(self, k): self.k = k\n    def __call__(self, r): return self.k\nf = A(1)\n",
        "class A:\n    def __init__(self, k): self.k = k\n    def __call__(self, r): return self.k\nf = A(2)\n",
    ),
    "a partial": (
        "import functools\ndef g(r, k):\n    return k\nf = functools.partial(g, k=1)\n",
        "import functools\ndef g(r, k):\n    return k\nf = functools.partial(g, k=2)\n",
    ),
    "an array": (
        "import numpy as np\nK = np.arange(3.0)\ndef f(r):\n    return K\n",
        "import numpy as np\nK = np.arange(4.0)\ndef f(r):\n    return K\n",
    ),
    "a decorated helper": (
        "import functools\n@functools.cache\ndef g():\n    return 1\ndef f(r):\n    return g()\n",
        "import functools\n@functools.cache\ndef g():\n    return 2\ndef f(r):\n    return g()\n",
    ),
}


@pytest.mark.parametrize("what", CHANGED)
def test_everything_that_runs_counts(what: str) -> None:
    before, after = CHANGED[what]
    assert code_identity(_function(before)) == code_identity(_function(before))
    assert code_identity(_function(before)) != code_identity(_function(after))


def test_what_does_not_run_does_not_count() -> None:
    moved = "# a comment\n\n\ndef f(r):\n\n    return 1.0\n"
    assert code_identity(_function(SAME)) == code_identity(_function(moved))
    cached = functools.cache(_function(SAME))
    before = code_identity(cached)
    cached(1)
    assert code_identity(cached) == before


def test_recursion_ends() -> None:
    assert code_identity(_function("def f(r):\n    return g(r)\ndef g(r):\n    return f(r)\n"))


def test_installed_code_counts_by_its_version(monkeypatch: pytest.MonkeyPatch) -> None:
    from coaxshell.studies import code_identity as room

    function = _function("import numpy as np\ndef f(r):\n    return np.linalg.norm(r)\n")
    before = code_identity(function)
    monkeypatch.setattr(room, "_release", lambda module: "numpy 99")
    assert code_identity(function) != before


@pytest.fixture
def study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a metric that gets its number from a helper of a helper, beside it and in a package."""
    monkeypatch.setattr(sys, "dont_write_bytecode", False)  # byte code of what was just changed must not be taken for its own
    (tmp_path / "kit").mkdir()
    (tmp_path / "kit" / "__init__.py").write_text("")
    (tmp_path / "kit" / "deep.py").write_text("NUMBER = 1.0\n")
    (tmp_path / "near_helper.py").write_text("from kit.deep import NUMBER\n\ndef value():\n    return NUMBER\n")
    (tmp_path / "lazy_helper.py").write_text("NUMBER = 10.0\n")
    (tmp_path / "mine.py").write_text(
        "import near_helper\n\ndef f(r):\n    import lazy_helper\n    return near_helper.value() + lazy_helper.NUMBER\n"
    )
    yield tmp_path
    for name in ("kit", "kit.deep", "near_helper", "lazy_helper"):
        sys.modules.pop(name, None)


@pytest.mark.parametrize(
    ("file", "text", "value"),
    [
        ("mine.py", "def f(r):\n    return 5.0\n", 5.0),
        ("near_helper.py", "def value():\n    return 7.0\n", 17.0),
        ("kit/deep.py", "NUMBER = 2.0\n", 12.0),
        ("lazy_helper.py", "NUMBER = 20.0\n", 21.0),
    ],
)
def test_a_change_of_any_file_gives_another_identity_and_the_new_number(study: Path, file: str, text: str, value: float) -> None:
    code = UserCode(str(study))
    before = from_text("mine.py:f", "metrics", code)
    sys.path.insert(0, str(study))
    try:
        assert before(None, "f") == 11.0
        importlib.invalidate_caches()
        path = study / file
        path.write_text(text)
        after = from_text("mine.py:f", "metrics", code)
        assert after.identity != before.identity
        assert after(None, "f") == value
    finally:
        sys.path.remove(str(study))


def test_resume_refuses_a_store_of_other_code(study: Path, hybrid: cx.System, quick: dict) -> None:
    over, folder = {"source.peak_pressure": [1e5]}, study / "store"
    metric = from_text("mine.py:f", "metrics", UserCode(str(study)))
    sys.path.insert(0, str(study))
    try:
        text = f"{study / 'mine.py'}:f"
        assert float(cx.sweep(hybrid, over, {"f": text}, workers=1, store=folder, **quick)["f"][0]) == 11.0
        (study / "kit" / "deep.py").write_text("NUMBER = 3.0\n")
        with pytest.raises(InputError, match="holds another study: its metrics differ"):
            cx.sweep(hybrid, over, {"f": text}, workers=1, store=folder, resume=True, **quick)
    finally:
        sys.path.remove(str(study))
    assert metric.identity


def test_another_package_or_library_is_another_origin(monkeypatch: pytest.MonkeyPatch) -> None:
    before = identity.origin()
    monkeypatch.setattr(identity, "libraries", lambda: "numpy 99")
    assert identity.origin() != before
    monkeypatch.undo()
    monkeypatch.setattr(identity, "package_digest", lambda *further: "other")
    assert identity.origin() != before


def test_a_worker_with_other_code_is_refused() -> None:
    metric = from_callable(_function(SAME), "metrics")
    changed = type(metric)(metric.name, "", "", "another identity", target=metric.target)
    with pytest.raises(OtherCodeError, match=r"metrics\.f: the code in a worker is not that of the process"):
        changed.require_same("f")
    metric.require_same("f")


def test_a_worker_with_another_environment_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    work = Alike(len, environment())
    assert work("abc") == 3
    monkeypatch.setattr(executors, "environment", lambda: environment().replace("numpy ", "numpy 0."))
    with pytest.raises(OtherEnvironmentError, match=r"is not like this one: numpy 0\..* there, numpy .* here"):
        work("abc")


def test_an_executor_of_other_workers_ends_the_study_in_one_line(hybrid: cx.System, quick: dict, monkeypatch: pytest.MonkeyPatch) -> None:
    from concurrent.futures import ThreadPoolExecutor

    first = iter([environment()])
    monkeypatch.setattr(executors, "environment", lambda: next(first, "coaxshell 0 (code x), Python 2.7, numpy 1"))
    with ThreadPoolExecutor(1) as pool, pytest.raises(InputError, match=r"executor: process .* is not like this one: coaxshell 0"):
        cx.sweep(hybrid, {"source.peak_pressure": [1e5]}, executor=pool, **quick)


def test_what_a_worker_cannot_unpack_is_told() -> None:
    from concurrent.futures import ThreadPoolExecutor

    def work(task: int) -> int:
        raise ModuleNotFoundError("No module named 'mymetrics'")

    with ThreadPoolExecutor(1) as pool, pytest.raises(InputError, match=r"cannot unpack the work .*mymetrics"):
        list(completed([1], work, executor=pool))


def test_differences_in_words() -> None:
    assert difference("coaxshell 1, numpy 1", "coaxshell 1, numpy 2") == "numpy 1 there, numpy 2 here"
    assert np.__version__ in environment()
