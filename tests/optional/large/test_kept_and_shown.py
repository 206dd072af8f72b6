"""Data that are kept as they are or made again, and how many of them a page shows."""

import json

import numpy as np
import pytest

from quasistatic_ref.certify.solution import Certificate, SolverStatistics, step_solution
from quasistatic_ref.cli.solution_files import rounded_wrenches, solution_text
from quasistatic_ref.optional.fast.posed import Constants, PosedContacts
from quasistatic_ref.step.contacts import Contacts
from tests.helpers import point_on_floor, random_step
from tests.tolerances import EXACT

STEP = random_step(np.random.default_rng(3), rows=(6, 4))
SAID = SolverStatistics("none", "optimal", None, None, 1e-12)


def posed(mu):
    """The contacts of STEP as a simulator poses them."""
    c = STEP.contacts
    arrays = (array.copy() for array in (c.phi, c.n, c.d1, c.d2, c.J))
    return PosedContacts(c.name, *arrays, c.mu_v, c.mu_omega, c.rows, mu)


def test_posed_contacts_have_the_friction_that_they_are_given_or_make_it():
    """(mu_v, mu_v, mu_omega) of each contact; the second has four rows, and no mu_omega."""
    c = STEP.contacts
    assert posed(c.mu).mu is c.mu
    (v, w), omega = c.mu_v, c.mu_omega[0]
    expected = [[v, v, omega], [w, w, 0.0]]
    np.testing.assert_allclose(posed(None).mu, expected, rtol=EXACT, atol=EXACT)


def test_a_step_checks_posed_contacts_and_keeps_those_that_were_checked():
    assert type(STEP.replace(contacts=posed(None)).contacts) is Contacts
    assert STEP.replace(contacts=STEP.contacts).contacts is STEP.contacts


def test_constants_of_another_mass_have_its_h_and_of_the_same_are_kept():
    """H is h K_q and, on the unactuated coordinates, M_u / h."""
    own = Constants(STEP.h, STEP.cone, STEP.K_q, STEP.M_u, STEP.extra, STEP.H, STEP.layout)
    assert own.at(STEP.M_u) is own
    expected = STEP.H.copy()
    expected[3:, 3:] *= 2
    np.testing.assert_allclose(own.at(2 * STEP.M_u).H, expected, rtol=EXACT, atol=EXACT)


def test_a_wrench_that_is_rounded_to_zero_has_no_sign():
    """Of -d2 a quarter of the least float64, over h = 1."""
    contacts = point_on_floor(mu_v=0.25).contacts
    wrench = rounded_wrenches(contacts, np.array([0.0, 0.0, 0.0, 5e-324]), 1.0)
    assert wrench[0].tolist() == [0.0, 0.0, 5e-324, 0.0]
    assert not np.signbit(wrench).any()


def test_multipliers_of_own_rows_are_the_last():
    lam = np.arange(12.0)
    solution = step_solution(STEP, np.zeros(7), lam, Certificate("none"), SAID)
    assert solution.lam.tolist() == lam[:10].tolist()
    assert solution.lam_extra.tolist() == [10.0, 11.0]


@pytest.mark.parametrize(("bound", "written"), [(1e-9, 0.0), (None, -1e-9)])
def test_multipliers_below_zero_are_written_as_the_bound_takes_them(bound, written):
    lam = np.ones(10)
    lam[1] = -1e-9
    claims = Certificate("residual", dict.fromkeys(("stationarity", "primal", "dual",
                         "complementarity"), 0.0), error_bound=bound)  # fmt: skip
    solution = step_solution(STEP, np.zeros(7), lam, claims, SAID)
    assert json.loads(solution_text(solution))["lam"][0][1] == written
