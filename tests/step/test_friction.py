"""The friction cone and the wrench that the multipliers add up to."""

import numpy as np
import pytest

from quasistatic_ref.lab.scenes.contacts import no_contacts
from quasistatic_ref.step.cones import pyramid
from quasistatic_ref.step.friction import contact_wrenches, friction_rows, row_gaps
from tests.helpers import changed, random_step
from tests.tolerances import EXACT, ROUNDING


@pytest.mark.parametrize("seed", range(20))
def test_the_rows_of_a_contact_share_one_normal_force_an_octahedron(seed):
    # |f_1| / mu_v + |f_2| / mu_v + |tau_n| / mu_omega <= f_n for every lam >= 0.
    rng = np.random.default_rng(seed)
    contacts = random_step(rng, rows=(6, 6, 4)).contacts
    lam = rng.exponential(size=16) * (rng.uniform(size=16) < 0.7)
    for j, (f_1, f_2, f_n, tau_n) in enumerate(contact_wrenches(contacts, lam, h=0.01)):
        spent = (abs(f_1) + abs(f_2)) / contacts.mu_v[j] + abs(tau_n) / contacts.mu_omega[j]
        assert spent <= f_n * (1 + ROUNDING)


@pytest.mark.parametrize("row", range(6))
def test_each_row_alone_reaches_a_vertex_of_the_octahedron(row, rng):
    contacts = random_step(rng, rows=(6,)).contacts
    mu_v, mu_omega = contacts.mu_v[0], contacts.mu_omega[0]
    vertices = [
        [mu_v, 0, 1, 0],
        [0, mu_v, 1, 0],
        [-mu_v, 0, 1, 0],
        [0, -mu_v, 1, 0],
        [0, 0, 1, mu_omega],
        [0, 0, 1, -mu_omega],
    ]
    actual = contact_wrenches(contacts, np.eye(6)[row], h=0.5)
    expected = [np.array(vertices[row]) / 0.5]
    np.testing.assert_allclose(actual, expected, rtol=ROUNDING, atol=ROUNDING)


@pytest.mark.parametrize("seed", range(5))
def test_the_wrenches_do_the_same_generalised_work_as_the_rows(seed):
    # sum_j J_j' [f_d1 d1 + f_d2 d2 + f_n n; tau_n] h = A' lam
    rng = np.random.default_rng(seed)
    contacts, h = random_step(rng, rows=(6, 4, 6)).contacts, 0.01
    lam = rng.exponential(size=16)
    wrenches = contact_wrenches(contacts, lam, h)
    by_wrench, by_row, at = np.zeros(7), np.zeros(7), 0
    for j, (f_1, f_2, f_n, tau_n) in enumerate(wrenches):
        force = f_1 * contacts.d1[j] + f_2 * contacts.d2[j] + f_n * contacts.n[j]
        by_wrench += contacts.J[j].T @ np.array([*force, tau_n]) * h
        for i in range(contacts.rows[j]):
            by_row += friction_rows(contacts)[j, i] * lam[at]
            at += 1
    np.testing.assert_allclose(by_wrench, by_row, rtol=ROUNDING, atol=ROUNDING)


def test_a_contact_without_torsion_has_no_torque(rng):
    contacts = random_step(rng, rows=(4, 6)).contacts
    lam = rng.exponential(size=10)
    assert contact_wrenches(contacts, lam, h=0.01)[0, 3] == 0.0
    assert contact_wrenches(contacts, lam, h=0.01)[1, 3] != 0.0


def test_the_directions_of_a_contact_add_up_to_nothing(rng):
    slips = rng.normal(size=(3, 5))
    total = sum(pyramid(np.zeros(5), *slips))
    np.testing.assert_allclose(total, 0.0, rtol=0.0, atol=ROUNDING)


def test_without_friction_all_six_rows_are_the_normal_row(rng):
    contacts = changed(random_step(rng, rows=(6,)).contacts, mu_v=[0.0], mu_omega=[0.0])
    normal = contacts.n[0] @ contacts.J[0, :3]
    expected = [[normal] * 6]
    np.testing.assert_allclose(friction_rows(contacts), expected, rtol=ROUNDING, atol=ROUNDING)


def test_no_contacts_make_no_rows_and_no_wrenches():
    assert friction_rows(no_contacts(5)).shape == (0, 6, 5)
    assert contact_wrenches(no_contacts(5), np.zeros(0), h=0.01).shape == (0, 4)


def test_the_gap_adds_to_the_motion_along_the_normal_of_an_ellipsoid(rng):
    """gap, slip_1, slip_2 and spin without motion: (phi, 0, 0, 0)."""
    contacts = random_step(rng, rows=(4, 6)).contacts
    expected = [[phi, 0.0, 0.0, 0.0] for phi in contacts.phi]
    actual = row_gaps(contacts, "ellipsoid")
    np.testing.assert_allclose(actual, expected, rtol=EXACT, atol=EXACT)
