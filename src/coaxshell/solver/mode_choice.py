"""The number of modes that a tolerance asks for, chosen before the run from a sample of orders.

What sources excite falls off with the order; what absorbers excite does too, once they are as many modes as they need to feel the wall.
Their forces are not known before the run: they are estimated for each absorber alone on its two walls, cubic springs by the stiffness of
the stretch that comes out. What saturating actuators change is not estimated beforehand, their feedback counts as the linear law: how far
they are driven, and so how the harmonics of what they give fall off, is known after the run, which then says so.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.estimates import ORDERS_FACTOR
from coaxshell.solver.excitation import source_parities
from coaxshell.solver.interface.absorbers import AbsorberSet, absorber_set
from coaxshell.solver.sampled_orders import NODES, SampledOrders, each_alone
from coaxshell.solver.scaling import Problem
from coaxshell.solver.settings import MAX_MODES, Settings
from coaxshell.solver.shared_parts import SharedParts
from coaxshell.solver.solution import Estimates

_FEWEST = 8
_GROWTH = 1.25
_LINEARISATIONS = 4
_MISSED = 2.0


def choose_modes(problem: Problem, grid: LaplaceGrid, tolerance: float, shared: SharedParts | None = None) -> tuple[int, float]:
    """Return the smallest order M whose estimated stress error is within the tolerance on every shell, and that estimate.

    If even 2000 orders are not enough, 2000 and what remains.
    """
    orders = np.unique(np.concatenate([np.arange(0, 33), np.geomspace(36, 2 * MAX_MODES, 48).round()]))
    sampled = SampledOrders.of(problem, grid, orders, shared)
    system = problem.system
    links = absorber_set(problem, system.absorber_list, source_parities(problem))
    squares = sampled.excited
    if links.count:
        links, motion, force = _free_forces(sampled, links, grid)
        squares = squares + sampled.forced(links, force)
    strain = sampled.norms(squares)[:, 1]
    remaining = ORDERS_FACTOR * share_above(orders, strain)
    enough = np.flatnonzero(remaining <= tolerance)
    chosen = min(max(int(enough[0]) if enough.size else MAX_MODES, _FEWEST), MAX_MODES)
    while links.count:
        changed = ORDERS_FACTOR * _changed(sampled, links, motion, force, strain, chosen)
        if max(changed, remaining[chosen]) <= tolerance or chosen == MAX_MODES:
            return chosen, float(max(changed, remaining[chosen]))
        chosen = min(int(_GROWTH * chosen) + 1, MAX_MODES)
    return chosen, float(remaining[chosen])


def share_above(orders: FloatArray, norms: FloatArray) -> FloatArray:
    """Return sqrt of the share of all orders' norm that lies above 0, 1, 2, ..., of the shell where it is largest.

    Parameters
    ----------
    orders : ndarray, shape (sampled,)
        Ascending from 0; between them norms are interpolated (log-log).
    norms : ndarray, shape (shells, sampled)
    """
    every = np.arange(0, int(orders[-1]) + 1)
    remaining = np.zeros(every.size)
    for row in norms:
        dense = np.exp(np.interp(np.log(every + 1.0), np.log(orders + 1.0), np.log(np.maximum(row, 1e-300))))
        total = dense.sum()
        if total > 1e-290:
            remaining = np.maximum(remaining, np.sqrt((np.cumsum(dense[::-1])[::-1] - dense) / total))
    return remaining


def _free_forces(sampled: SampledOrders, links: AbsorberSet, grid: LaplaceGrid) -> tuple[AbsorberSet, ComplexArray, ComplexArray]:
    """Return linear absorbers instead, the walls' motion without them and their forces, (2, N, nodes), phases drawn at random."""
    phase = np.exp(2j * np.pi * np.random.default_rng(0).random((2, links.count, sampled.nodes.size)))
    motion = phase * np.sqrt(sampled.motion(links))
    linear = links.linear_part()
    mobility = sampled.mobility(links)
    force = each_alone(linear, sampled.nodes, mobility, motion)
    mean = 2.0 * grid.shift * NODES.step * grid.frequency_step / np.pi  # of squares over the time that the contour weighs
    for _ in range(0 if not links.cubic.any() else _LINEARISATIONS):
        law = linear.damping[:, None] * sampled.nodes + linear.linear[:, None]
        moved = np.divide(force, law, out=np.zeros_like(force), where=np.broadcast_to(law != 0.0, force.shape))
        stretch = mean * (np.abs(moved) ** 2).sum(axis=-1).max(axis=0)
        spring = links.linear + 3.0 * links.cubic * stretch
        linear = replace(linear, linear=np.sqrt(spring * linear.linear) if np.all(linear.linear > 0) else spring)  # between: no swinging
        force = each_alone(linear, sampled.nodes, mobility, motion)
    return linear, motion, force


def _changed(
    sampled: SampledOrders, links: AbsorberSet, motion: ComplexArray, force: ComplexArray, strain: FloatArray, order: int
) -> float:
    """Return what leaving out the orders above one changes in the stress through the absorbers, relative, on the worst shell."""
    moved = np.einsum("abnk,bnk->ank", sampled.mobility(links, order), force)
    whole, beyond = sampled.motion(links), sampled.motion(links, order)
    share = np.sqrt(np.divide(beyond, whole, out=np.zeros_like(whole), where=whole > 0))
    change = each_alone(links, sampled.nodes, sampled.mobility(links), moved + motion * share)
    kept = np.where(sampled.orders <= order, sampled.weight, 0.0)
    part = sampled.norms(sampled.forced(links, change))[:, 1] @ kept
    total = strain @ sampled.weight
    return float(np.sqrt(np.divide(part, total, out=np.zeros_like(part), where=total > 1e-290)).max())


def resolve_modes(problem: Problem, grid: LaplaceGrid, settings: Settings, shared: SharedParts | None = None) -> tuple[int, list[str]]:
    """Return the number of modes asked for, chosen by the tolerance if "auto", and a warning if 2000 are not enough."""
    if settings.modes != "auto":
        return settings.modes, []
    order, remaining = choose_modes(problem, grid, settings.tolerance, shared)
    if remaining <= settings.tolerance:
        return order, []
    return order, [
        f'modes="auto": {order} orders, the most that are allowed, leave an estimated {remaining:.2g} of the stress, more than '
        f"the tolerance {settings.tolerance:g}; accept it or shorten the source's spectrum (a longer rise_time)"
    ]


def tolerance_missed(asked: Settings, order: int, estimates: Estimates, *, saturating: bool) -> list[str]:
    """Return a warning where a run by "auto" prints more than twice the error by its orders that was aimed at.

    Printed and chosen from are estimates alike, and with absorbers they differ.
    """
    if asked.modes != "auto":
        return []
    found = float(np.nan_to_num(estimates.modal_stress).max(initial=0.0))
    if found <= _MISSED * asked.tolerance:
        return []
    why = "; what saturating actuators change is not known before the run" if saturating else ""
    return [
        f'modes="auto" chose {order} orders, above which an estimated {found:.2g} of the stress is left, more than the tolerance '
        f"{asked.tolerance:g}{why}; give modes={min(2 * order, MAX_MODES)} and compare"
    ]
