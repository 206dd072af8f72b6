"""Each solver takes each kind of step: its answer is near the optimum, which has the same bits."""

from functools import cache
from itertools import islice

import numpy as np
import pytest

import quasistatic_ref as qr
from tests.closeness import assert_within
from tests.helpers import SHAPES, error, planted_step, random_step, sphere_on_floor
from tests.made import repeated
from tests.oracles.random_steps import steps
from tests.solvers import FREE, NONE, installed_backends, others_installed, solver_for
from tests.tolerances import OPTIMUM

BALL = sphere_on_floor(wrench=(0.0, 0.0, -2.943, 0.0, 0.0, 1e-3))
NO_CONTACTS = random_step(0, n_a=0, n_u=6, rows=()).contacts
FAR_LIMITS = qr.Extra(
    tuple(map(str, range(12))), np.vstack([np.eye(6), -np.eye(6)]), np.full(12, -300.0)
)
PLAIN = [
    *(random_step(0, *shape) for shape in SHAPES),
    *(planted_step(0, *shape)[0] for shape in SHAPES),
    BALL.replace(contacts=NO_CONTACTS),
    BALL.replace(extra=FAR_LIMITS),
    BALL.replace(contacts=repeated(BALL.contacts, [0, 0], phi=[0.0, 1e9])),
]
HOSTILE = list(islice(steps("any scales"), 3))
"""Numbers up to 1e12 apart: an optimum, or a proof that there is none."""
OTHERS = [name for name in others_installed() if "gurobi" not in name]
"""What CVXPY and qpsolvers have here besides the table."""


def end_of(step, solver):
    """The bits of the answer, or the kind of error."""
    try:
        return qr.solve_step(step, solver).delta_q.tobytes()
    except qr.QuasistaticError as error:
        return type(error)


@cache
def ends():
    """How each step ends without a backend: those of `PLAIN`, then the hostile ones."""
    ends = [end_of(step, NONE) for step in (*PLAIN, *HOSTILE)]
    assert {type(end) for end in ends[: len(PLAIN)]} == {bytes}
    return ends


@pytest.mark.shared
@pytest.mark.parametrize("name", [*installed_backends(), *OTHERS])
def test_each_step_ends_as_without_a_backend(name, capfd):
    for step, end in zip((*PLAIN, *HOSTILE), ends(), strict=True):
        solver = solver_for(step, name)
        assert end_of(step, solver) == end
        assert solver.name == name
    assert capfd.readouterr() == ("", "")  # and no interface warns, for warnings are errors here


@pytest.mark.shared
@pytest.mark.parametrize("name", installed_backends())
def test_an_unproved_answer_is_near_the_optimum(name):
    for step in PLAIN:
        exact = qr.solve_step(step, NONE)
        solver = solver_for(step, name)
        answer = qr.solve_step(step, solver, certify="residual")
        assert_within(error(step, answer.delta_q, exact.delta_q), 0.0, OPTIMUM)
        # lam is not unique with 15 contacts in R^13; what it does to the coordinates is.
        push, right = (qr.standard_form(step).A.T @ each.lam for each in (answer, exact))
        assert_within(push, right, OPTIMUM * np.abs(right).max(initial=0.0))
        assert not answer.lam_extra.any()
        assert answer.certificate.kind == "residual"
        statistics = answer.statistics
        assert answer.backend == statistics.backend == name
        assert statistics.interface == solver.interface
        assert (statistics.status == FREE) == (step.m == 0)


@pytest.mark.parametrize(
    ("certify", "kind"), [("full", "exact"), ("residual", "residual"), ("off", "none")]
)
def test_a_step_without_rows_asks_no_backend(certify, kind):
    """H delta_q = g: a ball that falls and is turned."""
    step = BALL.replace(contacts=NO_CONTACTS)
    solution = qr.solve_step(step, certify=certify)
    assert_within(solution.delta_q, np.linalg.solve(step.H, qr.standard_form(step).g), 1e-12)
    statistics = solution.statistics
    assert (statistics.status, statistics.digits, statistics.unanswered) == (FREE, None, False)
    assert solution.certificate.kind == kind
