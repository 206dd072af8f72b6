"""Ctrl-C ends a solve of OSQP and SCS, whichever interface calls them."""

import os
import signal
import threading
import time

import cvxpy as cp
import numpy as np
import pytest

from quasistatic_ref import StandardForm
from quasistatic_ref.optional.qpsolvers.through_qpsolvers import qpsolvers_reply
from quasistatic_ref.solve.step_problem import cvxpy_reply

ENDLESS = {
    "osqp": {"eps_abs": 1e-18, "eps_rel": 1e-18, "max_iter": 10**8, "time_limit": 60.0},
    "scs": {"eps_abs": 1e-20, "eps_rel": 1e-20, "max_iters": 10**8, "time_limit_secs": 60.0},
}
"""Options with which a solver does not end before its limit of time."""


@pytest.fixture
def form(rng):
    """A program of 40 unknowns and 150 rows."""
    return StandardForm(np.eye(40), rng.normal(size=40), rng.normal(size=(150, 40)), -np.ones(150))


class Program:
    """A form as a CVXPY problem."""

    def __init__(self, form):
        self.x = cp.Variable(len(form.g))
        cost = cp.Minimize(cp.sum_squares(self.x) / 2 - form.g @ self.x)
        self.problem = cp.Problem(cost, [form.A @ self.x >= form.b])

    def primal(self):
        """The unknowns of the last solve."""
        return self.x.value

    def dual(self):
        """Its multipliers."""
        return self.problem.constraints[0].dual_value


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
def test_an_interrupt_ends_a_solve_through_cvxpy(form, interrupted, name):
    program = Program(form)
    cvxpy_reply(program, name, {})  # compiled here, so that the signal comes during the solve
    interrupted()
    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        cvxpy_reply(program, name, ENDLESS[name])
    assert time.monotonic() - begin < 50.0


@pytest.mark.parametrize("name", ENDLESS)
def test_an_interrupt_ends_a_solve_through_qpsolvers(form, interrupted, name):
    interrupted()
    with pytest.raises(KeyboardInterrupt):
        qpsolvers_reply(form, name, ENDLESS[name])
