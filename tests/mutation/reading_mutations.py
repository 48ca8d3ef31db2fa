"""The mutations of what is read of a finished run."""

from __future__ import annotations

from mutation import Mutation

READING = (
    Mutation(
        "shell-mass",
        "studies/reading.py",
        "math.pi * (outside**2 - inside**2)",
        "math.pi * (outside - inside) ** 2",
        "mass of a shell",
        "studies/test_metrics.py",
    ),
    Mutation(
        "metric-rms",
        "studies/reading.py",
        "np.trapezoid(values**2, time)",
        "np.trapezoid(values, time)",
        "RMS pressure over time in a study",
        "studies/test_metrics.py",
    ),
    Mutation(
        "reduction",
        "model/prefixes.py",
        "ratio = value / reference",
        "ratio = reference / value",
        "smaller or larger than which run",
        "model/test_prefixes.py",
    ),
    Mutation(
        "oscillator-blocks",
        "numerics/oscillators.py",
        "power - trace[:, None, None] * np.eye(2)",
        "power + trace[:, None, None] * np.eye(2)",
        "slow oscillators, looked at after several steps",
        "numerics/test_oscillators.py",
    ),
    Mutation(
        "oscillator-first-sample",
        "numerics/oscillators.py",
        "[-taps[0], row @ before - taps[1]]",
        "[0.0, 0.0]",
        "an acceleration that begins with a jump",
        "numerics/test_oscillators.py",
    ),
    Mutation(
        "mode-residue",
        "solver/mode_residues.py",
        "weight / mode.slope * (mode.left @ loads)",
        "weight * mode.slope * (mode.left @ loads)",
        "what a natural mode carries of a motion",
        "response/test_participation.py",
    ),
    Mutation(
        "link-stroke",
        "response/strokes.py",
        "masses.to_numpy()[n] - wall if",
        "masses.to_numpy()[n] + wall if",
        "stroke of an absorber relative to its shells",
        "response/test_absorbers.py",
    ),
)
