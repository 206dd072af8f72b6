"""Closest points of solids in compiled code against the plain path: equal to the last bit."""

import numpy as np
import pytest

from quasistatic_ref import Box, ContactError, Cylinder, Sphere, convex_hull
from quasistatic_ref.contact.distance import pair_closest_points
from quasistatic_ref.optional.fast.compiled.solids import CORNERS, measured
from tests.optional.fast.compiled.test_fast import needs_compiler
from tests.oracles import closest
from tests.oracles.posed_pairs import PosedPairs

POSES = 12
LEFT = 0.5
"""Largest share of the poses that C may leave to Python: of 10,000 it leaves 6 % at most."""


@needs_compiler
def test_contacts_of_every_pair_of_shapes_have_the_bits_of_the_plain_path():
    from validation.make.solid_pairs import compiled_pairs, pose_counts, solids

    shapes = solids()
    names = compiled_pairs()
    assert len(names) == 22
    for seed, (first, second) in enumerate(names):
        tally = pose_counts(shapes[first], shapes[second], POSES, seed)
        assert tally["poses"] == POSES
        assert tally["decided"] > (1 - LEFT) * POSES, (first, second)
        assert tally["different"] == 0, (first, second)


def test_meshes_of_many_corners_are_measured_on_half_spaces_only():
    from validation.make.solid_pairs import pair_of

    ways = np.random.default_rng(0).normal(size=(CORNERS + 1, 3))
    points = ways / np.linalg.norm(ways, axis=1)[:, None]  # on a ball: all are corners
    shapes = closest.solids()
    for mesh, expected in ((convex_hull(points), False), (convex_hull(points[1:]), True)):
        assert measured(pair_of(mesh, shapes["half-space"], 1))
        assert measured(pair_of(mesh, shapes["box"], 1)) == expected
        assert measured(pair_of(shapes["sphere"], mesh, 1)) == expected


CUBE = Box(np.full(3, 0.25))
UNDER_TWO_FACES = {
    "box": (CUBE, (0.125, 0.125, 0.0)),
    "mesh": (convex_hull(CUBE.corners(np.ones(3))[0]), (0.125, 0.125, 0.0)),
    "cylinder": (Cylinder(0.25, 0.25), (0.125, 0.0, 0.125)),
}
"""A solid, and a place 0.125 m below two of its faces [m]."""


@needs_compiler
@pytest.mark.parametrize(("solid", "place"), UNDER_TWO_FACES.values(), ids=UNDER_TWO_FACES)
@pytest.mark.parametrize("number", [0, 1])
def test_a_ball_as_deep_under_two_faces_is_left_to_the_plain_path(solid, place, number):
    from validation.make.solid_pairs import pair_of

    sides = (solid, Sphere(0.0625))
    pair = pair_of(*sides[:: 1 - 2 * number], 1)
    R = np.tile(np.eye(3), (2, 1, 1))
    for height, expected in ((0.0, 0), (0.0625, 1)):  # then one of the faces is nearer
        t = np.zeros((2, 3))
        t[1 - number] = np.add(place, (height, 0.0, 0.0))
        assert len(PosedPairs([pair], 2).decided(R, t)[1]) == expected
        if not expected:
            with pytest.raises(ContactError, match="as deep in each other"):
                pair_closest_points(pair, R, t)


@needs_compiler
def test_solids_that_are_too_far_away_are_left_to_the_plain_path():
    from validation.make.solid_pairs import pair_of

    balls = PosedPairs([pair_of(Sphere(1.0), Sphere(1.0), 1)], 2)
    R = np.tile(np.eye(3), (2, 1, 1))
    for far, expected in ((0.5e15, 1), (2e15, 0)):
        assert len(balls.decided(R, np.array([[0.0, 0.0, 0.0], [far, 0.0, 0.0]]))[1]) == expected
