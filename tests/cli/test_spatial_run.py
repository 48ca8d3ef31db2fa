"""Where a run in three dimensions is worked on and kept, from the command line."""

from __future__ import annotations

import pytest

RUN = ("run", "bare", "--dimensions", "3", "--duration", "1", "--time-step", "2e-2", "--modes", "8", "--quiet")


def test_a_run_is_kept_and_gone_on_with(run, refused):
    plain = run(*RUN, "--json")
    assert plain.code == 0
    kept = run(*RUN, "--json", "--workers", 1, "--store", "kept")
    assert kept.out == plain.out
    assert "study.json" in kept.files
    again = refused(*RUN, "--store", "kept", left=kept.files)
    assert again.startswith("error: --store: 'kept' already holds")
    assert run(*RUN, "--json", "--store", "kept", "--resume").out == plain.out


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (("--resume",), "--resume: does not say where the run is kept; give its --store"),
        (("--workers", "0"), "--workers: '0' is not allowed; give a whole number from 1 to 1024"),
        (
            ("--workers", "2", "--dask", "tcp://x:1"),
            "--workers: has no effect beside dask, whose cluster has its own; give one or the other",
        ),
        (("--dimensions", "2", "--workers", "2"), "--workers: is for a run in three dimensions; leave it out, or use --dimensions 3"),
        (("--store", "s", "--compare", "active"), "--store: keeps one run; leave it out, or compare with a saved run (.nc)"),
    ],
)
def test_what_has_no_effect_is_refused(refused, options, told):
    assert refused(*RUN, *options) == f"error: {told}\n"
