"""Every pair of solids against another computation."""

import pytest

from tests.oracles import closest
from tests.oracles.pair_errors import pair_errors
from tests.tolerances import CLOSED_FORM, CURVED_PAIR, WAY_OUT


def by_coal(names):
    return bool(closest.CURVED & set(names)) and not {"sphere", "half-space"} & set(names)


@pytest.mark.parametrize("names", closest.pairs(), ids="-".join)
def test_a_pair_is_as_far_apart_as_another_computation_says(names):
    atol = CURVED_PAIR if by_coal(names) else CLOSED_FORM
    worst, refused = pair_errors(names, 8)
    assert refused <= by_coal(names)  # where one is deep inside the other
    assert worst.pop("points") <= max(atol, WAY_OUT)
    assert all(error <= atol for error in worst.values())
