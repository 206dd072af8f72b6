"""The exact optimum where its value is known in closed form."""

import numpy as np
import pytest

from quasistatic_ref.certify.exact import exact_slack, form_optimum, step_optimum
from quasistatic_ref.lab.bench.scenes import boxes
from tests.oracles.forms import exact_form_of


def test_matrix_beyond_the_precision_of_the_balls_is_solved():
    """H = L L', L unit bidiagonal with -2^25: |H^-1| = 2^350 and more, an integer matrix."""
    n = 8
    L = np.eye(n) - 2.0**25 * np.eye(n, k=-1)
    inverse = [[2 ** (25 * (i - j)) if i >= j else 0 for j in range(n)] for i in range(n)]  # of L
    g = np.ones(n)
    half = [sum(row) for row in inverse]  # L^-1 g
    x = [sum(inverse[i][j] * half[i] for i in range(n)) for j in range(n)]  # L^-T L^-1 g
    form = exact_form_of(L @ L.T, g, np.eye(n)[:1], np.zeros(1))
    optimum = form_optimum(form)
    assert optimum.delta_q.tolist() == [float(v) for v in x]
    assert exact_slack(form, optimum.working_set).tolist() == [float(x[0])]


def test_what_stays_where_it_is_needs_no_fractions(monkeypatch):
    """A box that slides askew does not turn: three entries are zero, which no ball shows."""
    scene = boxes(1)
    target = scene.target(0.0, scene.q)
    step = scene.simulator("off", False).step(scene.q, target, scene.force).step

    def refused(form, working):
        pytest.fail("solved in fractions")

    working = step_optimum(step).working_set
    monkeypatch.setattr("quasistatic_ref.certify.minimiser.fraction_point", refused)
    delta_q = step_optimum(step, working).delta_q
    assert delta_q.astype(bool).tolist() == [True, True, True, False, False, False]
