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
    Mutation(
        "plant-traction",
        "solver/plant.py",
        "if j == shell:",
        "if False:",
        "a volt moves the wall along itself too",
        "studies/test_control_design.py",
    ),
    Mutation(
        "bench-own-field",
        "studies/control_design/bench.py",
        "one.own * volts[place]",
        "0.0 * volts[place]",
        "an actuator's stress holds that of its own field",
        "studies/test_control_design.py",
    ),
    Mutation(
        "mirrored-poles",
        "numerics/vector_fitting.py",
        "found = np.where(found.real > 0.0, -found.conj(), found)",
        "found = np.where(found.real > 0.0, -found.conj(), 1.01 * found)",
        "the zeros of sigma are the poles",
        "studies/test_state_space.py",
    ),
    Mutation(
        "estimated-drive",
        "studies/control_design/lqg.py",
        "a = order.a - push @ state - estimate @ read + estimate @ through @ state",
        "a = order.a + push @ state - estimate @ read + estimate @ through @ state",
        "the filter knows what the controller does",
        "studies/test_state_space.py",
    ),
    Mutation(
        "charge-of-condenser",
        "response/electrical.py",
        "moved.columns.w * w + capacitance * voltage",
        "moved.columns.w * w",
        "a driven layer is a condenser",
        "response/test_control_effort.py",
    ),
    Mutation(
        "loops-together",
        "solver/margins.py",
        "np.vander(places, len(shells) + 1, increasing=True)[:, 1:]",
        "np.vander(places, len(shells) + 1, increasing=True)[:, :-1]",
        "a polynomial in the common factor, from where it was evaluated",
        "solver/test_several_laws.py",
    ),
    Mutation(
        "matrix-of-shells",
        "solver/electrode_loops.py",
        "sum(shares[a, c] * answered[c, b]",
        "sum(shares[c, a] * answered[c, b]",
        "rows of a matrix are what actuators answer",
        "solver/test_matrix_feedback.py",
    ),
    Mutation(
        "passive-matrix",
        "solver/tied_stability.py",
        "factors.append(-factor * wall.radius)",
        "factors.append(-factor)",
        "power of a wall is that of its whole circumference",
        "solver/test_matrix_feedback.py",
    ),
    Mutation(
        "charge-of-a-lack",
        "solver/limited_currents.py",
        "inverse - np.eye(inverse.shape[-1]) + strained @ inverse",
        "inverse - np.eye(inverse.shape[-1])",
        "a lack of voltage moves charge by the strain that it makes too",
        "solver/test_limited_currents.py",
    ),
    Mutation(
        "sign-of-a-bridge",
        "model/feedback.py",
        "tuple(b - through * a for",
        "tuple(b + through * a for",
        "more capacitance than the layer's lets its voltage through with its own sign",
        "solver/test_bridge.py",
    ),
)
