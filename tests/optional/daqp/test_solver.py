"""DAQP called group by group, in workspaces that are kept."""

import numpy as np

from quasistatic_ref import solve_step
from quasistatic_ref.lab.bench.scenes import boxes
from quasistatic_ref.optional.daqp.solver import DaqpSolver, Workspace
from quasistatic_ref.solve.solver import Reply
from quasistatic_ref.step.standard_form import StandardForm
from tests.helpers import changed, error, planted_step
from tests.tolerances import ACTIVE_SET


def test_a_warm_start_that_fails_is_followed_by_a_cold_one(rng, monkeypatch):
    step, *_ = planted_step(rng)
    solver = DaqpSolver(step)
    right = solve_step(step, solver, certify="off").delta_q
    honest = Workspace._solved
    calls = []

    def solved(self, form, *, warm):
        calls.append(warm)
        return Reply(None, None, False, "at a loss") if warm else honest(self, form, warm=warm)

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
    forms = {
        name: StandardForm(np.eye(3), -np.array(f), np.array(A), np.zeros(3))
        for name, (f, A) in CORNERS.items()
    }
    workspace = Workspace(forms["square"], {})
    for corner in ("square", "nearly flat", "square"):
        reply = workspace.reply(forms[corner])
        assert reply.solved
        assert np.abs(reply.answer[0]).max() < ACTIVE_SET


def test_a_step_that_couples_what_the_step_before_did_not_is_solved(rng):
    """J of a kept solver may have entries where it had zeros."""
    scene = boxes(2)
    step = scene.simulator("off", False).step(scene.q, np.zeros(0), scene.force).step
    solver = DaqpSolver(step)
    J = step.contacts.J.copy()
    J[0, 0, 6] = 0.5
    coupled = step.replace(contacts=changed(step.contacts, J=J))
    for one in (step, coupled):
        answer = solve_step(one, solver, certify="off").delta_q
        assert error(one, answer, solve_step(one, "none").delta_q) <= ACTIVE_SET
