"""Mutations of fluids at the true faces of walls, and of walls whose faces move differently."""

from __future__ import annotations

from mutation import Mutation

WETTED = (
    Mutation(
        "continued-wavenumber",
        "numerics/modes.py",
        "np.sqrt(along - 1j * self.wavenumber) * np.sqrt(along + 1j * self.wavenumber)",
        "np.sqrt(along**2 + self.wavenumber**2 + 0j)",
        "kappa left of the imaginary axis: cuts leave its ends to the left",
        "response/test_natural_frequencies.py",
    ),
    Mutation(
        "continued-ratio",
        "numerics/bessel_ratios.py",
        "np.exp(np.abs(za.real) - np.abs(zb.real))",
        "np.exp(za.real - zb.real)",
        "I_m(za)/I_m(zb) left of the imaginary axis",
        "response/test_natural_frequencies.py",
    ),
    Mutation(
        "face-leverage",
        "structure/shell_model.py",
        "return inner / self.radius, outer / self.radius",
        "return 1.0, 1.0",
        "load on W per pressure on a true face: r/R",
        "solver/test_wetted_faces.py",
    ),
    Mutation(
        "face-of-a-gap",
        "solver/coupling.py",
        "problem.shells[j].wetted[int(j < i)]) for j in sides]",
        "problem.shells[j].wetted[int(j >= i)]) for j in sides]",
        "which face of a wall a fluid wets",
        "solver/test_wetted_faces.py",
    ),
    Mutation(
        "cascade-inside",
        "solver/cascade.py",
        "h.outer - h.back * h.across * (inner * zeta) / divisor",
        "h.outer - h.back * h.across * (outer * zeta) / divisor",
        "what lies within a wall with two faces, seen from outside",
        "solver/test_cascade.py",
    ),
    Mutation(
        "head-of-a-wave",
        "acoustics/sources/plane.py",
        "-modes.neumann / self.head * _inverse_k(surface)",
        "-modes.neumann * _inverse_k(surface)",
        "load of a plane wave on a face of another radius than 1",
        "solver/test_wetted_faces.py",
    ),
    Mutation(
        "fluids-resistance",
        "solver/kernels.py",
        "return sum(fluid.density / fluid.slowness * leverage for",
        "return sum(fluid.density / fluid.slowness / leverage for",
        "how fluids on true faces slow a wall at once",
        "solver/test_wetted_faces.py",
    ),
    Mutation(
        "energy-of-a-face",
        "response/energy/parts.py",
        "motion.problem.head * motion.circle",
        "motion.problem.shells[-1].radius * motion.circle",
        "work of the exterior pressure on the outermost face",
        "solver/test_wetted_faces.py",
    ),
    Mutation(
        "pressure-within-a-wall",
        "response/fields/request.py",
        "(radius <= region.outer) if wall_follows else (radius < region.outer)",
        "(radius <= 1.2 * region.outer) if wall_follows else (radius < region.outer)",
        "which points lie in a wall between wetted faces",
        "response/test_wetted_fields.py",
    ),
    Mutation(
        "gap-between-faces",
        "solver/wetted_surfaces.py",
        "true = true_faces(beyond)[0] - true_faces(within)[1]",
        "true = true_faces(beyond)[1] - true_faces(within)[0]",
        "by which part a gap between mid-surfaces is too wide",
        "solver/test_wetted_faces.py",
    ),
)
