r"""Zeros of the minimiser on a working set: slacks of other rows, and coordinates.

No ball shows that a number is zero, and no float64 does. Most zeros follow from the working set's
equations alone. Other zeros follow from the loads: a ball that spins under its own weight does not
slide, because nothing pushes it along. These are read from the rational solution.

With zeros of the second kind a row e without slack may be one that W does not span. Then whether
the multipliers are unique and delta_q is differentiable depends on which combinations of such rows
W spans (:mod:`~quasistatic_ref.certify.degeneracy`). If W spans the sum of these rows, as it does
where both directions of a slip are closed, all of them are strictly active, and lam is not unique.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from flint import fmpz

from quasistatic_ref.certify.dependence import all_follow, spanned_in_contacts
from quasistatic_ref.certify.kkt import rational_solution
from quasistatic_ref.certify.rational import exact_form, exact_rows
from quasistatic_ref.certify.rows import places
from quasistatic_ref.step.data import StepData


def zeros_hold(
    step: StepData, working: Sequence[int], rows: Sequence[int], coordinates: Sequence[int]
) -> bool:
    """Whether some slacks and coordinates are all zero, and W spans the sum of these rows.

    Parameters
    ----------
    step : StepData
        In a polyhedral cone.
    working : sequence of int
        W: independent rows.
    rows, coordinates : sequence of int

    Returns
    -------
    bool
        If it is true all rows without slack are strictly active, and the multipliers are unique
        only where there are no `rows`. If it is false nothing is known.
    """
    if not coordinates and spanned_in_contacts(step, working, rows):
        return True
    every, k = (*working, *rows), len(working)
    if _implied(_Claim(_numbers(step, every), k, every, tuple(coordinates), step)):
        return True
    solution = rational_solution(exact_form(step, every), tuple(range(k)))
    if any(solution.slack[k:]) or any(solution.x[v] for v in coordinates):
        return False
    exact = exact_rows(step, every)
    total = [sum(column) for column in zip(*exact[k:], strict=True)]
    return not rows or all_follow(exact[:k], [total])


@dataclass(frozen=True)
class _Claim:
    """Rows and coordinates that are to be zero, and W, the first `k` of the rows.

    Equal if all numbers of them are, so that answers can be kept.
    """

    numbers: bytes
    k: int
    rows: tuple[int, ...]
    coordinates: tuple[int, ...]
    step: StepData = field(compare=False)


def _numbers(step: StepData, rows: Sequence[int]) -> bytes:
    """All numbers of which some rows are made, and the cone's name."""
    used, contacts = np.unique(places(step, rows)[0]), step.contacts
    used = used[used < contacts.n_c]
    own = contacts.J, contacts.phi, contacts.n, contacts.d1, contacts.d2, contacts.mu
    shared = (step.offsets, step.extra.A, step.extra.b)
    parts = [array.tobytes() for array in (*(a[used] for a in own), *shared)]
    return b"".join([step.cone.encode(), *parts])


@lru_cache(maxsize=8)
def _implied(claim: _Claim) -> bool:
    """Whether W implies all zeros; kept, since a body at rest has the same claim in every step."""
    n, k = claim.step.n_v, claim.k
    exact = exact_rows(claim.step, claim.rows)
    zeros = [[fmpz(int(i == v)) for i in range(n + 1)] for v in claim.coordinates]
    return all_follow(exact[:k], [*exact[k:], *zeros])
