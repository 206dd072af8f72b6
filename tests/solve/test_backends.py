"""Every interface agrees with the judge, and a bad answer never comes back."""

import dataclasses
import functools
import os
import sys
from types import SimpleNamespace

import numpy as np
import pytest

from quasistatic_ref import BackendError, InputError, StepDataError, StepNotSolved
from quasistatic_ref.solve import backends, solve
from quasistatic_ref.solve.backends import (
    BACKENDS,
    backend,
    greeting_silenced,
    installed_backends,
)
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.step_problem import CvxpySolver
from tests.cases import cases
from tests.closeness import assert_same, assert_within
from tests.helpers import (
    INTERFACES,
    JUDGE,
    PAPER,
    changed,
    error,
    pinch,
    planted_step,
    point_on_floor,
)
from tests.processes import python
from tests.tolerances import OPTIMUM

solve_step = functools.partial(solve.solve_step, certify="residual")  # what backends say

every_interface = pytest.mark.parametrize("interface", INTERFACES)


def test_the_solvers_of_these_tests_are_installed_so_that_green_means_ran():
    assert set(INTERFACES) | {JUDGE} <= set(installed_backends())


@every_interface
def test_a_step_gives_the_same_bits_whatever_was_solved_before(interface):
    steps = [planted_step(seed)[0] for seed in (1, 2)]
    mu = {name: getattr(steps[1].contacts, name) for name in ("mu_v", "mu_omega")}
    steps[0] = steps[0].replace(contacts=changed(steps[0].contacts, **mu))
    solver = solver_for(steps[0], interface)
    solve_step(steps[0], solver)
    after_another = solve_step(steps[1], solver)
    alone = solve_step(steps[1], interface)
    assert_same(after_another.delta_q, alone.delta_q)
    assert_same(after_another.lam, alone.lam)


def test_a_backend_that_cvxpy_shall_not_call_is_reached_through_qpsolvers(monkeypatch):
    osqp = dataclasses.replace(BACKENDS["osqp"], cvxpy=False, required=False)
    monkeypatch.setitem(BACKENDS, "osqp", osqp)
    assert "osqp" not in installed_backends()
    monkeypatch.setattr(backends, "REQUIRED", ())
    with pytest.raises(BackendError, match="is available as 'qpsolvers:osqp'"):
        backend("osqp")


@pytest.mark.parametrize(
    ("name", "limit"),
    [("clarabel", "max_iter"), ("osqp", "max_iter"), ("piqp", "max_iter"), ("daqp", "iter_limit")],
)
@pytest.mark.parametrize("prefix", ["", "qpsolvers:"])
def test_a_solver_stopped_after_one_iteration_is_raised(prefix, name, limit, monkeypatch):
    step, _, _ = planted_step(3, *PAPER)
    entry = BACKENDS[name]
    stopped = dataclasses.replace(
        entry, option_sets=lambda a: tuple(options | {limit: 1} for options in entry.option_sets(a))
    )
    monkeypatch.setitem(BACKENDS, name, stopped)
    with pytest.raises(StepNotSolved) as caught:
        solve_step(step, prefix + name)
    assert caught.value.step is step


def make_backend_lie(monkeypatch, spoil):
    """Make the backend return a spoilt answer while it still says optimal."""
    honest = CvxpySolver.answer

    def answer(*args):
        given = honest(*args)
        return dataclasses.replace(given, **spoil(given))

    monkeypatch.setattr(CvxpySolver, "answer", answer)


LIES = {
    "a motion a little off": lambda a: {"x": a.x + 1e-4},
    "no multipliers": lambda a: {"lam": 0 * a.lam},
    "no-motion": lambda a: {"x": 0 * a.x},
    "not a number": lambda a: {"x": np.nan * a.x},
}


@cases("spoil", LIES)
def test_an_optimal_status_is_not_evidence(spoil, monkeypatch, step):
    make_backend_lie(monkeypatch, spoil)
    with pytest.raises(StepNotSolved) as caught:
        solve_step(step)
    assert caught.value.step is step
    assert not caught.value.residuals.worst <= 1e-6


def test_certify_off_takes_the_solver_s_word_and_says_so(monkeypatch, step):
    make_backend_lie(monkeypatch, LIES["no-motion"])
    answer = solve_step(step, certify="off")
    assert answer.certificate.kind == "none"
    assert not answer.certificate.residuals


def test_a_backend_is_not_asked_for_more_than_it_can_and_says_so():
    assert BACKENDS["osqp"].floor == 1e-10
    assert solve_step(pinch(), "osqp", accuracy=1e-12).statistics.accuracy == 1e-10
    assert solve_step(pinch(), "osqp", accuracy=1e-5).statistics.accuracy == 1e-5


@pytest.mark.parametrize(
    ("name", "known", "remedy"),
    [
        ("proxqp", ("osqp", "qpsolvers:proxqp"), "is available as 'qpsolvers:proxqp'"),
        ("proxqp", ("osqp",), "is not installed; pip install proxsuite, or "),
        ("clarabel", ("osqp",), "is not installed; pip install clarabel; installed here: osqp"),
    ],
)
def test_a_backend_that_is_not_here_is_named_with_what_is(name, known, remedy, monkeypatch):
    table = "quasistatic_ref.solve.backends"
    monkeypatch.setattr(f"{table}.find_spec", lambda name: None)
    monkeypatch.setattr(f"{table}.installed_backends", lambda: known)
    with pytest.raises(BackendError, match=remedy):
        backend(name)


@pytest.mark.parametrize("accuracy", [0.0, -1.0, float("nan")])
def test_an_accuracy_that_is_not_positive_is_refused(accuracy):
    with pytest.raises(InputError, match="accuracy: must be a number greater than 0"):
        solve_step(pinch(), accuracy=accuracy)


def test_a_second_set_of_options_is_tried_where_the_first_does_not_solve(monkeypatch, rng):
    step, delta_q, _ = planted_step(rng)
    entry = BACKENDS["piqp"]
    good = entry.option_sets(1e-12)[0]
    for attempts in ((good | {"max_iter": 1}, good), (good, good | {"max_iter": 1})):
        tried = dataclasses.replace(entry, option_sets=lambda _, attempts=attempts: attempts)
        monkeypatch.setitem(BACKENDS, "piqp", tried)
        gap = error(step, solve_step(step, "piqp").delta_q, delta_q)
        assert_within(gap, 0.0, OPTIMUM)


def test_impulses_whose_forces_leave_float64_are_refused():
    """Pushed out by 1 m within h, a force of m / h^2 = 3e309 N."""
    with pytest.raises(StepDataError, match="exceed the range"):
        solve.solve_step(point_on_floor(m=0.3, phi=-1.0, h=1e-155))


def test_the_greeting_of_highs_is_not_seen(monkeypatch, capfd):
    greeted = []

    def greeting():
        greeted.append(True)
        os.write(1, b"Running HiGHS\n")

    monkeypatch.setitem(sys.modules, "highspy", SimpleNamespace(Highs=greeting))
    greeting_silenced.cache_clear()
    for _ in range(2):
        greeting_silenced()
    greeting_silenced.cache_clear()
    print("said by us")
    assert greeted == [True]
    assert capfd.readouterr().out == "said by us\n"


BROKEN_SCS = """
import quasistatic_ref.solve.solve
from quasistatic_ref.solve.backends import installed
assert "scs" not in installed("cvxpy")
"""


def test_a_solver_that_cannot_be_imported_is_left_out_in_our_words(tmp_path):
    (tmp_path / "scs.py").write_text("raise RuntimeError('no licence')")
    environment = os.environ | {"PYTHONPATH": str(tmp_path)}
    done = python("-W", "default", "-c", BROKEN_SCS, env=environment)
    assert done.stdout == ""
    assert "UserWarning: scs is installed, but cannot be imported, and is left out" in done.stderr
    assert "licence" not in done.stderr
