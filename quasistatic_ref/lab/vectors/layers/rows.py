"""Layer 4: the rows of Eqs. (4)-(8), in any polyhedral cone."""

from itertools import islice

import numpy as np

from quasistatic_ref.lab.made_steps.contacts import NUMBERS
from quasistatic_ref.lab.vectors.trees import Json
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Contacts
from quasistatic_ref.step.standard_form import friction_rows, row_constants


def row_count(name: str, rows: int) -> int:
    """How many rows a contact has in a cone, its ``rows`` being 6 or 4."""
    return len(cone(name).row_names) if rows == 6 else cone(name).without_torsion


def by_contact(values: Json, name: str, contacts: Json) -> list[Json]:
    """Values of rows, such as lam, as one list for each contact."""
    rest = iter(values)
    return [list(islice(rest, row_count(name, contact["rows"]))) for contact in contacts]


def own(case_input: Json) -> Json:
    """The package's answer, from :mod:`quasistatic_ref.step.friction`."""
    if not case_input["contacts"]:
        return {"A": [], "b": []}
    contacts = contacts_of(case_input["contacts"])
    name = case_input["cone"]
    mask = np.arange(len(cone(name).row_names)) < cone(name).counts(contacts.rows)[:, None]
    A = friction_rows(contacts, name)[mask]
    b = -row_constants(contacts, name)[mask]
    return {"A": A.tolist(), "b": b.tolist()}


def contacts_of(entries: Json) -> Contacts:
    """The package's `Contacts` made from the contacts of a case, of which it needs one."""
    columns = {key: np.array([entry[key] for entry in entries]) for key in NUMBERS}
    return Contacts(name=tuple(f"c{j}" for j in range(len(entries))), **columns)
