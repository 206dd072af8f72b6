"""Contact forces by compliance, proved by fractions.

In the step with compliance c, four lengths s of each contact are added to its gap, slips and spin,
and cost h |s|^2 / (2 c). It is formed here from the fractions of the step; the package names the
rows that bear, and the conditions of the optimum are decided by signs of fractions.
"""

from fractions import Fraction

import numpy as np

from quasistatic_ref.certify.active_set import dual_active_set
from quasistatic_ref.certify.compliance.forces import compliant_form
from quasistatic_ref.lab.program.rows import cone_table
from tests.oracles.rational_kkt import proved
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
    n = step.n_v
    lengths = 4 * step.contacts.n_c
    stiffness = Fraction(step.h) / Fraction(compliance)
    none = [Fraction(0)] * lengths
    H = [row + none for row in H]
    for i in range(n, n + lengths):
        H.append([stiffness * (i == j) for j in range(n + lengths)])
    tables = [cone_table(step.cone, rows, 1).tolist() for rows in step.contacts.rows]
    blocks = []
    end = 0
    for j, table in enumerate(tables):
        blocks.append(slice(end, end + len(table)))
        end += len(table)
        for row, along in zip(A[blocks[j]], table, strict=True):
            row += none
            row[n + 4 * j : n + 4 * j + 4] = [Fraction(1), *map(Fraction, along)]
    working = dual_active_set(compliant_form(step, compliance)).minimiser.working
    _, pressing, _ = proved((H, g + none, A, b), working)
    lam = [Fraction(0)] * len(b)
    for i, value in zip(working, pressing, strict=True):
        lam[i] = value
    return np.array(wrenches(step, [lam[block] for block in blocks])).reshape(-1, 4)
