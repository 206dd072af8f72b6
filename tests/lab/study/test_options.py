"""Options that a solver would not get, or not take, are errors before a study runs."""

from fractions import Fraction

import numpy as np
import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.study.accepted import check_options
from quasistatic_ref.lab.study.doors import call_of
from quasistatic_ref.lab.study.solvers import BY_NAME, SETTINGS, Solver, installed_here
from quasistatic_ref.lab.study.worker import Question, answered
from quasistatic_ref.optional.qpsolvers.through_qpsolvers import qpsolvers_reply
from quasistatic_ref.step.standard_form import StandardForm

HERE = [(door, name) for door in BY_NAME for name in installed_here(door)]


WRONG = [
    ("qpsolvers", "piqp", "eps_absolute", 1e-12),
    ("qpsolvers", "daqp", "primal_tolerance", 1e-12),
    ("qpsolvers", "highs", "primal_feasibility_tolerance", 1e-12),
    ("cvxpy", "clarabel", "tol_feasibility", 1e-12),
    ("cvxpy", "scs", "eps_abs", -1.0),
]  # fmt: skip


@pytest.mark.parametrize(
    ("door", "solver", "option", "value"), [one for one in WRONG if one[:2] in HERE]
)
def test_a_name_that_is_unknown_and_a_value_that_is_refused_are_errors(door, solver, option, value):
    with pytest.raises(InputError) as said:
        check_options(door, solver, {option: value})
    assert str(said.value).startswith(f"{option}: is ")
    assert f"{door}:{solver}" in str(said.value)


def test_what_a_solver_keeps_in_place_of_a_value_is_read_back():
    with pytest.raises(InputError, match=r"eps_abs: is 0\.33\d* after qpsolvers:piqp was given it"):
        check_options("qpsolvers", "piqp", {"eps_abs": Fraction(1, 3)})


@pytest.mark.parametrize(("door", "name"), HERE, ids=":".join)
def test_solvers_take_the_options_of_every_setting(door, name):
    solver = Solver(name, door, name)
    for setting in SETTINGS:
        if solver.takes(setting):
            check_options(door, name, solver.settings_of(setting, 2.0))


@pytest.mark.parametrize("name", [name for door, name in HERE if door == "qpsolvers"])
def test_a_solver_is_called_warm_where_its_door_uses_the_start(members, name):
    """With a start that is the answer, or far off, a solver that uses it returns other bits."""
    natural = next(one for one in members if one.id == "contacts/21/76").natural
    x = natural.answer.x
    starts = (None, x, x + 1000.0)
    answers = [qpsolvers_reply(natural.form, name, {}, start).x.tobytes() for start in starts]
    assert (len(set(answers)) > 1) == Solver(name, "qpsolvers", name).warm


def test_a_step_that_was_not_solved_starts_nothing():
    """OSQP leaves numbers that are finite, and mean nothing."""
    rows = np.array([[1.0, 1.0], [-1.0, -1.0]])
    none = StandardForm(np.eye(2), np.zeros(2), rows, np.array([1.0, 0.0]))
    osqp = Solver("osqp", "qpsolvers", "osqp")
    call = call_of(osqp)
    failed = answered(call, Question(none, {}), None).reply
    assert not failed.solved
    assert failed.x is not None
    form = none._replace(b=np.array([-1.0, -1.0]))
    assert not answered(call, Question(form, {}, start=none), None).started
    assert not answered(call, Question(form, {}, goes_on=True), failed).started
    assert answered(call, Question(form, {}, start=form), None).started
