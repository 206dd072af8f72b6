"""Points that are as near as the farthest that a pair keeps, and the same a little apart."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import HalfSpace, PointCloud, Sphere
from quasistatic_ref.contact.distance import pair_closest_points
from quasistatic_ref.optional.derivatives.contact.couples import couples
from quasistatic_ref.optional.derivatives.contact.point_ties import tied_points
from quasistatic_ref.tolerances import TIED
from tests.contact.still import pair, placed_shape

TURNED = Rotation.from_euler("xyz", [0.3, -0.7, 1.1]).as_matrix()
AT = np.array([0.5, -0.4, 0.3])
FLOOR = HalfSpace((0.0, 0.0, 1.0), 0.0)
BALL = Sphere(0.1)
HEIGHTS = np.array([0.03, 0.01, 0.02, 0.03, 0.04])
"""Points 0 and 3 are level: of three that are kept, one is left out that is as near."""


def ties(alpha, beta, k, poses):
    p = pair(placed_shape(alpha, 1), placed_shape(beta, 2), k)
    R = np.array([np.eye(3), poses[0][0], poses[1][0]])
    t = np.array([np.zeros(3), poses[0][1], poses[1][1]])
    points = pair_closest_points(p, R, t)
    return tied_points(couples([p], points, R, t), points)


def both(solid, body, k):
    """Of a body whose points are given in the frame of a solid that is turned; either one first.

    The body's own frame is a tenth of a metre to the side.
    """
    side = np.array([0.1, 0.0, 0.0])
    poses = (TURNED, AT), (TURNED, AT + TURNED @ side)
    shifted = PointCloud(body.points - side) if isinstance(body, PointCloud) else body
    found = ties(solid, shifted, k, poses)
    assert ties(shifted, solid, k, poses[::-1]) == found
    return found


def cloud(solid, heights):
    """Points at given heights above a solid, in its frame; 0.06 m across above the floor."""
    angle = 2.4 * np.arange(len(heights))
    across = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    if solid is FLOOR:
        return PointCloud(0.03 * across + np.outer(heights, [0.0, 0.0, 1.0]))
    return PointCloud((0.1 + np.array(heights))[:, None] * across)


@pytest.mark.parametrize("solid", [FLOOR, BALL])
def test_a_point_as_near_as_the_farthest_that_is_kept_is_tied(solid):
    kept, out = both(solid, cloud(solid, HEIGHTS), 3)
    assert sorted(kept + out) == [0, 3]
    assert len(kept) == 1
    for k in (1, 2, 4, 5, 6):
        assert both(solid, cloud(solid, HEIGHTS), k) == ([], [])


@pytest.mark.parametrize("solid", [FLOOR, BALL])
def test_points_are_tied_within_a_share_of_the_size(solid):
    # Equal is what differs by at most TIED * size, and the size is between 0.01 and 1 m here.
    for off, expected in ((TIED, False), (-TIED, False), (TIED * 0.01, True), (-TIED * 0.01, True)):
        near = cloud(solid, HEIGHTS + np.array([off, 0.0, 0.0, 0.0, 0.0]))
        assert (both(solid, near, 3) != ([], [])) == expected
    # Points 0 and 1 are kept, and one of 2 and 3, which are higher by `off`; the other is left out.
    for off, with_0 in ((TIED, False), (TIED * 0.01, True)):
        higher = cloud(solid, [0.03, 0.01, 0.03 + off, 0.03 + off, 0.04])
        kept, out = both(solid, higher, 3)
        assert out in ([2], [3])
        assert kept == [0] * with_0 + [5 - out[0]]
