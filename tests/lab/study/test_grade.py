"""Facts of an answer: its digits and residuals, and whether these reached the accuracy."""

import numpy as np
import pytest

from quasistatic_ref.lab.study.grade import RESIDUALS, facts_of_reply
from quasistatic_ref.solve.solver import Reply
from quasistatic_ref.solve.units import in_natural
from tests.closeness import assert_relative
from tests.lab.study.asked import Solver

MINE = Solver("mine", "function", "m:f")


def facts(problem, units, x, lam, accuracy=None, status="optimal"):
    return facts_of_reply(problem, units, Reply(x, lam, True, status), MINE, accuracy)


@pytest.mark.parametrize("units", ["raw", "natural"])
@pytest.mark.parametrize("exponent", [3, 6])
def test_digits_are_those_that_were_spoilt(problem, units, exponent):
    """X = x* + 10^-e H^-1 g has an error of 10^-e, whatever the units."""
    x = problem.answer.x + 10.0**-exponent * np.linalg.solve(problem.form.H, problem.form.g)
    lam = problem.answer.lam
    if units == "natural":
        x, lam = in_natural(x, lam, problem.units)
    for says in ("optimal", "too many sweeps"):
        row = facts(problem, units, x, lam, status=says)
        assert row["digits"] == pytest.approx(exponent, abs=1e-3)


@pytest.mark.parametrize("units", ["raw", "natural"])
def test_residuals_are_those_of_qpbenchmark_in_natural_units(problem, rng, units):
    """max(0, G x - h), |P x + q + G' z| and |x' P x + q' x + h' z|."""
    form = problem.natural.form
    x = rng.normal(size=len(form.g))
    z = rng.uniform(size=len(form.b))
    P, q, G, h = form.H, -form.g, -form.A, -form.b
    expected = [
        max(0, max(G @ x - h)),
        max(abs(P @ x + q + G.T @ z)),
        abs(x @ P @ x + q @ x + h @ z),
    ]
    if units == "raw":
        S, ell, rho = problem.units
        x = x * (rho * S)
        z = z * (rho / ell)
    row = facts(problem, units, x, z)
    assert_relative(np.array([row[name] for name in RESIDUALS]), np.array(expected), 1e-10)
    assert row["reached"] is None


def test_an_accuracy_is_reached_if_no_residual_is_larger(problem):
    """Each in turn: a row is left by t, a multiplier is -t, the balance is off by t."""
    there = problem.natural
    form = there.form
    x = there.answer.x
    lam = there.answer.lam
    tight = int(np.argmax(lam))
    for share in (0.5, 2.0):
        t = share * 1e-6
        outwards = np.linalg.lstsq(form.A[[tight]], [-t], rcond=None)[0]
        negative = lam.copy()
        negative[np.argmin(lam)] = -t
        off = np.linalg.solve(form.H, t * np.eye(len(x))[0])
        for answer in ((x + outwards, lam), (x, negative), (x + off, lam)):
            row = facts(problem, "natural", *answer, accuracy=1e-6)
            sizes = [row[name] for name in RESIDUALS]
            assert row["reached"] == (max(sizes) <= 1e-6)
            assert row["reached"] == (share < 1), sizes
            assert row["says"] == "solved"


@pytest.mark.parametrize("name", ["gaps/1e-14/279", "infeasible/1.14868e-11/243"])
@pytest.mark.parametrize("size", [None, np.nan, 1e308, 1e160])
def test_success_without_numbers_or_with_such_as_overflow_reaches_nothing(members, name, size):
    one = next(one for one in members if one.id == name)
    n, m = one.natural.form.A.shape[::-1]
    x = None if size is None else np.full(n, size)
    for lam in (None, np.zeros(m), np.zeros(m + 1)):
        row = facts(one, "natural", x, lam, 1e-3)
        assert (row["says"], row["reached"]) == ("solved", False)
        assert all(row[name] is None or np.isfinite(row[name]) for name in RESIDUALS)
        assert not row["digits"]
