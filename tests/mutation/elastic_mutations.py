"""The mutations of elastic solids."""

from __future__ import annotations

from mutation import Mutation

ELASTIC = (
    Mutation(
        "solid-shear-of-radius-and-hoop",
        "structure/elastic_mesh.py",
        "found[:, RADIAL_HOOP, :, u_r] = -m * at / r",
        "found[:, RADIAL_HOOP, :, u_r] = m * at / r",
        "shear strain of a solid by u_r",
        "structure/test_elastic_solids.py",
    ),
    Mutation(
        "solid-shear-of-hoop-and-axis",
        "structure/elastic_mesh.py",
        "found[:, HOOP_AXIAL, :, u_z] = -m * at / r",
        "found[:, HOOP_AXIAL, :, u_z] = m * at / r",
        "shear strain of a solid between hoop and axis",
        "structure/test_elastic_solids.py",
    ),
    Mutation(
        "solid-lame-constant",
        "structure/solid.py",
        "2.0 * shear * material.poisson_ratio / (1.0 - 2.0 * material.poisson_ratio)",
        "2.0 * shear * material.poisson_ratio / (1.0 - material.poisson_ratio)",
        "Lame's first constant",
        "structure/test_elastic_solids.py",
    ),
    Mutation(
        "solid-potential",
        "structure/elastic_basis.py",
        "mu[0] * weights, slope)",
        "0.5 * mu[0] * weights, slope)",
        "permittivity across a piezoelectric solid",
        "structure/test_elastic_solids.py",
    ),
    Mutation(
        "solid-sums-imaginary",
        "structure/elastic_basis.py",
        "found[m].imag = -y * plain",
        "found[m].imag = y * plain",
        "sum over the shapes of a solid wall, its phase",
        "structure/test_elastic_solids.py",
    ),
)
