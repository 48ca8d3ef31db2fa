"""The scattered field that the planes of the sea send back: that of its images, read where a point is seen from each of them.

With h the height and s the distance aside, an image at the shift D shows at (h, s) what the scattered wave itself is at (D - h, s) where it
is mirrored, else at (h - D, s), times its sign. Mirrored, a velocity changes its component along h.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from coaxshell.acoustics.images import Image, Planes
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.fields.request import reach
from coaxshell.solver.scaling import Problem


class Mirrored(NamedTuple):
    """Where the points of a field are seen from an image.

    Attributes
    ----------
    image : Image
    at : ndarray
        Positions of the points that it reaches, all in the water around the shells.
    radius, angle : ndarray
        Where the scattered wave is to be read for them, angles in degrees.
    """

    image: Image
    at: np.ndarray
    radius: FloatArray
    angle: FloatArray


def in_water(problem: Problem, radius: FloatArray, angle: FloatArray) -> np.ndarray:
    """Return which points are not above the surface of the sea nor within its bottom; angles in degrees."""
    if problem.planes is None:
        return np.ones(radius.shape, dtype=bool)
    turn = np.radians(angle)
    return problem.planes.in_water(radius * np.cos(turn), radius * np.sin(turn))


def mirrored(problem: Problem, radius: FloatArray, angle: FloatArray, times: FloatArray, resolution: float) -> Iterator[Mirrored]:
    """Yield what each image shows of the scattered wave at some points by the last of some instants; angles in degrees."""
    planes = problem.planes
    if planes is None:
        return
    around = np.flatnonzero((radius >= problem.head) & in_water(problem, radius, angle))
    if not around.size:
        return
    turn = np.radians(angle[around] - planes.up)
    h, s, most = radius[around] * np.cos(turn), radius[around] * np.sin(turn), reach(problem, times, resolution)
    for image in planes.images(most + float(np.abs(h).max())):
        height = image.shift - h if image.mirrored else h - image.shift
        far = np.hypot(height, s)
        seen = far <= most
        if seen.any():
            yield Mirrored(image, around[seen], far[seen], planes.up + np.degrees(np.arctan2(s, height))[seen])


def flow_back(planes: Planes, place: Mirrored, angle: FloatArray, flow: tuple[FloatArray, FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Return the radial and angular velocity at the points that an image makes of those where it is read, each (..., points)."""
    radial, angular = flow
    there = np.radians(place.angle - planes.up)
    along, aside = np.cos(there) * radial - np.sin(there) * angular, np.sin(there) * radial + np.cos(there) * angular
    along = -along if place.image.mirrored else along
    here = np.radians(angle[place.at] - planes.up)
    return np.cos(here) * along + np.sin(here) * aside, np.cos(here) * aside - np.sin(here) * along
