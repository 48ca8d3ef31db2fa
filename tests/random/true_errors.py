"""True errors of a run, from runs with four times the orders and with a quarter of the step, in the norm of the printed ones."""

from __future__ import annotations

import numpy as np
from random_systems import Case

import coaxshell as cx
from coaxshell.solver.orders_left_out import REST

FINER, FEWEST_ORDERS = 4, 64
NOISE = 5e-10
"""Of the shell that moves most: rounding, amplified by e^{sigma t}, and what wraps around the period, in both of two runs (3e-10 seen)."""


def motions(response: cx.Response, every: int = 1) -> np.ndarray:
    """Return modal displacement and strain, shape (shells, 2, parities, M + 1, T): what the printed errors are about."""
    w, v = (x[..., ::every] for x in (response.solution.normal, response.solution.tangential))
    m = np.arange(w.shape[2])[:, None]
    return np.stack([w, m * v - w], axis=1)


def distance(found: np.ndarray, true: np.ndarray) -> np.ndarray:
    """Return the least and the most that the relative L2 distance over surface and time may be, for the noise in both.

    Shape (2, shells, 2); NaN for a rigid shell.
    """
    parities, orders = (max(found.shape[i], true.shape[i]) for i in (2, 3))
    steps = min(found.shape[4], true.shape[4])

    def padded(x: np.ndarray) -> np.ndarray:
        full = np.zeros((*x.shape[:2], parities, orders, steps))
        full[:, :, : x.shape[2], : x.shape[3]] = x[..., :steps]
        return full

    weight = np.where(np.arange(orders) == 0, 1.0, 0.5)[:, None]
    size = [np.sqrt((weight * x**2).sum(axis=(2, 3, 4))) for x in (padded(found) - padded(true), padded(true))]
    largest = size[1].max(axis=0)
    whole = np.where(size[1] > 0, np.maximum(size[1], REST * largest), np.nan)
    return np.stack([np.maximum(size[0] - NOISE * largest, 0.0), size[0] + NOISE * largest]) / whole


def true_errors(case: Case, response: cx.Response) -> dict[str, np.ndarray]:
    """Return the bounds of the errors by cause, "orders" and "step" (march included), each of shape (2, shells, 2)."""
    settings = case.settings
    many = max(4 * settings["modes"], FEWEST_ORDERS)
    step = settings["time_step"]
    fine = cx.simulate(case.system, **{**settings, "time_step": step / FINER})
    more = cx.simulate(case.system, **{**settings, "modes": many})
    own = motions(response)
    return {
        "orders": distance(own, motions(more)),
        "step": distance(own, motions(fine, FINER)),
    }
