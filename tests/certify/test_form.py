"""Exact numbers and matrices: what is none, and what is zero without a radius."""

import numpy as np
import pytest
from flint import arb

from quasistatic_ref import StepDataError
from quasistatic_ref.certify.form import exact_matrix, inverse, whole_numbers
from quasistatic_ref.certify.form import fraction as exact
from quasistatic_ref.lab.vectors.exact.forms import exact_form_of
from tests.cases import cases


def test_a_ball_with_a_radius_is_no_exact_number():
    with pytest.raises(ValueError, match="exact"):
        whole_numbers([arb(1) / 3])
    with pytest.raises(ValueError, match="exact"):
        exact(arb(0, 1e-300))


ULP = 2.0**-52
NO_PROGRAM = {
    "singular": ([[1, 1], [1, 1]], 1, "positive definite"),
    "nearly definite": ([[1, 1 + ULP], [1 + ULP, 1 + ULP]], 1, "positive definite"),
    "not symmetric": ([[1, 1e-17], [0, 1]], 1, "symmetric"),
    "no number": (np.eye(2), np.nan, "finite"),
}
"""H, the entries of g, and what is said."""


@cases("H, g, words", NO_PROGRAM)
def test_a_program_without_an_exact_optimum_is_refused(H, g, words):
    with pytest.raises(StepDataError, match=words):
        exact_form_of(np.array(H), np.full(2, g), np.zeros((0, 2)), np.zeros(0))


def test_the_inverse_is_zero_between_what_nothing_couples():
    """0 - 1 - 2 is a chain, whose ends are coupled by its middle; 3 and 4 stand alone."""
    H = np.diag([3.0, 5.0, 7.0, 11.0, 13.0])
    H[0, 1] = H[1, 0] = H[1, 2] = H[2, 1] = 1.0
    H_inverse = inverse(exact_matrix(H))
    zero = [[v.is_zero() for v in row] for row in H_inverse.tolist()]
    alone = np.arange(5) > 2
    assert (np.array(zero) == ((alone[:, None] | alone) & ~np.eye(5, dtype=bool))).all()
    assert all(v.contains(i == j) for i, row in enumerate((exact_matrix(H) * H_inverse).tolist())
               for j, v in enumerate(row))  # fmt: skip
