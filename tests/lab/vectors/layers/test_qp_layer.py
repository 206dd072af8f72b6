"""Layer `qp`: cones, what the plain program takes for an optimum, and tolerances by hand."""

from fractions import Fraction

import numpy as np
import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.vectors.exact.conditioning import bounds, floors
from quasistatic_ref.lab.vectors.layers import qp
from tests.closeness import assert_relative
from tests.tolerances import ROUNDING

EPS = Fraction(1, 2**53)


def test_an_answer_in_the_ellipsoid_has_thirty_digits():
    # min 1/2 |x|^2 - 2 x_1 - x_0 in |x_1| <= x_0 is x = (1.5, 1.5), and lam = (0.5, -0.5).
    F = [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [0.0, 0.0]]
    case = {"H": [[1.0, 0.0], [0.0, 1.0]], "g": [1.0, 2.0]}
    case["second_order"] = [{"F": F, "f": [0.0, 0.0, 0.0, 0.0]}]
    answer = qp.expected(case)
    assert answer.output["delta_q"] == [1.5, 1.5]
    assert answer.digits["delta_q"] == ["1.50000000000000000000000000000e+00"] * 2
    assert answer.output["A_lam"] == [0.5, -0.5]


def test_a_cone_that_is_no_contacts_is_refused():
    block = {"F": np.zeros((4, 1)).tolist(), "f": [0.0, 1.0, 0.0, 0.0]}
    with pytest.raises(InputError, match="only its first entry"):
        qp.expected({"H": [[1.0]], "g": [1.0], "second_order": [block]})


def test_the_bound_of_a_spring_is_that_of_skeel():
    # One coordinate: |K^-1| (|K| |z| + |r|) = (|H g / H| + |g|) / H = 2 |g| / H, times c = 8.
    form = qp.form_of({"H": [[4.0]], "g": [3.0], "A": [], "b": []})
    assert bounds(form, ()).x == 8 * EPS * 2 * Fraction(3, 4)


def test_a_body_held_fast_is_right_to_eight_roundings_of_its_free_step():
    # H = 100: ||H^-1 g||_H = |g| / 10, an entry of x is off by a tenth of the error in that norm,
    # one of A'lam by ten times it, and the rows (+-1/2, 1) by sqrt(5/4) as much as x.
    case = {
        "H": [[100.0, 0.0], [0.0, 100.0]],
        "g": [0.03, -0.1],
        "A": [[0.5, 1.0], [-0.5, 1.0]],
        "b": [0.0, 0.0],
    }
    error = 8 * float(EPS) * np.hypot(0.03, 0.1) / 10
    x, net, slack = floors(qp.form_of(case))
    assert_relative(float(x), error / 10, ROUNDING)
    assert_relative(float(net), error * 10, ROUNDING)
    assert_relative(float(slack), error / 10 * np.sqrt(1.25), ROUNDING)
    answer = qp.expected(case)
    assert answer.output["delta_q"] == [0.0, 0.0]
    assert float(x) <= answer.tolerance["delta_q"].absolute <= 2 * float(x)
