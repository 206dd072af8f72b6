"""A guess of a working set that is wrong: where walks in floating point lead.

A backend does not see rows that are violated by less than its tolerance, nor multipliers of the
size of rounding, of which bodies at rest on each other have many. The proof of the guess does: it
gives the multipliers and slacks of the guess, the smallest of them too. From there the method
of :mod:`~quasistatic_ref.certify.active_set` goes on in float64. It only adds to these numbers, and
what it adds is about as small as what was violated: they stay right relative to their own size. A
sign may be wrong all the same. Where the walks end is a guess again, to be proved like any other.
"""

import math
from collections.abc import Callable
from typing import Final, NamedTuple, TypeAlias

import numpy as np

from quasistatic_ref.certify.exact import ExactOptimum
from quasistatic_ref.step.data import Array, Indices
from quasistatic_ref.step.standard_form import StandardForm

GUESSES: Final = 16
"""Guesses that follow a wrong one before the exact method has to decide. On the grasp one or two
follow one of DAQP; on boxes in a row at rest, whose ties differ by 1e-21, 1e-40 and 1e-61 m, four
to ten."""

WALKS: Final = 1000
"""Rows that are added from one proof to the next, at most."""

DEPENDENT: Final = 1e-9
"""A row is taken to depend on others if the squared length of the part that they do not span is at
most this share of the squared length of the row, both in the norm of H^-1."""

NO_FALL: Final = 1e-11
"""Share of the fastest change of a multiplier up to which another one is taken not to change."""

ROUNDING: Final = 2.0**-46
"""Of a slack that changes, relative to the sizes of what it is the sum of."""


class Refuted(NamedTuple):
    """A guess that is no working set of the optimum, and its minimiser.

    Parameters
    ----------
    working : ndarray of int, shape (k,)
        The guess, ascending.
    lam : ndarray, shape (k,)
        Its multipliers [N s]; 0 where they may be zero.
    slack : ndarray, shape (m,)
        Of its minimiser [m]; 0 where it may be zero.
    """

    working: Indices
    lam: Array
    slack: Array


Proof: TypeAlias = "ExactOptimum | Refuted | None"
"""What testing a working set gives: the optimum, proved; :class:`Refuted` if it is none of that; or
None if something stays undecided."""


def proved_nearby(
    prove: Callable[[Indices], Proof], guess: Indices, form: StandardForm, inverse: Array
) -> tuple[ExactOptimum | None, Indices]:
    """The optimum proved on a guess, or on a working set that walks make of it.

    Parameters
    ----------
    prove : callable
        Tests a working set, ascending.
    guess : ndarray of int, shape (k,)
        Rows.
    form : StandardForm
    inverse : ndarray, shape (n_v, n_v)
        Of its H [m^2/(N m s)].

    Returns
    -------
    ExactOptimum or None
        None where no guess is proved.
    ndarray of int
        The last guess.
    """
    found = prove(guess)
    for _ in range(GUESSES):
        if not isinstance(found, Refuted):
            break
        with np.errstate(all="ignore"):
            changed = walked(form, inverse, found)
        if changed is None:
            break
        guess = changed
        found = prove(guess)
    return None if isinstance(found, Refuted) else found, guess


def walked(form: StandardForm, inverse: Array, found: Refuted) -> Indices | None:
    """The working set, ascending, at which walks from a refuted one end; None if they do not.

    Parameters
    ----------
    form : StandardForm
    inverse : ndarray, shape (n_v, n_v)
        Of its H [m^2/(N m s)].
    found : Refuted
    """
    try:
        walk = Walk(form, inverse, found)
        walk.drop_what_pulls()
        for _ in range(WALKS):
            p = walk.violated()
            if p is None:
                return np.sort(walk.working)
            if not walk.add(p):
                return None
    except np.linalg.LinAlgError:
        pass
    return None


class Walk:
    """The minimiser on a working set that changes, by its multipliers and slacks in float64.

    Parameters
    ----------
    form : StandardForm
    inverse : ndarray, shape (n_v, n_v)
        Of its H [m^2/(N m s)].
    found : Refuted
        Where it starts.

    Attributes
    ----------
    working : ndarray of int, shape (k,)
    lam : ndarray, shape (k,)
        [N s].
    slack, noise : ndarray, shape (m,)
        [m]; a slack may be wrong by about the noise.
    """

    def __init__(self, form: StandardForm, inverse: Array, found: Refuted) -> None:
        self.A = form.A
        self.inverse = inverse
        self.sizes = np.abs(form.A), np.abs(inverse)
        self.working = found.working
        self.lam = found.lam
        self.slack = found.slack.copy()
        self.noise = np.zeros(len(found.slack))
        A_W = form.A[found.working]
        self._reached = A_W.dot(inverse).dot(A_W.T)

    def drop_what_pulls(self) -> None:
        """Leave out the row of the most negative multiplier until all are positive."""
        while len(self.lam):
            j = int(np.argmin(self.lam))
            pull = self.lam[j]
            if pull > 0:
                return
            row = self.A[self.working[j]]
            towards = np.delete(self._reached[:, j], j)
            self._drop(j)
            change = self._taken_over(towards)
            self.lam = self.lam + pull * change
            self._move(-pull, row, change)

    def violated(self) -> int | None:
        """The row that is violated most, if there is one."""
        surely = np.flatnonzero(self.slack < -self.noise)
        return int(surely[self.slack[surely].argmin()]) if surely.size else None

    def add(self, p: int) -> bool:
        """Walk until row p is satisfied; whether that is possible."""
        row = self.A[p]
        pressed = 0.0
        along = self.inverse.dot(row)
        square = float(row.dot(along))
        towards = self.A[self.working].dot(along)
        while True:
            falls = self._taken_over(towards)  # of lam, per unit of p's multiplier
            rate = square - float(falls.dot(towards))
            moves = rate > DEPENDENT * square
            full = max(-float(self.slack[p]), 0.0) / rate if moves else math.inf
            never = np.full(len(falls), math.inf)
            surely = falls > NO_FALL * np.abs(falls).max(initial=0.0)
            limits = np.divide(self.lam, falls, out=never, where=surely)
            least = float(limits.min(initial=math.inf))
            taken = min(full, least)
            if not taken < math.inf:  # NaN too
                return False
            self.lam = np.maximum(self.lam - taken * falls, 0.0)
            pressed += taken
            if moves:
                self._move(taken, row, falls)
            if full <= least:
                break
            first = int(np.argmin(limits))
            towards = np.delete(towards, first)
            self._drop(first)
        self.slack[p] = 0.0
        self._reached = np.block([[self._reached, towards[:, None]], [towards, square]])
        self.working = np.append(self.working, p)
        self.lam = np.append(self.lam, pressed)
        return True

    def _taken_over(self, towards: Array) -> Array:
        """What the rows of W take over of another that reaches them by `towards`, both (k,) [-].

        Raises
        ------
        LinAlgError
            If the rows are dependent in float64.
        """
        from scipy.linalg.lapack import dposv  # here: most runs take no walk, and need no SciPy

        if not len(towards):
            return towards
        _, share, failed = dposv(self._reached, towards)
        if failed > 0:
            raise np.linalg.LinAlgError
        return np.asarray(share)

    def _drop(self, j: int) -> None:
        rest = np.arange(len(self.working)) != j
        self.working = self.working[rest]
        self.lam = self.lam[rest]
        self._reached = self._reached[rest][:, rest]

    def _move(self, pressed: float, row: Array, falls: Array) -> None:
        """The slacks once a row is pressed, and those of W less by `falls` (k,) times that."""
        A_W = self.A[self.working]
        size_of_A, size_of_inverse = self.sizes
        push = row - falls.dot(A_W)
        size = np.abs(row) + np.abs(falls).dot(np.abs(A_W))
        self.slack += pressed * self.A.dot(self.inverse.dot(push))
        self.noise += ROUNDING * abs(pressed) * size_of_A.dot(size_of_inverse.dot(size))
        self.slack[self.working] = 0.0
