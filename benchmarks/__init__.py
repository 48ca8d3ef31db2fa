"""Timings of coaxshell: ``python -m benchmarks`` runs them all, ``python -m benchmarks.bare`` one of them."""
