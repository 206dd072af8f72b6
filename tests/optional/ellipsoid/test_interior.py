"""The parts of the interior point and of Newton's method in the ellipsoid, in closed form."""

import numpy as np
import pytest
from flint import arb, arb_mat, ctx

from quasistatic_ref.optional.ellipsoid.interior import Blocks, interior_point
from quasistatic_ref.optional.ellipsoid.newton import (
    INWARDS,
    OPEN,
    SLIDES,
    STICKS,
    _opening,
    _projected,
    contact_states,
    newton_pair,
)
from tests.tolerances import ROUNDING


def balls(values):
    return [arb(float(v)) for v in values]


def column(values):
    return arb_mat(len(values), 1, balls(values))


def floats(values):
    return [float(v) for v in values]


def projection_problem(g, b):
    """H = I, and a cone x_0 - b_0 >= |(x_1 - b_1, x_2 - b_2)| for every three coordinates."""
    n = len(g)
    A = [
        arb_mat([[arb(int(i + k == j)) for j in range(n)] for i in range(3)])
        for k in range(0, n, 3)
    ]
    H = arb_mat([[arb(int(i == j)) for j in range(n)] for i in range(n)])
    apexes = [column(b[k : k + 3]) for k in range(0, n, 3)]
    return Blocks(H, column(g), A, apexes, [arb(0)] * len(A))


FROM_APEX = {
    # g - b, its projection on the cone, and what the contact does.
    OPEN: ([2.0, 1.0, 0.0], [2.0, 1.0, 0.0]),
    STICKS: ([-2.0, 1.0, 0.0], [0.0, 0.0, 0.0]),
    SLIDES: ([-2.0, 4.0, 0.0], [1.0, 1.0, 0.0]),
}
B = np.array([0.5, 0.25, -0.125])
"""The apex."""


@pytest.mark.parametrize(
    "states", [[OPEN], [STICKS], [SLIDES], [STICKS, SLIDES], [SLIDES, SLIDES, STICKS]]
)
def test_both_methods_project_on_cones(states):
    """The optimum is b and the projection of g - b, and y = x - g."""
    b = np.tile(B, len(states))
    g = b + np.concatenate([FROM_APEX[state][0] for state in states])
    s = np.concatenate([FROM_APEX[state][1] for state in states])
    y = b + s - g
    problem = projection_problem(g, b)
    off = np.tile([2.0**-20, 0.0, 2.0**-21], len(states))
    with ctx.workprec(640):
        cold = interior_point(problem, arb(2) ** -60)
        near = [balls(one) for one in np.split(y + off, len(states))]
        start = column(b + s) + column(off)
        found = contact_states(problem, start, near)
        newton = newton_pair(problem, start, near, found)
        # What slides is on the boundary of its cone but for the way that it was moved inwards.
        inwards = [
            float((y_j[0] - (y_j[1] * y_j[1] + y_j[2] * y_j[2]).sqrt()) / INWARDS)
            for y_j, state in zip(newton.y, states, strict=True)
            if state == SLIDES
        ]
    assert found == states
    np.testing.assert_allclose(inwards, abs(y).max(), rtol=ROUNDING)
    for pair, tolerance in ((cold, 2.0**-25), (newton, 2.0**-52)):
        np.testing.assert_allclose(floats(pair.x.entries()), b + s, rtol=0, atol=tolerance)
        found_y, found_s = (np.concatenate([*map(floats, v)]) for v in (pair.y, pair.s))
        np.testing.assert_allclose(found_y, y, rtol=0, atol=4 * tolerance)
        np.testing.assert_allclose(found_s, s, rtol=0, atol=tolerance)


def test_the_nearest_point_of_a_cone_leaves_a_difference_in_the_cone_across_it():
    """The cone is its own dual; of a single coordinate it is the half-line."""
    rng = np.random.default_rng(2)
    assert _projected(np.zeros(0)).size == 0
    for z in [*rng.normal(size=(40, 4)), *rng.normal(size=(4, 1)), np.zeros(4)]:
        p = _projected(z)
        for v in (p, p - z):
            assert v[0] >= np.linalg.norm(v[1:]) - ROUNDING
        np.testing.assert_allclose(p @ (p - z), 0.0, rtol=0, atol=ROUNDING)


def test_one_displacement_opens_contacts_whose_normals_are_far_apart():
    """Three normals at 40 degrees to one way, of which each cone has 45 degrees, and a row."""
    angle = np.deg2rad(40.0)
    A = []
    for turn in np.arange(3) * 2 * np.pi / 3:
        n = [np.sin(angle) * np.cos(turn), np.sin(angle) * np.sin(turn), np.cos(angle)]
        A.append(np.array([n, *np.linalg.svd([n])[2][1:]]))
    A.append(np.array([[1.0, 0.0, 0.0]]))
    d = _opening([arb_mat(A_j.tolist()) for A_j in A], 3)
    for A_j in A:
        s = A_j @ d
        assert s[0] - np.linalg.norm(s[1:]) > 0


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
def test_both_methods_project_on_a_cone_that_gives_way(push, s, pressed, state, give):
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
