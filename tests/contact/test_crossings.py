"""Bodies on the edges of others: borne where edges, rims and lines of contact cross."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import Box, Capsule, Cone, Cylinder
from quasistatic_ref.contact.crossings import crossings
from tests.cases import cases
from tests.closeness import assert_within
from tests.contact.still import in_world
from tests.oracles.bodies_by_hand import BOX, HALF, UP, Scene, hull, wrong_words
from tests.tolerances import ROUNDING

STRAIGHT = np.eye(3)
HULL = hull(HALF)
TABLE = Box((0.2, 0.2, 0.01))
RAIL = Box((0.02, 0.2, 0.01))
BOOK = Box((0.1, 0.07, 0.01))
PUCK = Cylinder(0.07, 0.01)
LOG = Cylinder(0.03, 0.1)
CAPSULE = Capsule(0.03, 0.1)
SPIRE = Cone(0.03, 0.1)
AN_EIGHTH = Rotation.from_rotvec(np.pi / 4 * UP).as_matrix()
ALONG_X = Rotation.from_rotvec([0.0, np.pi / 2, 0.0]).as_matrix()
ON_EDGE = Rotation.from_rotvec([np.pi / 4, 0.0, 0.0]).as_matrix()
SLANT = np.arctan2(0.03, 0.2)
ON_SIDE = Rotation.from_rotvec([0.0, np.pi / 2 + SLANT, 0.0]).as_matrix()
RESTING = {
    # A fixed body whose top is at z = 0.01, another, how that is turned, its place, the least k.
    "a book over an edge": (TABLE, BOOK, STRAIGHT, (0.19, 0.0, 0.02), 4),
    "a turned box on its like": (TABLE, TABLE, AN_EIGHTH, (0.0, 0.0, 0.02), 8),
    "a hull over an edge": (TABLE, HULL, STRAIGHT, (0.19, 0.02, 0.06), 4),
    "a puck over an edge": (TABLE, PUCK, STRAIGHT, (0.19, 0.0, 0.02), 4),
    "a cone over an edge": (TABLE, Cone(0.07, 0.01), STRAIGHT, (0.19, 0.0, 0.02), 4),
    "a puck on a puck": (PUCK, Cylinder(0.05, 0.01), STRAIGHT, (0.04, 0.0, 0.02), 4),
    "a box on a puck": (PUCK, BOX, STRAIGHT, (0.03, 0.04, 0.06), 4),
    "a capsule on a rail": (RAIL, CAPSULE, ALONG_X, (0.01, 0.0, 0.04), 2),
    "a capsule over an edge": (TABLE, CAPSULE, ALONG_X, (0.19, 0.0, 0.04), 2),
    "a log on a rail": (RAIL, LOG, ALONG_X, (0.01, 0.0, 0.04), 2),
    "a log on a puck": (PUCK, LOG, ALONG_X, (0.02, 0.01, 0.04), 2),
    "a box on its edge": (RAIL, BOX, ON_EDGE, (0.01, 0.0, 0.01 + np.sqrt(2) * HALF), 2),
    "a cone on its side": (RAIL, SPIRE, ON_SIDE, (0.0, 0.0, 0.01 + 0.015 * np.cos(SLANT)), 2),
}


@cases("low, top, R, place, least", RESTING)
def test_a_body_whose_centre_is_over_what_touches_rests(low, top, R, place, least):
    """It does not move, and is borne by its weight, whichever is alpha and for every k."""
    bodies = [(top, R, np.array(place)), (low, STRAIGHT, np.zeros(3))]
    for normals in ({(1, 0): UP}, {(0, 1): -UP}):
        scene = Scene(bodies, normals, np.zeros((1, 6)))
        assert [wrong_words(scene, k, 0.5) for k in (least, least + 1, 12)] == [""] * 3


def test_crossings_are_where_they_are_by_hand():
    # Equal squares, one turned by 45 degrees: the sides of an octagon of inner radius 0.2.
    t = 0.2 * np.tan(np.pi / 8)
    corners = [[x * u, y * v] for x, y in ((0.2, t), (t, 0.2)) for u in (-1, 1) for v in (-1, 1)]
    middle = np.array([0.0, 0.0, 0.01])
    turned = in_world(TABLE, 2 * middle, AN_EIGHTH)
    points = crossings(in_world(TABLE), turned, middle, middle, UP)
    assert len(set(points.number.tolist())) == len(points.number)
    assert_within((points.beta - points.alpha)[:, :2], 0.0, ROUNDING)
    octagon = sorted(points.alpha[:, :2].round(12).tolist())
    assert_within(octagon, sorted(corners), ROUNDING)


@pytest.mark.parametrize("swapped", [False, True])
def test_rims_of_tilted_discs_do_not_cross_outside_of_them(swapped):
    """A disc on its rim's lowest point, at the rim of another: both touch there and nowhere else.

    Seen along the normal its rim is an ellipse, by radius (1 - cos tilt) narrower than its circle.
    """
    radius = 0.1
    half = 0.02
    tilt = 0.2
    R = Rotation.from_rotvec([0.0, tilt, 0.0]).as_matrix()
    lowest = R @ [radius, 0.0, -half]
    over = 0.1 * radius * (1 - np.cos(tilt))  # how far the lowest point is inside of the other rim
    touches = np.array([over - 0.05, 0.0, half])
    low = in_world(Cylinder(0.05, half))
    top = in_world(Cylinder(radius, half), touches - lowest, R)
    a, b, n = (top, low, -UP) if swapped else (low, top, UP)
    found = crossings(a, b, touches, touches, n)
    assert (np.sum((found.beta - found.alpha) * n, axis=1) >= -ROUNDING).all()
