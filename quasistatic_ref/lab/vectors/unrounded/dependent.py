"""Whether dependent rows stay dependent along changes of everything at once, by null vectors.

Let A hold the rows without slack, all of which bear load in some optimal lam. As long as none of
them opens, mu'(A delta_q - b) is 0 for each mu with A'mu = 0. A change by eps with a force besides
adds eps z to delta_q, A z = 0, any z of these for some force; of the order eps^2 the sum then
has the term mu'dA z. That is 0 for all z only if dA'mu combines the rows of A. Where it does
not, a row opens for one sign of z: a derivative along each coordinate may exist, but none of all.
"""

from collections.abc import Iterable, Sequence

import numpy as np
from flint import fmpq, fmpz_mat

from quasistatic_ref.lab.vectors.exact.precision import Matrix, Vector
from quasistatic_ref.lab.vectors.exact.rational import rationals
from quasistatic_ref.lab.vectors.unrounded.differences import Base, Quotient
from quasistatic_ref.lab.vectors.unrounded.grid import STEP
from quasistatic_ref.lab.vectors.unrounded.reasons import BEND, blocks, nearest
from quasistatic_ref.lab.vectors.unrounded.step import Contact, Solved, rows

CLOSE = fmpq(1, 1 << 50)
"""A row that moves by more along a change of 8e-31 has jumped with the tangents [m per unit]."""


def dependence_breaks(one: Base, found: Iterable[Quotient]) -> bool:
    """Whether some change takes dA'mu out of what the rows without slack span.

    Parameters
    ----------
    one : Base
        Of which each row without slack bears load in some optimal lam.
    found : iterable of Quotient
        Along single coordinates and parameters. A contact that another candidate replaces
        in a step nearby is compared with nothing.
    """
    found_at = one.step.optimum.minimiser
    tight = sorted([*found_at.working, *found_at.spanned, *found_at.unspanned])
    if not tight:
        return False
    A = fmpz_mat(one.step.form.rows(tight))
    moves = _null(A)
    together = _null(A.transpose()) if moves else []
    if not together:
        return False
    own = _blocks(one, one.contacts, one.step)
    for step, contacts in (side for change in found for side in change.sides):
        rates = _rates(one, own, contacts, _blocks(one, contacts, step))
        for mu in together:
            pulled = mu @ np.array([rates[i] for i in tight])
            if any(abs(pulled @ z) > BEND for z in moves):
                return True
    return False


def _null(A: fmpz_mat) -> list[Vector]:
    """Vectors z with A z = 0 that span all of these; the largest entry of each is 1 in size."""
    table, count = A.nullspace()
    columns = table.transpose().tolist()[:count]
    return [rationals(column) / max(map(abs, column)) for column in columns]


def _blocks(one: Base, contacts: Sequence[Contact], step: Solved) -> list[Matrix]:
    """The rows of each contact."""
    return [step.A[block] for block in blocks(one.at.case, contacts)]


def _rates(
    one: Base, own: list[Matrix], contacts: Sequence[Contact], nearby: list[Matrix]
) -> list[Vector]:
    """How fast each row of the step changes towards a step nearby, but for the sign."""
    places = {(c.near.pair, c.near.index): k for k, c in enumerate(contacts)}
    found: list[Vector] = []
    for contact, block in zip(one.contacts, own, strict=True):
        k = places.get((contact.near.pair, contact.near.index))
        others = block if k is None else _matched_rows(one, contact, block, contacts[k], nearby[k])
        found += [(y - x) / STEP for x, y in zip(block, others, strict=True)]
    return found


def _matched_rows(
    one: Base, contact: Contact, block: Matrix, other: Contact, nearby: Matrix
) -> Matrix:
    """The rows of a contact nearby, in the order of its own; turned to its tangents if they jump.

    Where tangents jump and q+ does not notice, the contact sticks, and its rows span as much in
    whatever tangents; or they are the same rows again.
    """
    found = [nearest(row, nearby) for row in block]
    far = (abs(x - y) for row, near in zip(block, found, strict=True)
           for x, y in zip(row, near, strict=True))  # fmt: skip
    if all(x <= CLOSE for x in far):
        return found
    return rows(one.at.case, [turned(contact, other)])[0]


def turned(contact: Contact, other: Contact) -> Contact:
    """A contact nearby, with tangents that differ from a contact's own by no more than n does.

    Parameters
    ----------
    contact : Contact
    other : Contact
        The same candidate in a step nearby.
    """
    c = contact.d1 @ other.d1
    s = contact.d1 @ other.d2
    n, first, second, spin = other.motion
    motion = [n, c * first + s * second, c * second - s * first, spin]
    return Contact(other.near, contact.d1, contact.d2, np.array(motion))
