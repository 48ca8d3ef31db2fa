"""Run every benchmark."""

from __future__ import annotations

from benchmarks import absorbers, bare, engines, gradient, limits, march, retuned, scaling, spatial, spatial_growth, spectra, studio, sweep


def main() -> None:
    """Run them one after another."""
    for benchmark in (bare, scaling, spatial, spatial_growth, absorbers, march, limits, retuned, sweep, gradient, spectra, engines, studio):
        benchmark.main()


if __name__ == "__main__":
    main()
