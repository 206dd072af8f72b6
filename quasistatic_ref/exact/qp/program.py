"""A quadratic program in the words of qpsolvers: its numbers, checked, and its rows by name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from itertools import chain, islice
from os import PathLike
from typing import Any, Final, Protocol

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import InputError
from quasistatic_ref.exact.qp.numbers import exact_numbers
from quasistatic_ref.exact.qp.sparse_matrix import SparseMatrix, stacked
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.shown import Shown
from quasistatic_ref.text.plain import Plain

FIELDS = ("P", "q", "G", "h", "A", "b", "lb", "ub")
"""The names of its arrays, in the order of the arguments of qpsolvers."""
NO_LIMIT = {"h": np.inf, "lb": -np.inf, "ub": np.inf}
"""The infinite number that an array may hold: there is no limit then."""
SYMMETRIC: Final = 1e-12
"""Largest |P - P'| relative to the largest entry of P that rounding may leave."""


class HasProgram(Protocol):
    """Anything with the arrays of a program, such as a ``qpsolvers.Problem``; some may be None."""

    P: Any
    q: Any
    G: Any
    h: Any
    A: Any
    b: Any
    lb: Any
    ub: Any


class HasAnswer(Protocol):
    """An answer with an x, such as a ``qpsolvers.Solution``; a start has its multipliers, too."""

    @property
    def x(self) -> ArrayLike | None:
        """The x at which the answer is, shape (n,) [any unit]."""


def x_of(answer: Any) -> Any:
    """The x of an answer, shape (n,); what is no answer is an x itself [any unit]."""
    return getattr(answer, "x", answer)


@dataclass(frozen=True, eq=False, repr=False)
class QuadraticProgram(Plain, Shown):
    """Minimise 1/2 x'Px + q'x subject to G x <= h, A x = b, lb <= x <= ub.

    An :class:`.ExactQP` has it, and ``load_qp`` makes it; its constructor checks nothing.

    `constant` is added to the objective [its unit].

    Parameters
    ----------
    P : ndarray, shape (n, n)
        Symmetric but for rounding: its symmetric part counts.
    q : ndarray, shape (n,)
    G, h : ndarray, shapes (k, n) and (k,)
        An infinite h is no inequality.
    A, b : ndarray, shapes (e, n) and (e,)
    lb, ub : ndarray, shape (n,)
        Infinite where there is no bound.
    constant : float [its unit]
        Added to the objective.
    exact : mapping of str to mapping of int to Fraction
        By array and flat place, the numbers that float64 does not hold; the arrays, and the
        constant, have the nearest ones.

    Examples
    --------
    >>> program = qr.exact_qp([[2.0]], ["-0.2"]).problem
    >>> program.q.tolist(), program.exact["q"]
    ([-0.2], {0: Fraction(-1, 5)})
    """

    P: Array
    q: Array
    G: Array
    h: Array
    A: Array
    b: Array
    lb: Array
    ub: Array
    constant: float = 0.0
    exact: Mapping[str, Mapping[int, Fraction]] = field(default_factory=dict)

    @cached_property
    def couplings(self) -> SparseMatrix:
        """P by its entries, with a zero where only the entry across it is none [any unit]."""
        if not self.P.any():
            none = np.zeros(0, np.int64)
            return SparseMatrix.of(none, none, np.zeros(0), self.P.shape)
        i, j = np.nonzero((self.P != 0) | (self.P.T != 0))
        return SparseMatrix.of(i, j, self.P[i, j], self.P.shape)

    @cached_property
    def rows(self) -> Rows:
        """The rows of the program, equations first."""
        k, e, n = len(self.h), len(self.b), len(self.q)
        every = np.arange(n)
        above, below = (
            SparseMatrix.of(every, every, np.full(n, way), (n, n)) for way in (1.0, -1.0)
        )
        fixed = self.lb == self.ub
        low, high = (self.exact.get(name, {}) for name in ("lb", "ub"))
        fixed[[i for i in {*low, *high} if low.get(i) != high.get(i)]] = False
        at_box = k + e
        groups = [  # name, sign and first slot of multipliers; a, c and which of them are rows
            ("A", -1, k, SparseMatrix.of_dense(self.A), -self.b, np.full(e, True)),
            ("lb", -1, at_box, above, -self.lb, fixed),
            ("G", 1, 0, SparseMatrix.of_dense(self.G, -1.0), self.h, np.isfinite(self.h)),
            ("lb", -1, at_box, above, -self.lb, np.isfinite(self.lb) & ~fixed),
            ("ub", 1, at_box, below, self.ub, np.isfinite(self.ub) & ~fixed),
        ]
        parts = []
        for name, of_row, first, rows, sides, there in groups:
            at = np.flatnonzero(there)
            labels = [f"{name}[{i}]" for i in at]
            numbers = rows.some(at, every), sides[at] + 0.0
            parts.append((labels, first + at, np.full(len(at), of_row), *numbers))
        names, slot, sign, entries, c = zip(*parts, strict=True)
        return Rows(
            names=[*chain(*names)],
            slot=np.concatenate(slot),
            sign=np.concatenate(sign),
            entries=stacked(entries),
            c=np.concatenate(c),
            equations=e + int(fixed.sum()),
            exact=self._exact_rows(),
        )

    def _exact_rows(self) -> dict[str, dict[int, Fraction]]:
        """By row and coordinate (n is its side), what float64 does not hold."""
        n = len(self.q)
        rows: dict[str, dict[int, Fraction]] = {}
        for name, side, of_a in (("G", "h", -1), ("A", "b", 1), ("lb", "lb", 0), ("ub", "ub", 0)):
            for place, v in self.exact.get(name, {}).items() if of_a else ():
                rows.setdefault(f"{name}[{place // n}]", {})[place % n] = of_a * v
            of_side = 1 if side in ("h", "ub") else -1
            for i, v in self.exact.get(side, {}).items():
                rows.setdefault(f"{name}[{i}]", {})[n] = of_side * v
        return rows

    def multipliers(self, of_rows: Array) -> dict[str, Array]:
        """The z, y and z_box of qpsolvers from `of_rows`, a multiplier of each row, (m,) [-]."""
        every = np.zeros(sum(self.sizes.values()))
        np.add.at(every, self.rows.slot, self.rows.sign * of_rows + 0.0)
        return {name: np.array(values) for name, values in self.split(every).items()}

    @property
    def sizes(self) -> dict[str, int]:
        """How many multipliers z, y and z_box are."""
        return {"z": len(self.h), "y": len(self.b), "z_box": len(self.q)}

    def split(self, multipliers: Any) -> dict[str, Any]:
        """The z, y and z_box of qpsolvers from one after the other."""
        left = iter(multipliers)
        return {name: [*islice(left, size)] for name, size in self.sizes.items()}


@dataclass(frozen=True, eq=False)
class Rows:
    """Every a x + c >= 0 of a program, and a x + c = 0, which come first.

    Parameters
    ----------
    names : list of str
        As ``"G[3]"``, of ``"G"``, ``"A"``, ``"lb"`` and ``"ub"``; where lb = ub the one is lb's.
    slot, sign : ndarray of int, shape (m,)
        Where the multiplier of each stands in z, y and z_box, one after the other; and times what.
    entries : SparseMatrix
        a, shape (m, n) [any unit].
    c : ndarray, shape (m,)
        [Any unit.]
    equations : int
        How many of the first are equations.
    exact : mapping of str to mapping of int to Fraction
        By name, entries of a, and c at place n, that float64 does not hold.
    """

    names: list[str]
    slot: Indices
    sign: Indices
    entries: SparseMatrix
    c: Array
    equations: int
    exact: Mapping[str, Mapping[int, Fraction]]

    @property
    def a(self) -> Array:
        """The matrix, zeros included, shape (m, n) [any unit]."""
        return self.entries.dense()

    def others(self, i: int, columns: Sequence[int]) -> dict[int, Fraction]:
        """Exact entries of row i that float64 rounds, by place in `columns`; its side is last."""
        row = self.exact.get(self.names[i], {})
        places = (*columns, self.entries.n) if row else ()
        return {t: row[j] for t, j in enumerate(places) if j in row}


def program_of(P: Any, *arrays: Any, constant: Any = 0.0) -> QuadraticProgram:
    """A program from what users give: arrays, dense or sparse, or an object that has all of them.

    Raises
    ------
    InputError
        Naming the array that is no such array.
    """
    if isinstance(P, QuadraticProgram):
        return P
    if all(hasattr(P, name) for name in FIELDS):
        if any(array is not None for array in arrays):
            raise InputError("P is a whole problem; give no other arrays beside it")
        P, *arrays = (getattr(P, name) for name in FIELDS)  # type: ignore[assignment]  # of Any
    if all(array is None for array in arrays):
        _check_is_no_whole(P)
    given = {
        name: value if value is None else exact_numbers(value, name)
        for name, value in zip(FIELDS, (P, *arrays), strict=True)
    }
    for name in ("P", "q"):
        if given[name] is None:
            raise InputError("is missing; P and q are needed", field=name)
    for matrix, side in (("G", "h"), ("A", "b")):
        if (given[matrix] is None) != (given[side] is None):
            raise InputError(f"{matrix} and {side} are given together, or not at all")
    n, k, e = (pair[0].size if (pair := given[name]) else 0 for name in "qhb")
    shapes = dict(zip(FIELDS, ((n, n), (n,), (k, n), (k,), (e, n), (e,), (n,), (n,)), strict=True))
    if not n:
        raise InputError("must have an entry for each variable, and has none", field="q")
    values = {
        name: np.full(shape, NO_LIMIT.get(name, 0.0))
        if (pair := given[name]) is None
        else _checked(name, pair[0], shape)
        for name, shape in shapes.items()
    }
    check_symmetric(values["P"])
    numbers, of_constant = exact_numbers([constant], "constant")
    if numbers.shape != (1,):
        raise InputError("must be one number", field="constant", value=constant)
    exact = {name: pair[1] for name, pair in given.items() if pair} | {"constant": of_constant}
    exact = {name: others for name, others in exact.items() if others}
    return QuadraticProgram(**values, constant=float(numbers[0]), exact=exact)


def _check_is_no_whole(P: Any) -> None:
    """Refuse what stands for a whole program elsewhere, and say what takes it: InputError."""
    if isinstance(P, str | PathLike):
        problem = "is the name of a file; load_qp reads it: exact_qp(load_qp(file))"
        raise InputError(problem, field="P", value=P)
    if hasattr(P, "get_problem_data"):
        problem = "is a problem of CVXPY; solve it by problem.solve(solver=Exact())"
        raise InputError(problem, field="P", value=type(P).__name__)


def check_symmetric(P: Array) -> None:
    """Refuse one triangle, which others ask for: which one is meant cannot be guessed.

    InputError if P is not symmetric.
    """
    if not P.any():
        return
    off = np.abs(P - P.T)
    if off.max() <= SYMMETRIC * np.abs(P).max():
        return
    for word, part in (("upper", np.triu), ("lower", np.tril)):
        if np.array_equal(P, part(P)):
            raise InputError(
                f"is one triangle, the {word} one; give P + P.T - np.diag(np.diag(P)) if the "
                "other was left out, (P + P.T) / 2 if 1/2 x'Px is meant as it stands",
                field="P",
            )
    i, j = (int(v) for v in np.unravel_index(off.argmax(), off.shape))
    problem = f"must be symmetric; P[{j}, {i}] is {P[j, i]:g}; give (P + P.T) / 2 if that is meant"
    raise InputError(problem, field=f"P[{i}, {j}]", value=float(P[i, j]))


def _checked(name: str, array: Array, shape: tuple[int, ...]) -> Array:
    """An array of that shape, whose numbers are finite, or the infinite one that it may hold."""
    if [k for k in array.shape if k != 1] == [k for k in shape if k != 1]:
        array = array.reshape(shape)  # a vector may be of one column, a matrix of one row
    if array.shape != shape and (array.size or 0 not in shape):
        words = " x ".join(map(str, shape))
        raise InputError(
            f"must be {words} numbers, as q, h and b say", field=name, value=array.shape
        )
    free = NO_LIMIT.get(name, 0.0)
    wrong = ~np.isfinite(array) & (array != free)
    if wrong.any():
        at = tuple(int(i) for i in np.argwhere(wrong)[0])
        where = f"{name}[{', '.join(map(str, at))}]"
        value = float(array[at])
        problem = "must be a finite number"
        if free and value == -free:
            problem = f"must be a finite number, or {free:g} for no limit: {value:g} is none at all"
        raise InputError(problem, field=where, value=value)
    return array.reshape(shape)
