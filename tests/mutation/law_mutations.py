"""The mutations of laws of links."""

from __future__ import annotations

from mutation import Mutation

LAWS = (
    Mutation(
        "lattice-classes",
        "solver/interface/lattice.py",
        "shares[of_order, orders] = beta[of_order] / beta",
        "shares[of_order, orders] = 1.0",
        "share of an order in its class on a lattice",
        "solver/test_seen.py solver/test_line_absorbers.py",
    ),
    Mutation(
        "lattice-surfaces",
        "solver/interface/seen.py",
        "(self._lattice, held, *(",
        "(self._lattice, *(",
        "kernels of a lattice between some shells are not those between others",
        "solver/test_seen.py",
    ),
    Mutation(
        "lattice-kernels",
        "solver/kernels.py",
        "weights + of_kind @ exponential_weights(decays[:, None], grid) if leads else weights",
        "weights",
        "kernels combined before they are inverted: their leading term",
        "solver/test_seen.py",
    ),
    Mutation(
        "many-linear-motion",
        "solver/interface/linear_many.py",
        "bare + spread.moved(_times(answer, pressure))",
        "bare - spread.moved(_times(answer, pressure))",
        "what the forces of many linear absorbers do to the walls: sign",
        "solver/test_many_linear_absorbers.py",
    ),
    Mutation(
        "many-linear-around",
        "solver/interface/linear_around.py",
        "other * (roots[1 - i] / root)",
        "other",
        "many linear absorbers as functions of the angle: radii of the two walls",
        "solver/test_many_linear_absorbers.py",
    ),
    Mutation(
        "ring-march-springs",
        "solver/interface/ring_march.py",
        "new = known + _by_class(rows, nonlinear)",
        "new = known - _by_class(rows, nonlinear)",
        "a ring marched by classes: what the springs' own forces move",
        "solver/test_ring_march.py",
    ),
    Mutation(
        "law-discrete-gradient",
        "solver/links/springs.py",
        "value = value + coefficient / (k + 1) * mixed",
        "value = value + coefficient / k * mixed",
        "the force of a polynomial spring over a step",
        "solver/test_link_laws.py",
    ),
    Mutation(
        "law-restitution",
        "solver/links/stops.py",
        "(1.0 + restitution) * u - np.log1p(u)",
        "(1.0 + restitution) * u - 0.9 * np.log1p(u)",
        "the damping of a stop from its restitution",
        "solver/test_link_laws.py",
    ),
    Mutation(
        "law-dry-friction",
        "solver/links/friction.py",
        "limit = np.where(state[1] > 0.0, self._kinetic, self._static)",
        "limit = np.where(state[1] > 0.0, self._static, self._kinetic)",
        "what holds once friction slips",
        "solver/test_link_laws.py",
    ),
    Mutation(
        "law-middles",
        "solver/links/histories.py",
        "np.exp(0.5 * grid.time_step * grid.nodes)",
        "np.exp(-0.5 * grid.time_step * grid.nodes)",
        "when the force of a step acts",
        "solver/test_laws_of_absorbers.py",
    ),
    Mutation(
        "law-other-side",
        "solver/interface/absorbers.py",
        "-inner * shares[1], *shares)",
        "-inner * shares[0], *shares)",
        "what one side of an unequal absorber does to the other",
        "solver/test_laws_of_absorbers.py",
    ),
)
