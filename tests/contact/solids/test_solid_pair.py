"""Every pair of solids against another computation."""

import pytest

from tests.closeness import assert_within
from tests.contact.still import in_world, solid_pair
from tests.oracles import closest
from tests.oracles.pair_errors import pair_errors
from tests.tolerances import CLOSED_FORM, CURVED_PAIR, WAY_OUT


def by_coal(names):
    return bool(closest.CURVED & set(names)) and not {"sphere", "half-space"} & set(names)


@pytest.mark.parametrize("poses", [4, pytest.param(8, marks=pytest.mark.long)])
@pytest.mark.parametrize("names", closest.pairs(), ids="-".join)
def test_a_pair_is_as_far_apart_as_another_computation_says(names, poses):
    atol = CURVED_PAIR if by_coal(names) else CLOSED_FORM
    worst, refused = pair_errors(names, poses)
    assert refused <= by_coal(names)  # where one is deep inside the other
    assert worst.pop("points") <= max(atol, WAY_OUT)
    assert all(error <= atol for error in worst.values())


@pytest.mark.parametrize("names", [("box", "cylinder"), ("mesh", "cone"), ("cone", "ellipsoid")])
def test_a_curved_pair_that_is_made_smaller_has_a_smaller_distance(names):
    smaller = 2.0**-20
    for R, t in closest.poses(4, 23):
        phi = []
        for scale in (1.0, smaller):
            a, b = (closest.solids(scale)[name] for name in names)
            phi.append(solid_pair("p", in_world(a), in_world(b, scale * t, R)).phi)
        assert_within(phi[1] / smaller, phi[0], CURVED_PAIR)
