"""What must not matter, and what must scale: on random steps of every kind."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from quasistatic_ref.lab.scenes.contacts import repeated
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import standard_form
from tests.helpers import (
    changed,
    error,
    planted_step,
    random_frame,
    random_step,
)
from tests.tolerances import ACTIVE_SET, MULTIPLIERS


@st.composite
def shapes(draw, contacts_at_least=1):
    """(n_a, n_u, rows), with at least one coordinate."""
    n_a = draw(st.integers(0, 4))
    n_u = draw(st.integers(0 if n_a else 1, 4))
    rows = draw(st.lists(st.sampled_from([4, 6]), min_size=contacts_at_least, max_size=5))
    return n_a, n_u, tuple(rows)


@st.composite
def steps(draw, contacts_at_least=1):
    """A feasible step: phi >= 0, or planted around an optimum with phi of either sign."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    shape = draw(shapes(contacts_at_least))
    # More planted rows than coordinates agree but for rounding, that is: not at all.
    if draw(st.booleans()) or len(shape[2]) > shape[0] + shape[1]:
        return random_step(rng, *shape)
    return planted_step(rng, *shape)[0]


scales = st.floats(1e-3, 1e3)
seeds = st.integers(0, 2**32 - 1)


def solved(step):
    return solve_step(step, "none")


def assert_same_motion(step, actual, expected):
    np.testing.assert_allclose(error(step, actual, expected), 0.0, rtol=0.0, atol=ACTIVE_SET)


def push(step, lam):
    """A' lam: what the multipliers do to the coordinates; lam itself need not be unique."""
    return standard_form(step).A.T @ lam


@given(steps(), seeds)
def test_the_order_of_contacts_leaves_delta_q_and_each_push(step, seed):
    order = np.random.default_rng(seed).permutation(step.contacts.n_c)
    moved = step.replace(contacts=repeated(step.contacts, order))
    one = solved(step)
    two = solved(moved)
    assert_same_motion(step, two.delta_q, one.delta_q)
    scale = np.abs(push(step, one.lam)).max() + np.abs(standard_form(step).g).max()
    np.testing.assert_allclose(
        push(moved, two.lam), push(step, one.lam), rtol=0.0, atol=MULTIPLIERS * scale
    )


@given(steps(), seeds)
def test_the_world_may_be_turned(step, seed):
    # n, d1, d2 and the world-frame rows of J turn together; delta_q is not in the world frame.
    R = random_frame(np.random.default_rng(seed))
    contacts = step.contacts
    J = contacts.J.copy()
    J[:, :3] = np.einsum("rs,csv->crv", R, contacts.J[:, :3])
    turned = changed(contacts, n=contacts.n @ R.T, d1=contacts.d1 @ R.T, d2=contacts.d2 @ R.T, J=J)
    assert_same_motion(step, solved(step.replace(contacts=turned)).delta_q, solved(step).delta_q)


@given(steps(), scales, seeds)
def test_another_unit_of_length_leaves_the_motion(step, s, seed):
    # Coordinates are lengths or angles. In a unit 1/s as long: lengths x s, energies x s^2,
    # angles as they are; mu_omega is a length.
    length = np.random.default_rng(seed).uniform(size=step.n_v) < 0.5
    D = np.where(length, s, 1.0)
    n_a = step.n_a
    contacts = step.contacts
    J = contacts.J / D
    J[:, :3] *= s
    scaled = StepData(
        h=step.h,
        K_q=s**2 * step.K_q / np.outer(D[:n_a], D[:n_a]),
        M_u=s**2 * step.M_u / np.outer(D[n_a:], D[n_a:]),
        tau_a=s**2 * step.tau_a / D[:n_a],
        tau_u=s**2 * step.tau_u / D[n_a:],
        delta_q_bar_a=step.delta_q_bar_a * D[:n_a],
        contacts=changed(contacts, phi=s * contacts.phi, J=J, mu_omega=s * contacts.mu_omega),
    )
    assert_same_motion(step, solved(scaled).delta_q / D, solved(step).delta_q)
