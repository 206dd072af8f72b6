"""Answers that no backend calls solutions."""

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.solve import solve
from quasistatic_ref.solve.backends import DEFAULT
from quasistatic_ref.solve.solver import Reply
from quasistatic_ref.solve.step_problem import CvxpySolver
from tests.helpers import pinch


def replying(monkeypatch, status, x):
    """Let CVXPY's backends answer so, without a solution's status."""

    def reply(self, options, scaled):
        m = scaled.form.b.size
        return Reply(None if x is None else x(scaled), np.zeros(m), False, status)

    monkeypatch.setattr(CvxpySolver, "reply", reply)


def exact_answer(scaled):
    """The optimum in natural units."""
    exact = solve.solve_step(scaled.step, "none")
    return exact.delta_q / (scaled.units.size * scaled.units.coordinate)


def test_an_answer_of_another_status_has_the_digits_that_were_measured(monkeypatch):
    replying(monkeypatch, "user_limit", exact_answer)
    said = qr.solve_step(pinch(), DEFAULT).statistics
    assert said.status == "failed: user_limit"
    assert said.digits == 16.0
    assert not said.unanswered


def test_a_backend_without_an_answer_has_no_digits(monkeypatch, cli, tmp_path):
    replying(monkeypatch, "infeasible_inaccurate", None)
    said = qr.solve_step(pinch(), DEFAULT).statistics
    assert (said.digits, said.unanswered) == (None, True)
    path = tmp_path / "pinch.step.json"
    qr.save_step(path, pinch())
    told = cli("solve", path).err
    assert "correct digits" not in told


@pytest.mark.parametrize("accuracy", [1e-16, 1e-17])
def test_clarabel_that_stops_short_of_the_accuracy_keeps_its_digits(accuracy):
    said = qr.solve_step(pinch(), "clarabel", accuracy=accuracy).statistics
    assert said.digits is None or said.digits > 10
    assert said.unanswered == (said.digits is None)
