"""What an extension returns: rows that bind nothing are dropped, and what is no term is named."""

import cvxpy as cp
import numpy as np
import pytest

import quasistatic_ref as qr
from tests.helpers import pinch

STEP = pinch()
UPPER = np.full(STEP.n_v, np.inf)
UPPER[0] = 1e-4
LIMITS = {
    "upper": lambda s: [s.delta_q <= UPPER],
    "lower, turned around": lambda s: [-s.delta_q >= -UPPER],
    "a Parameter": lambda s: [s.delta_q <= cp.Parameter(STEP.n_v, value=UPPER)],
    "with one that binds nothing": lambda s: [s.delta_q <= UPPER, s.delta_q_u >= -np.inf],
    "of a generator": lambda s: (row for row in [s.delta_q <= UPPER]),
}


@pytest.mark.parametrize("limit", LIMITS)
def test_infinite_limits_are_dropped(limit):
    """The same bits as of the finite row alone, which is the only row of the step's own."""
    alone = qr.solve_step(STEP, extension=qr.Extension(lambda s: [s.delta_q[0] <= UPPER[0]]))
    solution = qr.solve_step(STEP, extension=qr.Extension(LIMITS[limit]))
    assert solution.delta_q.tobytes() == alone.delta_q.tobytes()
    assert len(solution.step.extra.names) == 1


def test_infinite_limits_are_dropped_next_to_a_cone():
    """The same answer as with limits that are merely far away."""
    far = np.where(np.isinf(UPPER), 1e3, UPPER)

    def answer(upper):
        terms = qr.Extension(lambda s: [s.delta_q <= upper, cp.norm(s.delta_q_a) <= 1e-3])
        return qr.solve_step(STEP, extension=terms).delta_q

    np.testing.assert_allclose(answer(UPPER), answer(far), atol=1e-9)


REFUSED = {
    "list of constraints": lambda s: s.delta_q[0] <= 1e-4,
    "list of constraints and": lambda s: None,
    "'free'": lambda s: [s.delta_q[0] <= cp.Parameter(name="free")],
    "'weight'": lambda s: [cp.Parameter(name="weight", nonneg=True) * cp.sum_squares(s.delta_q)],
    "is an objective": lambda s: [cp.Maximize(cp.sum(s.delta_q))],
    "compares twice": lambda s: [-1 <= s.delta_q[0] <= 1],
    "not finite": lambda s: [s.delta_q[0] <= np.nan],
    "is not finite": lambda s: [s.delta_q == UPPER],
    "nothing can keep": lambda s: [s.delta_q >= UPPER],
    "several numbers": lambda s: [cp.square(s.delta_q)],
    "must be a constraint or a cost": lambda s: [True],
}


@pytest.mark.parametrize("named", REFUSED)
def test_a_wrong_term_is_an_error_that_names_the_extension(named):
    with pytest.raises(qr.InputError, match=named) as caught:
        qr.solve_step(STEP, extension=qr.Extension(REFUSED[named]))
    assert caught.value.field.startswith("extension")


def test_an_error_of_the_users_own_function_stays_what_it_is():
    with pytest.raises(KeyError):
        qr.solve_step(STEP, extension=qr.Extension(lambda s: {}["missing"]))
