"""Rows by number, by contact and by name.

The rows of A are contact-major; the user's own rows come last, as if of one contact more.
"""

from collections.abc import Iterable

import numpy as np

from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData


def contact_rows(step: StepData, rows: Iterable[int]) -> tuple[tuple[int, int], ...]:
    """(contact, row) of some rows of A; contact n_c stands for the user's own rows."""
    every = np.array([*rows], dtype=np.int64)
    contact = np.searchsorted(step.offsets[1:], every, side="right")
    row = every - step.offsets[contact]
    return tuple(zip(contact.tolist(), row.tolist(), strict=True))


def flat_rows(step: StepData, pairs: Iterable[tuple[int, int]]) -> tuple[int, ...]:
    """The rows of A that (contact, row) pairs mean.

    Raises
    ------
    IndexError
        If there is no such contact or row.
    """
    sizes = [*step.counts.tolist(), len(step.extra.names)]
    flat = []
    for contact, row in pairs:
        if not (0 <= contact < len(sizes) and 0 <= row < sizes[contact]):
            raise IndexError(f"the step has no row {row} of contact {contact}")
        flat.append(int(step.offsets[contact]) + row)
    return tuple(flat)


def row_owners(step: StepData, rows: Iterable[int]) -> dict[str, list[str]]:
    """Names of the contacts that some rows belong to, each with the names of those rows.

    The user's own rows stand under ``"extra"``.
    """
    owners: dict[str, list[str]] = {}
    row_names = cone(step.cone).row_names
    for contact, row in contact_rows(step, rows):
        if contact < step.contacts.n_c:
            owners.setdefault(step.contacts.name[contact], []).append(row_names[row])
        else:
            owners.setdefault("extra", []).append(step.extra.names[row])
    return owners
