"""No backend holds up a step at strange scales: a sample of validation/make/hostile_steps.py."""

import numpy as np

from quasistatic_ref.lab.scenes.at_random import random_contacts, random_step
from quasistatic_ref.solve.backends import NONE, UNSAFE
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.solver import solver_for
from quasistatic_ref.tolerances import ALIKE
from validation.make.hostile_steps import names
from validation.tools.fuzz import outcomes

HELD_UP = {"quadprog": 115, "cvxpy proxqp": 12, "highs": 308}
"""Inputs that held a backend up: quadprog for ever, by both its interfaces, and ProxQP through
CVXPY for longer than 10 s, in 20,000 iterations of up to 1,500 inner ones; HiGHS, by both of its
interfaces, ended the process."""
SAMPLE = 1
"""Steps that every path is given."""
READERS = "validation.make.hostile_steps"


def unlike_step(ratio):
    """A body of unit mass and inertia with four contacts without friction, two of them far out."""
    rng = np.random.default_rng(3)
    J = rng.standard_normal((4, 4, 6))
    J /= np.linalg.norm(J[:, 2], axis=1)[:, None, None]  # n is the third of a contact's axes
    J[2:] *= ratio
    frame = {"d1": [1.0, 0.0, 0.0], "d2": [0.0, 1.0, 0.0], "n": [0.0, 0.0, 1.0]}
    contacts = random_contacts(rng, 4, 6, phi=1e-3, rows=4, mu_v=0.0, J=J, **frame)
    return random_step(rng, 0, 6, contacts).replace(M_u=np.eye(6))


def test_a_backend_that_may_not_return_is_asked_only_where_rows_are_alike():
    assert {"quadprog", "highs"} == UNSAFE
    for ratio, status in ((0.9 * ALIKE, "optimal"), (1.1 * ALIKE, "failed: not called: its rows ")):
        step = unlike_step(ratio)
        exact = solve_step(step, NONE).delta_q
        for name in UNSAFE:
            for solver in (solver_for(step, name, name == "quadprog"), f"qpsolvers:{name}"):
                solution = solve_step(step, solver)
                assert solution.statistics.status.startswith(status)
                np.testing.assert_array_equal(solution.delta_q, exact)


def test_every_path_ends_exact_or_refused_also_where_it_was_held_up():
    held_up = [(name, i, 1) for part, i in HELD_UP.items() for name in names() if part in name]
    assert len(held_up) == 5  # but for ProxQP by two interfaces
    jobs = [(name, 0, SAMPLE) for name in names()] + held_up
    found = list(outcomes(jobs, READERS))
    assert [one for one in found if one[2] not in ("accepted", "refused")] == []
    assert len(found) == SAMPLE * len(names()) + len(held_up)
    ends = {}
    for _, i, outcome, *_ in found:
        ends.setdefault(i, set()).add(outcome)
    assert all(len(kinds) == 1 for kinds in ends.values())  # all paths end alike
    assert {"accepted"} in ends.values()
