"""Stops beyond a clearance, with a coefficient of restitution.

Beyond the clearance a stop pushes back by k x (1 + a dx/dt), x the penetration, and never pulls (K. H. Hunt, F. R. E. Crossley, Coefficient
of restitution interpreted as damping in vibroimpact, J. Appl. Mech. 42 (1975) 440-445). A mass that strikes it at the speed v leaves at
e v, whatever the mass and the stiffness: m v dv = -k x (1 + a v) dx integrates to

    u - ln(1 + u) = -e u - ln(1 - e u),        u = a v,

so that a = u(e)/v with the speed v at which this contact began, which the law remembers.
"""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.links.law import LawSlopes, Links, StepForce, Truths
from coaxshell.solver.links.springs import mean_beyond

_NEARLY_ELASTIC = 1e-5
"""1 - e below which u is 3 (1 - e)/2, the limit of its equation, whose terms then cancel."""


def damping_number(restitution: float) -> float:
    """Return u = a v of a coefficient of restitution e, 0 < e <= 1."""
    from scipy.optimize import brentq

    loss = 1.0 - restitution
    if loss < _NEARLY_ELASTIC:
        return 1.5 * loss

    def excess(u: float) -> float:
        return float((1.0 + restitution) * u - np.log1p(u) + np.log1p(-restitution * u))

    # excess rises from 0 and falls to minus infinity at u = 1/e
    return float(brentq(excess, 0.5 * loss, (1.0 - 1e-15) / restitution, xtol=1e-15, rtol=1e-14))


class Stops:
    """Two stops at D = g and D = -g, with the force -+k x (1 + a dx/dt) of each, either of which may be missing.

    Parameters
    ----------
    links : ndarray of int, shape (n,)
    clearance : ndarray, shape (n,)
        g.
    stiffness : ndarray, shape (2, n)
        k of the stop at g and of that at -g, 0 where there is none.
    restitution : ndarray, shape (n,)
        e.
    time_step : float
    """

    variables = 3
    """v, the speed at which the present contact with either stop began, and the rate of the stretch over the step before."""
    swings = True
    _signs = np.array([[1.0], [-1.0]])

    def __init__(self, links: Links, clearance: FloatArray, stiffness: FloatArray, restitution: FloatArray, time_step: float) -> None:
        self.links, self._clearance, self._stiffness, self._step = links, clearance, stiffness, time_step
        self._damping = np.array([damping_number(float(e)) for e in restitution])

    def force(self, after: FloatArray, before: FloatArray, state: FloatArray) -> StepForce:
        """Return h and its slope."""
        end, start, change = self._beyond(after), self._beyond(before), self._signs * (after - before)
        mean, slope = mean_beyond(end, start, change)
        rate, held = change / self._step, start > 0.0
        speed = self._speed(held, rate, state)
        growth = np.divide(self._damping, speed, out=np.zeros_like(end), where=speed > 0.0)
        pushes = 1.0 + growth * rate > 0.0
        factor = np.where(pushes, 1.0 + growth * rate, 0.0)
        renewed = ~held & (speed == rate)  # then growth falls as the rate rises
        rise = slope * factor + np.where(pushes & ~renewed, mean * growth / self._step, 0.0)
        return StepForce((self._stiffness * self._signs * mean * factor).sum(axis=0), (self._stiffness * rise).sum(axis=0))

    def advance(self, after: FloatArray, before: FloatArray, state: FloatArray) -> FloatArray:
        """Return v of the contacts after a step, kept or new, 0 without contact, and the rate over the step."""
        rate = (after - before) / self._step
        speed = self._speed(self._beyond(before) > 0.0, self._signs * rate, state)
        return np.concatenate([np.where(self._beyond(after) > 0.0, speed, 0.0), rate[None]])

    def _speed(self, held: Truths, rate: FloatArray, state: FloatArray) -> FloatArray:
        """Return v: of a contact that begins the larger of the rates of this step, in which it slows down, and of the step before."""
        return np.where(held, state[:2], np.maximum(np.maximum(rate, self._signs * state[2]), 0.0))

    def stored(self, stretch: FloatArray, state: FloatArray) -> FloatArray:
        """Return k x^2/2."""
        return np.asarray((0.5 * self._stiffness * np.maximum(self._beyond(stretch), 0.0) ** 2).sum(axis=0))

    def slopes(self, after: FloatArray, before: FloatArray, state: FloatArray) -> LawSlopes:
        """Return the slopes of h, v and the rate; where a contact begins, those of the rate that gives v.

        With x the mean penetration, y = sigma D - g, and 1 + a r the factor, a = u/v:  dh = k sigma [(1 + a r) dx + x d(a r)].
        """
        end, start, change = self._beyond(after), self._beyond(before), self._signs * (after - before)
        mean, by_end = mean_beyond(end, start, change)
        by_start = mean_beyond(start, end, -change)[1]
        rate, held = change / self._step, start > 0.0
        speed = self._speed(held, rate, state)
        safe = np.where(speed > 0.0, speed, 1.0)
        growth = np.where(speed > 0.0, self._damping / safe, 0.0)
        pushes = 1.0 + growth * rate > 0.0
        factor = np.where(pushes, 1.0 + growth * rate, 0.0)
        by_rate = np.where(pushes, mean * growth, 0.0)  # of mean * factor
        by_speed = np.where(pushes & (speed > 0.0), -mean * growth * rate / safe, 0.0)
        earlier = self._signs * state[2]
        fresh = ~held & (speed > 0.0)
        of_rate, of_earlier = fresh & (rate >= earlier), fresh & (rate < earlier)  # what v is made of
        total_rate = by_rate + np.where(of_rate, by_speed, 0.0)
        per = self._stiffness
        rise = (per * (by_end * factor + total_rate / self._step)).sum(axis=0)
        fall = (per * (by_start * factor - total_rate / self._step)).sum(axis=0)
        signed = per * self._signs * by_speed
        of_state = np.stack([*np.where(held, signed, 0.0), (np.where(of_earlier, signed, 0.0) * self._signs).sum(axis=0)])
        stays = end > 0.0
        moved = np.concatenate([np.where(stays & of_rate, self._signs, 0.0), np.ones_like(after)[None]]) / self._step
        kept = np.zeros((3, 3, *after.shape))
        for side in (0, 1):
            kept[side, side] = stays[side] & held[side]
            kept[side, 2] = np.where(stays[side] & of_earlier[side], self._signs[side], 0.0)
        return LawSlopes(rise, fall, of_state, moved, -moved, kept)

    def _beyond(self, stretch: FloatArray) -> FloatArray:
        return np.asarray(self._signs * stretch - self._clearance)
