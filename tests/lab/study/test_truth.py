"""What solvers are graded by: exact answers, enclosures, digits and residuals."""

import numpy as np
import pytest

from quasistatic_ref.lab.study.grade import grades, problem_forms
from quasistatic_ref.lab.study.promises import RESIDUALS, resolved
from quasistatic_ref.lab.study.solvers import Solver
from quasistatic_ref.solve.reply import Reply


def grades_of(problem, units, x, lam, solved=True):
    reply = Reply(x, lam, solved, "optimal", 7, 0.5, 1.0)
    mine = Solver("mine", "function", "m:f")
    return grades(problem_forms(problem), units, reply, mine, resolved({}, {}), None)


def lam_of(form, x):
    """Multipliers that balance x, not all of them positive."""
    return np.linalg.lstsq(form.A.T, form.H @ x - form.g, rcond=None)[0]


@pytest.mark.parametrize("units", ["raw", "natural"])
@pytest.mark.parametrize("exponent", [3, 6])
def test_digits_are_those_that_were_spoilt(problem, units, exponent):
    """X = x* + 10^-e H^-1 g has an error of 10^-e, whatever the units."""
    ready = problem_forms(problem)
    x = problem.answer.x + 10.0**-exponent * np.linalg.solve(problem.form.H, problem.form.g)
    lam = lam_of(problem.form, x)  # H x - g = A' lam: the net impulse is off by H (x - x*)
    if units == "natural":
        x = x / (ready.units.size * ready.units.coordinate)
        lam = lam * (ready.units.length / ready.units.size)
    row = grades_of(problem, units, x, lam)
    assert row["digits"] == pytest.approx(exponent, abs=1e-3)
    assert row["digits_net"] == pytest.approx(exponent, abs=1e-3)
    assert row["iterations"] == 7


def test_residuals_are_those_of_qpbenchmark(problem, rng):
    """max(0, G x - h), |P x + q + G' z| and |x' P x + q' x + h' z|."""
    form = problem.form
    x = 1e-4 * rng.normal(size=len(form.g))
    z = 1e-4 * rng.uniform(size=len(form.b))
    P, q, G, h = form.H, -form.g, -form.A, -form.b
    expected = [
        max(0, max(G @ x - h)),
        max(abs(P @ x + q + G.T @ z)),
        abs(x @ P @ x + q @ x + h @ z),
    ]
    row = grades_of(problem, "raw", x, z)
    np.testing.assert_allclose([row[name] for name in RESIDUALS], expected, rtol=1e-10, atol=1e-16)


def test_a_solver_that_gave_up_has_failed_and_keeps_its_digits(problem):
    for x, digits in ((problem.answer.x, 16.0), (np.full(len(problem.form.g), np.nan), None)):
        row = grades_of(problem, "raw", x, None, solved=False)
        assert (row["outcome"], row["claim"], row["false_claim"]) == ("failed", "neither", False)
        assert (row["digits"], row["digits_net"], row["digits_lam"]) == (digits, None, None)
