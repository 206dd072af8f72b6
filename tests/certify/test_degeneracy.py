"""The derivative of the optimum by the working set, against differences of exact optima."""

import numpy as np
import pytest

from quasistatic_ref import solve_step, standard_form
from quasistatic_ref.certify.degeneracy import form_degeneracy
from quasistatic_ref.certify.groups import flat_rows
from tests.closeness import assert_within
from tests.helpers import changed, random_step, slacks
from tests.oracles.forms import exact_form_of

EPS = 1e-6
"""Of differences, relative to each number: they are right to 1e-9 and better."""

BARELY = 1e-13
"""Slack of a row that just touches [m]: so little that no difference sees it."""


def moved(step, rng):
    """The step along a random direction of all its data, as a function of how far [-]."""
    contacts = step.contacts
    pull = rng.normal(size=step.n_v)
    rise, rub = rng.normal(size=(2, contacts.n_c))
    stiffer = rng.normal()

    def at(t):
        return step.replace(
            tau_a=step.tau_a + t * pull[: step.n_a],
            tau_u=step.tau_u + t * pull[step.n_a :],
            K_q=(1 + t * stiffer) * step.K_q,
            contacts=changed(
                contacts, phi=contacts.phi * (1 + t * rise), mu_v=contacts.mu_v * (1 + t * rub)
            ),
        )

    return at


def by_working_set(step, at):
    """Derivative of delta_q by (R25); whether (R26) holds one EPS on; and the rows W."""
    solution = solve_step(step, "none")
    W = [*flat_rows(step, solution.certificate.active)]
    here, there, back = (standard_form(at(t)) for t in (0.0, EPS, -EPS))
    dH, dg, dA, db = ((x - y) / (2 * EPS) for x, y in zip(there, back, strict=True))
    x = solution.delta_q
    A = here.A[W]
    system = np.block([[here.H, -A.T], [A, np.zeros((len(W), len(W)))]])
    right = np.append(dg - dH @ x + solution.lam[W] @ dA[W], db[W] - dA[W] @ x)
    ranks = {np.linalg.matrix_rank(np.column_stack([f.A, f.b])[W], 1e-9) for f in (there, back)}
    return np.linalg.solve(system, right)[: step.n_v], ranks == {len(W)}, W


def slope(step, at, t):
    """The one-sided derivative of delta_q, of second order."""
    here, near, far = (solve_step(at(s), "none").delta_q for s in (0.0, t, 2 * t))
    return (4 * near - far - 3 * here) / (2 * t)


@pytest.mark.parametrize("seed", range(12))
def test_r25_r26_random_optima_change_as_their_working_sets_say(seed):
    rng = np.random.default_rng(seed)
    step = random_step(rng)
    at = moved(step, rng)
    expected, consistent, _ = by_working_set(step, at)
    assert consistent
    assert solve_step(step, "none").certificate.differentiable
    size = np.abs(expected).max()
    for t in (EPS, -EPS):
        assert_within(slope(step, at, t), expected, 1e-6 * size)


@pytest.mark.parametrize("seed", range(12))
def test_r27_a_row_that_leaves_its_zero_slack_has_two_sides(seed):
    """Open contacts are lowered until they just touch: one that would open changes nothing."""
    rng = np.random.default_rng(seed)
    step = random_step(rng, rows=(6, 4, 4, 4))
    x = solve_step(step, "none").delta_q
    gaps = np.minimum.reduceat(slacks(step, x), step.offsets[:-1])
    phi = step.contacts.phi - np.where(gaps > BARELY, gaps - BARELY, 0.0)
    step = step.replace(contacts=changed(step.contacts, phi=phi))
    pull = rng.normal(size=step.n_v)

    def at(t):
        return step.replace(
            tau_a=step.tau_a + t * pull[: step.n_a], tau_u=step.tau_u + t * pull[step.n_a :]
        )

    expected, _, W = by_working_set(step, at)
    idle = slacks(step, x) < 2 * BARELY
    idle[W] = False
    size = np.abs(expected).max()
    opens = standard_form(step).A[idle] @ expected
    for t in (EPS, -EPS):
        same = np.abs(slope(step, at, t) - expected).max() <= 1e-6 * size
        assert same == (opens * np.sign(t) >= -1e-9 * size).all()


def test_rows_that_combine_to_one_of_the_working_set_leave_multipliers_open():
    """Row 0 bears, the others touch: twice row 1 and row 2 are three times row 0."""
    rows = np.array([[0.0, 1.0], [1.0, 1.0], [-2.0, 1.0]])
    form = exact_form_of(np.eye(2), np.array([0.0, -1.0]), rows, np.zeros(3))
    assert form_degeneracy(form, (0,))[:2] == (False, True)
