"""Bodies in penetration with two ways out that are equally short, and the same a little apart."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Sphere,
    convex_hull,
)
from quasistatic_ref.contact.distance import pair_closest_points
from quasistatic_ref.optional.derivatives.contact.couples import couples
from quasistatic_ref.optional.derivatives.contact.depth_ties import depth_tie
from quasistatic_ref.optional.derivatives.tolerances import TIED
from tests.contact.still import pair, placed_shape
from tests.optional.derivatives.free_bodies import POINT

TURNED = Rotation.from_euler("xyz", [0.3, -0.7, 1.1]).as_matrix()
AT = np.array([0.5, -0.4, 0.3])
STILL = np.eye(3), np.zeros(3)
AWAY = 1e-6
"""[m], beyond TIED of any size here."""

D, C, S = 0.03, 0.6, 0.8  # a depth [m], a cosine and its sine
BOX = Box((0.1, 0.2, 0.3))
TALL = Cylinder(0.1, 0.2)
FLAT = Cylinder(0.3, 0.1)
CONE = Cone(0.3, 0.1)
# The side of a cone is D deep where (R - r) 2 l - (z + l) R = D |(R, 2 l)|; here z + l = D.
CONE_R = 0.3 - D * (0.3 + np.hypot(0.3, 0.2)) / 0.2
TETRAHEDRON = convex_hull([[0, 0, 0], [0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.2]])
WIDE = Ellipsoid((0.3, 0.2, 0.1))
# Circles that touch an ellipsoid above and below its shortest axis c, within its section, have
# their centres within the ellipse of half-axes (a^2 - c^2) / a and (b^2 - c^2) / b.
END = (0.3**2 - 0.1**2) / 0.3
TIES = {
    "two faces of a box": (BOX, (0.1 - D, D - 0.2, 0.05), (1, 0, 0)),
    "side and top of a cylinder": (TALL, (C * (0.1 - D), S * (0.1 - D), 0.2 - D), (0, 0, 1)),
    "top and bottom of a cylinder": (FLAT, (0.05, -0.02, 0.0), (0, 0, 1)),
    "side and base of a cone": (CONE, (C * CONE_R, S * CONE_R, D - 0.1), (C, S, 0)),
    "two faces of a mesh": (TETRAHEDRON, (0.02, 0.02, 0.06), (1, 0, 0)),
    "two sides of an ellipsoid": (WIDE, (0.1, 0.05, 0.0), (0, 0, 1)),
    "the middle of a long ellipsoid": (Ellipsoid((0.3, 0.1, 0.1)), (0, 0, 0), (1, 0, 0)),
}
"""A solid, a point as deep below two parts of its surface, and a way to where it is not [-]."""

NO_TIES = {
    "beyond the rim of a cone, as far": (CONE, (0.3 + 2 * (0.3 - CONE_R), 0.0, -0.1 - 2 * D)),
    "beyond where two sides of an ellipsoid tie": (WIDE, (1.01 * END, 0.0, 0.0)),
    "off the middle of a long ellipsoid": (Ellipsoid((0.3, 0.1, 0.1)), (0.05, 0, 0)),
}
"""A solid and a point with one nearest point, or with none below the surface."""


NEAR = 0.1 * TIED
"""Share of the size that is a tie of depths, and no tie that only a rule could decide."""


def couple_of(alpha, beta, a, b):
    """The contact of two shapes at poses (R, t), at their closest points."""
    p = pair(placed_shape(alpha, 1), placed_shape(beta, 2))
    R, t = (np.array([x, y, z]) for x, y, z in zip(STILL, a, b, strict=True))
    (couple,) = couples([p], pair_closest_points(p, R, t), R, t)
    return couple


def tied(alpha, beta, a=STILL, b=STILL):
    """Whether they have two ways out."""
    return depth_tie(couple_of(alpha, beta, a, b))


def inside(solid, p, body, pose):
    """The same of a body whose middle is at p in the frame of a solid, either one first."""
    R, t = pose
    there = np.eye(3), R @ np.array(p, dtype=float) + t
    solid_first = tied(solid, body, pose, there)
    assert tied(body, solid, there, pose) == solid_first
    return solid_first


@pytest.mark.parametrize("name", TIES)
def test_a_point_with_two_nearest_points_of_a_solid_is_tied(name):
    solid, p, way = TIES[name]
    near = p + NEAR * solid.extent * np.array(way)
    assert inside(solid, near, POINT, (TURNED, AT))
    assert inside(solid, near, Sphere(0.01), (TURNED, AT))
    for off in (0.75 * TIED / solid.extent, -AWAY):
        assert not inside(solid, p + off * np.array(way), POINT, (TURNED, AT))


@pytest.mark.parametrize("name", NO_TIES)
def test_a_point_outside_of_a_solid_or_near_one_part_is_not_tied(name):
    solid, p = NO_TIES[name]
    assert not inside(solid, p, POINT, STILL)


B = Box((0.2, 0.2, 0.2))
LOG = Cylinder(0.2, 0.2)
LONG = Capsule(0.05, 0.2)
PAIRS = {
    "two boxes": (BOX, B, (0.3 - D, 0.4 - D, 0.1)),
    "two upright cylinders": (LOG, LOG, (0.4 - D, 0.0, 0.4 - D)),
    # The axis of the capsule is D deep: its side and its lower end leave by as much.
    "a box and a capsule": (B, LONG, (0.2 - D, 0.02, 0.4 - D)),
}
"""Two solids with axes alike, and where the second is: as deep along x and along y or z [m]."""


@pytest.mark.parametrize("name", PAIRS)
def test_two_solids_as_deep_in_each_other_along_two_axes_are_tied(name):
    a, b, t = PAIRS[name]
    way = np.eye(3)[0]
    size = max(a.extent, b.extent)
    near = np.array(t) + NEAR * size * way
    assert tied(a, b, (TURNED, AT), (TURNED, TURNED @ near + AT))
    for off in (0.75 * TIED / size, -AWAY):
        moved = TURNED @ (np.array(t) + off * way) + AT
        assert not tied(a, b, (TURNED, AT), (TURNED, moved))


# Its two upper faces fall by atan(0.1) from the ridge, an angle within FACING.
ROOF = convex_hull(
    [[x, y, z] for y in (-0.1, 0.1) for x, z in ((-0.1, -0.1), (0.1, -0.1), (-0.1, -0.01),
                                                 (0.1, -0.01), (0, 0))]
)  # fmt: skip


@pytest.mark.parametrize("side", [0, 1])
def test_a_corner_is_tied_between_faces_that_face_the_pair_s(side):
    """It is below a ridge, and by as much below either face; n is up from the roof, or down to it.

    If n were opposite, the one face would count that is level.
    """
    shapes = (ROOF, BOX) if side == 0 else (BOX, ROOF)
    couple = couple_of(*shapes, STILL, (np.eye(3), np.eye(3)[0]))
    corner = couple.of.bodies[side].t + np.array([0.0, 0.03, -0.02])
    n = np.array([0.0, 0.0, 1.0 if side == 0 else -1.0])
    assert depth_tie(couple._replace(n=n, centre=(side, corner)))
    assert not depth_tie(couple._replace(n=-n, centre=(side, corner)))


def test_capsules_are_tied_where_their_axes_cross():
    # The capsules are apart where their axes are by more than 0.05 + 0.03. Equal is what differs by
    # at most TIED * extent; the extent is 0.5.
    a = Capsule(0.05, 0.2)
    b = Capsule(0.03, 0.2)
    across = TURNED @ Rotation.from_euler("x", 1.0).as_matrix()
    near = NEAR * a.extent
    for off in (near, 0.75 * TIED / a.extent, AWAY, 0.07, 0.09):
        there = across, AT + TURNED[:, 0] * off
        assert tied(a, b, (TURNED, AT), there) == (off == near)


def test_ellipsoids_that_leave_each_other_to_either_side_are_tied():
    """Both ways are mirrored in the plane y = 0 and along no axis; off it one is shorter."""
    narrow = Ellipsoid((0.25, 0.12, 0.4))
    wide = Ellipsoid((0.3, 0.1, 0.4))
    for off, expected in ((NEAR * wide.extent, True), (AWAY, False)):
        there = np.eye(3), np.array([0.05, off, 0.0])
        assert tied(wide, narrow, STILL, there) == expected
