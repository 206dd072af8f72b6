"""The parts of the interior point and of Newton's method in the ellipsoid, in closed form."""

import numpy as np
import pytest
from flint import arb, arb_mat

from quasistatic_ref.numbers.precision import working_precision
from quasistatic_ref.optional.ellipsoid.interior import Blocks, Pair, interior_point
from quasistatic_ref.optional.ellipsoid.newton import (
    INWARDS,
    OPEN,
    SLIDES,
    STICKS,
    contact_states,
    newton_pair,
)
from tests.closeness import assert_relative, assert_within
from tests.tolerances import ROUNDING


def column(values):
    return arb_mat(len(values), 1, [arb(float(v)) for v in values])


def floats(column):
    return [float(v) for v in column.entries()]


def projection_problem(g, b, give=0.0):
    """H = I, and a cone x_0 - b_0 >= |(x_1 - b_1, x_2 - b_2)| for every three coordinates."""
    n = len(g)
    one = arb_mat(np.eye(n).tolist())
    blocks = [range(k, k + 3) for k in range(0, n, 3)]
    return Blocks(one, column(g), one, column(b), one * give, blocks)


FROM_APEX = {
    # g - b, its projection on the cone, and what the contact does.
    OPEN: ([2.0, 1.0, 0.0], [2.0, 1.0, 0.0]),
    STICKS: ([-2.0, 1.0, 0.0], [0.0, 0.0, 0.0]),
    SLIDES: ([-2.0, 4.0, 0.0], [1.0, 1.0, 0.0]),
}
B = np.array([0.5, 0.25, -0.125])
"""The apex."""


@pytest.mark.parametrize("give", [0.0, 3.0])
@pytest.mark.parametrize(
    "states", [[OPEN], [STICKS], [SLIDES], [STICKS, SLIDES], [SLIDES, SLIDES, STICKS]]
)
def test_both_methods_project_on_cones(states, give):
    """The slacks s are the projection of g - b. They are x - b + give y, and y = x - g."""
    b = np.tile(B, len(states))
    g = b + np.concatenate([FROM_APEX[state][0] for state in states])
    s = np.concatenate([FROM_APEX[state][1] for state in states])
    y = (b + s - g) / (1 + give)
    x = y + g
    problem = projection_problem(g, b, give)
    off = np.tile([2.0**-20, 0.0, 2.0**-21], len(states))
    with working_precision(640):
        cold = interior_point(problem, arb(2) ** -60)
        near = Pair(column(x + off), column(y + off))
        found = contact_states(problem, near)
        newton = newton_pair(problem, near, found)
        # What slides is on the boundary of its cone but for the way that it was moved inwards.
        inwards = [
            float((y_j[0] - (y_j[1] * y_j[1] + y_j[2] * y_j[2]).sqrt()) / INWARDS)
            for y_j, state in zip(problem.split(newton.y), states, strict=True)
            if state == SLIDES
        ]
        for pair, tolerance in ((cold, 2.0**-25), (newton, 2.0**-52)):
            assert_pair(problem, pair, (x, s, y), tolerance)
    assert found == states
    if not give:  # what gives way is pressed by more, below
        assert_relative(inwards, abs(y).max(), ROUNDING)


def assert_pair(problem, pair, expected, tolerance):
    """A pair is that of the numbers x, s and y, s being the slacks of x."""
    x, s, y = expected
    assert_within(floats(pair.x), x, tolerance)
    assert_within(floats(problem.slacks(*pair)), s, tolerance)
    assert_within(floats(pair.y), y, 4 * tolerance)
