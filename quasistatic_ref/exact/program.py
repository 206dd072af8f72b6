r"""A program in exact numbers: H, g and rows.

A ball without radius is an exact number. A float64 is one, and sums and products of such numbers
are, at a precision (``EXACT``) that no number of a step exhausts; conversions to integers refuse
any other ball. A step's numbers are taken as they stand: rounding what is built from them would
split the ties between the rows of a sticking contact.

.. math:: \min \tfrac12 x^T H x - g^T x \quad\text{s.t.}\quad a_i^T x + c_i \ge 0, \quad c = -b.

The first rows of a form may be equations, :math:`a_i^T x + c_i = 0`; a step has none.

Which rows are sums of others, each some times, is decided by elimination in whole numbers. What a
prime refutes needs none, and it names the few rows of which a sum consists. A sum of halves is
guessed in float64, and proved by multiplication.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from functools import cached_property
from itertools import compress
from typing import Final, NamedTuple, TypeAlias

import numpy as np
from flint import arb, arb_mat, fmpq, fmpz, fmpz_mat

from quasistatic_ref.exact.components import components
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.modulo import supports_modulo
from quasistatic_ref.numbers.precision import nearest, working_precision

EXACT: Final = 1 << 30
"""Bits at which no sum or product is rounded. What is short costs no more than at few bits."""

PRECISION: Final = 320
"""Bits of a ball's midpoint. The data have 53 to 250; 256 is enough on grasps, and what is
left undecided is decided in rational numbers, so this is a matter of speed alone."""

MANY_COORDINATES: Final = 64
"""Coordinates above which products with H^-1 pay by its blocks."""

UNIT: Final = 2.0**-53
"""Largest relative error of one operation in float64."""
UNDERFLOW: Final = 1e-290
"""So large that its product with UNIT is far above all that underflow takes from a sum."""

ROUNDING: Final = 1e-9
"""What float64 may leave of a sum that is zero, over the largest entry [-]: of a guess."""

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
    parts = [None if v.is_zero() else v.man_exp() for v in numbers]
    least = min((int(part[1]) for part in parts if part), default=0)
    zero = fmpz(0)
    return [part[0] << int(part[1]) - least if part else zero for part in parts], least


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


class ExactProgram(ABC):
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
        at most, times a factor of s if it is in another; UNDERFLOW, added to all factors of s and
        to the bound, is more.
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


class MatrixProgram(ExactProgram):
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
        """An upper bound of `|A x - b|` of each row, (m,), if `|x|` <= `most`, (n,) [any unit]."""
        return row_sizes(*self.inequalities, most)


def row_sizes(A: Array, b: Array, most: Array) -> Array:
    """`|A|` `most` + `|b|`, (m,) [m]: bounds of `|A x - b|` if `|x|` <= `most`, (n,) [m, rad]."""
    sizes: Array = (np.abs(A) + UNDERFLOW) @ most + np.abs(b)
    return sizes


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
    return _blocks(H) if H.nrows() > MANY_COORDINATES else []


def _blocks(H: arb_mat) -> list[tuple[list[int], arb_mat]]:
    n = H.nrows()
    entries = H.entries()
    coupled = np.array([not v.is_zero() for v in entries], dtype=bool).reshape(n, n)
    block_of, _ = components(coupled)
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


def rounded_quotients(numerators: Iterable[arb], denominator: arb) -> Array:
    """Exact numbers over one that is positive, each rounded correctly, shape (k,)."""
    pairs = (whole_numbers([p, denominator]) for p in numerators)
    return np.array([nearest(int(p), int(q)) for p, q in pairs], dtype=np.float64)


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


def independent_rows(form: ExactProgram, candidates: Sequence[int]) -> tuple[int, ...]:
    """The rows of A, in order of preference, that do not depend on earlier ones."""
    columns, _, rank = _eliminated([row[:-1] for row in form.integers(candidates)])
    chosen: list[int] = []
    for i, column in zip(candidates, columns, strict=True):
        if len(chosen) < rank and column[len(chosen)]:
            chosen.append(i)
    return tuple(chosen)


def combination(form: ExactProgram, working: Sequence[int], p: int) -> list[fmpq] | None:
    """The c of a_p = sum_j c_j A[working[j]]; None if a_p is independent of these rows.

    Parameters
    ----------
    form : ExactProgram
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


def sums(held: Sequence[Sequence[fmpz]], rows: Sequence[Sequence[fmpz]]) -> list[bool]:
    """Which rows are exactly linear combinations of the independent rows `held`.

    Most of the others are shown by a prime. It names few of those held as the terms of a sum, and
    elimination of these in whole numbers proves it.
    """
    supports = supports_modulo(held, rows)
    if supports is None:
        return implied(held, rows)
    answer = [False] * len(rows)
    of_terms: dict[tuple[int, ...], list[int]] = {}
    for place, support in enumerate(supports):
        if support is not None:
            of_terms.setdefault(tuple(support), []).append(place)
    for terms, places in of_terms.items():
        for some in ([held[j] for j in terms], held):
            says = implied(some, [rows[place] for place in places])
            if all(says):
                break
        for place, is_sum in zip(places, says, strict=True):
            answer[place] = is_sum
    return answer


def sums_of_halves(form: ExactProgram, held: Sequence[int], some: Sequence[int]) -> list[int]:
    """Which of some rows [a, c] are exactly sums of rows `held`, times multiples of a half.

    Most rows of a face's fourth corner are. Float64 guesses how many halves, so that a row that is
    not named may be such a sum, too.
    """
    A, _ = form.inequalities
    A_W = A[[*held]]
    with np.errstate(all="ignore"):
        try:
            halves = np.rint(2 * np.linalg.solve(A_W @ A_W.T, A_W @ A[some].T).T) / 2
        except np.linalg.LinAlgError:
            return []
        off = np.abs(halves @ A_W - A[some]).max(axis=1)
        near = off <= ROUNDING * np.abs(A_W).max()
    guessed = [*compress(some, near.tolist())]
    if not guessed:
        return []
    rows = columns(form.exact_rows([*held, *guessed]), slice(0, form.n + 1))
    with working_precision(EXACT):
        left = exact_matrix(np.hstack([halves[near], -np.eye(len(guessed))])) * rows
    zero = (all(v.is_zero() for v in row) for row in left.tolist())
    return [*compress(guessed, zero)]
