"""Lesson 4: the quadratic program, from scratch

Every number of a step is in its StepData; Eqs. (13) and (4) are a page of CVXPY.
"""

# %% setup
import cvxpy as cp
import numpy as np

import quasistatic_ref as qr
from quasistatic_ref.lab.digits import correct_digits
from quasistatic_ref.lab.scenes.pinch import pinch_step

STEPS = [
    pinch_step(5.0, 0.3, 0.5, 0.02),  # squeeze [N], lever [m], mu_v, mu_omega [m]: it slips
    qr.load_scenario("block_push", ["steps=60"]).run(progress=False).step_data(59),
]
EXACT = [qr.solve_step(step) for step in STEPS]

# %% task
"""delta_q of a step, by CVXPY: two variables, the objective of (13), the rows of (5) to (7)."""


def solved(step):
    return np.zeros(step.n_a + step.n_u)


# %% answer
def solved(step):
    a = cp.Variable(step.n_a)
    u = cp.Variable(step.n_u)
    delta_q = cp.hstack([a, u])
    c = step.contacts
    J_n, J_1, J_2 = (np.einsum("ci,civ->cv", axis, c.J[:, :3]) for axis in (c.n, c.d1, c.d2))
    gap = c.phi + J_n @ delta_q
    slips = [cp.multiply(c.mu_v, J @ delta_q) for J in (J_1, J_2)]
    rows = [gap + sign * slip >= 0 for slip in slips for sign in (1, -1)]
    six = np.flatnonzero(c.rows == 6)
    if len(six):
        spin = cp.multiply(c.mu_omega[six], c.J[six, 3] @ delta_q)
        rows += [gap[six] + spin >= 0, gap[six] - spin >= 0]
    h = step.h
    tau_k = step.K_q @ step.delta_q_bar_a
    cost = h / 2 * cp.quad_form(a, step.K_q) + cp.quad_form(u, step.M_u) / (2 * h)
    work = h * (tau_k + step.tau_a) @ a + h * step.tau_u @ u
    # In metres "optimal" promises little: costs of 1e-7 lie below the tolerances of solvers.
    cp.Problem(cp.Minimize(cost - work), rows).solve(solver=cp.CLARABEL)
    return delta_q.value


# %% check
check(
    "the program",
    lambda: all(
        correct_digits(step, solved(step), exact.delta_q) > 2
        for step, exact in zip(STEPS, EXACT, strict=True)
    ),
)

# %% task
"""The error ||x - x*||_H / ||H^-1 g||_H of an answer x to a step that a load moves."""


def error(x, exact, H, g):
    return np.nan


# %% answer
def error(x, exact, H, g):
    away = x - exact
    free = np.linalg.solve(H, g)
    return np.sqrt(away @ H @ away / (free @ H @ free))


# %% check
def as_digits(step, exact, x):
    c = correct_digits(step, x, exact.delta_q)
    H = np.zeros((step.n_a + step.n_u,) * 2)
    H[: step.n_a, : step.n_a], H[step.n_a :, step.n_a :] = step.h * step.K_q, step.M_u / step.h
    tau_k = step.K_q @ step.delta_q_bar_a
    g = step.h * np.concatenate([tau_k + step.tau_a, step.tau_u])
    return np.isclose(-np.log10(error(x, exact.delta_q, H, g)), c, atol=1e-6)


check(
    "digits",
    lambda: all(
        as_digits(step, exact, exact.delta_q * (1 + 10.0**-k))
        for step, exact in zip(STEPS, EXACT, strict=True)
        for k in (2, 5)
    ),
)
