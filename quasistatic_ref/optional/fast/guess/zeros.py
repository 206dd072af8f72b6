r"""Zeros of the minimiser on a working set: slacks of other rows, and coordinates.

No ball shows that a number is zero, and no float64 does. Most zeros follow from the working set's
equations alone. Other zeros follow from the loads: a ball that spins under its own weight does not
slide, because nothing pushes it along. These are read from the rational solution.

With zeros of the second kind a row e without slack may be one that W does not span. Then whether
the multipliers are unique and delta_q is differentiable depends on which combinations of such rows
W spans (:mod:`~quasistatic_ref.certify.degeneracy`). If W spans the sum of these rows, as it does
where both directions of a slip are closed, all of them are strictly active, and lam is not unique.
"""

from collections import OrderedDict
from collections.abc import Sequence
from functools import cache
from hashlib import sha256
from typing import NamedTuple

import numpy as np
from flint import fmpz

from quasistatic_ref.certify.degeneracy import differentiable, multipliers_unique
from quasistatic_ref.certify.dependence import follow, tight_rows
from quasistatic_ref.certify.minimiser import rational_solution
from quasistatic_ref.certify.rational import (
    Dyadic,
    concatenated,
    dyadic,
    exact_friction_rows,
    form_on,
)
from quasistatic_ref.certify.rows import places
from quasistatic_ref.step.cones import cone_matrix
from quasistatic_ref.step.data import Indices, StepData
from quasistatic_ref.step.friction import row_constants


class Degeneracy(NamedTuple):
    """What the rows without slack mean for the derivatives and multipliers of an optimum.

    Parameters
    ----------
    unique : bool
        Whether the multipliers are.
    smooth : bool
        Whether delta_q is differentiable in g.
    implied : bool
        Whether these rows have no slack whatever the loads are.
    """

    unique: bool
    smooth: bool
    implied: bool = False


def zeros(
    step: StepData, working: Sequence[int], rows: Sequence[int], coordinates: Sequence[int]
) -> Degeneracy | None:
    """What it means that some slacks and coordinates are all zero, if they are.

    Parameters
    ----------
    step : StepData
        In a polyhedral cone.
    working : sequence of int
        W: independent rows with positive multipliers.
    rows, coordinates : sequence of int
        `rows` are all other rows that may have no slack.

    Returns
    -------
    Degeneracy or None
        None if a number is not zero.
    """
    all_active = Degeneracy(unique=not rows, smooth=True)
    every = (*working, *rows)
    k = len(working)
    if _implied(step, _Claim(_numbers(step, every), k, every, tuple(coordinates))):
        return all_active._replace(implied=True)
    form = form_on(step, *_some_rows(step, every))
    w = tuple(range(k))
    solution = rational_solution(form, w)
    if any(solution.slack[k:]) or any(solution.x[v] for v in coordinates):
        return None
    columns = zip(*form.equations(range(k, form.m)), strict=True)
    total = [sum(column, fmpz(0)) for column in columns]
    if not rows or all(follow(form.equations(w), [total])):
        return all_active
    spanned, unspanned = tight_rows(form, w, solution.slack)
    unique = multipliers_unique(form, w, spanned, unspanned)
    return Degeneracy(unique, differentiable(form, w, unspanned))


class _Claim(NamedTuple):
    """Rows and coordinates that are to be zero, and W, the first `k` of the rows."""

    numbers: bytes
    k: int
    rows: tuple[int, ...]
    coordinates: tuple[int, ...]


def _numbers(step: StepData, rows: Sequence[int]) -> bytes:
    """A hash of all numbers of which some rows are made, of their shapes and the cone's name."""
    contacts = step.contacts
    of_rows = np.zeros(contacts.n_c + 1, dtype=bool)
    of_rows[places(step, rows)[0]] = True
    used = np.flatnonzero(of_rows[:-1])
    own = contacts.J, contacts.phi, contacts.n, contacts.d1, contacts.d2, contacts.mu
    shared = (step.offsets, step.extra.A, step.extra.b)
    parts = [array.tobytes() for array in (*(a[used] for a in own), *shared)]
    kind = f"{step.cone} {contacts.n_c} {step.extra.A.shape} "
    return sha256(b"".join([kind.encode(), *parts])).digest()


KEPT = 1024
"""Answers that are kept: a body at rest has the same claim in every step, and a step may have many
bodies."""
_known: OrderedDict[_Claim, bool] = OrderedDict()


def _implied(step: StepData, claim: _Claim) -> bool:
    """Whether W implies all zeros."""
    known = _known.get(claim)
    if known is None:
        n = step.n_v
        k = claim.k
        A, b = _some_rows(step, claim.rows)  # one positive factor for every a, one for every b
        exact: list[list[int]] = [[*a_i, b_i] for a_i, b_i in zip(A.m, b.m, strict=True)]
        equations = _across_pairs(step, claim, exact)
        equations += [[int(i == v) for i in range(n + 1)] for v in claim.coordinates]
        known = not equations or all(follow(exact[:k], equations))
        while len(_known) >= KEPT:
            _known.popitem(last=False)  # the oldest, in one call: other threads solve as well
        _known[claim] = known
    return known


def _across_pairs(step: StepData, claim: _Claim, exact: list[list[int]]) -> list[list[int]]:
    """The equations of the claim's rows that do not follow from those of W between the same bodies.

    Most do: the rows of a contact combine four motions, of which contacts with the same normal have
    the spin in common. Of few rows and coordinates that is decided in little time: a pushed row of
    25 boxes, of which hundreds of rows are zero, takes a quarter of the time of one decision.
    """
    contact, _ = places(step, claim.rows)
    moves = np.vstack([(step.contacts.J != 0).any(axis=1), np.ones((1, step.n_v), bool)])
    between: dict[bytes, list[int]] = {}
    for i, j in enumerate(contact.tolist()):
        between.setdefault(moves[j].tobytes(), []).append(i)
    left = []
    for moved, rows in between.items():
        columns = [*np.flatnonzero(np.frombuffer(moved, dtype=bool)).tolist(), step.n_v]
        some = [[exact[i][v] for v in columns] for i in rows]
        k = sum(i < claim.k for i in rows)
        found = follow(some[:k], some[k:]) if k else [False] * len(rows)
        left += [exact[i] for i, seen in zip(rows[k:], found, strict=True) if not seen]
    return left


def _some_rows(step: StepData, rows: Sequence[int]) -> tuple[Dyadic, Dyadic]:
    """Some rows of A, and their entries of b."""
    contact, row = places(step, rows)
    own = contact == step.contacts.n_c
    used, at = np.unique(contact[~own], return_inverse=True)
    constants = row_constants(step.contacts, step.cone)[contact[~own], row[~own]]
    of_contacts = exact_friction_rows(step.contacts, step.cone, used)[at, row[~own]]
    A = concatenated([of_contacts, dyadic(step.extra.A[row[own]])])  # Eq. (8)
    b = concatenated([dyadic(-constants), dyadic(step.extra.b[row[own]])])
    order = np.argsort(own, kind="stable").argsort()
    return A[order], b[order]


@cache
def combined(name: str) -> Indices:
    """How the rows of a cone combine gap, slips and spin: integers (R, 4), times one factor > 0."""
    return np.array(dyadic(cone_matrix(name)).m.tolist(), dtype=np.int64)
