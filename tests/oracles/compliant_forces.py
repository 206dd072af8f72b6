"""Contact forces by compliance, proved by fractions.

In the step with compliance c, four lengths s of each contact are added to its gap, slips and spin,
and cost h |s|^2 / (2 c): the plain program's rows around the fractions of the step. The package
names the rows that bear, and the conditions of the optimum are decided by signs of fractions.
"""

from fractions import Fraction

import numpy as np

from quasistatic_ref.certify.active_set import dual_active_set
from quasistatic_ref.lab.program.forces import compliant_program, forces_of
from quasistatic_ref.lab.program.rows import cone_table
from quasistatic_ref.optional.forces.forces import compliant_form
from tests.oracles.rational_kkt import exact, proved_optimum
from tests.oracles.solution_truth import program
from validation.check_solution import rounded


def forces(step, compliance):
    """(f_d1, f_d2, f_n, tau_n) of each contact, shape (n_c, 4) [N, N m], each rounded once.

    Parameters
    ----------
    step : StepData
        In the pyramid, the product or the frictionless cone, without rows of a user.
    compliance : float
        [m/N].

    Raises
    ------
    ArithmeticError
        If the rows that the package names are not those of the optimum.
    """
    contacts = step.contacts
    tables = [cone_table(step.cone, rows) for rows in contacts.rows]
    c = [Fraction(compliance)] * contacts.n_c
    softened = compliant_program(*program(step), tables, Fraction(step.h), c)
    working = dual_active_set(compliant_form(step, compliance)).working
    x, _, _ = proved_optimum([*map(exact, softened)], working)
    mu = zip(exact(contacts.mu_v), exact(contacts.mu_omega), strict=True)
    entries = [{"mu_v": mu_v, "mu_omega": mu_omega} for mu_v, mu_omega in mu]
    found = forces_of(x[step.n_v :], c, entries)
    return np.array([[*map(rounded, parts)] for parts in found]).reshape(-1, 4)
