"""Layer 4: the rows of Eqs. (4)-(8), in any polyhedral cone."""

from itertools import islice

import numpy as np

from quasistatic_ref.lab.scenes.contacts import NUMBERS
from quasistatic_ref.lab.vectors.exact.rational import (
    UNIT,
    digits,
    exact,
    largest,
    rounded,
    tolerance,
)
from quasistatic_ref.lab.vectors.expected import Expected, Json, Tolerance
from quasistatic_ref.step.cones import cone, cone_matrix
from quasistatic_ref.step.data import Contacts
from quasistatic_ref.step.friction import friction_rows, row_gaps

ROUNDINGS = 16
"""Of an entry of A: a dot product of three terms, its product with mu, and the sum of four such,
each counted twice."""


def expected(case_input: Json) -> Expected:
    """A and b of all contacts, contact-major, without rounding until the end."""
    contacts = case_input["contacts"]
    table = exact(cone_matrix(case_input["cone"])[:, 1:])
    A, b, size = [], [], exact(0.0).item()
    for contact in contacts:
        J, axes = exact(contact["J"]), exact([contact[key] for key in ("n", "d1", "d2")])
        motion = np.concatenate([axes @ J[:3], J[3:]])  # along n, d1, d2 and about n
        reach = np.concatenate([abs(axes) @ abs(J[:3]), abs(J[3:])])
        rows = row_coefficients(contact, case_input["cone"], table)
        A += [*(motion[0] + rows @ motion[1:])]  # Eqs. (4)-(7)
        b += [-exact(contact["phi"]).item()] * len(rows)  # Eq. (8)
        size = max(size, largest(reach[0] + abs(rows) @ reach[1:]))
    A_exact, b_exact = np.array(A, dtype=object), np.array(b, dtype=object)
    return Expected(
        output={"A": rounded(A_exact), "b": rounded(b_exact)},
        digits=digits(A=A_exact, b=b_exact),
        tolerance={
            "A": tolerance(ROUNDINGS * UNIT * size, "rounding of the sums that make an entry"),
            "b": Tolerance(0.0, "b is -phi of the contact, which is not rounded"),
        },
    )


def row_coefficients(contact: Json, name: str, table: np.ndarray) -> np.ndarray:
    """What each row of a contact adds of d1, d2 and spin: (mu_v t1, mu_v t2, mu_omega t3).

    Both they and the `table` [-] of the cone have the shape (R, 3).
    """
    torsion = contact["rows"] == 6
    mu = exact([contact["mu_v"], contact["mu_v"], contact["mu_omega"] if torsion else 0.0])
    return np.asarray(table[: row_count(name, contact["rows"])] * mu)


def row_count(name: str, rows: int) -> int:
    """How many rows a contact has in a cone, its ``rows`` being 6 or 4."""
    return len(cone(name).row_names) if rows == 6 else cone(name).short


def by_contact(values: Json, name: str, contacts: Json) -> list[Json]:
    """What stands row by row, as lam does, parted by contact."""
    rest = iter(values)
    return [list(islice(rest, row_count(name, contact["rows"]))) for contact in contacts]


def own(case_input: Json) -> Json:
    """The package's answer, from :mod:`quasistatic_ref.step.friction`."""
    if not case_input["contacts"]:
        return {"A": [], "b": []}
    contacts, name = contacts_of(case_input["contacts"]), case_input["cone"]
    mask = np.arange(len(cone(name).row_names)) < cone(name).counts(contacts.rows)[:, None]
    A, b = friction_rows(contacts, name)[mask], -row_gaps(contacts, name)[mask]
    return {"A": A.tolist(), "b": b.tolist()}


def contacts_of(entries: Json) -> Contacts:
    """Contacts of the package from those of a case, of which there is at least one."""
    columns = {key: np.array([entry[key] for entry in entries]) for key in NUMBERS}
    return Contacts(name=tuple(f"c{j}" for j in range(len(entries))), **columns)
