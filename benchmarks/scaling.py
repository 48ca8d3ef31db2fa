"""Cost of the bare system against the number of orders and of steps, with fitted exponents."""

from __future__ import annotations

import coaxshell as cx
from benchmarks.measure import exponent, median_seconds

ORDERS = (125, 250, 500, 1000)
STEPS = (2500, 5000, 10000, 20000, 40000)


def main() -> None:
    """Print both curves."""
    system = cx.presets.load("bare")
    seconds = [median_seconds(lambda m=m: cx.simulate(system, duration=2.0, time_step=2e-3, modes=m).warnings, 5) for m in ORDERS]
    print("orders M at 1000 steps:", ", ".join(f"{m}: {s:.3f} s" for m, s in zip(ORDERS, seconds, strict=True)))
    print(f"  exponent {exponent(ORDERS, seconds):.2f}")
    seconds = [median_seconds(lambda n=n: cx.simulate(system, duration=5.0, time_step=5.0 / n, modes=40).warnings, 5) for n in STEPS]
    print("steps at M = 40:", ", ".join(f"{n}: {s:.3f} s" for n, s in zip(STEPS, seconds, strict=True)))
    print(f"  exponent {exponent(STEPS, seconds):.2f}")


if __name__ == "__main__":
    main()
