"""The ellipsoid's native program: rows and their coefficients, reach, impulses."""

import numpy as np

from quasistatic_ref import Extra, standard_form
from quasistatic_ref.optional.fast.second_order import ConeSolver, coefficients
from quasistatic_ref.solve.units import DenseStepInBothUnits, in_si
from tests.closeness import assert_within
from tests.helpers import changed, random_step
from tests.tolerances import OPTIMUM


def two_contacts(rng, phi):
    """A step in the ellipsoid with two contacts and a row of the user's own."""
    step = random_step(rng, 3, 4, (6, 4)).replace(cone="ellipsoid")
    own = Extra(("own",), np.ones((1, 7)), [-1.0])
    return step.replace(contacts=changed(step.contacts, phi=phi), extra=own)


def test_rows_are_multiplied_by_their_coefficients_and_own_rows_are_not(rng):
    """1, mu_v, mu_v and mu_omega of each contact, 0 where mu_omega is not used; then 1."""
    step = two_contacts(rng, [1e-4, 2e-4])
    v, w = step.contacts.mu_v
    omega = step.contacts.mu_omega[0]
    mu = np.array([1, v, v, omega, 1, w, w, 0, 1])
    np.testing.assert_array_equal(coefficients(step), mu)
    solver = ConeSolver(step, "clarabel")
    both = DenseStepInBothUnits(step)
    assert solver.write(both) is None
    expected = mu[:, None] * both.natural_form.A
    np.testing.assert_array_equal(solver.program.A, expected)


def test_all_rows_of_a_contact_out_of_reach_are_idle(rng):
    step = two_contacts(rng, [1e-4, 1e6])
    idle = ConeSolver(step, "clarabel").write(DenseStepInBothUnits(step))
    assert idle.tolist() == [False] * 4 + [True] * 4 + [False]


def test_impulses_balance_the_step(rng):
    """H delta_q - g = A'lam, the rows A being the motion along n, d1, d2 and about n."""
    step = two_contacts(rng, [-1e-2, -2e-2])
    both = DenseStepInBothUnits(step)
    answer = ConeSolver(step, "clarabel").answer(both, 1e-9)
    delta_q, lam = in_si(answer.natural_delta_q, answer.natural_lam, both.units)
    form = standard_form(step)
    push = form.H @ delta_q - form.g
    size = np.abs(push).max()
    assert_within(form.A.T @ lam, push, OPTIMUM * size)
    assert np.abs(lam[1:4]).max() > OPTIMUM * size
