"""Bounds on the hull of a cloud, which spare forming it: never wrong, and open where close."""

import numpy as np
import pytest

from quasistatic_ref.optional.doctor.frame.hulls import (
    CloudHull,
    corners_of,
    holds,
    hull_of,
    surely_outside,
    volume_bounds,
)
from quasistatic_ref.shapes.box import Box
from quasistatic_ref.shapes.placed_shape import PlacedShape

CORNERS = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
CLOUDS = {
    "cube": CORNERS,
    "sheet of 1 x 1 x 0.001": CORNERS * [1, 1, 1e-3],
    "sheet of 1 x 1 x 1e-8": CORNERS * [1, 1, 1e-8],
    "tetrahedron": np.vstack([np.zeros(3), np.eye(3)]),
    "ball": np.random.default_rng(0).standard_normal((200, 3)),
    "far rod": np.random.default_rng(1).random((50, 3)) * [1, 0.01, 0.01] + [0, 5, 0],
}
FLAT = {
    "square": CORNERS[:4],
    "line": np.linspace(0, 1, 5)[:, None] * [1.0, 2.0, 3.0],
    "point": np.ones((1, 3)),
    "three points": np.eye(3),
}


@pytest.mark.parametrize("cloud", CLOUDS.values(), ids=CLOUDS)
def test_bounds_of_a_cloud_hold_for_its_hull(cloud):
    hull = CloudHull(cloud)
    assert hull.has_volume
    least, most = volume_bounds(hull)
    slack = 1 + 1e-9
    assert 0 < least <= hull.volume * slack <= most * slack**2
    points = cloud.mean(axis=0) + np.random.default_rng(2).standard_normal((300, 3)) * np.ptp(
        cloud, axis=0
    )
    inside = hull.signed_distance(points)[0] <= 1e-12
    assert all(inside[i] for i, point in enumerate(points) if hull.surely_holds(point))
    assert hull.surely_holds(hull.tetrahedra[0].mean(axis=0))


@pytest.mark.parametrize("cloud", FLAT.values(), ids=FLAT)
def test_a_cloud_in_a_plane_has_no_volume(cloud):
    assert not CloudHull(cloud).has_volume


def test_volumes_by_hand():
    """A diagonal of a unit cube and a corner, area 2^-0.5; corners are 2^-0.5 above and below."""
    cube = CloudHull(CORNERS)
    assert cube.volume == pytest.approx(1.0)
    assert volume_bounds(cube) == pytest.approx((1 / 3, 1.0))
    assert volume_bounds(Box((1, 2, 3))) == (48.0, 48.0)


def test_shapes_of_a_link_hold_points_as_their_hull_does():
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    placed = PlacedShape("cloud", 1, turn, [1.0, 2.0, 3.0], CloudHull(CLOUDS["ball"]))
    rng = np.random.default_rng(3)
    for point in placed.t + rng.standard_normal((50, 3)):
        seen = turn.T @ (point - placed.t)
        assert holds(placed, point) == (placed.shape.hull.signed_distance(seen[None])[0][0] <= 0)


@pytest.mark.parametrize("cloud", CLOUDS.values(), ids=CLOUDS)
def test_what_a_plane_separates_from_a_link_is_outside_of_its_hull(cloud):
    """And where a point is farther away than the hull is long, the plane is found."""
    placed = PlacedShape("cloud", 1, np.eye(3), [0.0, 0.0, 0.0], CloudHull(cloud))
    box = PlacedShape("box", 1, np.eye(3), cloud.mean(axis=0), Box((1e-3, 1e-3, 1e-3)))
    hull = hull_of([placed, box])
    points = cloud.mean(axis=0) + np.random.default_rng(4).standard_normal((200, 3)) * hull.extent
    outside = surely_outside(points, corners_of([placed, box]))
    away = hull.signed_distance(points)[0]
    assert (away[outside] > 0).all()
    assert outside[away > hull.extent].all()
    assert outside.any()
    assert surely_outside(points[:0], cloud).shape == (0,)
