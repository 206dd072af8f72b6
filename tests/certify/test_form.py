"""H, g, A, b without rounding, against the formulas in plain loops of fractions."""

from fractions import Fraction as F

import numpy as np
import pytest
from flint import arb

from quasistatic_ref import Extra, StepDataError
from quasistatic_ref.certify.form import StepForm, exact_matrix, inverse, whole_numbers
from quasistatic_ref.certify.form import fraction as exact
from quasistatic_ref.lab.vectors.exact.forms import exact_form_of
from tests.oracles.random_steps import any_step
from tests.oracles.solution_truth import program


def fraction(q):
    return F(int(q.p), int(q.q))


def in_si(form):
    """H, g, A, b of a form, as fractions."""
    H, g, A, c = (
        [[fraction(exact(v)) for v in row] for row in M.tolist()]
        for M in (form.H, form.g, form.A, form.c)
    )
    h = fraction(exact(form.h))
    return (
        [[v / h for v in row] for row in H],
        [v / h for (v,) in g],
        A,
        [-v for (v,) in c],
    )


def with_extra(step, rng):
    A = rng.standard_normal((2, step.n_v))
    b = np.array([1e-9, -3.0])
    return step.replace(extra=Extra(("one", "two"), A, b))


@pytest.mark.parametrize("seed", range(6))
def test_step_is_formed_without_rounding(seed):
    rng = np.random.default_rng(seed)
    n_a, n_u = [(3, 4), (0, 6), (5, 0), (2, 2), (7, 6), (1, 0)][seed]
    step = with_extra(any_step(rng, n_a, n_u, 3 * (seed % 3), 1e9), rng)
    expected = tuple(part.tolist() for part in program(step))
    for cone in ("pyramid", "facets-4"):  # two words for one cone
        assert in_si(StepForm(step.replace(cone=cone))) == expected


def test_a_ball_with_a_radius_is_no_exact_number():
    with pytest.raises(ValueError, match="exact"):
        whole_numbers([arb(1) / 3])
    with pytest.raises(ValueError, match="exact"):
        exact(arb(0, 1e-300))


def test_matrices_that_are_not_symmetric_or_finite_are_refused():
    one = np.ones(2)
    none = np.zeros((0, 2))
    with pytest.raises(StepDataError, match="symmetric"):
        exact_form_of(np.array([[1.0, 1e-17], [0.0, 1.0]]), one, none, np.zeros(0))
    with pytest.raises(StepDataError, match="finite"):
        exact_form_of(np.eye(2), np.array([np.nan, 0]), none, np.zeros(0))


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
