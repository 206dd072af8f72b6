"""What is said of a proved answer is formed when it is read, and is what it always was."""

import gc
import pickle
from dataclasses import fields, replace

import pytest

from quasistatic_ref import Certificate, SolverStatistics, load_scenario, solve_step, verify
from quasistatic_ref.certify.norm import correct_digits
from quasistatic_ref.exact.program import ExactProgram
from quasistatic_ref.solve import solve
from tests.made import bits
from tests.oracles.random_steps import drawn


@pytest.fixture(scope="module")
def solution():
    return solve_step(drawn(11, "grasp"))


def forms_alive():
    gc.collect()
    return [one for one in gc.get_objects() if isinstance(one, ExactProgram)]


def test_a_run_does_not_ask_how_rows_touch(monkeypatch):
    def refused(*_):
        raise AssertionError("asked")

    monkeypatch.setattr(solve, "step_degeneracy", refused)
    before = len(forms_alive())
    run = load_scenario("stack", steps=2).run(progress=False)
    assert run["digits"].min() > 0
    assert len(forms_alive()) <= before + 1  # the last one, which the run's simulator keeps
    certificate = solve_step(run.step_data(1)).certificate
    with pytest.raises(AssertionError, match="asked"):
        _ = certificate.differentiable


def at_once(late):
    """The public data of which some fields are formed when they are read, all formed."""
    (kind,) = {Certificate, SolverStatistics} & {*type(late).__mro__}
    return kind(**{f.name: getattr(late, f.name) for f in fields(kind)})


def test_late_fields_are_those_of_the_data_that_they_stand_for(solution):
    """Equal, of one hash, and the same through a pickle, read before it or not."""
    late = solution.certificate
    unread = pickle.loads(pickle.dumps(late))
    assert not {"residuals", "degeneracy", "active"} & {*vars(unread)}
    for other in (unread, pickle.loads(pickle.dumps(late)), replace(late), at_once(late)):
        assert other == late
        assert hash(other) == hash(late)
        assert verify(replace(solution, certificate=other))
    assert replace(late, kind="none") != late


def test_digits_are_those_of_the_reply_that_the_solver_gave(solution):
    statistics = solution.statistics
    unread = pickle.loads(pickle.dumps(statistics))
    assert (
        statistics.digits
        == correct_digits(solution.step, statistics.reply, solution.delta_q)
        == unread.digits
    )
    assert bits(at_once(statistics)) == bits(statistics) == bits(unread)
