"""A quadratic program in the words of qpsolvers: its numbers, checked, and its rows by name."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.formats.shown import Shown
from quasistatic_ref.numbers.arrays import Array, Indices, Mask, checked_numbers, read_only
from quasistatic_ref.optional.qp.form import Block, blocks_of

FIELDS = ("P", "q", "G", "h", "A", "b", "lb", "ub")
"""The names of its arrays, in the order of the arguments of qpsolvers."""


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
        """Its rows, equations first."""
        eye = np.eye(len(self.q))
        with np.errstate(invalid="ignore"):
            fixed = self.lb == self.ub
        lower = np.isfinite(self.lb) & ~fixed
        upper = np.isfinite(self.ub) & ~fixed
        bounded = np.isfinite(self.h)
        groups = [
            ("A", np.arange(len(self.b)), self.A, -self.b, -1),
            ("lb", np.flatnonzero(fixed), eye[fixed], -self.lb[fixed], -1),
            ("G", np.flatnonzero(bounded), -self.G[bounded], self.h[bounded], 1),
            ("lb", np.flatnonzero(lower), eye[lower], -self.lb[lower], -1),
            ("ub", np.flatnonzero(upper), -eye[upper], self.ub[upper], 1),
        ]
        field, place, a, c, sign = zip(*groups, strict=True)
        lengths = [*map(len, place)]
        return Rows(
            field=tuple(np.repeat(field, lengths).tolist()),
            place=np.concatenate(place),
            a=np.concatenate(a) + 0.0,
            c=np.concatenate(c) + 0.0,
            sign=np.repeat(sign, lengths),
            is_equation=np.arange(sum(lengths)) < lengths[0] + lengths[1],
        )

    @cached_property
    def blocks(self) -> list[Block]:
        """Its parts that nothing couples, in exact numbers; InputError as of `blocks_of`."""
        return blocks_of(self)


@dataclass(frozen=True, eq=False)
class Rows:
    """Every a x + c >= 0 of a program, and a x + c = 0, which come first.

    Parameters
    ----------
    field : tuple of str, length m
        ``"G"``, ``"A"``, ``"lb"`` or ``"ub"``; where lb = ub the one row is of ``"lb"``.
    place : ndarray of int, shape (m,)
        Which row of the field.
    a, c : ndarray, shapes (m, n) and (m,)
        [Any unit.]
    sign : ndarray of int, shape (m,)
        What makes a multiplier of the row one of qpsolvers.
    is_equation : ndarray of bool, shape (m,)
    """

    field: tuple[str, ...]
    place: Indices
    a: Array
    c: Array
    sign: Indices
    is_equation: Mask

    @cached_property
    def names(self) -> list[str]:
        """The name of each, as ``"G[3]"``."""
        return [f"{f}[{i}]" for f, i in zip(self.field, self.place.tolist(), strict=True)]

    def multipliers(self, of_rows: Array, program: QuadraticProgram) -> dict[str, Array]:
        """The z, y and z_box of qpsolvers from `of_rows`, a multiplier of each row, (m,) [-]."""
        field = np.array(self.field)
        values = of_rows * self.sign + 0.0
        sizes = {
            "z": (program.h, ("G",)),
            "y": (program.b, ("A",)),
            "z_box": (program.q, ("lb", "ub")),
        }
        result = {}
        for name, (like, fields) in sizes.items():
            of = np.isin(field, fields)
            result[name] = np.zeros(len(like))
            np.add.at(result[name], self.place[of], values[of])
        return result

    def of_multipliers(self, z: Array, y: Array, z_box: Array) -> Array:
        """The multiplier of each row, shape (m,), from z, y and z_box of qpsolvers [-]."""
        each = {"G": z, "A": y, "lb": z_box, "ub": z_box}
        return np.array(
            [each[f][i] for f, i in zip(self.field, self.place, strict=True)] * self.sign
        )


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
        P, *arrays = (getattr(P, name) for name in FIELDS)  # type: ignore[assignment]
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
    default = {"lb": -np.inf, "ub": np.inf}
    values = {
        name: np.full(shape, default.get(name, 0.0))
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


NO_LIMIT = {"h": np.inf, "lb": -np.inf, "ub": np.inf}
"""The infinite number that an array may hold: there is no limit then."""


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
