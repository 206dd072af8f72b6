r"""A program in exact numbers: H, g and rows, those of a step formed where they are needed.

A ball without radius is an exact number. A float64 is one, and sums and products of such numbers
are, at a precision (``EXACT``) that no number of a step exhausts; conversions to integers refuse
any other ball. A step's numbers are taken as they stand: rounding what is built from them would
split the ties between the rows of a sticking contact.

.. math:: \min \tfrac12 x^T H x - g^T x \quad\text{s.t.}\quad a_i^T x + c_i \ge 0, \quad c = -b.

The first rows of a form may be equations, :math:`a_i^T x + c_i = 0`; a step has none.

H is positive definite, as ``step/data.py`` has checked. It is block diagonal, or one block where a
user's cost is in it. Eq. :eq:`eq-13` is taken times h, because M_u / h is a quotient. So its
multipliers are y = h lam, and on a working set W, without a cost,

- of the springs, :math:`h^2 K_q x_a = h^2 (\tau_k + \tau_a) + A_a^T y`;
- of what moves freely, :math:`M_u x_u = h^2 \tau_u + A_u^T y`.

Rows, of Eqs. :eq:`eq-4`-:eq:`eq-8`, are formed one by one: a solution needs those of W, and a slack
that float64 shows to be positive needs none.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from functools import cached_property, lru_cache
from typing import Final, NamedTuple, TypeAlias

import numpy as np
from flint import arb, arb_mat, fmpq, fmpz, fmpz_mat

from quasistatic_ref.certify.groups import labels
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.numbers.precision import check_arithmetic, working_precision
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData, row_layout
from quasistatic_ref.step.hessian import Hessian
from quasistatic_ref.step.standard_form import inequalities

EXACT: Final = 1 << 30
"""Bits at which no sum or product is rounded. What is short costs no more than at few bits."""

PRECISION: Final = 320
"""Bits of a ball's midpoint. The data have 53 to 250; 256 is enough on grasps, and what is
left undecided is decided in rational numbers, so this is a matter of speed alone."""

MANY: Final = 64
"""Coordinates above which products with H^-1 pay by its blocks."""

UNIT: Final = 2.0**-53
"""Largest relative error of one operation in float64."""
UNDERFLOW: Final = 1e-290
"""So large that its product with UNIT is far above all that underflow takes from a sum."""

Row: TypeAlias = "list[arb]"
"""a and c of a x + c >= 0: n + 1 exact numbers."""


def exact_matrix(array: Array) -> arb_mat:
    """Finite float64 numbers as an exact matrix, without rounding.

    Parameters
    ----------
    array : ndarray, shape (rows, columns)
        Of any unit [-].
    """
    rows, columns = array.shape
    return arb_mat(rows, columns, array.ravel().tolist())


def whole_numbers(numbers: Sequence[arb]) -> list[fmpz]:
    """Exact numbers times one power of two that makes them integers; ValueError of a radius."""
    return scaled(numbers)[0]


def scaled(numbers: Sequence[arb]) -> tuple[list[fmpz], int]:
    """The integers m and the e of exact numbers m 2^e.

    Raises
    ------
    ValueError
        If a number is a ball with a radius.
    """
    parts = [number.man_exp() for number in numbers]
    exponents = [int(e) for _, e in parts]
    least = min(exponents, default=0)
    return [m << e - least for (m, _), e in zip(parts, exponents, strict=True)], least


def fraction(number: float | arb) -> fmpq:
    """An exact number as a fraction [its unit]; ValueError as of :func:`whole_numbers`."""
    m, e = arb(number).man_exp()
    return m * fmpq(2) ** int(e)


def columns(rows: Sequence[Row], of: slice) -> arb_mat:
    """A matrix made of some columns of `rows`."""
    return arb_mat(len(rows), of.stop - of.start, [v for row in rows for v in row[of]])


class Inverse(NamedTuple):
    """H^-1 in balls.

    Parameters
    ----------
    H_inverse : arb_mat
        Shape (n, n).
    blocks : list of (list of int, arb_mat)
        Coordinates of each of its blocks, and the block; none where they are not told apart.
    free : arb_mat
        The minimiser without rows, shape (n, 1).
    size : float
        Of its largest entry [m, rad].
    """

    H_inverse: arb_mat
    blocks: list[tuple[list[int], arb_mat]]
    free: arb_mat
    size: float


class ExactForm(ABC):
    """A program whose H, g and rows are exact.

    Attributes
    ----------
    n, m : int
        Numbers of coordinates and of rows.
    equations : int
        Number of equations, which are the first rows.
    H : arb_mat
        Positive definite, shape (n, n).
    H_inverse : arb_mat
        In balls.
    g : arb_mat
        Shape (n, 1).
    h : arb
        y = h lam: what the program's cost was multiplied by.
    bits : int
        Of balls, to begin with.
    """

    n: int
    m: int
    equations: int = 0
    bits: int
    H: arb_mat
    H_inverse: arb_mat
    g: arb_mat
    h: arb

    @abstractmethod
    def exact_rows(self, some: Iterable[int]) -> list[Row]:
        """The given rows [a, c] as an exact matrix."""

    @property
    @abstractmethod
    def inequalities(self) -> tuple[Array, Array]:
        """A, shape (m, n) [m] per unit of x, and b, shape (m,) [m], of A x >= b in float64."""

    @abstractmethod
    def sizes(self, most: Array) -> Array:
        """An upper bound of the sizes of the terms that add up to each slack, shape (m,) [m].

        Parameters
        ----------
        most : ndarray, shape (n,)
            At least `|x|` [m, rad].
        """

    def float_slacks(self, x: Array, most: Array) -> tuple[Array, Array]:
        """All slacks in float64, and bounds of their errors, each shape (m,).

        A slack s with bound e is proved to be positive by s > e, which is false where a number is
        infinite or not a number.

        Parameters
        ----------
        x : ndarray, shape (n,)
            Each entry is off by at most UNIT times that of `most` from the point that is meant.
        most : ndarray, shape (n,)
            At least `|x|` [m, rad].

        Notes
        -----
        Let u = UNIT and s a row's size. Sums and products of k numbers in any order, fused or not,
        have an error of at most k u (1 + O(u)) of the sum of their sizes: that of the row with
        [x, 1] is off by (n + 1) u s from its rounding, by u s from what x is off by, and by at most
        10 u s from that of the row itself. In all (n + 12) u s. The bound is (2 n + 64) u s: what
        is left, more than twice that, is for the rounding of s itself. Each underflow takes 2^-1074
        at most, times a factor of s if it is in another; TINY, added to all factors of s and to the
        bound, is more.
        """
        A, b = self.inequalities
        return A @ x - b, (2 * self.n + 64) * UNIT * self.sizes(most) + UNDERFLOW

    def implied_by_cone(self, working: Sequence[int], some: Iterable[int]) -> list[int]:
        """The given rows that follow from rows of the same contact in W: their slack is zero."""
        return []

    def slacks(self, some: Iterable[int], z: arb_mat) -> list[arb]:
        """Slacks a x + c of the given rows at z = [x; 1], (n + 1, 1), in the current precision."""
        return [value for (value,) in self.values(some, z)]

    def values(self, some: Iterable[int], z: arb_mat) -> list[list[arb]]:
        """Products [a, c] z of the given rows with each column of z, shape (n + 1, d)."""
        values: list[list[arb]] = (
            columns(self.exact_rows(some), slice(0, self.n + 1)) * z
        ).tolist()
        return values

    def integers(self, some: Iterable[int]) -> list[list[fmpz]]:
        """The given rows [a, c], scaled to integers by one common power of two."""
        rows = self.exact_rows(some)
        numbers = whole_numbers([v for row in rows for v in row])
        size = self.n + 1
        return [numbers[k : k + size] for k in range(0, len(numbers), size)]

    @cached_property
    def _scaled_rows(self) -> dict[int, tuple[list[fmpz], int]]:
        return {}

    def scaled_rows(self, some: Iterable[int]) -> list[tuple[list[fmpz], int]]:
        """Integers and power of two of each of the given rows [a, c]."""
        kept = self._scaled_rows
        rows = [*some]
        missing = [i for i in rows if i not in kept]
        for i, row in zip(missing, self.exact_rows(missing), strict=True):
            kept[i] = scaled(row)
        return [kept[i] for i in rows]

    def whole_rows(self, some: Iterable[int]) -> list[list[fmpz]]:
        """The given rows [a, c], each scaled to integers by a power of two of its own."""
        return [row for row, _ in self.scaled_rows(some)]

    @cached_property
    def scaled_cost(self) -> tuple[list[fmpz], int]:
        """Integers, and their power of two, of [H, g], row by row."""
        rows = zip(self.H.tolist(), self.g.entries(), strict=True)
        return scaled([v for H_v, g_v in rows for v in (*H_v, g_v)])

    @cached_property
    def _inverses(self) -> dict[int, Inverse]:
        return {}

    def inverse(self, bits: int) -> Inverse:
        """H^-1 in balls of some bits."""
        if bits not in self._inverses:
            H_inverse = self.H_inverse if bits <= PRECISION else inverse(self.H, bits)
            with working_precision(bits):
                free = H_inverse * self.g
            size = max((abs(float(v)) for v in free.entries()), default=0.0)
            self._inverses[bits] = Inverse(H_inverse, blocks_of(H_inverse), free, size)
        return self._inverses[bits]

    @cached_property
    def A(self) -> arb_mat:
        """The coefficients a of all rows a x + c >= 0, shape (m, n)."""
        return columns(self.exact_rows(range(self.m)), slice(0, self.n))

    @cached_property
    def c(self) -> arb_mat:
        """The constants c of all rows a x + c >= 0, shape (m, 1)."""
        return columns(self.exact_rows(range(self.m)), slice(self.n, self.n + 1))


class MatrixForm(ExactForm):
    """A program of any exact matrices.

    Parameters
    ----------
    H : arb_mat
        Positive definite, shape (n, n).
    g : arb_mat
        Shape (n, 1).
    rows : arb_mat
        [a, c] of each row, shape (m, n + 1).
    equations : int
        How many of the first rows are equations.
    bits : int, optional
        Of balls: no answer depends on it.
    """

    def __init__(
        self,
        H: arb_mat,
        g: arb_mat,
        rows: arb_mat,
        *,
        equations: int = 0,
        bits: int | None = None,
    ) -> None:
        self.n = H.nrows()
        self.m = rows.nrows()
        self.bits = bits or PRECISION
        self.equations = equations
        self.H = H
        self.H_inverse = inverse(H)
        self.g = g
        self.h = arb(1)
        self._rows = rows.tolist()

    def exact_rows(self, some: Iterable[int]) -> list[Row]:
        """The given rows [a, c] as an exact matrix."""
        return [self._rows[i] for i in some]

    @cached_property
    def inequalities(self) -> tuple[Array, Array]:
        """A, (m, n), and b, (m,) [any unit], of A x >= b: each number rounded once."""
        rows = np.array([[float(v) for v in row] for row in self._rows]).reshape(-1, self.n + 1)
        return rows[:, :-1], -rows[:, -1]

    def sizes(self, most: Array) -> Array:
        """The bound `|a|` `most` + `|b|` of each row, (m,); `most` (n,) bounds x [any unit]."""
        return row_sizes(*self.inequalities, most)


class StepForm(ExactForm):
    """The program of a step.

    Parameters
    ----------
    step : StepData

    Raises
    ------
    InputError
        If nothing can be proved in this thread.
    """

    def __init__(self, step: StepData) -> None:
        check_arithmetic()
        self._step = step
        self._cone = cone(step.cone)
        self._mu = self._cone.row_coefficients(step.contacts.mu)
        n_c = step.contacts.n_c
        self._contact, self._places = _places(step.cone, step.contacts.rows.tobytes())
        if step.extra.names:
            of_extra = [(n_c + k, 0) for k in range(len(step.extra.names))]
            self._places = [*self._places, *of_extra]
        self._factors: dict[int, tuple[arb_mat, arb_mat, arb_mat]] = {}
        self._rows: dict[int, list[Row]] = {}
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
            self._factors = other._factors
            self._rows = other._rows
            self.inequalities = other.inequalities
        return self

    @cached_property
    def inequalities(self) -> tuple[Array, Array]:
        """A, (m, n) [m] per unit of x, and b, (m,) [m], of Eq. :eq:`eq-8` in float64."""
        return inequalities(self._step)

    def sizes(self, most: Array) -> Array:
        """The bound `|phi|` + F R of a contact's rows, (m,) [m]; `most` (n,) bounds x [m, rad].

        R is the largest entry of `|J|` `most`, and more than what underflows in it; F is more than
        the sum of the sizes of the frame with friction. An entry of a row combines four products of
        frame and J, with coefficients of at most one: it is off by 3 u of three products summed,
        2 u of the friction, 4 u of combining them.
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

    def factors(self, c: int) -> tuple[arb_mat, arb_mat, arb_mat]:
        """Three exact factors whose product is the rows [a, c] of contact c, or of a user's row.

        The matrix of the cone, the frame with friction, and J with phi, of shapes (R, 4), (4, 5)
        and (5, n + 1). Of 106 bits or more, the present precision makes the last two exact.
        """
        contacts = self._step.contacts
        if c in self._factors:
            return self._factors[c]
        if c >= contacts.n_c:
            one = arb_mat([[1]])
            extra = self._step.extra
            k = c - contacts.n_c
            self._factors[c] = one, one, exact_matrix(np.append(extra.A[k], -extra.b[k])[None])
        else:
            n, d1, d2 = (axis[c].tolist() for axis in (contacts.n, contacts.d1, contacts.d2))
            mu_1, mu_2, mu_w = map(arb, self._mu[c].tolist())
            J = np.zeros((5, self.n + 1))
            J[:4, :-1] = contacts.J[c]
            J[4, -1] = contacts.phi[c]
            d1, d2 = [mu_1 * v for v in d1], [mu_2 * v for v in d2]
            turn = [*n, 0, 1, *d1, 0, 0, *d2, 0, 0, 0, 0, 0, mu_w, 0]
            combined = _cone_matrix(self._cone.name)
            self._factors[c] = combined, arb_mat(4, 5, turn), exact_matrix(J)
        return self._factors[c]

    def exact_rows(self, some: Iterable[int]) -> list[Row]:
        """Some rows [a, c]: Eq. :eq:`eq-4` combines the four rows of a contact's motion."""
        rows = []
        with working_precision(EXACT):
            for c, kind in (self._places[i] for i in some):
                if c not in self._rows:
                    combined, turn, J = self.factors(c)
                    self._rows[c] = (combined * (turn * J)).tolist()
                rows.append(self._rows[c][kind])
        return rows

    def values(self, some: Iterable[int], z: arb_mat) -> list[list[arb]]:
        """Slacks of some rows at z, from the motion of each contact."""
        of_contact: dict[int, list[list[arb]]] = {}
        values = []
        for c, kind in (self._places[i] for i in some):
            if c not in of_contact:
                combined, turn, J = self.factors(c)
                of_contact[c] = (combined * (turn * (J * z))).tolist()
            values.append(of_contact[c][kind])
        return values

    def implied_by_cone(self, working: Sequence[int], some: Iterable[int]) -> list[int]:
        """Rows that follow from rows of the same contact in W: six rows have rank four."""
        held: dict[int, tuple[int, ...]] = {}
        for c, kind in sorted(self._places[i] for i in working):
            held[c] = (*held.get(c, ()), kind)
        n_c = self._step.contacts.n_c
        kinds = {c: _implied_kinds(self._cone.name, of_c) for c, of_c in held.items() if c < n_c}
        places = ((i, *self._places[i]) for i in some)
        return [i for i, c, kind in places if c in kinds and kinds[c][kind]]


def row_sizes(A: Array, b: Array, most: Array) -> Array:
    """`|a|` `most` + `|b|` of rows of A, (m, n), and b, (m,) [m]; `most` is (n,) [m, rad]."""
    sizes: Array = (np.abs(A) + UNDERFLOW) @ most + np.abs(b)
    return sizes


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
    parts = np.zeros((3, n, n))
    parts[0, :n_a, :n_a] = hessian.K_q
    parts[1, n_a:, n_a:] = hessian.M_u
    if of_cost is not None:
        parts[2] = of_cost
    K_q, M_u, H_cost = map(exact_matrix, parts)
    with working_precision(EXACT):
        springs = K_q * (arb(hessian.h) * hessian.h)
        H = springs + M_u + H_cost * arb(hessian.h)
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
def _cone_matrix(cone_name: str) -> arb_mat:
    return exact_matrix(cone(cone_name).matrix)


@lru_cache(maxsize=1024)
def _implied_kinds(cone_name: str, held: tuple[int, ...]) -> list[bool]:
    """Rows of any contact that follow from its independent rows `held`."""
    numbers = [whole_numbers(row) for row in _cone_matrix(cone_name).tolist()]
    return implied([numbers[kind] for kind in held], numbers)


def inverse(H: arb_mat, bits: int = PRECISION) -> arb_mat:
    """The inverse, in balls of some bits, of an exact matrix that is positive definite.

    By its blocks. Between coordinates that H does not couple it is zero without a radius, so that a
    coordinate without a load and a contact is seen to stay where it is.
    """
    n = H.nrows()
    full = [arb(0)] * (n * n)
    for at, block in _blocks(H):
        places = (i * n + j for i in at for j in at)
        for k, v in zip(places, _block_inverse(block, bits).entries(), strict=True):
            full[k] = v
    return arb_mat(n, n, full)


def blocks_of(H: arb_mat) -> list[tuple[list[int], arb_mat]]:
    """Coordinates and entries of each diagonal block of a matrix, (n, n); none if it is small."""
    return _blocks(H) if H.nrows() > MANY else []


def _blocks(H: arb_mat) -> list[tuple[list[int], arb_mat]]:
    n = H.nrows()
    entries = H.entries()
    coupled = np.array([not v.is_zero() for v in entries], dtype=bool).reshape(n, n)
    block_of, _ = labels(coupled)
    firsts = np.flatnonzero(block_of == np.arange(n))
    every = [np.flatnonzero(block_of == first).tolist() for first in firsts]
    return [
        (at, arb_mat(len(at), len(at), [entries[i * n + j] for i in at for j in at]))
        for at in every
    ]


def _block_inverse(H: arb_mat, bits: int) -> arb_mat:
    while True:  # ends: H is regular, so some precision resolves it
        with working_precision(bits):
            try:
                return H.inv()
            except ZeroDivisionError:
                bits *= 2


def implied(held: Sequence[Sequence[fmpz]], rows: Sequence[Sequence[fmpz]]) -> list[bool]:
    """Which rows are combinations of those that are `held`, which are independent."""
    columns, _, rank = _eliminated([*held, *rows])
    k = len(held)
    return [not any(column[k:rank]) for column in columns[k:]]


def null_space(rows: Sequence[Sequence[fmpz]], size: int) -> fmpz_mat:
    """A basis of all z with row z = 0 for each row, as columns, shape (size, d).

    Whatever the rows imply holds for it: a row is a combination of them if and only if it vanishes
    on the basis.

    Parameters
    ----------
    rows : sequence of list of fmpz
    size : int
        Of a row.
    """
    matrix = fmpz_mat(len(rows), size, [v for row in rows for v in row])
    basis, d = matrix.nullspace()
    return fmpz_mat(size, d, [v for row in basis.tolist() for v in row[:d]])


def independent_rows(form: ExactForm, candidates: Sequence[int]) -> tuple[int, ...]:
    """The rows of A, in order of preference, that do not depend on earlier ones."""
    columns, _, rank = _eliminated([row[:-1] for row in form.integers(candidates)])
    chosen: list[int] = []
    for i, column in zip(candidates, columns, strict=True):
        if len(chosen) < rank and column[len(chosen)]:
            chosen.append(i)
    return tuple(chosen)


def combination(form: ExactForm, working: Sequence[int], p: int) -> list[fmpq] | None:
    """The c of a_p = sum_j c_j A[working[j]]; None if a_p is independent of these rows.

    Parameters
    ----------
    form : ExactForm
    working : sequence of int
        Independent rows.
    p : int
    """
    columns, denominator, rank = _eliminated([row[:-1] for row in form.integers([*working, p])])
    if rank > len(working):
        return None
    return [fmpq(v, denominator) for v in columns[-1][:rank]]


def _eliminated(rows: Sequence[Sequence[fmpz]]) -> tuple[list[list[fmpz]], fmpz, int]:
    """Rows as columns of a matrix in reduced echelon form, times a denominator; and its rank."""
    if not (rows and rows[0]):
        return [[] for _ in rows], fmpz(1), 0
    matrix = fmpz_mat(len(rows), len(rows[0]), [v for row in rows for v in row])
    reduced, denominator, rank = matrix.transpose().rref()
    return reduced.transpose().tolist(), denominator, rank
