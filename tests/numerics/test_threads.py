"""The threads of a process: order kept, failures told, work within work done at once, and a forked process with threads of its own."""

from __future__ import annotations

import multiprocessing
import threading

import pytest

from coaxshell.numerics import threads
from coaxshell.numerics.threads import map_on_threads


@pytest.fixture(autouse=True)
def several(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two threads, whatever the machine has."""
    monkeypatch.setattr(threads, "WORKERS", 2)
    threads._threads.cache_clear()


def test_results_come_in_the_order_of_the_items_and_from_the_same_threads() -> None:
    names = [list(map_on_threads(lambda _: threading.current_thread().name, range(20))) for _ in range(3)]
    assert list(map_on_threads(lambda x: x * x, range(50))) == [x * x for x in range(50)]
    assert threading.current_thread().name not in {name for some in names for name in some}
    assert len({name for some in names for name in some}) <= 2


def test_what_a_piece_of_work_raises_is_raised() -> None:
    with pytest.raises(ZeroDivisionError):
        list(map_on_threads(lambda x: 1 // x, [1, 0, 1]))


def test_work_within_work_does_not_wait_for_threads_that_are_all_busy() -> None:
    nested = map_on_threads(lambda x: sum(map_on_threads(lambda y: x * y, range(10))), range(8))
    assert list(nested) == [45 * x for x in range(8)]


def _sum() -> None:
    raise SystemExit(sum(map_on_threads(lambda x: x, range(10))))


@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
def test_a_forked_process_has_threads_of_its_own() -> None:
    assert sum(map_on_threads(lambda x: x, range(10))) == 45
    process = multiprocessing.get_context("fork").Process(target=_sum)
    process.start()
    process.join(20)
    assert process.exitcode == 45
