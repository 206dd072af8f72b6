"""What solvers are graded by: exact answers, enclosures, digits and residuals."""

import numpy as np
import pytest
from scipy.linalg import block_diag

from quasistatic_ref.certify.exact import form_optimum
from quasistatic_ref.lab.study.doors import NEAR, neighbour
from quasistatic_ref.lab.study.grade import grades, problem_forms
from quasistatic_ref.lab.study.problems.answers import exact_answer
from quasistatic_ref.lab.study.promises import RESIDUALS, resolved
from quasistatic_ref.lab.study.solvers import Solver
from quasistatic_ref.lab.vectors.exact.forms import exact_form_of
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.step.standard_form import StandardForm


def random_parts(rng, sizes=(1, 3, 4)):
    """A program of small integers, full of ties, whose parts are strewn over it; rows by part."""
    L, A = (block_diag(*[rng.integers(-2, 3, (k * n, n)) for n in sizes]) for k in (1, 3))
    strewn, of = (rng.permutation(len(M)) for M in (L, A))
    H = (L @ L.T + np.eye(len(L)))[np.ix_(strewn, strewn)]
    form = StandardForm(H, 1.0 * rng.integers(-2, 3, len(H)), 1.0 * A[np.ix_(of, strewn)],
                        -1.0 * rng.integers(0, 3, len(A)))  # fmt: skip
    return form, np.repeat(range(len(sizes)), 3 * np.array(sizes))[of]


@pytest.mark.parametrize("seed", range(10))
def test_parts_that_nothing_couples_have_the_bits_of_the_whole(seed):
    """Whatever rows they start from."""
    rng = np.random.default_rng(seed)
    form, of = random_parts(rng)
    whole = form_optimum(exact_form_of(*form))
    answer = exact_answer(form, rng.permutation(len(of))[:4].tolist())
    for name, of_whole in (("x", "delta_q"), ("net", "net"), ("slack", "slack")):
        assert getattr(answer, name).tobytes() == getattr(whole, of_whole).tobytes()
    assert answer.unique == whole.multipliers_unique
    assert answer.differentiable == whole.differentiable


def test_a_part_without_a_solution_is_proof_that_the_whole_has_none():
    """Its first row, twice: a x >= 1 and -a x >= 1."""
    form, of = random_parts(np.random.default_rng(0))
    one, other = np.flatnonzero(of == 1)[:2]
    form.A[other] = -form.A[one]
    form.b[[one, other]] = 1.0
    y = exact_answer(form).farkas
    assert y == {one: "1", other: "1"}


def test_natural_units_change_nothing_but_the_units(problem):
    natural = problem.natural
    units = problem.units
    scale = units.size * units.coordinate
    np.testing.assert_array_equal(exact_answer(natural.form).x * scale, problem.answer.x)
    measures = problem.facts["measures"]
    assert measures["condition_natural"] < measures["condition"]


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
    """X = x* + 10^-e ||H^-1 g||_H v with ||v||_H = 1 has an error of 10^-e, whatever the units."""
    ready = problem_forms(problem)
    H = problem.form.H
    g = problem.form.g
    v = np.linalg.solve(H, g) / np.sqrt(g @ np.linalg.solve(H, g))
    free = np.sqrt(g @ np.linalg.solve(H, g))
    x = problem.answer.x + 10.0**-exponent * free * v
    lam = lam_of(problem.form, x)  # H x - g = A' lam: the net impulse is off by H (x - x*)
    if units == "natural":
        x = x / (ready.units.size * ready.units.coordinate)
        lam = lam * (ready.units.length / ready.units.size)
    row = grades_of(problem, units, x, lam)
    assert row["digits"] == pytest.approx(exponent, abs=1e-3)
    assert row["digits_net"] == pytest.approx(exponent, abs=1e-3)
    assert row["iterations"] == 7


def test_residuals_are_those_of_qpbenchmark(problem):
    """Primal max(0, G x - h), dual |P x + q + G' z|, gap |x' P x + q' x + h' z|, by loops."""
    rng = np.random.default_rng(0)
    form = problem.form
    x = 1e-4 * rng.normal(size=len(form.g))
    z = 1e-4 * rng.uniform(size=len(form.b))
    P = form.H
    q = -form.g
    G = -form.A
    h = -form.b
    primal = max(max(0.0, sum(G[i] * x) - h[i]) for i in range(len(h)))
    dual = max(abs(sum(P[v] * x) + q[v] + sum(G[:, v] * z)) for v in range(len(q)))
    gap = abs(sum(x[v] * sum(P[v] * x) for v in range(len(q))) + sum(q * x) + sum(h * z))
    row = grades_of(problem, "raw", x, z)
    numbers = [row[name] for name in RESIDUALS]
    np.testing.assert_allclose(numbers, [primal, dual, gap], rtol=1e-10, atol=1e-16)


def test_a_solver_that_gave_up_has_failed_and_keeps_its_digits(problem):
    for x, digits in ((problem.answer.x, 16.0), (np.full(len(problem.form.g), np.nan), None)):
        row = grades_of(problem, "raw", x, None, solved=False)
        assert (row["outcome"], row["claim"], row["false_claim"]) == ("failed", "neither", False)
        assert (row["digits"], row["digits_net"], row["digits_lam"]) == (digits, None, None)


def test_a_neighbour_differs_in_g_alone_by_one_percent_at_most(problem):
    form = problem.form
    near = neighbour(form, problem.id)
    assert near.H is form.H
    assert near.A is form.A
    change = np.abs(near.g / form.g - 1)[form.g != 0]
    assert 0 < change.max() <= NEAR * (1 + 1e-12)
    np.testing.assert_array_equal(near.g, neighbour(form, problem.id).g)
