"""The same derivatives by diffcp, through CVXPY's differentiable layer of another form of (13)."""

import cvxpy as cp
import numpy as np
import pytest

from quasistatic_ref.optional.derivatives.step.sensitivity import sensitivity
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.standard_form import standard_form
from tests.helpers import planted_step
from tests.tolerances import DIFFCP


@pytest.mark.parametrize("seed", range(5))
def test_derivatives_by_forces_and_gaps_agree_with_diffcp(seed):
    step, _, _ = planted_step(np.random.default_rng(seed))
    form, contacts = standard_form(step), step.contacts
    found = sensitivity(step, solve_step(step).certificate)
    assert found.why_not == {}
    # min 1/2 ||L'x||^2 - g'x with x = size y, as diffcp needs it: sum_squares, not quad_form.
    size = float(np.abs(solve_step(step).delta_q).max())
    L = np.linalg.cholesky(form.H)
    y, g, phi = cp.Variable(step.n_v), cp.Parameter(step.n_v), cp.Parameter(contacts.n_c)
    row_phi = cp.hstack([phi[j] for j in range(contacts.n_c) for _ in range(contacts.rows[j])])
    scale = 1 / np.abs(form.H).max()
    objective = scale * (0.5 * cp.sum_squares(L.T @ y) - g @ y / size)
    problem = cp.Problem(cp.Minimize(objective), [form.A @ y + row_phi / size >= 0])
    g.value, phi.value = form.g, contacts.phi
    problem.solve(solver=cp.DIFFCP, requires_grad=True, eps=1e-12, max_iters=100_000)
    for v in range(step.n_v):
        y.gradient = size * np.eye(step.n_v)[v]
        problem.backward()
        by_force = np.concatenate([found.tau_a, found.tau_u], axis=1)[v]
        largest = np.abs(found.tau_u).max()
        np.testing.assert_allclose(step.h * g.gradient, by_force, rtol=0.0, atol=DIFFCP * largest)
        np.testing.assert_allclose(
            phi.gradient, found.phi[v], rtol=0.0, atol=DIFFCP * np.abs(found.phi).max()
        )
