"""Points that are as near as the farthest that a pair keeps, and the same a little apart."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import quasistatic_ref as qr
from quasistatic_ref import HalfSpace, PointCloud, Sphere
from quasistatic_ref.contact.distance import pair_closest_points
from quasistatic_ref.optional.derivatives.contact.couples import couples
from quasistatic_ref.optional.derivatives.contact.point_ties import tied_points
from quasistatic_ref.optional.derivatives.step import reason
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
    # Equal is what differs by at most TIED * size, or RANKED of the smaller shape: of a ball of
    # 0.2 m 2e-10 m, and of a floor and a cloud TIED of a size between 0.01 and 1 m.
    far = 10 * TIED
    for off, expected in ((far, False), (-far, False), (TIED * 0.01, True), (-TIED * 0.01, True)):
        near = cloud(solid, HEIGHTS + np.array([off, 0.0, 0.0, 0.0, 0.0]))
        assert (both(solid, near, 3) != ([], [])) == expected
    # Points 0 and 1 are kept, and one of 2 and 3, which are higher by `off`; the other is left out.
    for off, with_0 in ((far, False), (TIED * 0.01, True)):
        higher = cloud(solid, [0.03, 0.01, 0.03 + off, 0.03 + off, 0.04])
        kept, out = both(solid, higher, 3)
        assert out in ([2], [3])
        assert kept == [0] * with_0 + [5 - out[0]]


@pytest.mark.parametrize("shape", [qr.Box((0.05, 0.05, 0.05)), qr.Cylinder(0.05, 0.05)])
@pytest.mark.parametrize("k", [2, 3])
@pytest.mark.parametrize("turn", [0.0, 1e-10, 5e-10, 1e-9, 2e-9])
def test_gaps_at_the_edges_of_their_multiples_are_tied(shape, k, turn):
    """Where a rise of 1e-10 m changes which corners are contacts, there is no derivative by q."""
    body = qr.Body.of_shape("body", shape, mass=1.0, xyz=(0.0, 0.0, 0.05))
    scenario = qr.load_scenario({
        "h": 0.01,
        "steps": 1,
        "bodies": {"body": body},
        "shapes": {"floor": qr.HalfSpace((0, 0, 1), 0.0)},
        "contacts": {"floor": {"alpha": "floor", "beta": "body", "mu_v": 0.5, "rows": 4, "k": k}},
    })  # fmt: skip
    system, simulator = scenario.system, scenario.simulator()
    axis = np.array([0.0, 0.0, 0.0, 1.0, 0.3, 0.0])
    q = system.integrate(system.q_start, turn * axis)

    def chosen(rise):
        moved = system.integrate(q, rise * np.eye(6)[2])
        return sorted(simulator.closest_points(system.kinematics(moved)).point)

    rises = 1e-10 * np.linspace(-1.0, 1.0, 21)
    jumps = any(chosen(rise) != chosen(0.0) for rise in rises)
    tied = [why for why in qr.derivatives(simulator, q, []).reasons if why.kind == reason.POINTS]
    assert not jumps or tied
    assert tied or turn > 1e-9
