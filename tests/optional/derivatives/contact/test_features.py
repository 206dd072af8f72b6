"""What each shape is about points of its surface, on rims and next to them: closed forms."""

import numpy as np
import pytest

from quasistatic_ref import Box, Capsule, Cone, Cylinder, HalfSpace, convex_hull
from quasistatic_ref.optional.derivatives.contact.features import feature
from quasistatic_ref.tolerances import ON_RIM
from tests.closeness import assert_within
from tests.tolerances import ROUNDING

X, Y, Z = np.eye(3)
C, S = 0.6, 0.8  # a cosine and its sine
U = np.array([C, S, 0.0])
AROUND = np.array([-S, C, 0.0])
TILTED = np.array([2.0, 3.0, 6.0]) / 7
BOX = Box((0.01, 0.02, 0.03))
LOG = Cylinder(0.01, 0.02)
PILL = Capsule(0.01, 0.01)
MESH = convex_hull(BOX.corners(Z)[0])
# A cone of base radius 0.03 and height 0.04: its slant is 0.05, and the normal of its side is
# 0.8 outwards and 0.6 up. Its generator through the azimuth of U goes 0.6 inwards and 0.8 up.
CONE = Cone(0.03, 0.02)
SIDE = 0.8 * U + 0.6 * Z
GENERATOR = 0.8 * Z - 0.6 * U
TETRAHEDRON = convex_hull([[0, 0, 0], [0.02, 0, 0], [0, 0.02, 0], [0, 0, 0.02]])
# Of its edge between the faces with normals -Z and (1, 1, 1) / sqrt 3, the normal halfway.
EDGE = (np.ones(3) / np.sqrt(3) - Z) / np.linalg.norm(np.ones(3) / np.sqrt(3) - Z)
NO = np.zeros((3, 3))
TOP = 0.01 * Z  # of the segment of PILL
# Of a ball of radius r the farthest point along n is r n / |n|, and its derivative r (I - n n').
BALL = 0.01 * (np.eye(3) - np.outer(TILTED, TILTED))


FREE = {
    "a half-space": (HalfSpace(TILTED, 0.0), 0 * X, TILTED, NO, "normal"),
    "a face of a box": (BOX, np.array([0.01, 0.0, 0.01]), X, NO, "normal"),
    "an edge of a box": (BOX, np.array([0.01, 0.02, 0.0]), U, NO, [Z]),
    "an edge of a mesh": (MESH, np.array([0.01, 0.02, 0.0]), U, NO, [Z]),
    "a blunt edge of a mesh": (TETRAHEDRON, 0.01 * (X + Y), EDGE, NO, [(X - Y) / np.sqrt(2)]),
    "a corner of a mesh": (MESH, np.array([0.01, 0.02, 0.03]), TILTED, NO, []),
    "the side of a capsule": (PILL, 0.01 * U, U, 0.01 * np.outer(AROUND, AROUND), [Z]),
    "an end of a capsule": (PILL, TOP + 0.01 * TILTED, TILTED, BALL, []),
    "the side of a cylinder": (LOG, 0.01 * U, U, 0.01 * np.outer(AROUND, AROUND), [Z]),
    "the top of a cylinder": (LOG, np.array([0.0, 0.005, 0.02]), Z, NO, "normal"),
    # At half of its height its radius is 0.015, about a normal that is 0.8 outwards.
    "the side of a cone": (
        CONE,
        0.015 * U,
        SIDE,
        0.015 / 0.8 * np.outer(AROUND, AROUND),
        [GENERATOR],
    ),
    "the base of a cone": (CONE, np.array([0.0, 0.01, -0.02]), -Z, NO, "normal"),
    "the tip of a cone": (CONE, 0.02 * Z, Z, NO, []),
}
"""Shape, point, normal, D, and F: unit vectors, or all across the normal."""


def span(vectors):
    """Projection onto what orthonormal vectors (k, 3) span."""
    return np.array(vectors).reshape(-1, 3).T @ np.array(vectors).reshape(-1, 3)


def like(found, expected):
    assert_within(found, expected, ROUNDING)


@pytest.mark.parametrize("name", FREE)
def test_a_feature_bends_and_is_straight_as_its_shape_is(name):
    shape, x, n, bend, free = FREE[name]
    found = feature(shape, x, n)
    like(found.bend, bend)
    like(span(found.free), np.eye(3) - np.outer(n, n) if free == "normal" else span(free))
    assert not len(found.ends)


ENDS = {
    "an edge of a box, along a face": (BOX, np.array([0.01, 0.02, 0.0]), X, [Z], [Y]),
    "a corner of a box, along a face": (BOX, np.array([0.01, 0.02, 0.03]), X, [], [Y, Z]),
    "an end of a capsule's side": (PILL, TOP + 0.01 * U, U, [], [Z]),
    "the rim of a cylinder's side": (LOG, 0.01 * U + 0.02 * Z, U, [], [Z]),
    "the rim of a cylinder's top": (LOG, 0.01 * U + 0.02 * Z, Z, [], [X, Y]),
    "the rim of a cone's side": (CONE, 0.03 * U - 0.02 * Z, SIDE, [], [GENERATOR]),
    "the tip of a cone, along its side": (CONE, 0.02 * Z, SIDE, [], [GENERATOR]),
}
"""Shape, point, normal, F, and the directions in which the feature ends."""


@pytest.mark.parametrize("name", ENDS)
def test_a_feature_ends_where_another_begins(name):
    shape, x, n, free, ends = ENDS[name]
    found = feature(shape, x, n)
    like(span(found.free), span(free))
    like(span(found.ends), span(ends))


RIMS = {
    "a face of a box": (BOX, np.array([0.01, 0.02, 0.0]), X, Y, 2 * 0.03),
    "the side of a capsule": (PILL, TOP + 0.01 * U, U, Z, 0.02),
    "the side of a cylinder": (LOG, 0.01 * U + 0.02 * Z, U, Z, 0.03),
    "the top of a cylinder": (LOG, 0.01 * U + 0.02 * Z, Z, U, 0.03),
    "the side of a cone": (CONE, 0.03 * U - 0.02 * Z, SIDE, -GENERATOR, 0.05),
}
"""Shape, point of a rim, normal, the way to the rim from inside of the face, the shape's size [m].

Of a capsule, a cylinder and a cone the size is radius + half_length, of a box its longest side.
"""


@pytest.mark.parametrize("name", RIMS)
def test_near_a_rim_is_on_it_and_a_share_of_the_size_away_is_not(name):
    shape, x, n, way, size = RIMS[name]
    near, away = (feature(shape, x - share * ON_RIM * size * way, n) for share in (0.3, 3.0))
    assert len(near.ends) > 0
    assert not len(away.ends)
    assert len(away.free) > len(near.free)
