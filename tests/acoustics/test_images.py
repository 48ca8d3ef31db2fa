"""Mirror images in surface and bottom, and what they send back, against sums over points."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import iv, kv, kvp

from coaxshell.acoustics.images import Planes
from coaxshell.numerics.radial_functions import RadialFunctions
from coaxshell.solver.graf import returned_load

UP, HEAD, ORDER = 33.0, 0.97, 8
KAPPA = np.array([0.3 + 1.0j, 2.0 + 5.0j, 0.2 + 20.0j])


def test_one_plane_has_one_image_and_two_have_those_of_images() -> None:
    (surface,) = Planes(3.0, None).images(100.0)
    assert surface == (6.0, True, -1.0)
    assert surface.height(1.0) == 5.0
    (bottom,) = Planes(None, 2.0).images(100.0)
    assert bottom == (-4.0, True, 1.0)
    many = set(Planes(3.0, 2.0).images(14.0))
    assert {(6.0, True, -1.0), (-4.0, True, 1.0), (10.0, False, -1.0), (-10.0, False, -1.0), (-14.0, True, -1.0), (16.0, True, 1.0)} <= many
    for h in (-1.3, 0.4):  # the images of a point on a plane cancel the point, or double it
        heights = {round(image.height(h), 12): image.sign for image in Planes(3.0, 2.0).images(100.0)} | {h: 1.0}
        inner = {height: sign for height, sign in heights.items() if abs(height) < 60}
        assert all(heights[round(6.0 - height, 12)] == -sign for height, sign in inner.items())
        assert all(heights[round(-4.0 - height, 12)] == sign for height, sign in inner.items())


@pytest.mark.parametrize("planes", [Planes(1.7, None, UP), Planes(None, 1.4, UP), Planes(1.7, 1.4, UP)], ids=["surface", "bottom", "both"])
def test_what_comes_back_by_orders_is_what_images_show_at_points(planes: Planes) -> None:
    rng = np.random.default_rng(1)
    waves = rng.normal(size=(2, ORDER + 1, KAPPA.size)) + 1j * rng.normal(size=(2, ORDER + 1, KAPPA.size))
    waves[1, 0] = 0.0
    images = list(planes.images(12.0))
    found = returned_load(waves, RadialFunctions(KAPPA, HEAD, np.arange(ORDER + 1.0)), planes, images)
    theta = 2.0 * np.pi * np.arange(128) / 128
    up = np.radians(UP)
    h, s, m = HEAD * np.cos(theta - up), HEAD * np.sin(theta - up), np.arange(ORDER + 1)[:, None]
    for k, kappa in enumerate(KAPPA):
        shown = np.zeros(theta.size, np.complex128)
        for image in images:
            height = image.shift - h if image.mirrored else h - image.shift
            radius, angle = np.hypot(height, s), np.arctan2(s, height) + up
            spread = kv(m, kappa * radius) / kv(m, kappa * HEAD)
            shown += image.sign * (spread * (waves[0, :, k, None] * np.cos(m * angle) + waves[1, :, k, None] * np.sin(m * angle))).sum(
                axis=0
            )
        weight = np.where(m == 0, 1.0, 2.0) / theta.size
        modal = np.stack([(weight * np.cos(m * theta) * shown).sum(axis=1), (weight * np.sin(m * theta) * shown).sum(axis=1)])
        load = -modal / (kappa * HEAD * kvp(m[:, 0], kappa * HEAD) * iv(m[:, 0], kappa * HEAD))
        np.testing.assert_allclose(found[..., k], load, rtol=0, atol=1e-12 * np.abs(load).max())


def test_a_named_value_of_the_sum() -> None:
    """K_3(12) + K_1(12) = 5.442387699e-6: order 2 seen by order 1 from a surface at d = 3, kappa = 2."""
    surface = RadialFunctions(np.array([2.0 + 0j]), 1.0, np.arange(4.0))
    waves = np.zeros((1, 4, 1), np.complex128)
    waves[0, 2] = kv(2, 2.0)
    planes = Planes(3.0, None, 0.0)
    load = returned_load(waves, surface, planes, planes.images(9.0))[0, 1, 0]
    np.testing.assert_allclose(load * 2.0 * kvp(1, 2.0), 5.442387699e-6, rtol=1e-9)
