"""A solver is one thing to pass: a name, or an object that says what it is and is not replaced."""

import copy
import pickle

import numpy as np
import pytest

from quasistatic_ref import (
    BackendError,
    Extension,
    Extra,
    InputError,
    StepNotSolved,
    load_scenario,
    solve_step,
)
from quasistatic_ref.optional.daqp.solver import Workspaces
from tests.closeness import assert_same
from tests.helpers import (
    changed,
    error,
    planted_step,
    point_on_floor,
    random_step,
    results_of,
)
from tests.made import repeated
from tests.solvers import BACKENDS, NaturalStep, installed_backends, solver_for
from tests.tolerances import OPTIMUM

STEP = planted_step(0)[0]
ROW = Extra(("stop",), np.ones((1, 7)), [-1.0])


def with_half(mu):
    contacts = STEP.contacts
    return STEP.replace(contacts=changed(contacts, **{mu: getattr(contacts, mu) / 2}))


OTHERS = {
    "n_a": (random_step(0, n_a=2), "CD"),
    "n_u": (random_step(0, n_u=5), "CD"),
    "cone": (STEP.replace(cone="facets-8"), "CDQ"),
    "contacts.rows": (random_step(0, rows=(4, 6, 6)), "CD"),
    "extra": (STEP.replace(extra=ROW), "CD"),
    "h": (STEP.replace(h=2 * STEP.h), "C"),
    "contacts.mu_v": (with_half("mu_v"), "C"),
    "contacts.mu_omega": (with_half("mu_omega"), "C"),
}
"""Steps of another kind, and who cannot take them: (C)vxpy, (D)aqp, (Q)psolvers."""


@pytest.mark.parametrize("name", ["piqp", "qpsolvers:piqp", "daqp"])
@pytest.mark.parametrize("what", OTHERS)
def test_a_solver_refuses_a_step_that_does_not_fit_and_says_what_differs(what, name):
    solver = solver_for(STEP, name)
    other, who = OTHERS[what]
    assert solver.fits(STEP)
    letter = type(solver).__name__[0]
    refused = letter in who
    assert solver.fits(other) == (not refused)
    if refused:
        for certify in ("off", "full"):
            with pytest.raises(InputError) as caught:
                solve_step(other, solver, certify=certify)
            named = str(caught.value).partition("in ")[2].partition(";")[0].split(", ")
            assert what in named
            assert set(named) <= {w for w, (_, refuse) in OTHERS.items() if letter in refuse}
    else:
        answer = solve_step(other, solver, certify="off").delta_q
        assert error(other, answer, solve_step(other, "none").delta_q) <= OPTIMUM
    assert solver.fits(STEP)


@pytest.mark.parametrize("name", ["osqp", "daqp"])
def test_rows_of_an_extension_count_as_rows_of_the_step(name):
    with pytest.raises(InputError, match="in extra; make"):
        solve_step(STEP, solver_for(STEP, name), extension=Extension(rows=ROW))


def test_no_solver_gives_no_answer_of_its_own():
    none = solver_for(STEP, "none")
    with pytest.raises(BackendError, match="has no answer of its own"):
        solve_step(STEP, none, certify="residual")
    reply = none.reply(NaturalStep(STEP), 1e-9)
    assert (reply.x, reply.solved, reply.status) == (None, False, "not called")


@pytest.mark.parametrize(("fast", "interface"), [(False, "cvxpy"), (True, "native")])
def test_a_simulator_keeps_its_solver_while_steps_fit(fast, interface):
    some = load_scenario("two_finger_pinch", ["solver.certify=off"], fast=fast)
    run = some.simulator()
    results = results_of(some, run)
    step = next(results).step
    first = run.solver
    next(results)
    assert run.solver is first
    extra = Extra(("stop",), np.ones((1, step.n_v)), [-1.0])
    solution = run.solution(step.replace(extra=extra))
    assert run.solver is not first
    assert type(run.solver) is type(first)
    assert solution.statistics.interface == interface


@pytest.mark.parametrize(
    ("name", "interface"),
    [
        ("osqp", "cvxpy"), ("qpsolvers:piqp", "qpsolvers"), ("daqp", "native"), ("none", "none"),
    ],
)  # fmt: skip
def test_a_solver_that_was_pickled_or_copied_starts_afresh(name, interface):
    solver = solver_for(STEP, name)
    expected = solve_step(STEP, solver)
    for again in (pickle.loads(pickle.dumps(solver)), copy.copy(solver)):
        assert type(again) is type(solver)
        assert (again.name, again.interface) == (name, interface)
        assert again.fits(STEP)
        found = solve_step(STEP, again)
        assert_same(found.delta_q, expected.delta_q)
        assert found.statistics.status == expected.statistics.status


def test_a_backend_that_raises_is_set_up_again_for_the_next_step(monkeypatch):
    solver = solver_for(STEP, "daqp")
    solve_step(STEP, solver)

    def broken(workspaces, programs):
        workspaces.each.clear()
        raise RuntimeError("out of order")

    with monkeypatch.context() as patch:
        patch.setattr(Workspaces, "reply", broken)
        with pytest.raises(StepNotSolved, match="the solver failed: out of order") as caught:
            solve_step(STEP, solver, certify="off")
    assert isinstance(caught.value.__cause__, RuntimeError)
    answer = solve_step(STEP, solver, certify="off").delta_q
    assert error(STEP, answer, solve_step(STEP, "none").delta_q) <= OPTIMUM


def test_a_backend_of_studies_only_is_no_backend_of_steps():
    for name in ("qpalm", "qpsolvers:qpalm", "quadprog", "qpsolvers:quadprog"):
        assert name not in installed_backends()
        why = BACKENDS[name.removeprefix("qpsolvers:")].no_steps
        with pytest.raises(BackendError, match=f"is not a backend of steps: {why}; studies"):
            solver_for(point_on_floor(), name)


def test_a_step_that_cvxpy_would_compile_for_minutes_is_proved_without_its_answer():
    """Of a point whose one contact is there 2001 times."""
    point = point_on_floor(force=(0.1, 0.0, -1.0))
    step = point.replace(contacts=repeated(point.contacts, [0] * 2001))
    proved = solve_step(step)
    assert proved.statistics.status.startswith("failed: not called: CVXPY takes too long")
    assert proved.certificate.kind == "exact"
    assert proved.delta_q.tobytes() == solve_step(point).delta_q.tobytes()
    says = "2001 contacts, more than 2000; the backends daqp and none"
    with pytest.raises(StepNotSolved, match=says):
        solve_step(step, certify="off")
    assert solve_step(step, "daqp", certify="off").statistics.status == "optimal"
