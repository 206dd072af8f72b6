"""Eq. (5), d~_1 and d~_2. Under test: step.problem.StepProblem."""

from tests.closeness import assert_close
from tests.equations.test_eq04_contact_rows import at
from tests.helpers import random_step
from tests.tolerances import ROUNDING


def printed_directions(contacts):
    expected = []
    for j in range(contacts.n_c):
        d_tilde_1 = [contacts.mu_v[j] * contacts.d1[j][r] for r in range(3)] + [0.0]
        d_tilde_2 = [contacts.mu_v[j] * contacts.d2[j][r] for r in range(3)] + [0.0]
        expected.append([d_tilde_1, d_tilde_2])
    return expected


def shares_of_the_problem(step, delta_q):
    """What each CVXPY constraint i adds to the gap phi + J_n delta_q: d~_i' J delta_q by (4)."""
    problem, sides = at(step, delta_q)
    return [side - problem.contact_motion[0].value for side in sides]


def shares_by_loops(step, delta_q, directions):
    """d~_i' J delta_q of every contact, for the printed d~_i of each contact."""
    share = []
    for j, d_tilde in enumerate(directions):
        total = 0.0
        for r in range(4):
            for k in range(step.n_v):
                total += d_tilde[r] * step.contacts.J[j][r][k] * delta_q[k]
        share.append(total)
    return share


def assert_shares_are_printed(rng, printed, first):
    """The constraints from one on add to the gap what the printed directions do."""
    step = random_step(rng, rows=(6, 6, 6))
    delta_q = rng.normal(size=step.n_v)
    shares = shares_of_the_problem(step, delta_q)
    for i, directions in enumerate(zip(*printed(step.contacts), strict=True), start=first):
        expected = shares_by_loops(step, delta_q, directions)
        assert_close(shares[i], expected, ROUNDING)


def test_they_are_what_the_first_two_constraints_add_to_the_gap(rng):
    assert_shares_are_printed(rng, printed_directions, 0)
