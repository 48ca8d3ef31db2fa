"""Mutations of layers between electrodes and of feedback through them."""

from __future__ import annotations

from mutation import Mutation

WHERE = "structure/test_electrodes.py solver/test_control_by_electrodes.py"

ELECTRODES = (
    Mutation(
        "open-circuit-voltage",
        "structure/electrodes.py",
        "return -layer.thickness * around / layer.permittivity, ",
        "return -layer.thickness * around * layer.permittivity, ",
        "voltage of an open circuit: t e/mu",
        WHERE,
    ),
    Mutation(
        "mean-of-sensors",
        "structure/electrodes.py",
        "volts / len(sensors)",
        "volts",
        "the mean of the readings, not their sum",
        WHERE,
    ),
    Mutation(
        "driven-layers-are-short",
        "structure/electrodes.py",
        'if layer.role == "sensor"]',
        'if layer.role != "passive"]',
        "no open-circuit stiffening of a driven layer",
        WHERE,
    ),
    Mutation(
        "traction-of-electrodes",
        "structure/electroded_wall.py",
        "tangential = -(k.vw - law * (push.v * read.w)) / along",
        "tangential = -k.vw / along",
        "feedback drives V by what W reads",
        WHERE,
    ),
    Mutation(
        "pressure-of-v",
        "structure/electroded_wall.py",
        "(k.vw - law * (push.w * read.v)) * tangential",
        "(k.vw - law * (push.v * read.w)) * tangential",
        "feedback is not symmetric: W driven by what V reads",
        WHERE,
    ),
    Mutation(
        "rank-one",
        "solver/stability.py",
        "diagonal[i] - law * (pressure + self.along[i] * diagonal[i])",
        "diagonal[i] - law * pressure",
        "the determinant of V and W of walls with electrodes",
        WHERE,
    ),
    Mutation(
        "charging",
        "response/energy/electrodes.py",
        "held += 0.5 * capacitance",
        "held += capacitance",
        "energy in the field of a driven layer",
        "solver/test_control_by_electrodes.py",
    ),
    Mutation(
        "spill-over",
        "structure/segments.py",
        "weight = self.covered / self.count * np.where(orders == 0, 1.0, 2.0)",
        "weight = 1.0 / self.count * np.where(orders == 0, 1.0, 2.0)",
        "load of a segment that does not cover its share",
        "solver/test_segments.py",
    ),
    Mutation(
        "dead-segments",
        "solver/electrode_loops.py",
        "return found + times(inverse, np.einsum(",
        "return found - times(inverse, np.einsum(",
        "dead segments stay at ground",
        "solver/test_segments.py",
    ),
    Mutation(
        "complementary-minor",
        "solver/electrode_loops.py",
        "np.concatenate([each, np.linalg.det(self.between_dead(self.inverse))[None]])",
        "np.concatenate([each, np.ones_like(each[:1])])",
        "the determinant of live segments alone",
        "solver/test_segments.py",
    ),
    Mutation(
        "side-of-the-limit",
        "solver/limited_step.py",
        "sides[held] * limit[held]",
        "limit[held]",
        "voltages stop at both limits",
        "solver/test_limited_voltages.py",
    ),
    Mutation(
        "closed-loop-of-the-lack",
        "solver/limited_voltages.py",
        "given = free + times(loops.inverse, lacking)",
        "given = free + lacking",
        "what a lack of voltage changes in what is asked for",
        "solver/test_limited_voltages.py",
    ),
)
