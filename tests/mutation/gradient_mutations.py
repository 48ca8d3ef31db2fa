"""Mutations of gradients: the run backwards."""

from __future__ import annotations

from mutation import Mutation

GRADIENTS = (
    Mutation(
        "gradient-history",
        "solver/adjoint/backward.py",
        "known = loads[block] - points.project_transposed(ahead).T",
        "known = loads[block] + points.project_transposed(ahead).T",
        "what later forces take off a force at a step",
        "solver/test_adjoint.py",
    ),
    Mutation(
        "gradient-tangent",
        "solver/adjoint/answer.py",
        "tangent = linear + 3.0 * cubic * forward.stretch**2",
        "tangent = linear + cubic * forward.stretch**2",
        "slope of a cubic spring in the march backwards",
        "solver/test_adjoint.py",
    ),
    Mutation(
        "gradient-law-memory",
        "solver/adjoint/laws.py",
        "tape.alpha[n] = later.state * law + (later.state_state * alpha[:, None]).sum(axis=0)",
        "tape.alpha[n] = later.state * law",
        "what a law remembers, backwards",
        "solver/test_adjoint.py",
    ),
    Mutation(
        "gradient-law-rate",
        "solver/adjoint/laws.py",
        "self._psi = self._ahead + self._step * self._rise * law",
        "self._psi = self._step * self._rise * law",
        "what the rate over a step does to all stretches after it",
        "solver/test_adjoint.py",
    ),
    Mutation(
        "fit-clock",
        "studies/fitting/fitting.py",
        "-slope * one.size / self._noise[number]",
        "slope * one.size / self._noise[number]",
        "what a clock changes of its records",
        "studies/test_fit.py",
    ),
    Mutation(
        "fit-correlated-noise",
        "studies/fitting/certainty.py",
        "zip(rows, spread * correlated, strict=True)",
        "zip(rows, spread, strict=True)",
        "residuals that hang together say less",
        "studies/test_fit.py",
    ),
    Mutation(
        "fit-strain",
        "response/strain.py",
        "-per * (1.0 + bent * m**2)",
        "-per * (1.0 + bent * m)",
        "strain of a thin wall at a depth",
        "studies/test_fit.py",
    ),
    Mutation(
        "gradient-nodes",
        "solver/adjoint/nodes.py",
        "kappa = law_of.mass_displacement(first, second)",
        "kappa = law_of.mass_displacement(first, -second)",
        "the mass of a linear absorber, transposed",
        "solver/test_adjoint.py",
    ),
    Mutation(
        "gradient-weights",
        "solver/adjoint/structure.py",
        'matrix -= np.einsum("kimn,klmn,jlmn->ijmn", compliance, kernels, compliance, optimize=True)',
        "matrix -= 0.0 * matrix",
        "what step weights of the velocity kernels change with a wall",
        "solver/test_adjoint.py",
    ),
    Mutation(
        "gradient-mirror",
        "studies/gradients/sensitivity.py",
        "np.where(np.abs(turned) < 1e-6, 1.0, -1.0)",
        "np.where(np.abs(turned) < 1e-6, 1.0, 1.0)",
        "a mirror image turns the other way",
        "solver/test_adjoint.py",
    ),
    Mutation(
        "gradient-limits",
        "studies/optimisation/by_gradient.py",
        "slopes.append(scale * (exact / mean if mean else 1.0) * by * stretch)",
        "slopes.append(-scale * (exact / mean if mean else 1.0) * by * stretch)",
        "slope of a limit in a search by gradients",
        "studies/test_optimisation_methods.py",
    ),
    Mutation(
        "gradient-count",
        "numerics/laplace_grid.py",
        "counts = np.full(self.nodes.size, 2.0)",
        "counts = np.full(self.nodes.size, 1.0)",
        "nodes of a real transform stand for two",
        "solver/test_adjoint.py",
    ),
)
