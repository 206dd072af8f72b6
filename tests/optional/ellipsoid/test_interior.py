"""The parts of the interior point and of Newton's method in the ellipsoid, in closed form."""

import numpy as np
import pytest
from flint import arb, arb_mat, ctx

from quasistatic_ref.optional.ellipsoid.interior import (
    Blocks,
    _centrality,
    _inverse_scaling,
    _reach,
    interior_point,
)
from quasistatic_ref.optional.ellipsoid.newton import (
    OPEN,
    SLIDES,
    STICKS,
    _linearised,
    _opening,
    contact_states,
    newton_pair,
)
from tests.tolerances import ROUNDING

FAR = 2.0**30


def balls(values):
    return [arb(float(v)) for v in values]


def column(values):
    return arb_mat(len(values), 1, balls(values))


def floats(values):
    return [float(v) for v in values]


def inside(rng, k):
    """A point well inside of the cone of k coordinates."""
    v = rng.standard_normal(k)
    v[0] = np.linalg.norm(v[1:]) + rng.uniform(0.1, 2)
    return v


@pytest.mark.parametrize("k", [1, 2, 4])
def test_scaling_takes_the_slack_to_the_multiplier(k):
    """W^-2 s = y, symmetric and positive definite, and of one coordinate y / s."""
    rng = np.random.default_rng(k)
    for _ in range(5):
        s = inside(rng, k)
        y = inside(rng, k)
        W = np.array([floats(row) for row in _inverse_scaling(balls(s), balls(y)).tolist()])
        np.testing.assert_allclose(W @ s, y, rtol=ROUNDING, atol=ROUNDING * np.abs(W).max())
        np.testing.assert_allclose(W, W.T, rtol=ROUNDING, atol=ROUNDING * np.abs(W).max())
        assert np.linalg.eigvalsh(W)[0] > 0


def test_centrality_is_one_on_the_path_less_off_it_and_nothing_outside():
    """On the path s = mu y^-1. Of s = y = (2, 1) the eigenvalues are 1 and 3, in the mean 5."""
    y = [2.0, 1.0, 0.0]
    inverse = [2.0, -1.0, 0.0]
    assert float(_centrality([balls(inverse)], [balls(y)])) == pytest.approx(1, rel=ROUNDING)
    path = [balls(inverse), balls([1.0])], [balls(y), balls([3.0])]
    assert float(_centrality(*path)) == pytest.approx(1, rel=ROUNDING)
    alike = [balls([2.0, 1.0])], [balls([2.0, 1.0])]
    assert float(_centrality(*alike)) == pytest.approx(1 / 5, rel=ROUNDING)
    uneven = [balls([1.0]), balls([1.0])], [balls([1.0]), balls([3.0])]
    assert float(_centrality(*uneven)) == pytest.approx(1 / 2, rel=ROUNDING)
    for outside in ([1.0, 2.0, 0.0], [-3.0, 1.0, 0.0], [1.0, 1.0, 0.0]):
        assert float(_centrality([balls(outside)], [balls(y)])) == 0.0
    complementary = [balls([1.0, 1.0, 0.0])], [balls([1.0, -1.0, 0.0])]  # both on the boundary
    assert float(_centrality(*complementary)) == 0.0


@pytest.mark.parametrize(
    ("v", "d", "reach"),
    [
        ([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], 1.0),
        ([2.0, 0.0, 0.0], [0.0, 3.0, 4.0], 2 / 5),
        ([2.0, 1.0, 0.0], [-1.0, 1.0, 0.0], 1 / 2),  # 2 - t = 1 + t
        ([2.0, 1.0, 0.0], [0.0, -1.0, 0.0], 3.0),
        ([1.0, 0.0, 0.0], [1.0, 0.5, 0.0], FAR),
        ([1.0, 0.0, 0.0], [1.0, 0.0, 0.0], FAR),
        ([1.0, 0.0, 0.0], [1.0, 1.0, 0.0], FAR),  # in parallel with the boundary
        ([1.0, 0.0, 0.0], [0.0, 0.0, 0.0], FAR),
        ([4.0], [-2.0], 2.0),
        ([4.0], [2.0], FAR),
    ],
)
def test_the_way_to_the_boundary_of_a_cone(v, d, reach):
    assert float(_reach(balls(v), balls(d))) == pytest.approx(reach, rel=ROUNDING)


def floor_problem(push=0.0):
    """H = I, g = (-2, push, 0), and the cone x_0 >= |(x_1, x_2)| of the three coordinates."""
    A = arb_mat([[arb(int(i == j)) for j in range(3)] for i in range(3)])
    return Blocks(A, column([-2.0, push, 0.0]), [A], [column([0.0, 0.0, 0.0])])


@pytest.mark.parametrize(
    ("push", "x", "y", "state"),
    [
        # The optimum is the projection of g on the cone, and y = x - g.
        (1.0, [0.0, 0.0, 0.0], [2.0, -1.0, 0.0], STICKS),
        (4.0, [1.0, 1.0, 0.0], [3.0, -3.0, 0.0], SLIDES),
    ],
)
def test_both_methods_project_on_a_cone(push, x, y, state):
    problem = floor_problem(push)
    with ctx.workprec(640):
        cold = interior_point(problem, arb(2) ** -60)
        off = column(x) + column([2.0**-20, 0.0, 2.0**-21])
        near = [balls(np.add(y, [2.0**-20, 0.0, 2.0**-20]))]
        states = contact_states(problem, off, near)
        newton = newton_pair(problem, off, near, states)
    assert states == [state]
    for pair, tolerance in ((cold, 2.0**-25), (newton, 2.0**-52)):
        np.testing.assert_allclose(floats(pair.x.entries()), x, rtol=0, atol=tolerance)
        np.testing.assert_allclose(floats(pair.y[0]), y, rtol=0, atol=4 * tolerance)
        np.testing.assert_allclose(floats(pair.s[0]), x, rtol=0, atol=tolerance)


@pytest.mark.parametrize(
    ("s", "y", "state"),
    [
        ([3.0, 1.0, 0.0], [1.0, 0.5, 0.0], OPEN),  # inside by 2, pressed by 1
        ([2.0, 1.0, 0.0], [1.0, 0.5, 0.0], SLIDES),  # inside by 1; the impulse by 1/2 of 2
        ([0.25, 0.25, 0.0], [1.0, 0.5, 0.0], STICKS),  # the impulse inside by 1/2
        ([0.5, 0.5, 0.0], [1.0, 0.5, 0.0], SLIDES),
        ([0.5], [1.0], STICKS),  # a row alone has no slip
        ([1.0], [0.5], OPEN),
    ],
)
def test_the_larger_of_two_slacks_says_what_a_contact_does(s, y, state):
    A = arb_mat([[arb(int(i == j)) for j in range(len(s))] for i in range(len(s))])
    b = column(np.ones(len(s)))
    problem = Blocks(A, column(np.zeros(len(s))), [A], [b])
    assert contact_states(problem, column(np.add(s, 1.0)), [balls(y)]) == [state]


def test_what_slides_is_linearised_with_its_curvature():
    """At s = (6, 3, 4): c = 6 - 5, C = (1, -0.6, -0.8), and of |s_1:| the second derivative.

    That is (I - u u') / 5 along u = (0.6, 0.8), times the multiplier 10.
    """
    problem = floor_problem()
    x = column([6.0, 3.0, 4.0])
    y = [balls([10.0, 0.0, 0.0])]
    K, C, c, f = _linearised(problem, x, y, [SLIDES])
    u = np.array([0.6, 0.8])
    expected = np.eye(3)
    expected[1:, 1:] += 2 * (np.eye(2) - np.outer(u, u))
    np.testing.assert_allclose([floats(row) for row in K.tolist()], expected, rtol=ROUNDING)
    np.testing.assert_allclose(floats(C.entries()), [1, -0.6, -0.8], rtol=ROUNDING)
    assert floats(c.entries()) == pytest.approx([1.0], rel=ROUNDING)
    assert floats(f.entries()) == [10.0]
    K, C, c, f = _linearised(problem, x, y, [STICKS])
    assert floats(K.entries()) == floats(C.entries()) == np.eye(3).ravel().tolist()
    assert (floats(c.entries()), floats(f.entries())) == ([6.0, 3.0, 4.0], [10.0, 0.0, 0.0])
    K, C, c, _ = _linearised(problem, x, y, [OPEN])
    assert (floats(K.entries()), C.nrows(), c.nrows()) == (np.eye(3).ravel().tolist(), 0, 0)


def test_no_direction_opens_walls_that_face_each_other():
    east = arb_mat([[arb(1)]])
    west = arb_mat([[arb(-1)]])
    assert _opening([east], 1) is not None
    assert _opening([east, west], 1) is None
    assert _opening([], 2).tolist() == [0.0, 0.0]
