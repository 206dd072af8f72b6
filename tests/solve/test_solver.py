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
    first_step,
    point_on_floor,
    random_step,
)
from tests.made import repeated
from tests.solvers import BACKENDS, ScaledStep, installed_backends, solver_for
from tests.tolerances import OPTIMUM


def with_mu(step, **mu):
    return step.replace(contacts=changed(step.contacts, **mu))


OTHERS = {
    "n_a": (lambda s, rng: random_step(rng, n_a=2), "CD"),
    "n_u": (lambda s, rng: random_step(rng, n_u=5), "CD"),
    "cone": (lambda s, rng: s.replace(cone="facets-8"), "CDQ"),
    "contacts.rows": (lambda s, rng: random_step(rng, rows=(4, 6, 6)), "CD"),
    "extra": (
        lambda s, rng: s.replace(extra=Extra(("a",), np.ones((1, 7)), [-1.0])), "CD",
    ),
    "h": (lambda s, rng: s.replace(h=2 * s.h), "C"),
    "contacts.mu_v": (lambda s, rng: with_mu(s, mu_v=0.5 * s.contacts.mu_v), "C"),
    "contacts.mu_omega": (lambda s, rng: with_mu(s, mu_omega=0.5 * s.contacts.mu_omega), "C"),
}  # fmt: skip
"""Steps of another kind, and who cannot take them: (C)vxpy, (D)aqp, (Q)psolvers."""


@pytest.mark.parametrize("name", ["piqp", "qpsolvers:piqp", "daqp"])
@pytest.mark.parametrize("what", OTHERS)
def test_a_solver_refuses_a_step_that_does_not_fit_and_says_what_differs(what, name, step, rng):
    solver = solver_for(step, name)
    other, who = OTHERS[what]
    other = other(step, rng)
    assert solver.fits(step)
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
    assert solver.fits(step)


def test_rows_of_an_extension_count_as_rows_of_the_step(step):
    floor = Extension(lambda s: [s.delta_q >= -1.0])
    for name in ("osqp", "daqp"):
        with pytest.raises(InputError, match="in extra; make"):
            solve_step(step, solver_for(step, name), extension=floor)


def test_no_solver_gives_no_answer_of_its_own(step):
    none = solver_for(step, "none")
    with pytest.raises(BackendError, match="has no answer of its own"):
        solve_step(step, none, certify="residual")
    with pytest.raises(StepNotSolved, match="not called"):
        none.answer(ScaledStep(step), 1e-9)


@pytest.mark.parametrize(("fast", "interface"), [(False, "cvxpy"), (True, "native")])
def test_a_simulator_keeps_its_solver_while_steps_fit(fast, interface):
    some = load_scenario("two_finger_pinch", ["solver.certify=off"], fast=fast)
    run = some.simulator()
    result = first_step(some, run)
    first = run.solver
    run.step(result.q, some.targets(2 * some.h))
    assert run.solver is first
    extra = Extra(("stop",), np.ones((1, result.step.n_v)), [-1.0])
    solution = run.solution(result.step.replace(extra=extra))
    assert run.solver is not first
    assert type(run.solver) is type(first)
    assert solution.statistics.interface == interface


@pytest.mark.parametrize(
    ("name", "interface"),
    [
        ("osqp", "cvxpy"), ("qpsolvers:piqp", "qpsolvers"), ("daqp", "native"), ("none", "none"),
    ],
)  # fmt: skip
def test_a_solver_that_was_pickled_or_copied_starts_afresh(name, interface, step):
    solver = solver_for(step, name)
    expected = solve_step(step, solver)
    for again in (pickle.loads(pickle.dumps(solver)), copy.copy(solver)):
        assert type(again) is type(solver)
        assert (again.name, again.interface) == (name, interface)
        assert again.fits(step)
        found = solve_step(step, again)
        assert_same(found.delta_q, expected.delta_q)
        assert found.statistics.status == expected.statistics.status


def test_a_backend_that_raises_is_set_up_again_for_the_next_step(step, monkeypatch):
    solver = solver_for(step, "daqp")
    honest = Workspaces.reply

    def broken(*_):
        raise RuntimeError("out of order")

    monkeypatch.setattr(Workspaces, "reply", broken)
    with pytest.raises(StepNotSolved, match="the solver failed: out of order") as caught:
        solve_step(step, solver, certify="off")
    assert isinstance(caught.value.__cause__, RuntimeError)
    monkeypatch.setattr(Workspaces, "reply", honest)
    answer = solve_step(step, solver, certify="off").delta_q
    assert error(step, answer, solve_step(step, "none").delta_q) <= OPTIMUM


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
