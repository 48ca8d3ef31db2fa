"""Mutations of the sea: images, and what the planes send back."""

from __future__ import annotations

from mutation import Mutation

SEA = (
    Mutation(
        "image-sign",
        "acoustics/images.py",
        "yield Image(2.0 * self.surface, True, -1.0)",
        "yield Image(2.0 * self.surface, True, 1.0)",
        "a surface releases the pressure",
        "acoustics/test_images.py",
    ),
    Mutation(
        "image-spread",
        "solver/emitters.py",
        "image.sign * start / away",
        "image.sign",
        "an image is further away: its wave is weaker at its own head",
        "solver/test_sea.py",
    ),
    Mutation(
        "graf-order-zero",
        "solver/graf.py",
        "np.where(m == 0.0, 0.5, 1.0)",
        "np.where(m == 0.0, 1.0, 1.0)",
        "order 0 of what comes back counts once",
        "acoustics/test_images.py",
    ),
    Mutation(
        "sent-back-slope",
        "solver/reflections.py",
        "leaving -= structure.returned",
        "leaving += structure.returned",
        "what came back before is scattered again",
        "solver/test_sea.py",
    ),
    Mutation(
        "weight-of-the-water",
        "model/sea.py",
        "weight * (self.depth - height)",
        "weight * (self.depth + height)",
        "water higher up stands under less",
        "model/test_sea.py",
    ),
    Mutation(
        "bubble-gas",
        "model/bubble.py",
        "change = -3.0 * EXPONENT",
        "change = 3.0 * EXPONENT",
        "a collapsing bubble loses energy by radiation",
        "model/test_bubble.py",
    ),
    Mutation(
        "mirrored-flow",
        "response/fields/mirrored.py",
        "along = -along if place.image.mirrored else along",
        "along = along if place.image.mirrored else along",
        "a mirrored velocity changes its component along the height",
        "response/test_sea_fields.py",
    ),
)
