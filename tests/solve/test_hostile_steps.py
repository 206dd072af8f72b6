"""No backend holds up a step at strange scales."""

import random

import pytest

from quasistatic_ref import InputError, QuasistaticError, solve_step
from quasistatic_ref.solve.backends import NONE, installed, installed_backends
from quasistatic_ref.solve.solver import solver_for
from tests.oracles.attacked_steps import hostile_step

HELD_UP = {"quadprog": 115, "cvxpy proxqp": 12, "highs": 308}
"""Steps that held a backend up: quadprog for ever, by both its interfaces, and ProxQP through
CVXPY for longer than 10 s, in 20,000 iterations of up to 1,500 inner ones; HiGHS, by both of its
interfaces, ended the process."""
PATHS = [
    *(("cvxpy", name) for name in installed_backends()),
    *(
        pytest.param(("native", name), marks=pytest.mark.extra("fast"))
        for name in installed("native")
    ),
]
"""Every backend that is here by every interface."""


def hostile(number):
    """A step at scales of 1e-12 to 1e12."""
    rng = random.Random(f"step.json/{number}")
    rng.choice([0])
    while True:
        try:
            return hostile_step(rng)
        except InputError:
            continue


def end_of(step, solver):
    """The bits of the answer, or the kind of error."""
    try:
        return solve_step(step, solver).delta_q.tobytes()
    except QuasistaticError as error:
        return type(error)


@pytest.mark.parametrize("path", PATHS, ids=lambda path: " ".join(path).replace(":", " "))
def test_every_path_ends_as_no_backend_does_also_where_it_was_held_up(path):
    interface, name = path
    numbers = [0, *(number for part, number in HELD_UP.items() if part in " ".join(path))]
    for step in map(hostile, numbers):
        solver = solver_for(step, name, fast=interface == "native")
        assert end_of(step, solver) == end_of(step, NONE)


def test_some_steps_that_held_a_backend_up_have_an_optimum():
    assert bytes in {type(end_of(hostile(number), NONE)) for number in HELD_UP.values()}
