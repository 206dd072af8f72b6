"""Why q+ has no derivative: which of its parts changes its branch at the configuration.

Whether there is a derivative is decided by differences of q+, and by those of rows that depend on
each other. The reasons are then looked for in the parts: an exact tie of distances, a closest point
or normal whose second difference does not vanish, tangents that jump and turn the cone with them, a
row without slack that need not press.
Only contacts that touch, with a row without slack, can be the reason.
"""

from collections.abc import Callable, Iterable, Sequence
from itertools import accumulate

from flint import fmpq

from quasistatic_ref.lab.vectors.exact.precision import Matrix, Vector
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers.rows import row_count
from quasistatic_ref.lab.vectors.unrounded.differences import Base, Quotient, least_solid
from quasistatic_ref.lab.vectors.unrounded.grid import STEP
from quasistatic_ref.lab.vectors.unrounded.nearby import Near, candidates, tied_indices
from quasistatic_ref.lab.vectors.unrounded.step import Contact, rows
from quasistatic_ref.lab.vectors.unrounded.strictly_active import strictly_active

BEND = fmpq(1, 10**12)
"""A second difference over eps that is larger is a jump of the derivative: that of a smooth q+ is
its second derivative times 8e-31."""


def reasons(one: Base, found: Sequence[Quotient]) -> list[Json]:
    """Reasons of each kind that are met; the quotients are those along the coordinates of q."""
    touching = _tight_contacts(one)
    listed = [*_rows(one), *_selections(one, touching)]
    for k in touching:
        contact = one.contacts[k]
        if any(_bends(one.contacts, k, q, _place) for q in found):
            listed.append(_reason("feature", one, contact))
        elif any(_turns(one, k, q) for q in found):
            listed.append(_reason("tangents", one, contact))
    return listed or [_reason("multipliers", one, one.contacts[k]) for k in touching]


def switches(one: Base, found: Sequence[Quotient]) -> bool:
    """Whether some part changes its branch, whatever becomes of q+."""
    if _rows(one) or _selections(one, range(len(one.contacts))):
        return True
    return any(
        _bends(one.contacts, k, q, part)
        for k in range(len(one.contacts))
        for q in found
        for part in (_place, _frame)
    )


def _reason(kind: str, one: Base, contact: Contact, indices: Sequence[int] = ()) -> Json:
    pair = one.at.case["pairs"][contact.near.pair]["name"]
    return {"kind": kind, "pair": pair, "index": [*indices] or [contact.near.index], "rows": []}


def blocks(case: Json, contacts: Iterable[Contact]) -> list[range]:
    """The rows of each contact."""
    counts = [row_count(case["cone"], case["pairs"][c.near.pair]["rows"]) for c in contacts]
    ends = accumulate(counts)
    return [range(end - count, end) for end, count in zip(ends, counts, strict=True)]


def _tight_contacts(one: Base) -> list[int]:
    """Numbers of the contacts that have a row without slack."""
    found = one.step.optimum.minimiser
    tight = {*found.working, *found.spanned, *found.unspanned}
    every = enumerate(blocks(one.at.case, one.contacts))
    return [k for k, block in every if tight.intersection(block)]


def _rows(one: Base) -> list[Json]:
    """Weakly active rows, contact by contact."""
    weak = weak_rows(one)
    found = []
    for contact, block in zip(one.contacts, blocks(one.at.case, one.contacts), strict=True):
        own = [i - block.start for i in weak if i in block]
        if own:
            found.append({**_reason("row", one, contact), "rows": own})
    return found


def weak_rows(one: Base) -> list[int]:
    """Rows without slack whose multiplier is 0 in every optimal lam."""
    minimiser = one.step.optimum.minimiser
    unspanned = minimiser.unspanned
    strict = strictly_active(one.step.form, minimiser.working, unspanned)
    return [i for i in unspanned if i not in strict]


def _selections(one: Base, matters: Iterable[int]) -> list[Json]:
    """Pairs of which a tie of distances decides what is kept."""
    places = [(one.contacts[k].near.pair, one.contacts[k].near.index) for k in matters]
    found = []
    for pair, written in enumerate(one.at.case["pairs"]):
        near = candidates(one.at, pair, one.pools[pair])
        equal = tied_indices(near, written["k"], least=least_solid(one.at.case, pair))
        if any((pair, index) in places for index in equal):
            contact = next(c for c in one.contacts if c.near.pair == pair)
            found.append(_reason("selection", one, contact, equal))
    return found


def _place(contact: Contact) -> Vector:
    near: Near = contact.near
    return [near.phi, *near.alpha, *near.beta, *near.n]


def _frame(contact: Contact) -> Vector:
    return [*contact.d1, *contact.d2]


def _same(own: Sequence[Contact], k: int, found: Quotient) -> list[Contact]:
    """A contact at the step and at the two nearby; none where another candidate replaces it."""
    (_, ahead), (_, behind) = found.sides
    each = [contacts[k] for contacts in (own, ahead, behind)]
    return each if len({contact.near.index for contact in each}) == 1 else []


def _jumps(own: Vector, ahead: Vector, behind: Vector) -> bool:
    """Whether the second difference of some number does not vanish."""
    every = zip(own, ahead, behind, strict=True)
    return any(abs(x + y - 2 * z) > BEND * STEP for z, x, y in every)


def _bends(
    own: Sequence[Contact], k: int, found: Quotient, part: Callable[[Contact], Vector]
) -> bool:
    """Whether the second difference of a contact's numbers does not vanish; of another, no."""
    same = _same(own, k, found)
    return bool(same) and _jumps(*map(part, same))


def _turns(one: Base, k: int, found: Quotient) -> bool:
    """Whether the rows of a contact, as a set, jump or bend."""
    same = _same(one.contacts, k, found)
    if not same:
        return False
    own, *sides = (rows(one.at.case, [contact])[0] for contact in same)
    return any(_jumps(row, *(nearest(row, side) for side in sides)) for row in own)


def nearest(row: Vector, others: Matrix) -> Vector:
    """That of other rows whose numbers differ least from a row's."""
    return min(others, key=lambda other: max(abs(x - y) for x, y in zip(row, other, strict=True)))
