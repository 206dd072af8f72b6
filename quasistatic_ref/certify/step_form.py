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

import numpy as np
from flint import arb, arb_mat

from quasistatic_ref.certify.form import (
    EXACT,
    PRECISION,
    UNDERFLOW,
    ExactForm,
    Row,
    exact_matrix,
    implied,
    inverse,
    row_sizes,
    whole_numbers,
)
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.numbers.precision import check_arithmetic, working_precision
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData, row_layout
from quasistatic_ref.step.hessian import Hessian
from quasistatic_ref.step.standard_form import inequalities


class StepForm(ExactForm):
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
        self._cone = cone(step.cone)
        self._mu = self._cone.row_coefficients(step.contacts.mu)
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

    def with_rows_of(self, other: StepForm | None) -> StepForm:
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

        Of a contact's rows it is `|phi|` + F R. R is the largest entry of `|J|` `most`, and more
        than what underflows in it; F is more than the sum of the sizes of the frame with friction.
        An entry of a row combines four products of frame and J, with coefficients of at most one:
        it is off by 3 u of three products summed, 2 u of the friction, 4 u of combining them.
        """
        contacts = self._step.contacts
        axes = np.concatenate([contacts.n, contacts.d1, contacts.d2], axis=1)
        F = (1 + np.abs(axes).sum(axis=1)) * (1 + self._mu.sum(axis=1))
        R = ((np.abs(contacts.J) + UNDERFLOW) @ most).max(axis=1, initial=0.0) + UNDERFLOW
        of_rows: Array = (np.abs(contacts.phi) + F * R)[self._contact]
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
            J[:4, :-1] = contacts.J[c]
            J[4, -1] = contacts.phi[c]
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
        return _cone_rows(self._cone.name) if c < self._step.contacts.n_c else [arb_mat([[1]])]

    def implied_by_cone(self, working: Sequence[int], some: Iterable[int]) -> list[int]:
        """Rows that follow from rows of the same contact in W: six rows have rank four."""
        held: dict[int, tuple[int, ...]] = {}
        for c, kind in sorted(self._places[i] for i in working):
            held[c] = (*held.get(c, ()), kind)
        n_c = self._step.contacts.n_c
        kinds = {c: _implied_kinds(self._cone.name, of_c) for c, of_c in held.items() if c < n_c}
        places = ((i, *self._places[i]) for i in some)
        return [i for i, c, kind in places if c in kinds and kinds[c][kind]]


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


@lru_cache(maxsize=32)
def _cone_rows(cone_name: str) -> list[arb_mat]:
    """The exact coefficients of gap, slips and spin in each row of a cone, (1, 4) [-]."""
    return [exact_matrix(row[None]) for row in cone(cone_name).matrix]


@lru_cache(maxsize=1024)
def _implied_kinds(cone_name: str, held: tuple[int, ...]) -> list[bool]:
    """Rows of any contact that follow from its independent rows `held`."""
    numbers = [whole_numbers(row.entries()) for row in _cone_rows(cone_name)]
    return implied([numbers[kind] for kind in held], numbers)
