"""The parts of the interior point and of Newton's method in the ellipsoid, in closed form."""

import numpy as np
import pytest
from flint import arb, arb_mat, ctx

from quasistatic_ref.optional.ellipsoid.interior import (
    Blocks,
    interior_point,
)
from quasistatic_ref.optional.ellipsoid.newton import (
    SLIDES,
    STICKS,
    contact_states,
    newton_pair,
)


def balls(values):
    return [arb(float(v)) for v in values]


def column(values):
    return arb_mat(len(values), 1, balls(values))


def floats(values):
    return [float(v) for v in values]


def floor_problem(push, give):
    """H = I, g = (-2, push, 0), and the cone s_0 >= |(s_1, s_2)| of s = x + give y."""
    A = arb_mat([[arb(int(i == j)) for j in range(3)] for i in range(3)])
    return Blocks(A, column([-2.0, push, 0.0]), [A], [column([0.0, 0.0, 0.0])], [arb(give)])


@pytest.mark.parametrize("give", [0.0, 3.0])
@pytest.mark.parametrize(
    ("push", "s", "pressed", "state"),
    [
        # s is the projection of g on the cone; s = x + give y and y = x - g: (1 + give) y = s - g.
        (1.0, [0.0, 0.0, 0.0], [2.0, -1.0, 0.0], STICKS),
        (4.0, [1.0, 1.0, 0.0], [3.0, -3.0, 0.0], SLIDES),
    ],
)
def test_both_methods_project_on_a_cone(push, s, pressed, state, give):
    problem = floor_problem(push, give)
    y = np.array(pressed) / (1 + give)
    x = y + np.array([-2.0, push, 0.0])
    with ctx.workprec(640):
        cold = interior_point(problem, arb(2) ** -60)
        off = column(x + np.array([2.0**-20, 0.0, 2.0**-21]))
        near = [balls(np.add(y, [2.0**-20, 0.0, 2.0**-20]))]
        states = contact_states(problem, off, near)
        newton = newton_pair(problem, off, near, states)
    assert states == [state]
    for pair, tolerance in ((cold, 2.0**-25), (newton, 2.0**-52)):
        np.testing.assert_allclose(floats(pair.x.entries()), x, rtol=0, atol=tolerance)
        np.testing.assert_allclose(floats(pair.y[0]), y, rtol=0, atol=4 * tolerance)
        np.testing.assert_allclose(floats(pair.s[0]), s, rtol=0, atol=tolerance)
