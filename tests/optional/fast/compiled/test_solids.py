"""Closest points of solids in compiled code against the plain path: equal to the last bit."""

import numpy as np

from tests.optional.fast.compiled.test_fast import needs_compiler
from tests.oracles import closest

POSES = 60
LEFT = 0.5
"""Largest share of the poses that C may leave to Python: of 10,000 it leaves 6.2 % at most."""
Z = np.array([0.0, 0.0, 1.0])


@needs_compiler
def test_contacts_of_every_pair_of_shapes_have_the_bits_of_the_plain_path():
    from validation.make.solid_pairs import compiled_pairs, tried

    solids = closest.solids()
    names = compiled_pairs()
    assert len(names) == 12
    for seed, (first, second) in enumerate(names):
        tally = tried(solids[first], solids[second], POSES, seed)
        assert tally["poses"] == POSES
        assert tally["decided"] > (1 - LEFT) * POSES, (first, second)
        assert tally["different"] == 0, (first, second)
