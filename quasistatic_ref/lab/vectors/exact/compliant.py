"""The forces of the contacts of a step by compliance, exact."""

from typing import TypeAlias

import numpy as np

from quasistatic_ref.certify.active_set import dual_active_set
from quasistatic_ref.certify.minimiser import Minimiser
from quasistatic_ref.lab.program.forces import compliances, compliant_program, forces_of
from quasistatic_ref.lab.program.rows import cone_table
from quasistatic_ref.lab.vectors.exact.entered import exact
from quasistatic_ref.lab.vectors.exact.forms import exact_form_of
from quasistatic_ref.lab.vectors.exact.precision import number, rounded_results
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.numbers.arrays import Array

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
    assert isinstance(end, Minimiser)
    s = np.array(end.fractions.exact_x[len(program[1]) :])
    return rounded_results(lambda: forces_of(s, [number(c_j) for c_j in c], entries))
