"""Run every benchmark."""

from __future__ import annotations

from benchmarks import (
    absorbers,
    bare,
    engines,
    gradient,
    limits,
    march,
    retuned,
    scaling,
    spatial,
    spatial_cluster,
    spatial_growth,
    spectra,
    studio,
    studio_page,
    sweep,
)

SOLVER = (bare, scaling, spatial, spatial_growth, absorbers, march, limits, retuned, sweep, gradient, spectra, engines)
OTHERS = (studio, studio_page, spatial_cluster)
"""Of the studio, and of a cluster last: its blocks are smaller, for all that follows in the process."""


def main() -> None:
    """Run them one after another."""
    for benchmark in (*SOLVER, *OTHERS):
        benchmark.main()


if __name__ == "__main__":
    main()
