"""Mutations of rational control laws and of the proof that a loop is passive."""

from __future__ import annotations

from mutation import Mutation

WHERE = "solver/test_rational_feedback.py"
PROOF = "solver/test_passivity.py"

FEEDBACK = (
    Mutation(
        "law-delay",
        "structure/control_law.py",
        "law = law * np.exp(-self.delay * s)",
        "law = law * np.exp(self.delay * s)",
        "a law that answers late, not early",
        WHERE,
    ),
    Mutation(
        "law-in-transits",
        "structure/control_law.py",
        "tuple(a / time ** (len(x) - 1 - i)",
        "tuple(a * time ** (len(x) - 1 - i)",
        "coefficients in 1/s in units of transits",
        WHERE,
    ),
    Mutation(
        "law-corner",
        "model/feedback.py",
        "time = 1.0 / (6.283185307179586 * corner)",
        "time = 1.0 / corner",
        "a corner in Hz",
        "model/test_feedback.py",
    ),
    Mutation(
        "law-filter",
        "structure/control_law.py",
        "np.where(orders <= self.weights, 1.0, 0.0)",
        "np.where(orders < self.weights, 1.0, 0.0)",
        "the highest order that is fed back",
        WHERE,
    ),
    Mutation(
        "passive-all-along",
        "solver/passivity.py",
        "(resistance > _SURE * wall.mass * least).all(axis=1)",
        "(resistance > _SURE * wall.mass * least).any(axis=1)",
        "a wall is passive where it is so at all nodes",
        PROOF,
    ),
    Mutation(
        "passive-along-the-hoop",
        "structure/electroded_wall.py",
        "np.minimum(whole, np.where(modes.column == 0, np.inf, (along / s).real))",
        "np.minimum(-whole, np.where(modes.column == 0, np.inf, (along / s).real))",
        "a wall takes energy, not gives it",
        PROOF,
    ),
)
