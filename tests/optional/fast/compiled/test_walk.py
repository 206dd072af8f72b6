"""A wrong guess of a working set is mended by walks in floating point, and proved."""

import numpy as np
import pytest

from quasistatic_ref import load_scenario, solve_step
from quasistatic_ref.certify.active_set import Farkas
from quasistatic_ref.certify.exact import form_optimum
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.lab.scenes.piles import pile
from quasistatic_ref.optional.fast import proofs
from tests.helpers import pinch
from tests.optional.fast.compiled.test_fast import needs_compiler
from tests.oracles.rows_given import step_of
from validation.make.confirmed_bits import (
    NEARBY,
    OTHERS,
    ascending,
    differing_fields,
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
            found = proof(step, ascending(guess), nearby=True)
            if found is None:
                continue
            assert set(differing_fields(found, truth)) <= (
                NEARBY if truth.multipliers_unique else OTHERS
            )
            mended += proof(step, ascending(guess)) is None
    assert mended >= 5


CERTIFIED = "off", "full"
NONE = np.zeros(0)


def refuse(*_):
    raise AssertionError("the method that decides everything was called, or prepared")


@pytest.mark.extra("robots")
@needs_compiler
def test_rows_that_daqp_does_not_see_do_not_cost_the_exact_method(monkeypatch):
    """A hand turns a ball: from the third step on a row is missing of nearly every guess."""
    monkeypatch.setattr(proofs, "group_optimum", refuse)
    scenario = load_scenario("allegro_turn", fast=True)
    simulator = scenario.simulator()
    simulator.taken = lambda q, given, most: ()  # each step asks DAQP
    q = scenario.system.q_start
    wrong = 0
    for k in range(12):
        found = simulator.step(q, scenario.targets(scenario.h * (k + 1)))
        q = found.q
        wrong += found.solution.statistics.digits < 16
        assert found.solution.certificate.kind == "exact"
    assert wrong > 0


@needs_compiler
def test_boxes_at_rest_on_each_other_do_not_cost_the_exact_method(monkeypatch):
    """Four boxes, which fall by 1e-5 m a step, through three gaps of 1e-4 m."""
    falling, certified = (pile((1, 1, 4), backend="daqp", certify=c).simulator for c in CERTIFIED)
    q = falling.system.q_start
    for _ in range(50):
        q = falling.step(q, NONE).q
    monkeypatch.setattr(proofs, "group_optimum", refuse)
    assert certified.step(q, NONE).solution.certificate.kind == "exact"


@needs_compiler
def test_rows_that_depend_on_each_other_are_chosen_from_and_proved(monkeypatch):
    """Clarabel presses on all six rows of each contact that sticks, of which four hold it."""
    monkeypatch.setattr(proofs, "group_optimum", refuse)
    assert solve_step(pinch(grip=5.0), "clarabel", fast=True).certificate.kind == "exact"


def proved_working_set(A, b, g, guess):
    """The working set that is proved where a guess is not; None if none is."""
    step = step_of(A, b, g)
    assert proof(step, ascending(guess)) is None
    found = proof(step, ascending(guess), nearby=True)
    return None if found is None else [*found.working_set]


LINE = [[1.0], [1.0], [1.0]]
BOTH = [[1.0, 0.0], [1.0, 1.0]]
THREE = [[1.0, 0, 0], [0, 1.0, 0], [1.0, 1, 1]]
D = round(8e-5 * 2**44) / 2**44
"""So that 1 + D is not rounded, and 1 + D^2 is."""


@needs_compiler
@pytest.mark.parametrize(
    ("A", "b", "g", "guess", "right"),
    [
        # x >= 1 is violated at 0.
        (LINE[:1], [1.0], [0.0], [], [0]),
        # x >= 2 depends on x >= 1, takes its place, and is left alone.
        (LINE[:2], [1.0, 2.0], [0.0], [0], [1]),
        # x <= -1 against x >= 1: nothing gives way.
        ([[1.0], [-1.0]], [1.0, 1.0], [0.0], [0], None),
        # x >= 1 twice: rows that depend on each other are no working set; one of them is.
        (LINE, [1.0, 1.0, 2.0], [0.0], [0, 1], [2]),
        # x <= 1 and x + y >= 0 at g = (2, 2): the second pulls; without it, the first bears 1. On
        # both, x = 1 and y = -1: A'lam = x - g = (-1, -3) = lam_0 (-1, 0) + lam_1 (1, 1).
        ([[-1.0, 0.0], [1.0, 1.0]], [-1.0, 0.0], [2.0, 2.0], [0, 1], [0]),
        # 1 - x >= 0 bears 1e3; y >= 1e-30 m is all that is violated.
        ([[-1.0, 0.0], [0.0, 1.0]], [-1.0, 1e-30], [1e3, 0.0], [0], [0, 1]),
        # x >= 2 b and x + y >= 3 b: the second leaves x at 1.5 b; on both, both bear.
        (BOTH, [2.0, 3.0], [0.0, 0.0], [], [0, 1]),
        (1e-6 * np.array(BOTH), [2e-6, 3e-6], [0.0, 0.0], [], [0, 1]),
        (BOTH, [2e-9, 3e-9], [0.0, 0.0], [], [0, 1]),
        # x >= 1 and y >= 2 hold with lam = (1, 2); x + y + z >= 3 + s takes one of each as it
        # grows. At the rate 1 it closes s up to 1, where x >= 1 bears nothing; then at the rate 2
        # up to 3, where the next unit of y >= 2 is used up.
        (THREE, [1.0, 2.0, 3.5], [0.0] * 3, [0, 1], [0, 1, 2]),
        (THREE, [1.0, 2.0, 5.5], [0.0] * 3, [0, 1], [1, 2]),
        (THREE, [1.0, 2.0, 6.5], [0.0] * 3, [0, 1], [2]),
        # (1, 1, 0) is a sum of (1, 0, 0) and (1, D, 0), which leave nothing of it; but the squares
        # of these differ by no more than D^2, and so by 1e-8 of that wrongly. At x = (1, 1, 0) none
        # of the three has a slack, and the third bears all.
        ([[1.0, 0, 0], [1, D, 0], [1, 1, 0]], [1.0, 1 + D, 2], [0.0] * 3, [0, 1, 2], [2]),
    ],
)
def test_walks_from_a_wrong_guess_end_at_the_working_set(A, b, g, guess, right):
    assert proved_working_set(A, b, g, guess) == right
