"""DAQP called group by group, in workspaces that are kept."""

import numpy as np

from quasistatic_ref import solve_step
from quasistatic_ref.optional.daqp.solver import Answer, DaqpSolver, Workspace
from tests.helpers import boxes_step, changed, error, planted_step
from tests.tolerances import ACTIVE_SET

AT_A_LOSS = Answer(np.zeros(0), np.zeros(0), -2, 0, 0.0)


def test_a_warm_start_that_fails_is_followed_by_a_cold_one(rng, monkeypatch):
    step, *_ = planted_step(rng)
    solver = DaqpSolver(step)
    right = solve_step(step, solver, certify="off").delta_q
    honest = Workspace._solved
    calls = []

    def solved(self, H, *, warm):
        calls.append(warm)
        return AT_A_LOSS if warm else honest(self, H, warm=warm)

    monkeypatch.setattr(Workspace, "_solved", solved)
    again = solve_step(step, solver, certify="off").delta_q
    assert error(step, again, right) <= ACTIVE_SET
    assert calls == [True, False]


CORNERS = {
    "square": ([0.0, 1.0, 1.0], np.eye(3)),
    "nearly flat": (
        [-1.0, 1.0, 0.0],
        [[-(2.0**-16), -1.0, -1.0], [0.0, 1.0, 0.0], [0.0, 1.0, 1.0]],
    ),
}
"""Loads f and rows of walls A x >= 0; x = 0 is the answer, as f is A' of multipliers >= 0."""


def test_a_workspace_that_had_no_finite_answer_is_set_up_again():
    """DAQP has NaN in the second corner after the first, and would have it from then on."""
    f, A, b, H = np.zeros(3), np.zeros((3, 3)), np.zeros(3), np.eye(3)
    f[:], A[:] = CORNERS["square"]
    workspace = Workspace(H, f, A, b, {})
    for corner in ("square", "nearly flat", "square"):
        f[:], A[:] = CORNERS[corner]
        answer = workspace.answer(H)
        assert answer.flag == 1
        assert np.abs(answer.x).max() < ACTIVE_SET


def test_a_step_that_couples_what_the_step_before_did_not_is_solved(rng):
    """J of a kept solver may have entries where it had zeros."""
    step = boxes_step(2)
    solver = DaqpSolver(step)
    J = step.contacts.J.copy()
    J[0, 0, 6] = 0.5
    coupled = step.replace(contacts=changed(step.contacts, J=J))
    for one in (step, coupled):
        answer = solve_step(one, solver, certify="off").delta_q
        assert error(one, answer, solve_step(one, "none").delta_q) <= ACTIVE_SET
