"""The exact derivative of a step by its forces, and that of diffcp through CVXPY."""

import cvxpy as cp
import numpy as np

from quasistatic_ref import derivatives, load_scenario, solve_step
from quasistatic_ref.step.standard_form import standard_form

scenario = load_scenario("door", steps=61)
run = scenario.run(progress=False)
step = run.step_data(60)
solution, form = solve_step(step), standard_form(step)
size = np.abs(solution.delta_q).max()  # x is of size one
x, g = cp.Variable(step.n_v), cp.Parameter(step.n_v, value=form.g / size)
cost = cp.sum_squares(np.linalg.cholesky(form.H).T @ x) / 2 - g @ x
problem = cp.Problem(cp.Minimize(cost / form.H.max()), [form.A @ x >= form.b / size])
problem.solve(solver=cp.DIFFCP, requires_grad=True, eps=1e-12, max_iters=100_000)
x.gradient = np.eye(step.n_v)[-1]  # of the last coordinate, by all forces
problem.backward()
exact = derivatives(scenario.simulator(), run.q[60], run.q_bar_a[60]).dq_dtau[-1]
print(np.abs(step.h * g.gradient - exact).max() / np.abs(exact).max())
