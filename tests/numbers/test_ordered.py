"""Sums of products in one order: those of plain loops, to the last bit."""

from functools import reduce
from operator import add

import numpy as np
import pytest

from quasistatic_ref.numbers.ordered import crossed, dot, length, norm, product, rotated

RNG = np.random.default_rng(3)


def by_loops(A, B):
    """The product of two matrices, entry by entry, each summed from the first to the last."""
    return np.array([[reduce(add, row * column) for column in B.T] for row in A])


@pytest.mark.parametrize(("m", "k", "n"), [(3, 3, 3), (3, 3, 4), (50, 3, 20), (4, 6, 13)])
def test_a_product_of_matrices_is_that_of_loops(m, k, n):
    A = RNG.normal(size=(m, k))
    B = RNG.normal(size=(k, n))
    expected = by_loops(A, B)
    assert product(A, B).tobytes() == expected.tobytes()
    assert product(np.array([A, A]), B)[1].tobytes() == expected.tobytes()
    assert product(A, B[:, 0]).tobytes() == expected[:, 0].tobytes()
    assert product(A[0], B).tobytes() == expected[0].tobytes()
    assert product(A[0], B[:, 0]) == expected[0, 0]
    assert product(np.array([A, A])[..., :0], B[:0, 0]).tolist() == np.zeros((2, m)).tolist()


def test_points_are_turned_by_one_matrix_or_each_by_its_own():
    R = RNG.normal(size=(5, 3, 3))
    points = RNG.normal(size=(5, 3))
    assert rotated(R[0], points).tobytes() == by_loops(points, R[0].T).tobytes()
    each = [by_loops(x[None], own.T)[0] for x, own in zip(points, R, strict=True)]
    assert rotated(R, points).tobytes() == np.array(each).tobytes()


def test_products_of_vectors_are_those_of_loops():
    a, b = RNG.normal(size=(2, 5, 3))
    assert dot(a, b).tolist() == np.diag(by_loops(a, b.T)).tolist()
    assert norm(a).tolist() == np.sqrt(np.diag(by_loops(a, a.T))).tolist()
    assert crossed(a, b).tobytes() == np.cross(a, b).tobytes()


def test_a_length_is_found_where_its_square_is_no_number():
    for scale in (1e-320, 1e-200, 1.0, 1e200):
        assert length(scale * np.array([3.0, 4.0])) == pytest.approx(5 * scale, rel=1e-3)
    assert length(np.zeros(3)) == 0
