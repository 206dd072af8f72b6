"""Contact forces by compliance, proved by fractions.

In the step with compliance c, four lengths s of each contact are added to its gap, slips and spin,
and cost h |s|^2 / (2 c). It is formed here from the fractions of the step; the package names the
rows that bear, and the conditions of the optimum are decided by signs of fractions.
"""

from fractions import Fraction
from itertools import accumulate

import numpy as np

from quasistatic_ref.certify.active_set import dual_active_set
from quasistatic_ref.lab.program.rows import cone_table
from quasistatic_ref.optional.forces.forces import compliant_form
from tests.oracles.rational_kkt import proved_optimum
from tests.oracles.solution_truth import program, wrenches


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
    H, g, A, b = program(step)
    tables = [cone_table(step.cone, rows, 1) for rows in step.contacts.rows]
    ends = list(accumulate(len(table) for table in tables))
    blocks = [slice(end - len(table), end) for end, table in zip(ends, tables, strict=True)]
    gives = np.zeros((len(b), 4 * len(tables)), dtype=object)
    for j, table in enumerate(tables):
        gives[blocks[j], 4 * j : 4 * j + 4] = np.insert(table, 0, 1, axis=1)
    aside = np.zeros((len(g), gives.shape[1]), dtype=object)
    stiffness = Fraction(step.h) / Fraction(compliance) * np.eye(gives.shape[1], dtype=int)
    whole = np.block([[H, aside], [aside.T, stiffness]]), np.append(g, aside[:1])
    working = dual_active_set(compliant_form(step, compliance)).minimiser.working
    _, pressing, _ = proved_optimum((*whole, np.hstack([A, gives]), b), working)
    lam = np.zeros(len(b), dtype=object)
    lam[list(working)] = pressing
    return np.array(wrenches(step, [lam[block] for block in blocks])).reshape(-1, 4)
