"""Many clients at once: each gets its newest answer, the light routes stay quick to answer, and nothing piles up."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import pytest
from asking import described, solve


@pytest.mark.parametrize("clients", [6, pytest.param(50, marks=pytest.mark.slow)])
def test_many_clients_moving_sliders(client, clients):
    def move(number):
        system, statuses = described("absorbers"), []
        for step in range(3):
            system["absorbers"]["mass"] = 5.0 + number + 0.1 * step
            statuses.append(solve(client, system, who=f"client-{number}-of-{clients}", revision=step).status_code)
        return statuses

    with ThreadPoolExecutor(clients) as pool:
        moved = [pool.submit(move, number) for number in range(clients)]
        meanwhile = [client.get("/api/jobs?client=idle").status_code for _ in range(20)]
    assert [statuses.result() for statuses in moved] == [[200, 200, 200]] * clients
    assert meanwhile == [200] * 20


def test_what_is_kept_is_bounded():
    import numpy as np

    from coaxshell.numerics.cache import ByteBoundedCache, held_bytes

    cache = ByteBoundedCache(1000, held_bytes)
    for number in range(50):
        cache.put(number, np.zeros(30))
        assert cache.bytes <= 1000
    assert (cache.get(49) is not None, cache.get(0), len(cache)) == (True, None, 4)
    cache.put("too large", np.zeros(1000))
    assert cache.get("too large") is None


def test_structures_are_weighed_by_their_arrays():
    from coaxshell.model import presets
    from coaxshell.numerics.cache import held_bytes
    from coaxshell.response import prepare

    prepared = prepare(presets.load("absorbers"), duration=2.0, time_step=0.02, modes=12)
    before = held_bytes(prepared)
    response = prepared.simulate()
    assert held_bytes(prepared) > before + response.solution.normal.nbytes
