"""The faces of a polyhedral cone of forces, and the face on which the point nearest to -z lies.

The cone of forces is spanned by the rows of a contact's friction cone. On a face of it the nearest
point is linear in z: -z projected on what the rows of that face span.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from flint import fmpq, fmpq_mat

from quasistatic_ref.certify.rational import fraction
from quasistatic_ref.step.arrays import Array, read_only
from quasistatic_ref.step.cones import cone

Rows = tuple[int, ...]
"""The face of a contact: independent rows of its cone, whose combinations it is."""


@dataclass(frozen=True, eq=False)
class Face:
    """A face of the cone of forces: where the point nearest to -z lies there, and where it is.

    Parameters
    ----------
    integers : ndarray of int, shape (R + 4, 4)
        Times z and over the denominator: R numbers that are >= 0 if the nearest point lies on this
        face (the multipliers of its rows, and the slacks of z + s in the others); and s.
    denominator : int
    floats : ndarray, shape (R + 4, 4)
        Their quotient [-].
    """

    integers: Any
    denominator: int
    floats: Array


@cache
def rows_of(name: str, count: int) -> Array:
    """The rows of a contact that has `count` of its cone's, shape (count, 4) [-].

    One with the leading rows only has no spin, whose length would be one more to give way by.
    """
    matrix = cone(name).matrix
    return read_only(matrix[:count] * [1, 1, 1, count == len(matrix)])


@cache
def face(name: str, count: int, rows: Rows) -> Face:
    """The face that some independent rows of a contact span, which has `count` rows."""
    C = fmpq_mat(count, 4, [fraction(x) for x in rows_of(name, count).ravel().tolist()])
    table = C.tolist()
    C_w = fmpq_mat(len(rows), 4, [x for i in rows for x in table[i]])
    multipliers: Any = fmpq_mat(0, 4)
    if rows:
        multipliers = (C_w * C_w.transpose()).solve(-C_w)
    s = C_w.transpose() * multipliers
    conditions = (C + C * s).tolist()
    for i, multiplier in zip(rows, multipliers.tolist(), strict=True):
        conditions[i] = multiplier
    numerators, denominator = fmpq_mat(conditions + s.tolist()).numer_denom()
    integers = np.array([int(x) for x in numerators.entries()], dtype=object).reshape(-1, 4)
    floats = np.array([[float(fmpq(x) / denominator) for x in row] for row in numerators.tolist()])
    return Face(integers, int(denominator), floats)


def nearest_face(C: Any, z: Any, multipliers: Callable[[Any, Any], Any], zero: Any = 0) -> Rows:
    """The face on which the point nearest to -z lies, by the method of Lawson and Hanson (1974).

    Parameters
    ----------
    C : ndarray, shape (R, 4)
        Rows of the cone, in float64 or in fmpq, as z is.
    z : ndarray, shape (4,)
        [m].
    multipliers : callable
        (C_w, z) -> the lam that makes z + C_w' lam shortest, for independent rows C_w.
    zero : number
        Violations up to this are none [m].

    Returns
    -------
    tuple of int
        Independent rows, in increasing order. In float64 it is a guess.
    """
    lam = 0 * C[:, 0]
    rows: list[int] = []
    for _ in range(3 * len(C)):  # in exact numbers it ends by itself
        violation = -(C @ (z + C.T @ lam))
        violation[rows] = zero
        most = int(np.argmax(violation))
        if len(rows) == 4 or not violation[most] > zero:
            break
        rows.append(most)
        new = multipliers(C[rows], z)
        while not (new > 0).all():
            lam, rows = _without_first_to_vanish(lam, rows, new)
            new = multipliers(C[rows], z)
        lam[rows] = new
    return tuple(sorted(rows))


def _without_first_to_vanish(lam: Any, rows: list[int], new: Any) -> tuple[Any, list[int]]:
    """Go from lam >= 0 towards new multipliers, as far as none is negative, and drop what is 0."""
    old = lam[rows]
    ends = {k: o / (o - n) for k, (o, n) in enumerate(zip(old, new, strict=True)) if n <= 0 < o}
    first = min(ends, key=ends.__getitem__, default=len(rows) - 1)  # else the row just added
    lam = lam.copy()
    lam[rows] = old + ends.get(first, 0) * (new - old)
    lam[rows[first]] *= 0
    left = [i for i in rows if lam[i] > 0]
    dropped = [i for i in rows if not lam[i] > 0]
    lam[dropped] = 0 * lam[dropped]
    return lam, left


def exact_numbers(C: Array) -> Any:
    """The numbers C without rounding, as an array of fmpq of the same shape [-]."""
    return np.array([fraction(x) for x in C.ravel().tolist()], dtype=object).reshape(C.shape)


def exact_multipliers(C_w: Any, z: Any) -> Any:
    """The lam that makes z + C_w' lam shortest, shape (k,) [m], in fmpq; C_w is (k, 4), z (4,)."""
    k = len(C_w)
    G = fmpq_mat(k, k, (C_w @ C_w.T).ravel().tolist())
    return np.array(G.solve(fmpq_mat(k, 1, (-(C_w @ z)).tolist())).entries(), dtype=object)


def float_multipliers(C_w: Array, z: Array) -> Array:
    """The same in float64: lam, shape (k,) [m], of C_w, (k, 4) [-], and z, (4,) [m]."""
    return np.asarray(np.linalg.lstsq(C_w.T, -z)[0], dtype=np.float64)
