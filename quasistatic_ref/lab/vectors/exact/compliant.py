r"""The forces of the contacts of a step by compliance, exact, and how well float64 knows them.

Let errors r in the balance H x - g = h sum_j B_j's_j / c_j [N s] and errors d in the lengths
z = B x + (phi, 0, 0, 0) [m] lead to another x and other s. The s of a contact is the point nearest
to -z of the cone of forces, and therefore ds'dz <= -\|ds\|^2, where dz = B dx + d. The balance,
multiplied by dx, then says that \|dx\|_H^2 + h sum \|ds_j\|^2 / c_j is at most
h sum \|ds_j\| \|d_j\| / c_j + \|r\|_{H^-1} \|dx\|_H. With the least c of all, forces,
ds_j / c_j, are therefore off by at most

.. math:: \frac1c \sqrt{\|d\|^2 + \tfrac{c}{h} \|r\|_{H^{-1}}^2}.
"""

from dataclasses import astuple
from math import sqrt
from typing import TypeAlias

import numpy as np
from flint import fmpq

from quasistatic_ref.certify.active_set import Optimum, dual_active_set
from quasistatic_ref.lab.program.forces import compliances, compliant_program, forces_of
from quasistatic_ref.lab.program.rows import cone_table
from quasistatic_ref.lab.vectors.exact.conditioning import ROUNDINGS, Errors
from quasistatic_ref.lab.vectors.exact.entered import exact
from quasistatic_ref.lab.vectors.exact.forms import exact_form_of
from quasistatic_ref.lab.vectors.exact.precision import number, rounded_results
from quasistatic_ref.lab.vectors.exact.rational import UNIT, fraction, inverse
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.step.data import Array

Program: TypeAlias = "tuple[Array, Array, Array, Array]"
"""H, g, A and b."""
READ = ("mu_v", "mu_omega", "rows", "compliance")


def compliant_forces(program: Program, case: Json, contacts: Json, lam: Json) -> tuple[Json, Json]:
    """(f_d1, f_d2, f_n, tau_n) of each contact [N, N m], rounded correctly, and in 30 digits.

    Parameters
    ----------
    program : tuple of ndarray
        Of a step that has a solution.
    case : dict
        Of which ``h`` and ``cone`` are read.
    contacts : list of dict
        Of which ``mu_v``, ``mu_omega``, ``rows`` and, if it is there, ``compliance`` are read.
    lam : list
        Multipliers of the program: rows that bear load there are tried first.
    """
    entries = [exact({key: c[key] for key in READ if key in c}) for c in contacts]
    tables = [cone_table(case["cone"], entry["rows"], entry["mu_v"]) for entry in entries]
    c = compliances(contacts)
    softened = compliant_program(*program, tables, case["h"], c)
    form = exact_form_of(*softened)
    end = dual_active_set(form, np.flatnonzero(lam).tolist())
    assert isinstance(end, Optimum)
    s = np.array(end.minimiser.fractions.point[len(program[1]) :])
    return rounded_results(lambda: forces_of(s, [number(c_j) for c_j in c], entries))


def forces_bound(
    program: Program, case: Json, contacts: Json, delta_q: Json, errors: Errors
) -> float:
    """How far forces may be off [N, N m] by errors of H, g, A and b, and by rounding of sums.

    Parameters
    ----------
    program, case, contacts
        As of `compliant_forces`.
    delta_q : list
    errors : Errors
    """
    if not contacts:
        return 0.0
    n = len(delta_q)
    H, g, A, b, x = (np.abs(np.array(exact(np.array(v).tolist()))) for v in (*program, delta_q))
    of_H, of_g, of_A, of_b = (fmpq(e.numerator, e.denominator) for e in astuple(errors))
    share = fmpq(ROUNDINGS * (n + 1), UNIT.denominator)
    r = of_H * sum(x) + of_g + share * max(H @ x + g)
    d = of_A * sum(x) + of_b + share * max(A.reshape(-1, n) @ x + b)
    soft = np.abs(inverse(np.array(exact(program[0].tolist())))).sum()
    c = float(min(compliances(contacts)))
    squares = 4 * len(contacts) * d * d + number(c) / number(case["h"]) * soft * r * r
    largest = max(max(1.0, one["mu_v"], one["mu_omega"]) for one in contacts)
    return float(largest) * sqrt(fraction(squares)) / c
