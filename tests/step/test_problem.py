"""The parameterised CVXPY problem: its size, its cache, its empty cases, its multipliers."""

import re

import cvxpy as cp
import numpy as np
import pytest
from cvxpy.utilities.scopes import quad_form_dpp_scope
from numpy.testing import assert_array_equal

from quasistatic_ref import Extra, StepDataError, StepProblem, load_scenario, solve_step
from quasistatic_ref.solve import step_problem
from quasistatic_ref.solve.natural_step import NaturalStep
from quasistatic_ref.solve.step_problem import CvxpySolver
from quasistatic_ref.solve.units import in_si
from quasistatic_ref.step.problem import set_values
from quasistatic_ref.step.standard_form import friction_rows, page_units, si_units, standard_form
from tests.closeness import assert_close, assert_relative, assert_within
from tests.helpers import (
    PAPER,
    error,
    planted_step,
    random_step,
    with_mu_of,
)
from tests.oracles.printed_rows import problem_at
from tests.tolerances import OPTIMUM, ROUNDING


def test_a_program_is_compiled_at_its_first_solve_alone(monkeypatch):
    first, *others = (planted_step(seed, *PAPER)[0] for seed in range(3))
    others = [with_mu_of(first, step) for step in others]
    kept = CvxpySolver(first, "clarabel")
    solve_step(first, kept)
    compiled = kept.problem.problem._cache.param_prog
    assert compiled is not None

    def recompile(*_, **__):
        raise AssertionError("CVXPY compiled the problem again")

    monkeypatch.setattr(cp.Problem, "_construct_chain", recompile)
    for step in others:
        answer = solve_step(step, kept, certify="off").delta_q
        truth = solve_step(step, "none").delta_q
        assert_within(error(step, answer, truth), 0.0, OPTIMUM)
        assert kept.problem.problem._cache.param_prog is compiled


@pytest.mark.parametrize(("n_a", "n_u"), [(3, 4), (0, 1), (1, 0)])
def test_the_page_splits_J_to_the_bits_of_the_rows(n_a, n_u, rng):
    """J_n, J_1, J_2 and J_w combined as in Eqs. (5)-(7) are friction_rows."""
    step = random_step(rng, n_a, n_u)
    page = problem_at(step, np.zeros(n_a + n_u))
    J_n, J_1, J_2, J_w = (page.parameters[name].value for name in ("J_n", "J_1", "J_2", "J_w"))
    mu_v, _, mu_omega = step.contacts.mu.T[..., None]
    parts = (mu_v * J_1, mu_v * J_2, -mu_v * J_1, -mu_v * J_2, mu_omega * J_w, -mu_omega * J_w)
    rows = np.stack([J_n + part for part in parts], axis=1)
    assert_array_equal(friction_rows(step.contacts), rows)


@pytest.mark.parametrize("name", ["pyramid", "product", "facets-8", "frictionless", "many rows"])
def test_the_data_of_the_filled_page_are_the_standard_form(name, rng):
    """In SI and in natural units, whether the page is compiled once or canonicalised each time.

    With delta_q = h^2 a, energy / h^3 and rows / h^2. With rows of the user's own; CVXPY's list
    goes over the rows of a contact first.
    """
    rows, name = ((6, 4) * 600, "pyramid") if name == "many rows" else ((6, 4, 6), name)
    own = Extra(("a", "b"), rng.normal(size=(2, 13)), rng.normal(size=2))
    steps = [random_step(rng, 7, 6, rows).replace(cone=name, extra=own) for _ in range(2)]
    steps[1] = with_mu_of(steps[0], steps[1])
    page = StepProblem(steps[0])
    assert step_problem.is_large(page.problem) == (len(rows) > 3)
    m = int(steps[0].offsets[-1])
    order = [*np.argsort(np.nonzero(steps[0].mask)[1], kind="stable"), m, m + 1]
    h = steps[0].h
    unit = si_units(13)
    for step in steps:
        scaled = NaturalStep(step)
        natural = ((scaled.units, scaled.ends), scaled.within_reach, page_units(unit, h))
        for placed, form, (S, ell, rho) in (((), standard_form(step), unit), natural):
            set_values(page.page, step, *placed)
            data = step_problem.problem_data(page.problem, "clarabel", {}).numbers
            assert_relative(data["P"].toarray(), form.H * np.outer(S, S) * h)
            assert_close(data["c"], -form.g * S / rho / h, ROUNDING)
            assert_close(-data["A"].toarray(), form.A[order] * (S / ell), ROUNDING)
            assert_relative(-data["b"], form.b[order] / (rho * ell) / h**2)
    assert_within(S**2 * h - 1.0, 0.0, 1.0)  # the page's own units come to about one
    assert_within(rho * ell * h**2 - 1.0, 0.0, 1.0)


@pytest.mark.parametrize("name", ["bunny_grasp", "door"])
def test_a_plain_step_is_the_page_filled_and_solved_in_public(name):
    """The backend's answer of a run is that of ``problem.solve``, in every bit."""
    step = load_scenario(name, steps=3).run(progress=False, findings=False).step_data(2)
    scaled = NaturalStep(step)
    solver = CvxpySolver(step)
    accuracy, options = solver.option_sets(1e-12)[0]
    page = StepProblem(step)
    set_values(page.page, step, scaled.units, scaled.ends)
    page.problem.solve(solver="CLARABEL", canon_backend=step_problem.CANON, **options)
    units = page_units(scaled.units, step.h)
    delta_q, lam = in_si(page.primal(), page.dual(), units)
    reply = solver.reply(scaled, accuracy)
    found, impulses = in_si(*reply.point, scaled.units)
    assert_array_equal(found, delta_q)
    assert_array_equal(impulses, np.where(scaled.out_of_reach, 0.0, lam))
    assert_array_equal(StepProblem(step).solve(), delta_q)


def test_the_page_is_dpp_where_quadratic_forms_are_affine_in_their_matrix(rng):
    page = problem_at(random_step(rng), np.zeros(7)).problem
    assert not page.is_dpp()
    with quad_form_dpp_scope():
        assert page.is_dpp()


def test_the_page_prints_with_the_names_of_the_paper(rng):
    """Some contacts alone have torsion: their rows are taken by a product, which keeps brackets."""
    printed = str(StepProblem(random_step(rng)).problem)
    assert {"K_q", "M_u", "phi", "J_n", "mu_v", "mu_omega", "h^2"} <= set(
        re.findall(r"[\w^]+", printed)
    )
    assert "float64" not in printed
    assert "[" not in printed
    assert len(printed) < 1500


def test_a_step_of_another_kind_is_refused(rng):
    with pytest.raises(StepDataError, match=r"^h: must be 0\.01; make a problem of this step"):
        StepProblem(random_step(rng)).fill(random_step(rng).replace(h=0.02))
