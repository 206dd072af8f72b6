"""Eq. (6), d~_3 and d~_4. Under test: step.problem.StepProblem."""

from tests.equations.test_eq05_tangential_directions import assert_shares_are_printed


def printed_directions(contacts):
    expected = []
    for j in range(contacts.n_c):
        d_tilde_3 = [-contacts.mu_v[j] * contacts.d1[j][r] for r in range(3)] + [0.0]
        d_tilde_4 = [-contacts.mu_v[j] * contacts.d2[j][r] for r in range(3)] + [0.0]
        expected.append([d_tilde_3, d_tilde_4])
    return expected


def test_they_are_what_the_third_and_fourth_constraint_add_to_the_gap(rng):
    assert_shares_are_printed(rng, printed_directions, 2)
