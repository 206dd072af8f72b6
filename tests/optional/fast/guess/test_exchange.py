"""A wrong guess of a working set is mended by walks in floating point, and proved."""

from contextlib import nullcontext

import numpy as np
import pytest

from quasistatic_ref.certify import exact as method
from quasistatic_ref.certify.active_set import Farkas
from quasistatic_ref.certify.exact import form_optimum
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.lab.scenes.piles import pile
from quasistatic_ref.optional.fast.guess import exchange
from quasistatic_ref.optional.fast.guess.exchange import GUESSES, Refuted, proved_nearby, walked
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.standard_form import StandardForm
from tests.helpers import pinch
from tests.optional.fast.compiled.test_fast import needs_compiler
from validation.make.confirmed_bits import (
    NEARBY,
    OTHERS,
    differing,
    nearby_answer,
    proof,
    random_case,
    wrong_sets,
)


@needs_compiler
def test_what_is_proved_near_a_wrong_guess_is_the_optimum_in_every_bit():
    """Of lam and the working set that is said where the multipliers are unique."""
    mended = 0
    for seed in range(20):
        step = random_case(seed)[1]
        truth = form_optimum(exact_form(step))
        if isinstance(truth, Farkas):
            continue
        rng = np.random.default_rng(seed)
        right = list(truth.working_set)
        for guess in wrong_sets(rng, right, len(truth.lam)):
            found = nearby_answer(step, guess)
            if found is None:
                continue
            assert set(differing(found, truth)) <= (NEARBY if truth.multipliers_unique else OTHERS)
            mended += isinstance(proof(step, np.array(sorted(set(guess)))), Refuted)
    assert mended >= 5


CERTIFIED = "off", "full"
NONE = np.zeros(0)


def refused(*_):
    raise AssertionError("the method that decides everything was called, or prepared")


@pytest.mark.extra("robots")
@needs_compiler
def test_rows_that_daqp_does_not_see_do_not_cost_the_exact_method(monkeypatch):
    """A hand turns a ball: from the third step on a row is missing of nearly every guess."""
    monkeypatch.setattr(method, "form_optimum", refused)
    monkeypatch.setattr("quasistatic_ref.optional.fast.proofs.warm_rows", refused)
    scenario = load_scenario("allegro_turn", fast=True)
    simulator = scenario.simulator()
    q = scenario.system.q_start
    wrong = 0
    for k in range(12):
        found = simulator.step(q, scenario.targets(scenario.h * (k + 1)))
        q = found.q
        wrong += found.solution.statistics.digits < 16
        assert found.solution.certificate.kind == "exact"
    assert wrong > 0


@needs_compiler
@pytest.mark.parametrize("tries", [GUESSES, 0])
def test_boxes_at_rest_on_each_other_do_not_cost_the_exact_method(monkeypatch, tries):
    """Four boxes, which fall by 1e-5 m a step, through three gaps of 1e-4 m; with walks alone."""
    monkeypatch.setattr(exchange, "GUESSES", tries)
    falling, certified = (pile((1, 1, 4), backend="daqp", certify=c).simulator for c in CERTIFIED)
    q = falling.system.q_start
    for _ in range(50):
        q = falling.step(q, NONE).q
    monkeypatch.setattr(method, "form_optimum", refused)
    with nullcontext() if tries else pytest.raises(AssertionError, match="decides everything"):
        assert certified.step(q, NONE).solution.certificate.kind == "exact"


@needs_compiler
def test_rows_that_depend_on_each_other_are_chosen_from_and_proved(monkeypatch):
    """Clarabel presses on all six rows of each contact that sticks, of which four hold it."""
    monkeypatch.setattr(method, "form_optimum", refused)
    assert solve_step(pinch(grip=5.0), "clarabel", fast=True).certificate.kind == "exact"


def line(*bounds):
    """X >= b for each bound, of one coordinate, H = 1 and g = 0."""
    b = np.array(bounds, dtype=np.float64)
    return StandardForm(np.eye(1), np.zeros(1), np.ones((len(b), 1)), b)


def refuted(form, working, lam):
    """A guess and the slacks of its minimiser, H being 1: x = g + A'lam."""
    x = form.g + form.A[working].T @ np.array(lam)
    return Refuted(np.array(working, dtype=np.int64), np.array(lam), form.A @ x - form.b)


def test_a_walk_adds_the_row_and_drops_what_stops_pressing():
    form = line(1.0, 2.0)
    assert walked(line(1.0), np.eye(1), refuted(line(1.0), [], [])).tolist() == [0]
    # x >= 1 holds with lam = 1; x >= 2 depends on it, takes its place, and is left alone.
    assert walked(form, np.eye(1), refuted(form, [0], [1.0])).tolist() == [1]
    # x <= -1 against x >= 1: nothing gives way.
    form = StandardForm(np.eye(1), np.zeros(1), np.array([[1.0], [-1.0]]), np.ones(2))
    assert walked(form, np.eye(1), refuted(form, [0], [1.0])) is None
    # x >= 1 twice: rows that depend on each other are no working set.
    form = line(1.0, 1.0, 2.0)
    assert walked(form, np.eye(1), refuted(form, [0, 1], [0.5, 0.5])) is None


@pytest.mark.parametrize(("a", "b"), [(1.0, 1.0), (1e-6, 1.0), (1.0, 1e-9)])
def test_a_row_that_stays_violated_when_another_is_added_is_added_too(a, b):
    """X >= 2 b and x + y >= 3 b, both times a: the second leaves x at 1.5 b; on both, both bear."""
    A = a * np.array([[1.0, 0.0], [1.0, 1.0]])
    form = StandardForm(np.eye(2), np.zeros(2), A, a * b * np.array([2.0, 3.0]))
    assert walked(form, np.eye(2), refuted(form, [], [])).tolist() == [0, 1]


@pytest.mark.parametrize(
    ("short", "left"),
    [(0.5, [0, 1, 2]), (2.5, [1, 2]), (3.5, [2])],
)
def test_a_walk_drops_one_row_after_the_other(short, left):
    """X >= 1 and y >= 2 hold with lam = (1, 2); x + y + z >= 3 + s takes one of each as it grows.

    At the rate 1 it closes s up to 1, where x >= 1 bears nothing; then at the rate 2 up to 3, where
    the next unit of y >= 2 is used up.
    """
    form = StandardForm(
        np.eye(3), np.zeros(3), np.array([[1.0, 0, 0], [0, 1.0, 0], [1.0, 1, 1]]),
        np.array([1.0, 2.0, 3.0 + short]),
    )  # fmt: skip
    assert walked(form, np.eye(3), refuted(form, [0, 1], [1.0, 2.0])).tolist() == left


def test_what_pulls_is_dropped_one_row_at_a_time():
    """X <= 1 and x + y >= 0 at g = (2, 2): the second pulls; without it, the first bears 1.

    On both, x = 1 and y = -1: A'lam = x - g = (-1, -3) = lam_0 (-1, 0) + lam_1 (1, 1).
    """
    form = StandardForm(
        np.eye(2), np.array([2.0, 2.0]), np.array([[-1.0, 0.0], [1.0, 1.0]]), np.array([-1.0, 0.0])
    )
    assert walked(form, np.eye(2), refuted(form, [0, 1], [-2.0, -3.0])).tolist() == [0]


def test_small_violations_are_seen_next_to_large_numbers():
    """1 - x >= 0 bears 1e3; y >= 1e-30 m is all that is violated, and a copy of it is not."""
    form = StandardForm(
        np.eye(2), np.array([1e3, 0.0]), np.array([[-1.0, 0.0], [0.0, 1.0], [0.0, 1.0]]),
        np.array([-1.0, 1e-30, 1e-30]),
    )  # fmt: skip
    found = refuted(form, [0], [1e3 - 1])
    assert walked(form, np.eye(2), found).tolist() == [0, 1]


def test_a_guess_is_given_up_after_some_walks():
    guesses = []
    form = line(*range(1, 20))

    def never(rows):
        guesses.append(rows.tolist())
        slack = np.ones(19)
        slack[len(guesses)] = -1.0
        return Refuted(rows, np.ones(len(rows)), slack)

    found, last = proved_nearby(never, np.zeros(0, np.int64), form, np.eye(1))
    assert found is None
    assert last.tolist() == guesses[-1]
    assert len(guesses) == 1 + GUESSES
    first = np.zeros(0, np.int64)
    assert proved_nearby(lambda rows: None, first, form, np.eye(1)) == (None, first)
