"""A quadratic program in the words of qpsolvers: its numbers, checked, and its rows by name."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import chain, islice
from typing import Any, Protocol

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.formats.shown import Shown
from quasistatic_ref.numbers.arrays import Array, Indices, checked_numbers, read_only
from quasistatic_ref.optional.qp.form import Block, blocks_of

FIELDS = ("P", "q", "G", "h", "A", "b", "lb", "ub")
"""The names of its arrays, in the order of the arguments of qpsolvers."""
NO_LIMIT = {"h": np.inf, "lb": -np.inf, "ub": np.inf}
"""The infinite number that an array may hold: there is no limit then."""


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


@dataclass(frozen=True, eq=False, repr=False)
class QuadraticProgram(Plain, Shown):
    """Minimise 1/2 x'Px + q'x subject to G x <= h, A x = b, lb <= x <= ub.

    Parameters
    ----------
    P : ndarray, shape (n, n)
        Its symmetric part counts.
    q : ndarray, shape (n,)
    G, h : ndarray, shapes (k, n) and (k,)
        An infinite h is no inequality.
    A, b : ndarray, shapes (e, n) and (e,)
    lb, ub : ndarray, shape (n,)
        Infinite where there is no bound.
    """

    P: Array
    q: Array
    G: Array
    h: Array
    A: Array
    b: Array
    lb: Array
    ub: Array

    @cached_property
    def rows(self) -> Rows:
        """The rows of the program, equations first."""
        k, e, n = len(self.h), len(self.b), len(self.q)
        eye = np.eye(n)
        fixed = self.lb == self.ub
        at_box = k + e
        groups = [  # name, sign and first slot of multipliers; a, c and which of them are rows
            ("A", -1, k, self.A, -self.b, np.full(e, True)),
            ("lb", -1, at_box, eye, -self.lb, fixed),
            ("G", 1, 0, -self.G, self.h, np.isfinite(self.h)),
            ("lb", -1, at_box, eye, -self.lb, np.isfinite(self.lb) & ~fixed),
            ("ub", 1, at_box, -eye, self.ub, np.isfinite(self.ub) & ~fixed),
        ]
        parts = []
        for name, of_row, first, rows, sides, there in groups:
            at = np.flatnonzero(there)
            labels = [f"{name}[{i}]" for i in at]
            numbers = rows[at] + 0.0, sides[at] + 0.0
            parts.append((labels, first + at, np.full(len(at), of_row), *numbers))
        names, slot, sign, a, c = zip(*parts, strict=True)
        return Rows(
            names=[*chain(*names)],
            slot=np.concatenate(slot),
            sign=np.concatenate(sign),
            a=np.concatenate(a),
            c=np.concatenate(c),
            equations=e + int(fixed.sum()),
        )

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

    @cached_property
    def blocks(self) -> list[Block]:
        """The uncoupled blocks of the program, in exact numbers; InputError as of `blocks_of`."""
        return blocks_of(self)


@dataclass(frozen=True, eq=False)
class Rows:
    """Every a x + c >= 0 of a program, and a x + c = 0, which come first.

    Parameters
    ----------
    names : list of str
        As ``"G[3]"``, of ``"G"``, ``"A"``, ``"lb"`` and ``"ub"``; where lb = ub the one is lb's.
    slot, sign : ndarray of int, shape (m,)
        Where the multiplier of each stands in z, y and z_box, one after the other; and times what.
    a, c : ndarray, shapes (m, n) and (m,)
        [Any unit.]
    equations : int
        How many of the first are equations.
    """

    names: list[str]
    slot: Indices
    sign: Indices
    a: Array
    c: Array
    equations: int


def program_of(P: Any, *arrays: Any) -> QuadraticProgram:
    """A program from what users give: arrays, dense or sparse, or an object that has all of them.

    Raises
    ------
    InputError
        Naming the array that is no such array.
    """
    if all(hasattr(P, name) for name in FIELDS):
        if any(array is not None for array in arrays):
            raise InputError("P is a whole problem; give no other arrays beside it")
        P, *arrays = (getattr(P, name) for name in FIELDS)  # type: ignore[assignment]  # of Any
    given = dict(zip(FIELDS, (P, *arrays), strict=True))
    for name in ("P", "q"):
        if given[name] is None:
            raise InputError("is missing", field=name)
    for matrix, side in (("G", "h"), ("A", "b")):
        if (given[matrix] is None) != (given[side] is None):
            raise InputError(f"{matrix} and {side} are given together, or not at all")
    n = np.size(given["q"])
    k, e = (np.size(given[name]) if given[name] is not None else 0 for name in ("h", "b"))
    shapes = dict(zip(FIELDS, ((n, n), (n,), (k, n), (k,), (e, n), (e,), (n,), (n,)), strict=True))
    values = {
        name: np.full(shape, NO_LIMIT.get(name, 0.0))
        if given[name] is None
        else _checked(name, given[name], shape)
        for name, shape in shapes.items()
    }
    if not n:
        raise InputError("must have an entry for each variable, and has none", field="q")
    crossed = np.flatnonzero(values["lb"] > values["ub"])
    if crossed.size:
        i = crossed[0]
        problem = f"is above ub[{i}] = {values['ub'][i]:g}"
        raise InputError(problem, field=f"lb[{i}]", value=float(values["lb"][i]))
    return QuadraticProgram(**{name: read_only(array) for name, array in values.items()})


def _checked(name: str, value: Any, shape: tuple[int, ...]) -> Array:
    """A float64 copy of an array of that shape."""
    dense = value.toarray() if hasattr(value, "toarray") else value
    array = checked_numbers(dense, name, InputError)
    if [k for k in array.shape if k != 1] == [k for k in shape if k != 1]:
        array = array.reshape(shape)  # a vector may be of one column, a matrix of one row
    if array.shape != shape and (array.size or 0 not in shape):
        words = " x ".join(map(str, shape))
        raise InputError(
            f"must be {words} numbers, as q, h and b say", field=name, value=array.shape
        )
    wrong = ~np.isfinite(array) & (array != NO_LIMIT.get(name, 0.0))
    if wrong.any():
        at = tuple(int(i) for i in np.argwhere(wrong)[0])
        where = f"{name}[{', '.join(map(str, at))}]"
        raise InputError("must be a finite number", field=where, value=float(array[at]))
    return array.reshape(shape) + 0.0
