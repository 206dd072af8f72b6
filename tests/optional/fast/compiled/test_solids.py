"""Closest points of solids in compiled code against the plain path: equal to the last bit."""

import numpy as np

from quasistatic_ref import convex_hull
from quasistatic_ref.optional.fast.compiled.solids import CORNERS, measured
from tests.optional.fast.compiled.test_fast import needs_compiler
from tests.oracles import closest

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
