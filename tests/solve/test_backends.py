"""Every interface agrees with the judge, and a bad answer never comes back."""

import dataclasses
import functools
import os
import sys
from types import SimpleNamespace

import pytest

import quasistatic_ref as qr
from quasistatic_ref import BackendError, InputError, StepDataError, StepNotSolved
from quasistatic_ref.solve.backends import backend, greeting_silenced
from tests.closeness import assert_same, assert_within
from tests.helpers import (
    PAPER,
    REQUIRED,
    error,
    pinch,
    planted_step,
    point_on_floor,
    with_mu_of,
)
from tests.processes import python
from tests.solvers import BACKENDS, installed_backends, solver_for
from tests.tolerances import OPTIMUM

COLD = (*REQUIRED[:-1], "cvxpy:daqp", *(f"qpsolvers:{name}" for name in REQUIRED))
"""Those that start each step alike."""
solve_step = functools.partial(qr.solve_step, certify="residual")  # what backends say


@pytest.fixture
def tries(monkeypatch):
    """A function that sets the options which a backend tries: ``tries("piqp", first, second)``."""

    def tried(name, *sets):
        entry = dataclasses.replace(BACKENDS[name], option_sets=lambda _: sets)
        monkeypatch.setitem(BACKENDS, name, entry)

    return tried


def test_the_solvers_of_these_tests_are_installed_so_that_green_means_ran():
    assert {*COLD, "daqp"} <= {*installed_backends()}


@pytest.mark.parametrize("interface", COLD)
def test_a_step_gives_the_same_bits_whatever_was_solved_before(interface):
    other, step = (planted_step(seed)[0] for seed in (1, 2))
    solver = solver_for(step, interface)
    solve_step(with_mu_of(step, other), solver)
    after_another = solve_step(step, solver)
    alone = solve_step(step, interface)
    assert_same(after_another.delta_q, alone.delta_q)
    assert_same(after_another.lam, alone.lam)


def test_a_backend_that_cvxpy_shall_not_call_is_reached_through_qpsolvers(monkeypatch):
    assert "scs" in installed_backends()
    monkeypatch.setitem(BACKENDS, "scs", dataclasses.replace(BACKENDS["scs"], cvxpy=False))
    assert "scs" not in installed_backends()
    with pytest.raises(BackendError, match="is available as 'qpsolvers:scs'"):
        backend("scs")


LIMITS = {"clarabel": "max_iter", "osqp": "max_iter", "piqp": "max_iter", "daqp": "iter_limit"}


@pytest.mark.parametrize("name", LIMITS)
@pytest.mark.parametrize("prefix", ["", "qpsolvers:"])
def test_a_solver_stopped_after_one_iteration_is_raised(prefix, name, tries):
    step, *_ = planted_step(3, *PAPER)
    options, *_ = BACKENDS[name].option_sets(1e-12)
    tries(name, options | {LIMITS[name]: 1})
    with pytest.raises(StepNotSolved) as caught:
        solve_step(step, prefix + name)
    assert caught.value.step is step


@pytest.mark.parametrize("accuracy", [1e-16, 1e-17])
def test_clarabel_that_stops_short_of_the_accuracy_keeps_its_digits(accuracy):
    said = qr.solve_step(pinch(), "clarabel", accuracy=accuracy).statistics
    assert said.digits is None or said.digits > 10
    assert said.unanswered == (said.digits is None)


def test_a_backend_is_not_asked_for_more_than_it_can_and_says_so():
    assert BACKENDS["osqp"].floor == 1e-10
    assert solve_step(pinch(), "osqp", accuracy=1e-12).statistics.accuracy == 1e-10
    assert solve_step(pinch(), "osqp", accuracy=1e-5).statistics.accuracy == 1e-5


@pytest.mark.parametrize(
    ("name", "remedy"),
    [("proxqp", "proxsuite, or "), ("clarabel", "clarabel; installed here: none")],
)
def test_a_backend_that_is_not_here_is_named_with_what_is(name, remedy, monkeypatch):
    table = "quasistatic_ref.solve.backends"
    monkeypatch.setattr(f"{table}.find_spec", lambda name: None)
    monkeypatch.setattr(f"{table}.installed_backends", lambda: ())
    with pytest.raises(BackendError, match=f"is not installed; pip install {remedy}"):
        backend(name)


@pytest.mark.parametrize("accuracy", [0.0, -1.0, float("nan")])
def test_an_accuracy_that_is_not_positive_is_refused(accuracy):
    with pytest.raises(InputError, match="accuracy: must be a number greater than 0"):
        solve_step(pinch(), accuracy=accuracy)


def test_a_second_set_of_options_is_tried_where_the_first_does_not_solve(tries, rng):
    step, delta_q, _ = planted_step(rng)
    good, *_ = BACKENDS["piqp"].option_sets(1e-12)
    bad = good | {"max_iter": 1}
    for sets in ((bad, good), (good, bad)):
        tries("piqp", *sets)
        gap = error(step, solve_step(step, "piqp").delta_q, delta_q)
        assert_within(gap, 0.0, OPTIMUM)


def test_impulses_whose_forces_leave_float64_are_refused_where_anything_is_claimed():
    """Pushed out by 0.1 m within h, a force of 0.1 m / h^2 = 3e308 N."""
    step = point_on_floor(m=30.0, phi=-0.1, h=1e-154)
    for certify in ("full", "residual"):
        with pytest.raises(StepDataError, match="exceed the range of float64"):
            qr.solve_step(step, certify=certify)
    assert qr.solve_step(step, certify="off").lam.any()


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
