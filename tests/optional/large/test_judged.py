"""The bound of an uncertified answer: the least one holds, and what is no answer is refused."""

import math

import numpy as np
import pytest

from quasistatic_ref import solve_step
from quasistatic_ref.lab.scenes.contacts import no_contacts
from quasistatic_ref.lab.scenes.rigid import free_step
from quasistatic_ref.optional.large.judged import bound_verdict
from tests.certify.test_farkas import EAST, WEST, point_between_walls
from tests.helpers import point_on_floor
from tests.oracles.solution_truth import least_bound

STEP = point_on_floor(force=(4.0, 1.0, -2.943))  # it slides: some rows bear load, some none
EXACT = solve_step(STEP, "none")


def bound_of(delta_q, lam):
    """The smallest float64 that bounds an answer's error, by plain fractions."""
    claims = {"kind": "exact", "active": EXACT.certificate.active}
    record = {"delta_q": delta_q.tolist(), "lam": [lam.tolist()], "lam_extra": []}
    return least_bound(STEP, record | {"certificate": claims})


@pytest.mark.parametrize("off", [0.0, 1e-3, 0.1])
@pytest.mark.parametrize("share", [1.0, 0.9, 0.0])
def test_the_least_bound_holds_and_none_below(off, share):
    delta_q = EXACT.delta_q + off * np.array([1e-3, -2e-3, 5e-4])
    lam = share * EXACT.lam
    least = bound_of(delta_q, lam)
    assert 0 < least < 1
    assert bound_verdict(STEP, delta_q, lam, least)
    less = math.nextafter(least, 0)
    assert "the error is larger" in bound_verdict(STEP, delta_q, lam, less).reason


def test_a_bound_is_from_nothing_to_one():
    right = EXACT.delta_q, EXACT.lam
    assert bound_verdict(STEP, *right, 1.0)
    for bound in (-1e-300, math.nextafter(1.0, 2.0), 5.0):
        assert "a bound is from 0 to 1" in bound_verdict(STEP, *right, bound).reason
    assert "the error is larger" in bound_verdict(STEP, *right, 0.0).reason  # it is rounded


def test_a_negative_multiplier_is_refused_however_small():
    lam = EXACT.lam.copy()
    lam[-1] = -5e-324
    assert "negative" in bound_verdict(STEP, EXACT.delta_q, lam, 1.0).reason


@pytest.mark.parametrize(
    ("delta_q", "lam", "bound", "reason"),
    [
        (EXACT.delta_q, EXACT.lam, None, "without a bound"),
        (EXACT.delta_q, None, 0.5, "without a bound"),
        (EXACT.delta_q, EXACT.lam[:3], 0.5, "shape"),
        (EXACT.delta_q, np.full(4, math.inf), 0.5, "not finite"),
        (EXACT.delta_q, EXACT.lam, math.nan, "not finite"),
    ],
)
def test_what_is_no_answer_is_refused_in_a_sentence(delta_q, lam, bound, reason):
    verdict = bound_verdict(STEP, delta_q, lam, bound)
    assert not verdict
    assert reason in verdict.reason


def test_in_the_ellipsoid_no_bound_is_proved():
    ellipsoid = STEP.replace(cone="ellipsoid")
    assert "without a bound" in bound_verdict(ellipsoid, EXACT.delta_q, np.zeros(4), 1.0).reason


def test_a_free_step_has_a_bound_and_an_infeasible_one_has_none():
    none = free_step(np.eye(3), np.ones(3), no_contacts(3), 1.0)
    assert bound_verdict(none, np.ones(3), np.zeros(0), 0.0)
    assert not bound_verdict(none, np.ones(3) + 1e-15, np.zeros(0), 0.0)
    step = point_between_walls([EAST, WEST], -1e-3, force=np.ones(3))
    assert "no solution" in bound_verdict(step, np.zeros(3), np.ones(8), 1.0).reason
