"""Make data/bessel_ratios.npz: I_{m+1}/I_m and K_{m+1}/K_m by 50-digit arithmetic on the recurrences themselves.

Run once by hand (under a minute); no test runs it. mpmath's own besseli and besselk need minutes at these orders and arguments.
"""

from __future__ import annotations

from pathlib import Path

import mpmath as mp
import numpy as np

ORDERS = (0, 1, 2, 3, 7, 20, 60, 148, 150, 300, 620, 1000, 1500, 1999, 2000)
MODULI = (1e-3, 0.1, 1.0, 10.0, 60.0, 149.0, 300.0, 800.0, 1999.0, 5000.0, 2e4, 1e5)
PHASES = (0.0, 0.8, 1.5, 1.5705)
NEAR_AXIS = (1.0, 3.0)


def arguments() -> list[complex]:
    """Return z on rays, the positive real axis among them, and on the lines Re z = 1 and 3, where Laplace contours run."""
    rays = [complex(r * np.cos(p), r * np.sin(p)) for r in MODULI for p in PHASES]
    lines = [complex(x, np.sqrt(r * r - x * x)) for r in MODULI for x in NEAR_AXIS if r > 3]
    return rays + lines


def i_ratios(z: mp.mpc, top: int) -> list[mp.mpc]:
    """Return I_{m+1}/I_m for m = 0..top by Miller's recurrence from far above the turning point m = |z|."""
    largest = max(float(abs(z)), top)
    ratio, kept = mp.mpc(0), [mp.mpc(0)] * (top + 1)
    for m in range(int(largest + 100 + 60 * largest ** (1 / 3)), 0, -1):
        ratio = 1 / (2 * m / z + ratio)
        if m - 1 <= top:
            kept[m - 1] = ratio
    return kept


def hankel_series(order: int, z: mp.mpc) -> mp.mpc:
    """Return sqrt(2z/pi) e^z K_order(z) by its asymptotic series (DLMF 10.40.2), good to 50 digits for |z| >= 60."""
    total = term = mp.mpc(1)
    for k in range(1, 120):
        term *= (4 * order**2 - (2 * k - 1) ** 2) / (8 * k * z)
        total += term
        if abs(term) < mp.mpf(10) ** (-mp.mp.dps - 2):
            break
    return total


def k_ratios(z: mp.mpc, top: int) -> list[mp.mpc]:
    """Return K_{m+1}/K_m for m = 0..top by upward recurrence."""
    kept = [hankel_series(1, z) / hankel_series(0, z) if abs(z) >= 59 else mp.besselk(1, z) / mp.besselk(0, z)]
    for m in range(1, top + 1):
        kept.append(2 * m / z + 1 / kept[-1])
    return kept


def main() -> None:
    mp.mp.dps = 50
    z = arguments()
    rows_i, rows_k = [], []
    for value in z:
        argument = mp.mpc(value)
        every_i, every_k = i_ratios(argument, ORDERS[-1]), k_ratios(argument, ORDERS[-1])
        rows_i.append([complex(every_i[m]) for m in ORDERS])
        rows_k.append([complex(every_k[m]) for m in ORDERS])
    np.savez_compressed(
        Path(__file__).parent / "data" / "bessel_ratios.npz", z=z, orders=ORDERS, i=np.transpose(rows_i), k=np.transpose(rows_k)
    )


if __name__ == "__main__":
    main()
