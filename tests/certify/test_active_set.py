"""The walk: which row leaves, exact ties included, and that it ends."""

import numpy as np
import pytest
from flint import arb

from quasistatic_ref.certify import active_set
from quasistatic_ref.certify.active_set import Farkas, Optimum, dual_active_set
from quasistatic_ref.certify.minimiser import Minimiser
from quasistatic_ref.lab.vectors.exact.forms import exact_form_of


def program(A, b, g=None):
    """Nearest x to g with A x >= b."""
    A = np.array(A, dtype=float)
    n = A.shape[1]
    return exact_form_of(np.eye(n), np.zeros(n) if g is None else g, A, np.array(b, dtype=float))


def point_on(form, working, balls=True):
    """The minimiser on a working set; without balls all signs are those of fractions."""
    point = Minimiser(form, tuple(working))
    if not balls:
        point.balls.y[:] = [arb(0, 1e300)] * len(working)  # which hold every sign
    return point


@pytest.fixture(params=[True, False], ids=["balls", "fractions"])
def balls(request):
    return request.param


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
@pytest.mark.parametrize(
    ("right", "first"),
    [
        # On x_0 = b_0, x_1 = b_1 lam = b; with a_2 x = 9 u = b - (9 - b_0 - b_1). Row j vanishes
        # at b_j / (b_j - u_j) = b_j / (9 - b_0 - b_1): the smaller b first.
        ((1.0, 1.0), None),
        ((1.0, 2.0), 0),
        ((2.0, 1.0), 1),
        ((2.0, 2.0 + 2**-51), 0),
    ],
)
def test_multiplier_that_vanishes_first_leaves_the_longest_held_in_a_tie(
    order, right, first, balls
):
    form = program([[1, 0, 0], [0, 1, 0], [1, 1, 1]], [*right, 9])
    before = point_on(form, order, balls)
    after = point_on(form, (*order, 2), balls)
    leaving = active_set._first_to_vanish(before, after)
    assert order[leaving] == (order[0] if first is None else first)


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
@pytest.mark.parametrize(
    ("c", "first"),
    [
        # lam = (1, 3): lam_j / c_j is 1 and 3 / c_1.
        ((1.0, 3.0), None),
        ((1.0, 2.0), 0),
        ((1.0, 4.0), 1),
        ((-1.0, 1.0), 1),
        ((1.0, -4.0), 0),
        ((1.0, 0.0), 0),
    ],
)
def test_the_row_of_smallest_ratio_leaves_in_a_tie_the_longest_held(order, c, first, balls):
    form = program([[1, 0], [0, 1], c], [1, 3, 99])
    combination = active_set.combination(form, order, 2)
    assert [float(str(c_j)) for c_j in combination] == [c[i] for i in order]
    fall = [-c_j for c_j in combination]
    leaving = active_set._first_to_vanish(point_on(form, order, balls), fall)
    assert order[leaving] == (order[0] if first is None else first)


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_multipliers_that_do_not_fall_never_vanish(order, balls):
    """Of lam = (1, 3), lam_0 stays as t grows, and lam_1 + t grows with it."""
    form = program([[1, 0], [0, 1], [0, -1]], [1, 3, 99])
    combination = active_set.combination(form, order, 2)
    fall = [-c_j for c_j in combination]
    assert active_set._first_to_vanish(point_on(form, order, balls), fall) is None


def test_combination_without_positive_part_proves_infeasibility():
    """x_0 >= 1, x_1 >= 1 and -2 x_0 - 3 x_1 >= -4: y = (2, 3, 1), b'y = 1."""
    end = dual_active_set(program([[1, 0], [0, 1], [-2, -3]], [1, 1, -4]), [0, 1])
    assert isinstance(end, Farkas)
    assert {i: float(str(y_i)) for i, y_i in end.y.items()} == {0: 2.0, 1: 3.0, 2: 1.0}


def lifted_corner(seed):
    """A start at a corner, x_i >= 1, that sums of its rows lift: x = (10, 10, 10, 10, 0).

    All multipliers at the corner are one, so all leave at once when the sum of four rows comes
    in. Every row is there twice; the sums of two are without slack at the end and depend on it.
    """
    rng = np.random.default_rng(seed)
    each = np.eye(5)[:4]
    pairs = [each[i] + each[j] for i in range(4) for j in range(i)]
    rows = np.vstack([each, each, [each.sum(axis=0)] * 2, pairs, pairs])
    b = np.array([1] * 8 + [40] * 2 + [20] * 12)
    order = rng.permutation(len(b))
    start = rng.permutation(np.flatnonzero(order < 8)).tolist()
    return program(rows[order], b[order]), start


@pytest.mark.parametrize("seed", range(8))
def test_exactly_tied_duplicated_and_dependent_rows_end(seed):
    form, warm = lifted_corner(seed)
    end = dual_active_set(form, warm)
    assert isinstance(end, Optimum)
    assert end.minimiser.fractions.point == [10, 10, 10, 10, 0]
    assert 0 < end.walks <= form.m


def test_rows_whose_multipliers_are_zero_are_left_out(balls):
    # The nearest x to g = (0, 1, 2) with x_0 >= 0 and x_1 >= 2 has the multipliers 0 and 1.
    form = program([[1, 0, 0], [0, 1, 0]], [0, 2], g=[0.0, 1.0, 2.0])
    assert point_on(form, (0, 1), balls).positive() == (1,)
    for warm in ((), (0,), (0, 1)):
        assert dual_active_set(form, warm).minimiser.working == (1,)
