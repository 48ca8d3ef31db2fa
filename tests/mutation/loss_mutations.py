"""The mutations of losses and of stresses through the wall."""

from __future__ import annotations

from mutation import Mutation

LOSSES = (
    Mutation(
        "prony-loss-modulus",
        "structure/losses.py",
        "(x - loss_factor * x * x) / (1.0 + x * x)",
        "(x + loss_factor * x * x) / (1.0 + x * x)",
        "the fit of a loss factor by springs and dampers",
        "structure/test_losses.py",
    ),
    Mutation(
        "rubber-volume",
        "structure/constituents.py",
        "PlaneStiffness(shear, -shear, shear, shear)",
        "PlaneStiffness(shear, shear, shear, shear)",
        "that the volume of a rubber does not relax",
        "structure/test_losses.py",
    ),
    Mutation(
        "heat-of-an-arm",
        "response/energy/shells.py",
        "2.0 / arm.time * stored",
        "1.0 / arm.time * stored",
        "what a damper turns into heat",
        "response/test_losses.py",
    ),
    Mutation(
        "relaxed-beyond-the-end",
        "response/relaxing.py",
        "(last + slope * steps",
        "(slope * steps",
        "how a history goes on where the relaxed modulus looks beyond its end",
        "response/test_losses.py",
    ),
    Mutation(
        "reach-of-a-stress",
        "response/depth_stress.py",
        "squares = hoop**2 + (axial - hoop) * axial",
        "squares = 0.25 * (hoop**2 + (axial - hoop) * axial)",
        "what the stress of an instant can reach, by which instants are left out",
        "response/test_wall_stress.py",
    ),
    Mutation(
        "weakest-layer",
        "response/wall_stress.py",
        "nearest = min(known",
        "nearest = max(known",
        "which layer comes nearest to its strength",
        "response/test_wall_stress.py",
    ),
    Mutation(
        "outer-face-of-a-layer",
        "structure/thin_wall.py",
        "else top - inside",
        "else top + inside",
        "that a layer's outer face is searched as its own",
        "response/test_wall_stress.py",
    ),
)
