"""The planes of the sea, backwards: what they send back is one more load, which the motion of the outermost wall makes.

With p that load, w the motion of the outermost face and slope that of the sources there, the rounds of reflections end at

    p = R e (s^2 w - slope - p/(d - e)),

R the sum over images, d and e of disc and exterior. If a unit of p changes a number by mu through the structure and X is read of w,

    lambda = mu(X + s^2 e R'lambda) - e/(d - e) R'lambda,

a series of as many rounds, each later by the same 2 (d - b) as forwards: a unit of p changes the number by lambda in all.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from coaxshell.acoustics.basis import RadialBasis
from coaxshell.errors import InputError
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.solver.adjoint.answer import Backwards, Reading, backwards
from coaxshell.solver.excitation import incident_on_surface
from coaxshell.solver.graf import causal_images, returned_load
from coaxshell.solver.reflections import sent_by
from coaxshell.solver.rounds import rounds
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.solver.spectral import map_node_blocks, node_blocks


def backwards_with_planes(solved: SolvedSpectra, reading: Reading) -> Backwards:
    """Return the answer backwards of a run, what surface and bottom sent back included.

    Raises
    ------
    InputError
        If the reflections were broken off before the end of the run.
    """
    planned = rounds(solved.problem, float(solved.grid.time[-1]))
    back = backwards(solved, reading)
    if not planned.done or solved.structure.returned is None:
        return back
    if planned.done < planned.needed:
        problem = f"{planned.needed} reflections are needed, of which {planned.done} were added up: the run is not exact to its end"
        raise InputError("duration", problem, f"use at most {planned.exact_until():.3g}, or planes further away")
    total: ComplexArray | None = None
    for _ in range(planned.done + 1):
        felt, own = _through_planes(solved, total)
        normal = reading.normal.copy()
        normal[-1] += felt
        back = backwards(solved, Reading(normal, reading.tangential))
        total = _per_load(solved, back) - own
    assert total is not None
    return replace(back, returned=total)


def _per_load(solved: SolvedSpectra, back: Backwards) -> ComplexArray:
    """Return mu, shape (parities, M + 1, nodes)."""
    structure, grid = solved.structure, solved.grid
    per_motion = back.reading.normal + structure.tangential_ratio[:, None] * back.reading.tangential
    if back.felt is not None:
        felt = grid.invert_transposed(back.felt.displacement) + grid.nodes * grid.invert_transposed(back.felt.velocity)
        per_motion[:, : felt.shape[1]] += felt
    leverage = solved.problem.shells[-1].leverage[1]
    return np.asarray(leverage * np.einsum("imk,ihmk->hmk", structure.compliance[:, -1], per_motion))


def _through_planes(solved: SolvedSpectra, total: ComplexArray | None) -> tuple[ComplexArray, ComplexArray]:
    """Return s^2 e R'lambda and e/(d - e) R'lambda."""
    structure, problem, grid, planes = solved.structure, solved.problem, solved.grid, solved.problem.planes
    felt, own = np.zeros((2, *solved.normal.shape[1:]), np.complex128)
    if total is None:
        return felt, own
    assert planes is not None
    images = causal_images(planes, problem.head, float(grid.time[-1]))

    def work(block: slice) -> None:
        surface = RadialBasis(structure.modes, grid.nodes[block])(1.0, problem.head)
        sent = surface.exterior * returned_load(total[..., block], surface, planes, images, transposed=True)
        felt[..., block] = grid.nodes[block] ** 2 * sent
        own[..., block] = sent / (surface.disc - surface.exterior)

    map_node_blocks(node_blocks(grid, structure.modes.max_order), work, None, "reflections backwards")
    return felt, own


def of_planes(solved: SolvedSpectra, back: Backwards, before: Problem, after: Problem) -> float:
    """Return what the number changes by with the planes, the head and the sources where these send waves back, the motion held."""
    if back.returned is None:
        return 0.0
    same = before.planes == after.planes and before.head == after.head and before.scales == after.scales
    if same and before.sources == after.sources and before.emitters == after.emitters:
        return 0.0
    radial, outer = RadialBasis(solved.modes, solved.grid.nodes), solved.face_motion.outer[-1]
    ends = [sent_by(one, solved.structure, outer, incident_on_surface(one, solved.grid, radial)[1]) for one in (before, after)]
    return float((back.returned * (ends[1] - ends[0])).sum().real)
