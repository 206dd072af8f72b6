"""A guess of a working set that is wrong by a row or two: where walks in floating point lead.

A backend does not see rows that are violated by less than its tolerance, nor does float64 see a
violation below the rounding of the slack. The proof of the guess does, and names one such row. The
walk from there is that of :mod:`~quasistatic_ref.certify.active_set`, with signs that rounding may
have made wrong: what it leads to is a guess again, which has to be proved like any other.
"""

import math
from collections.abc import Callable
from typing import NamedTuple, TypeAlias

import numpy as np

from quasistatic_ref.certify.exact import ExactOptimum
from quasistatic_ref.step.data import Array, Indices
from quasistatic_ref.step.standard_form import StandardForm

CHANGES = 4
"""Walks before a guess is given up: on the grasp one or two mend a wrong guess of DAQP."""

DEPENDENT = 1e-9
"""A row is taken to depend on others if the squared length of the part that they do not span is at
most this share of the squared length of the row, both in the norm of H^-1."""


class Violated(NamedTuple):
    """A guess whose multipliers are positive, but whose minimiser violates a row.

    Parameters
    ----------
    row : int
        The first row that is violated.
    working : ndarray of int, shape (k,)
        The guess, ascending.
    lam : ndarray, shape (k,)
        Its multipliers [N s].
    delta_q : ndarray, shape (n_v,)
        Its minimiser [m, rad].
    """

    row: int
    working: Indices
    lam: Array
    delta_q: Array


Proof: TypeAlias = "ExactOptimum | Violated | None"
"""What testing a working set gives: the optimum, proved; :class:`Violated` if its multipliers are
positive but a row is surely violated; or None if something stays undecided."""


def proved_nearby(
    prove: Callable[[Indices], Proof], guess: Indices, form: StandardForm, inverse: Array
) -> ExactOptimum | None:
    """The optimum proved on a guess, or on the working set that a few walks make of it; or None.

    Parameters
    ----------
    prove : callable
        Tests a working set, ascending.
    guess : ndarray of int, shape (k,)
        Rows.
    form : StandardForm
    inverse : ndarray, shape (n_v, n_v)
        Of its H [m^2/(N m s)].
    """
    found = prove(guess)
    for _ in range(CHANGES):
        if not isinstance(found, Violated):
            break
        with np.errstate(all="ignore"):
            changed = walked(form, inverse, found)
        found = None if changed is None else prove(changed)
    return None if isinstance(found, Violated) else found


def walked(form: StandardForm, inverse: Array, found: Violated) -> Indices | None:
    """The working set, ascending, after a walk that adds the violated row; None if none is reached.

    Parameters
    ----------
    form : StandardForm
    inverse : ndarray, shape (n_v, n_v)
        Of its H [m^2/(N m s)].
    found : Violated
    """
    p, working, lam, delta_q = found
    row, A = form.A[p], form.A[working]
    moved, short = inverse.dot(row), float(form.b[p] - row.dot(delta_q))
    square = float(row.dot(moved))
    reached, towards = A.dot(inverse).dot(A.T), A.dot(moved)
    while True:
        try:
            falls = np.linalg.solve(reached, towards)  # of lam, per unit of p's multiplier
        except np.linalg.LinAlgError:
            return None
        rate = square - float(falls.dot(towards))
        full = max(short, 0.0) / rate if rate > DEPENDENT * square else math.inf
        pairs = zip(lam.tolist(), falls.tolist(), strict=True)
        limits = [lam_j / fall if fall > 0 else math.inf for lam_j, fall in pairs]
        least = min(limits, default=math.inf)
        if not full > least:  # NaN too
            return np.array(sorted([*working.tolist(), p])) if full < math.inf else None
        rest = np.arange(len(working)) != limits.index(least)
        lam, working = (lam - least * falls)[rest], working[rest]
        reached, towards = reached[rest][:, rest], towards[rest]
        short -= least * rate
