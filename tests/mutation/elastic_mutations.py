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
        "np.multiply(-y, scale, out=terms[..., 1])",
        "np.multiply(y, scale, out=terms[..., 1])",
        "sum over the shapes of a solid wall, its phase",
        "structure/test_elastic_solids.py",
    ),
    Mutation(
        "solid-stress-field",
        "structure/elastic_depth.py",
        "e[0] * phi_slope - (",
        "e[0] * phi_slope + (",
        "stress of a ceramic by the field along it",
        "solver/test_elastic_walls.py",
    ),
    Mutation(
        "solid-loads",
        "structure/elastic_wall.py",
        "pressed = -part.faces * np.array(self.wetted)",
        "pressed = -part.faces * self.radius",
        "loads on the faces of a solid wall act at their radii",
        "solver/test_elastic_walls.py",
    ),
    Mutation(
        "solid-points-of-a-layer",
        "structure/elastic_wall.py",
        "(0.0 if layer is self.layers[-1] else hair)",
        "(0.0 if layer is self.layers[-1] else -hair)",
        "that the last point of a layer is read as its own",
        "response/test_solid_wall_stress.py",
    ),
    Mutation(
        "solid-between-points",
        "response/solid_wall_stress.py",
        "max(place - 1, 0), min(place + 1",
        "place, min(place",
        "depths between the points of a layer are searched",
        "response/test_solid_wall_stress.py",
    ),
    Mutation(
        "solid-reach",
        "response/depth_stress.py",
        "squares = solid_von_mises(**parts) ** 2",
        "squares = 0.01 * solid_von_mises(**parts) ** 2",
        "what the stress of an instant can reach in a solid wall",
        "response/test_solid_wall_stress.py",
    ),
    Mutation(
        "solid-outer-face-radiates",
        "response/energy/work.py",
        "motion.solid.faces[1, -1]",
        "motion.solid.faces[0, -1]",
        "the outer face of an elastic wall radiates, not its inner one",
        "solver/test_elastic_walls.py",
    ),
    Mutation(
        "solid-far-shapes",
        "structure/elastic_basis.py",
        "np.where(far, -largest /",
        "np.where(far, largest /",
        "series of the shapes far above the nodes: alternating",
        "structure/test_elastic_solids.py",
    ),
)
