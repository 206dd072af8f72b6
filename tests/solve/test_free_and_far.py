"""Steps without rows, rows that are far away, and answers that no backend calls solutions."""

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.solve import solve
from quasistatic_ref.solve.backends import DEFAULT, installed_backends
from quasistatic_ref.solve.solver import FREE, Reply
from quasistatic_ref.solve.step_problem import CvxpySolver
from tests.closeness import assert_relative, assert_within
from tests.helpers import pinch, random_step, sphere_on_floor

every_backend = pytest.mark.parametrize("backend", installed_backends())
WEIGHT = (0.0, 0.0, -2.943, 0.0, 0.0, 1e-3)


@every_backend
@pytest.mark.parametrize("certify", ["full", "residual", "off"])
def test_a_step_without_rows_is_solved_and_no_backend_is_asked(backend, certify):
    """H delta_q = g: a ball that falls and is turned, and coordinates with springs."""
    ball = sphere_on_floor(wrench=WEIGHT)
    nothing = random_step(0, n_a=0, n_u=6, rows=()).contacts
    for step in (ball.replace(contacts=nothing), random_step(1, rows=())):
        solution = qr.solve_step(step, backend, certify=certify)
        delta_q = np.linalg.solve(step.H, qr.standard_form(step).g)
        assert_relative(solution.delta_q, delta_q, 1e-12)
        said = solution.statistics
        assert (said.status, said.digits, said.unanswered) == (FREE, None, False)
        assert solution.certificate.kind == {"full": "exact", "off": "none"}.get(certify, certify)


FIELDS = ("n", "d1", "d2", "J", "mu_v", "mu_omega", "rows")


@every_backend
@pytest.mark.parametrize(("what", "far"), [("limit", 300.0), ("contact", 1e9)])
def test_what_is_far_away_costs_no_answer(backend, far, what):
    """Limits of all coordinates, both ways, [m] or [rad], and a floor; the ball is on another."""
    step = sphere_on_floor(wrench=WEIGHT)
    exact = qr.solve_step(step)
    if what == "limit":
        scaled = np.vstack([np.eye(6), -np.eye(6)])
        names = tuple(f"limit {i}" for i in range(12))
        step = step.replace(extra=qr.Extra(names, scaled, np.full(12, -far)))
    else:
        own = step.contacts
        twice = {name: np.repeat(array, 2, axis=0)
                 for name, array in vars(own).items() if name in FIELDS}  # fmt: skip
        phi = np.array([own.phi[0], far])
        step = step.replace(contacts=qr.Contacts(**(twice | {"name": ("near", "far"), "phi": phi})))
    said = qr.solve_step(step, backend, certify="off")
    size = np.abs(qr.standard_form(step).g).max() / step.H.max()
    assert_within(said.delta_q, exact.delta_q, 1e-5 * size)
    assert not said.lam_extra.any()
    assert not said.lam[6:].any()
    assert qr.solve_step(step, backend).delta_q.tobytes() == exact.delta_q.tobytes()


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
