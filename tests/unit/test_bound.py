"""The error bound holds for every answer, good or bad, and says so when it knows nothing."""

import numpy as np
import pytest

from quasistatic_ref.certify.bound import error_bound, opening_direction
from quasistatic_ref.certify.exact_step import exact_step
from quasistatic_ref.lab.scenes.grasps import grasp_step
from quasistatic_ref.step.data import Extra
from quasistatic_ref.step.standard_form import standard_form
from tests.unit.test_farkas import EAST, point_between_walls


@pytest.mark.parametrize("size", [0.0, 1e-14, 1e-9, 1e-4, 1.0, 10.0])
def test_bound_is_never_below_the_error(size):
    rng = np.random.default_rng(7)
    for _ in range(10):
        step = grasp_step(rng)
        exact, H = exact_step(step), standard_form(step).H
        free = np.linalg.solve(H, standard_form(step).g)
        delta_q = exact.delta_q + size * np.sqrt(free @ H @ free / np.diag(H)) * rng.normal(size=13)
        lam = exact.lam + size * exact.lam.max() * rng.normal(size=80)
        off = delta_q - exact.delta_q
        bound = error_bound(step, delta_q, lam)
        assert bound.gap >= 0.5 * off @ H @ off
        assert bound.error >= np.sqrt(off @ H @ off / (free @ H @ free))


def test_bound_shows_about_eight_digits_of_an_exact_answer():
    rng = np.random.default_rng(8)
    for _ in range(10):
        step = grasp_step(rng)
        exact = exact_step(step)
        assert 1e-10 < error_bound(step, exact.delta_q, exact.lam).error < 1e-6


def test_step_without_contacts_is_bounded_to_rounding():
    step = point_between_walls(np.zeros((0, 3)), [], force=(1.0, 2.0, 3.0))
    exact = exact_step(step)
    assert error_bound(step, exact.delta_q, exact.lam).error < 1e-15


def test_wedged_or_broken_answers_are_not_bounded():
    pair = Extra(("left", "right"), np.array([[1.0, 0, 0], [-1.0, 0, 0]]), np.zeros(2))
    step = point_between_walls([EAST], [1.0], force=(1.0, 0.0, 0.0)).replace(extra=pair)
    assert opening_direction(step) is None
    lam = np.zeros(6)
    assert error_bound(step, np.array([1e-9, 0, 0]), lam).error == np.inf
    assert error_bound(step, np.array([np.nan, 0, 0]), lam).gap == np.inf
    assert error_bound(step, np.zeros(3), lam).gap < np.inf  # feasible as it stands
    rest = point_between_walls([EAST], [1.0])
    assert error_bound(rest, np.zeros(3), np.zeros(4)).error == np.inf  # g = 0: no scale
    assert error_bound(rest, np.zeros(3), np.zeros(4)).gap == 0.0


def test_opening_direction_opens_every_row():
    rng = np.random.default_rng(9)
    for _ in range(20):
        step = grasp_step(rng)
        direction = opening_direction(step)
        assert direction is not None
        assert (standard_form(step).A @ direction > 0).all()
