"""H, g, A, b without rounding, against the formulas in plain loops of fractions."""

from fractions import Fraction as F

import numpy as np
import pytest

from quasistatic_ref import Extra, StepDataError
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.lab.scenes.grasps import grasp_step
from quasistatic_ref.lab.vectors.exact.forms import exact_form_of
from tests.oracles.random_steps import any_step
from tests.oracles.solution_truth import program


def fraction(q):
    return F(int(q.p), int(q.q))


def in_si(form):
    """H, g, A, b of a form in SI units, as fractions."""
    x, s, net = (fraction(u) for u in (form.x_unit, form.slack_unit, form.net_unit))
    n = range(form.n)
    m = range(form.m)
    H = [[int(form.H[i, j]) * net / x for j in n] for i in n]
    g = [int(form.g[i, 0]) * net for i in n]
    A = [[int(form.A[i, j]) * s / x for j in n] for i in m]
    b = [int(form.b[i, 0]) * s for i in m]
    return H, g, A, b


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
        assert in_si(exact_form(step.replace(cone=cone))) == expected


def test_grasp_step_has_the_size_of_the_paper():
    form = exact_form(grasp_step(np.random.default_rng(0)))
    assert (form.m, form.n) == (80, 13)


def test_multipliers_and_slacks_have_consistent_units():
    """A'lam is lam_unit times the rows in SI: net = (slack / x) * lam."""
    form = exact_form(grasp_step(np.random.default_rng(1)))
    assert form.net_unit == form.lam_unit * form.slack_unit / form.x_unit


def test_matrices_that_are_not_symmetric_or_finite_are_refused():
    one = np.ones(2)
    none = np.zeros((0, 2))
    with pytest.raises(StepDataError, match="symmetric"):
        exact_form_of(np.array([[1.0, 1e-17], [0.0, 1.0]]), one, none, np.zeros(0))
    with pytest.raises(StepDataError, match="finite"):
        exact_form_of(np.eye(2), np.array([np.nan, 0]), none, np.zeros(0))
