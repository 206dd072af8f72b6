"""Ctrl-C ends a solve of OSQP and SCS, whichever interface calls them."""

import os
import signal
import threading
import time

import pytest

from quasistatic_ref import StepProblem, standard_form
from quasistatic_ref.optional.qpsolvers.through_qpsolvers import qpsolvers_reply
from quasistatic_ref.solve.step_problem import cvxpy_reply
from tests.helpers import random_step

ENDLESS = {
    "osqp": {"eps_abs": 1e-18, "eps_rel": 1e-18, "max_iter": 10**8, "time_limit": 60.0},
    "scs": {"eps_abs": 1e-20, "eps_rel": 1e-20, "max_iters": 10**8, "time_limit_secs": 60.0},
}
"""Options with which a solver does not end before its limit of time."""


STEP = random_step(0, 20, 20, (6,) * 25)
"""40 unknowns and 150 rows."""


@pytest.fixture
def interrupted():
    """A function that sends SIGINT in a second, as a terminal does."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timers = []

    def soon():
        timers.append(threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT)))
        timers[-1].start()

    yield soon
    for timer in timers:
        timer.cancel()
    signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("name", ENDLESS)
def test_an_interrupt_ends_a_solve_through_cvxpy(interrupted, name):
    page = StepProblem(STEP)
    cvxpy_reply(page, name, {})  # compiled here, so that the signal comes during the solve
    interrupted()
    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        cvxpy_reply(page, name, ENDLESS[name])
    assert time.monotonic() - begin < 50.0


@pytest.mark.parametrize("name", ENDLESS)
def test_an_interrupt_ends_a_solve_through_qpsolvers(interrupted, name):
    interrupted()
    with pytest.raises(KeyboardInterrupt):
        qpsolvers_reply(standard_form(STEP), name, ENDLESS[name])
