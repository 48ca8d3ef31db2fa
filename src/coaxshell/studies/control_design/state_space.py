"""A system without feedback as state-space models, one an order: what toolboxes of control theory work with; :func:`to_state_space`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Unpack

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.control import PDControl, Transducers
from coaxshell.model.loading import SystemLike, as_system
from coaxshell.model.places import shell_name
from coaxshell.model.units import to_si
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.vector_fitting import RationalFit, vector_fit
from coaxshell.solver.plant import Plant
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.settings import Settings, SettingsKeywords
from coaxshell.studies.control_design.fitted_orders import FittedOrders, OrderModel
from coaxshell.studies.control_design.lqg import LqgDesign, lqg

_NODES = 240
_RANK = 1e-7
"""Share of the largest singular value of a residue that counts."""
_MOST = 60


class StateSpaceModel(FittedOrders):
    """State-space models of a system without feedback, and the controllers that follow from them."""

    def lqg(self, effort: float = 0.1, noise: float = 0.01) -> LqgDesign:
        """Return the linear-quadratic-Gaussian controllers of all orders, judged on the true loop; see :mod:`.lqg`."""
        return lqg(self, effort, noise)


def to_state_space(
    system: SystemLike,
    *,
    orders: Iterable[int] = range(4),
    frequency: float | str,
    error: float = 1e-3,
    transducers: Transducers = "electrodes",
    shells: Any = "all",
    **keywords: Unpack[SettingsKeywords],
) -> StateSpaceModel:
    """Return state-space models of a system without feedback, one a circumferential order, truncated in frequency.

    Inputs are the voltages on the actuators of each controlled shell and the modal pressure outside, outputs what their sensors read and
    the hoop stress of their cores. Fluids that radiate have no finite model: rational functions with common stable poles are fitted on
    Re s = 1/duration up to a frequency, with as many poles as the error asks for, 60 at most; beyond, the model says nothing.

    Parameters
    ----------
    system : System, str or Path
    orders : iterable of int
    frequency : float or str
        Hz, or "5 kHz".
    error : float
        Largest difference over the largest value of each transfer function; what was reached stands in each model.
    transducers : str
        "electrodes" or "paper".
    shells : "all" or sequence
        Which are controlled.
    **keywords
        As to :func:`simulate`; ``duration`` counts.

    Raises
    ------
    InputError
        If an argument is not allowed, or a wall is one of elastic solids.
    """
    found = as_system(system)
    settings = Settings.asked(found, keywords)
    wanted = sorted(set(orders))
    if not wanted or any(isinstance(m, bool) or not isinstance(m, int | np.integer) or m < 0 for m in wanted):
        raise InputError("orders", f"{wanted!r} is not allowed", "give whole numbers from 0 on")
    try:
        hertz = to_si(frequency, "frequency")
    except InputError as refused:
        raise InputError("frequency", refused.problem, refused.remedy) from None
    if hertz <= 0.0 or not 0.0 < error < 1.0:
        name, value = ("frequency", hertz) if hertz <= 0.0 else ("error", error)
        raise InputError(name, f"{value:g} is not allowed", "must be above 0" + (" and below 1" if name == "error" else ""))
    under = found.replace(control=PDControl(proportional=0, derivative=0, transducers=transducers, shells=shells))
    problem = dimensionless(under, settings=settings)
    highest = 2.0 * np.pi * hertz * problem.scales.time
    s = 1.0 / settings.duration + 1j * highest * (np.arange(2 * _NODES + 1) / (2 * _NODES)) ** 1.3
    plant = Plant.of(problem, Modes(np.asarray(wanted, dtype=np.float64), sparse=len(wanted) < wanted[-1]), np.asarray(s))
    values = transfer_functions(plant)
    models = tuple(_fitted(int(m), plant.nodes, values[..., i, :], error, problem.scales.time) for i, m in enumerate(wanted))
    names = [shell_name(i, len(problem.shells)) for i in plant.shells]
    inputs = (*(f"{name} actuator" for name in names), "pressure outside")
    outputs = (*(f"{name} sensor" for name in names), *(f"{name} stress" for name in names))
    return StateSpaceModel(problem, settings, hertz, inputs, outputs, models)


def transfer_functions(plant: Plant) -> ComplexArray:
    """Return readings (V) and core stresses (Pa) per volt and per modal pressure outside (Pa), (outputs, inputs, orders, nodes)."""
    walls, pressure, last = plant.problem.shells, plant.problem.scales.pressure, len(plant.problem.shells) - 1
    rows = []
    for sensed in (True, False):
        for i in plant.shells:
            parts = [(None, walls[i].sensor_gain(plant.modes))] if sensed else list(walls[i].stress_parts(plant.modes))
            total: Any = 0.0
            for factor, gain in parts:
                outside = plant.per_load(i, gain, last) * (walls[last].leverage[1] / pressure)
                g = (1.0 if sensed else pressure) * (1.0 if factor is None else factor.at(plant.nodes))
                total = total + g * np.concatenate([plant.per_volt(i, gain), outside[None]])
            rows.append(total)
    return np.stack([np.asarray(row) for row in rows])


def _fitted(order: int, s: ComplexArray, values: ComplexArray, wanted: float, time: float) -> OrderModel:
    """Return the model of one order with as few poles as meet what is wanted between the nodes of the fit."""
    shape = values.shape[:2]
    functions = values.reshape(-1, s.size)
    there = np.abs(functions).max(axis=1) > 0.0  # order 0 has no curvature, which the paper's sensors read
    best: tuple[float, RationalFit] | None = None
    for count in range(4, _MOST + 1, 4):
        fit = vector_fit(s[::2], functions[there][:, ::2], count)
        off = np.abs(fit.at(s[1::2]) - functions[there][:, 1::2]).max(axis=1) / np.abs(functions[there]).max(axis=1)
        if best is None or off.max() < best[0]:
            best = float(off.max()), fit
        if off.max() < wanted:
            break
    assert best is not None
    error, fit = best
    residues, constant = np.zeros((functions.shape[0], fit.poles.size), np.complex128), np.zeros(functions.shape[0])
    residues[there], constant[there] = fit.residues, fit.constant
    a, b, c = _realised(fit.poles, residues.reshape(*shape, -1))
    return OrderModel(order, a / time, b / time, c, constant.reshape(shape), error)


def _realised(poles: ComplexArray, residues: ComplexArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return A, B and C of the sum of r/(s - p), each residue, (outputs, inputs), of as many states as it has rank."""
    scale_out, scale_in = (np.maximum(np.abs(residues).max(axis=axis), 1e-300) for axis in ((1, 2), (0, 2)))
    blocks, drives, shown = [], [], []
    for n, p in enumerate(poles):
        u, size, v = np.linalg.svd(residues[..., n] / scale_out[:, None] / scale_in)
        rank = max(1, int((size > _RANK * size[0]).sum()))
        root = np.sqrt(size[:rank])
        left, right = scale_out[:, None] * u[:, :rank] * root, (root[:, None] * v[:rank]) * scale_in
        if p.imag == 0.0:
            blocks.append(p.real * np.eye(rank))
            drives.append(right.real)
            shown.append(left.real)
            continue
        blocks.append(np.kron([[p.real, -p.imag], [p.imag, p.real]], np.eye(rank)))
        drives.append(np.concatenate([right.real, right.imag]))
        shown.append(2.0 * np.concatenate([left.real, -left.imag], axis=1))
    states = sum(len(x) for x in blocks)
    a, at = np.zeros((states, states)), 0
    for block in blocks:
        a[at : at + len(block), at : at + len(block)] = block
        at += len(block)
    return a, np.concatenate(drives), np.concatenate(shown, axis=1)
