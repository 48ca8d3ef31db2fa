"""Central lines of answers at given frequencies and how to break them."""

from __future__ import annotations

from mutation import Mutation

STEADY = (
    Mutation(
        "rigid-scattering-of-steady-waves",
        "solver/steady.py",
        "load = pressure - self.radial(1.0, self.problem.head).exterior * slope",
        "load = pressure + 0.0 * self.radial(1.0, self.problem.head).exterior * slope",
        "what a rigid surface scatters in the load of a steady wave",
        "response/test_frequency_response.py",
    ),
    Mutation(
        "form-function-from-the-axis",
        "response/frequency/fields.py",
        "np.exp(2.0 * surface.argument)",
        "np.exp(1.0 * surface.argument)",
        "the phase of the form function is that of the wave on the axis",
        "response/test_frequency_response.py",
    ),
    Mutation(
        "mean-square-by-Lommel",
        "response/frequency/fields.py",
        "sign * (r**2 * np.abs(slope) ** 2 + (k2 * r**2 - m**2) * np.abs(p) ** 2)",
        "sign * (r**2 * np.abs(slope) ** 2 + (k2 * r**2 + m**2) * np.abs(p) ** 2)",
        "mean square pressure of a fluid within the shells",
        "response/test_frequency_response.py",
    ),
    Mutation(
        "line-force-on-its-circle",
        "solver/steady.py",
        "circle = np.pi * (wall.radius if side is None else wall.wetted[1])",
        "circle = np.pi * (1.0 if side is None else wall.wetted[1])",
        "share of a line force that each order gets",
        "response/test_frequency_response.py",
    ),
    Mutation(
        "wavenumbers-of-a-point-source",
        "response/frequency/along.py",
        "along = 2.0 / np.pi * path.weights * np.cos(path.wavenumbers * away)",
        "along = 2.0 / np.pi * path.weights",
        "the phase of each wavenumber along the axis",
        "response/test_frequency_response.py",
    ),
    Mutation(
        "mean-power-of-a-band",
        "studies/steady_metrics.py",
        'sign = -1.0 if name == "transmission_loss" else 1.0',
        "sign = 1.0",
        "losses average what comes through",
        "studies/test_metrics.py",
    ),
)
