r"""The program of a step in exact numbers, formed where they are needed.

H is positive definite, as ``step/data.py`` has checked. It is block diagonal, or one block where a
user's cost is in it. Eq. :eq:`eq-13` is taken times h, because M_u / h is a quotient. So its
multipliers are y = h lam, and on a working set W, without a cost,

- of the springs, :math:`h^2 K_q x_a = h^2 (\tau_k + \tau_a) + A_a^T y`;
- of what moves freely, :math:`M_u x_u = h^2 \tau_u + A_u^T y`.

Rows, of Eqs. :eq:`eq-4`-:eq:`eq-8`, are formed one by one: a solution needs those of W, and a slack
that float64 shows to be positive needs none.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property, lru_cache
from typing import Final

import numpy as np
from flint import arb, arb_mat, fmpz

from quasistatic_ref.exact.program import (
    EXACT,
    PRECISION,
    UNDERFLOW,
    ExactProgram,
    Row,
    exact_matrix,
    implied,
    inverse,
    row_sizes,
    whole_numbers,
)
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.numbers.precision import check_arithmetic, working_precision
from quasistatic_ref.step.cones import Coefficients, cone
from quasistatic_ref.step.data import StepData, row_layout
from quasistatic_ref.step.hessian import Hessian
from quasistatic_ref.step.standard_form import inequalities


class StepProgram(ExactProgram):
    """The program of a step.

    Parameters
    ----------
    step : StepData
    own : (ndarray, ndarray), shapes (m_c, w) and (m,), optional [m]
        Its ``own_inequalities``, where they are known.

    Raises
    ------
    InputError
        If nothing can be proved in this thread.
    """

    def __init__(self, step: StepData, own: tuple[Array, Array] | None = None) -> None:
        check_arithmetic()
        self._step = step
        self._own = own
        kind = cone(step.cone)
        self._cone_rows = _cone_rows(kind.coefficients)
        self._mu = kind.row_coefficients(step.contacts.mu)
        n_c = step.contacts.n_c
        self._contact, self._places = _places(step.cone, step.contacts.rows.tobytes())
        if step.extra.names:
            of_extra = [(n_c + k, 0) for k in range(len(step.extra.names))]
            self._places = [*self._places, *of_extra]
        self._motions: dict[int, arb_mat] = {}
        self._rows: dict[int, Row] = {}
        self.n = step.n_v
        self.m = step.m
        self.bits = PRECISION
        self.h = arb(step.h)
        if step.extra.cost is None:
            pull = arb_mat(self.n, 1)
            springs, self.H, self.H_inverse = step.hessian.once(exact_hessian)
        else:
            H, g = step.extra.cost
            pull = exact_matrix(g[:, None])
            springs, self.H, self.H_inverse = _with_cost(step.hessian, H.tobytes())
        shift = arb_mat(self.n, 1, [*step.delta_q_bar_a.tolist(), *[0] * step.n_u])
        force = arb_mat(self.n, 1, [*step.tau_a.tolist(), *step.tau_u.tolist()])
        with working_precision(EXACT):
            self.g = springs * shift + (force * self.h + pull) * self.h  # Eq. (1), times h^2

    def with_rows_of(self, other: StepProgram | None) -> StepProgram:
        """The form, with the rows that another one has formed if they are the same numbers."""
        step = self._step
        if other is not None and (
            other._step.contacts is step.contacts and other._step.extra is step.extra
        ):
            self._motions = other._motions
            self._rows = other._rows
            self.inequalities = other.inequalities
        return self

    @cached_property
    def inequalities(self) -> tuple[Array, Array]:
        """A, (m, n) [m] per unit of x, and b, (m,) [m], of Eq. :eq:`eq-8` in float64."""
        return inequalities(self._step, self._own)

    def sizes(self, most: Array) -> Array:
        """An upper bound of `|A x - b|` of each row, (m,) [m], if `|x|` <= `most`, (n,) [m, rad].

        Of a contact's rows it is `|phi|` + F R, times the largest coefficient in its cone, which is
        at least 1. R is the largest entry of `|J|` `most`, and more than what underflows in it; F
        is more than the sum of the sizes of the frame with friction. An entry of a row combines
        four products of frame and J with coefficients of the cone: it is off by 3 u of three
        products summed, 2 u of the friction, 4 u of combining them.
        """
        contacts = self._step.contacts
        axes = np.concatenate([contacts.n, contacts.d1, contacts.d2], axis=1)
        F = (1 + np.abs(axes).sum(axis=1)) * (1 + self._mu.sum(axis=1))
        moved = np.append(most, 0.0)[contacts.column][:, None]
        R = ((np.abs(contacts.own) + UNDERFLOW) * moved).sum(axis=2).max(axis=1) + UNDERFLOW
        largest = self._cone_rows.largest
        of_rows: Array = (largest * (np.abs(contacts.phi) + F * R))[self._contact]
        extra = self._step.extra
        if not extra.names:
            return of_rows
        return np.concatenate([of_rows, row_sizes(extra.A, extra.b, most)])

    def motion(self, c: int) -> arb_mat:
        """The exact gap, slips and spin of contact c, (4, n + 1); or a user's row, (1, n + 1).

        Each is [a, c] of a length a x + c: Eq. :eq:`eq-3` in the frame, times friction.
        """
        if c in self._motions:
            return self._motions[c]
        contacts = self._step.contacts
        if c >= contacts.n_c:
            extra = self._step.extra
            k = c - contacts.n_c
            self._motions[c] = exact_matrix(np.append(extra.A[k], -extra.b[k])[None])
        else:
            n, d1, d2 = (axis[c].tolist() for axis in (contacts.n, contacts.d1, contacts.d2))
            J = np.zeros((5, self.n + 1))
            J[:4, contacts.column[c]] = contacts.own[c]  # what stands for none is written over
            J[:, -1] = 0, 0, 0, 0, contacts.phi[c]
            with working_precision(EXACT):
                mu_1, mu_2, mu_w = map(arb, self._mu[c].tolist())
                d1, d2 = [mu_1 * v for v in d1], [mu_2 * v for v in d2]
                turn = [*n, 0, 1, *d1, 0, 0, *d2, 0, 0, 0, 0, 0, mu_w, 0]
                self._motions[c] = arb_mat(4, 5, turn) * exact_matrix(J)
        return self._motions[c]

    def exact_rows(self, some: Iterable[int]) -> list[Row]:
        """Some rows [a, c]: Eq. :eq:`eq-4` combines the four lengths of a contact's motion."""
        some = [*some]
        with working_precision(EXACT):
            for i in some:
                if i not in self._rows:
                    c, kind = self._places[i]
                    row = self._coefficients(c)[kind] * self.motion(c)
                    self._rows[i] = row.entries()
        return [self._rows[i] for i in some]

    def values(self, some: Iterable[int], z: arb_mat) -> list[list[arb]]:
        """Slacks of some rows at z, from the motion of each contact."""
        moved: dict[int, arb_mat] = {}
        values = []
        for c, kind in (self._places[i] for i in some):
            if c not in moved:
                moved[c] = self.motion(c) * z
            values.append((self._coefficients(c)[kind] * moved[c]).entries())
        return values

    def _coefficients(self, c: int) -> list[arb_mat]:
        """What multiplies the motion of contact c in each of its rows."""
        return self._cone_rows.exact if c < self._step.contacts.n_c else [arb_mat([[1]])]

    def implied_by_cone(self, working: Sequence[int], some: Iterable[int]) -> list[int]:
        """Rows that follow from rows of the same contact in W, and from a spin that it shares.

        Six rows have rank four, and contacts about one axis of the same two bodies turn together.
        """
        held: dict[int, tuple[int, ...]] = {}
        for c, kind in sorted(self._places[i] for i in working):
            held[c] = (*held.get(c, ()), kind)
        n_c = self._step.contacts.n_c
        of = {c: kinds for c, kinds in held.items() if c < n_c}
        known = {self._spin(c): c for c, kinds in of.items() if self._cone_rows.imply_spin(kinds)}
        follows = {}
        for c, kinds in of.items():
            turns = bool(known) and known.get(self._spin(c), c) != c
            follows[c] = self._cone_rows.implied(kinds, turns)
        places = ((i, *self._places[i]) for i in some)
        return [i for i, c, kind in places if c in follows and follows[c][kind]]

    def _spin(self, c: int) -> bytes:
        """What tells the spins of contacts apart, as functions of x and but for their factors."""
        of_c: bytes = self._spins[c].tobytes()
        return of_c

    @cached_property
    def _spins(self) -> Array:
        """Columns of J_w and its entries, or all their negatives, of each contact, (n_c, 2 w)."""
        contacts = self._step.contacts
        J_w = np.where(contacts.column < self.n, contacts.own[:, 3], 0.0)
        first = J_w[np.arange(len(J_w)), (J_w != 0).argmax(axis=1)]
        return np.hstack([contacts.column, np.where(first < 0, -1.0, 1.0)[:, None] * J_w + 0.0])


def exact_hessian(hessian: Hessian, of_cost: Array | None = None) -> tuple[arb_mat, ...]:
    """h^2 K_q; H = h^2 K_q + M_u + h H of a cost; and the inverse of H in balls.

    `of_cost` is the exact H of a user's cost, (n_v, n_v) [N s/m], or None.

    Parameters
    ----------
    hessian : Hessian
    of_cost : ndarray, shape (n_v, n_v), optional [N s/m]
        H of a user's cost.
    """
    n_a = hessian.n_a
    n = n_a + len(hessian.M_u)
    springs = arb_mat(n, n)
    M_u = np.zeros((n, n))
    M_u[n_a:, n_a:] = hessian.M_u
    with working_precision(EXACT):
        if n_a:
            K_q = np.zeros((n, n))
            K_q[:n_a, :n_a] = hessian.K_q
            springs = exact_matrix(K_q) * (arb(hessian.h) * hessian.h)
        H = springs + exact_matrix(M_u)
        if of_cost is not None:
            H += exact_matrix(of_cost) * arb(hessian.h)
    return springs, H, inverse(H)


@lru_cache(maxsize=32)
def _with_cost(hessian: Hessian, of_cost: bytes) -> tuple[arb_mat, ...]:
    """:func:`exact_hessian` of a cost, cached, because most steps of a run have the same."""
    n = hessian.n_a + len(hessian.M_u)
    return exact_hessian(hessian, np.frombuffer(of_cost).reshape(n, n))


@lru_cache(maxsize=64)
def _places(cone_name: str, rows: bytes) -> tuple[Indices, list[tuple[int, int]]]:
    """For each row its contact, (m,), and its number within the cone's rows."""
    contact, kind = np.nonzero(row_layout(cone_name, rows).mask)
    return contact, [*zip(contact.tolist(), kind.tolist(), strict=True)]


class ConeRows:
    """The rows of a cone as exact numbers.

    Parameters
    ----------
    coefficients : tuple of tuple of float
        Of gap, slip_1, slip_2 and spin in each row [-].

    Attributes
    ----------
    exact : list of arb_mat, shapes (1, 4)
        The same.
    largest : float
        The largest of them, by size, and at least 1 [-].
    """

    def __init__(self, coefficients: Coefficients) -> None:
        self.exact = [exact_matrix(row) for row in np.array(coefficients)[:, None]]
        self.largest = max(1.0, *(abs(x) for row in coefficients for x in row))
        self._numbers = [whole_numbers(row.entries()) for row in self.exact]
        self._implied: dict[tuple[tuple[int, ...], bool], list[bool]] = {}

    def implied(self, held: tuple[int, ...], turns: bool = False) -> list[bool]:
        """Rows of any contact that follow from its independent rows `held`.

        Parameters
        ----------
        held : tuple of int
        turns : bool
            Whether they follow from these and its spin, which is independent of them.
        """
        if (held, turns) not in self._implied:
            rows = [self._numbers[kind] for kind in held] + [SPIN] * turns
            self._implied[held, turns] = implied(rows, self._numbers)
        return self._implied[held, turns]

    @cached_property
    def _spin_of(self) -> dict[tuple[int, ...], bool]:
        return {}

    def imply_spin(self, held: tuple[int, ...]) -> bool:
        """Whether a contact's independent rows `held` imply its spin."""
        if held not in self._spin_of:
            (self._spin_of[held],) = implied([self._numbers[kind] for kind in held], [SPIN])
        return self._spin_of[held]


SPIN: Final = [fmpz(v) for v in (0, 0, 0, 1)]
"""The coefficients of the spin alone [-]."""

_cone_rows = lru_cache(maxsize=32)(ConeRows)
