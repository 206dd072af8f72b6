"""Where the features of each shape end, on rims and next to them: closed forms."""

import numpy as np
import pytest

from quasistatic_ref import Box, Capsule, Cone, Cylinder
from quasistatic_ref.optional.derivatives.contact.features import feature
from quasistatic_ref.tolerances import ON_RIM
from tests.closeness import assert_within
from tests.tolerances import ROUNDING

X, Y, Z = np.eye(3)
U = np.array([0.6, 0.8, 0.0])
BOX = Box((0.01, 0.02, 0.03))
LOG = Cylinder(0.01, 0.02)
PILL = Capsule(0.01, 0.01)
# A cone of base radius 0.03 and height 0.04: its slant is 0.05, and the normal of its side is
# 0.8 outwards and 0.6 up. Its generator through the azimuth of U goes 0.6 inwards and 0.8 up.
CONE = Cone(0.03, 0.02)
SIDE = 0.8 * U + 0.6 * Z
GENERATOR = 0.8 * Z - 0.6 * U
ENDS = {
    "an edge of a box, along a face": (BOX, 0.01 * X + 0.02 * Y, X, [Z], [Y], Y, 0.06),
    "a corner of a box, along a face": (
        BOX, np.array([0.01, 0.02, 0.03]), X, [], [Y, Z], (Y + Z) / np.sqrt(2), 0.06,
    ),
    "an end of a capsule's side": (PILL, 0.01 * U + 0.01 * Z, U, [], [Z], Z, 0.02),
    "the rim of a cylinder's side": (LOG, 0.01 * U + 0.02 * Z, U, [], [Z], Z, 0.03),
    "the rim of a cylinder's top": (LOG, 0.01 * U + 0.02 * Z, Z, [], [X, Y], U, 0.03),
    "the rim of a cone's side": (
        CONE, 0.03 * U - 0.02 * Z, SIDE, [], [GENERATOR], -GENERATOR, 0.05
    ),
    "the tip of a cone, along its side": (
        CONE, 0.02 * Z, SIDE, [], [GENERATOR], GENERATOR, 0.05
    ),
}  # fmt: skip
"""Shape, point of a rim, normal, F, the directions in which the feature ends, the way to the rim
from inside of the face, and the shape's size [m]: of a box its longest side, of the others
radius + half_length."""


def span(vectors):
    """Projection onto what orthonormal vectors (k, 3) span."""
    return np.array(vectors).reshape(-1, 3).T @ np.array(vectors).reshape(-1, 3)


@pytest.mark.parametrize("name", ENDS)
def test_a_feature_ends_on_its_rim_and_not_a_share_of_the_size_away(name):
    shape, x, n, free, ends, way, size = ENDS[name]
    on_rim = feature(shape, x, n)
    assert_within(span(on_rim.free), span(free), ROUNDING)
    assert_within(span(on_rim.ends), span(ends), ROUNDING)
    near, away = (feature(shape, x - share * ON_RIM * size * way, n) for share in (0.3, 3.0))
    assert len(near.ends) > 0
    assert not len(away.ends)
    assert len(away.free) > len(near.free)
