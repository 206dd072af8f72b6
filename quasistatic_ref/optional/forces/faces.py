"""The faces of a polyhedral cone of forces, and the face on which the point nearest to -z lies.

The cone of forces is spanned by the rows of a contact's friction cone. On a face of it the nearest
point is linear in z: -z projected on what the rows of that face span.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from flint import arb_mat, fmpq_mat

from quasistatic_ref.exact.active_set import dual_active_set
from quasistatic_ref.exact.minimiser import Minimiser
from quasistatic_ref.exact.program import EXACT, MatrixProgram, exact_matrix, fraction
from quasistatic_ref.numbers.arrays import Array, read_only
from quasistatic_ref.numbers.precision import working_precision
from quasistatic_ref.step.cones import Coefficients, cone
from quasistatic_ref.step.data import StepData

Rows = tuple[int, ...]
"""The face of a contact: independent rows of its cone, whose combinations it is."""


@dataclass(frozen=True, eq=False)
class Face:
    """A face of the cone of forces, with its projection of points and its conditions.

    Parameters
    ----------
    linear : arb_mat
        Whole numbers, shape (R + 4, 4). Times z and over the denominator they are R numbers that
        are >= 0 if the nearest point lies on this face (the multipliers of its rows, and the slacks
        of z + s in the others); and s.
    denominator : int
    """

    linear: arb_mat
    denominator: int


def rows_of(name: str, count: int) -> Array:
    """The rows of a contact that has `count` of its cone's, shape (count, 4) [-].

    One with the leading rows only has no spin, whose length would be one more to give way by.
    """
    return _leading_rows(cone(name).coefficients, count)


@lru_cache(maxsize=64)
def _leading_rows(coefficients: Coefficients, count: int) -> Array:
    has_all = count == len(coefficients)
    return read_only(np.array(coefficients[:count]) * [1, 1, 1, has_all])


def cone_rows(step: StepData) -> Array:
    """The rows of all contacts of a step, block diagonal, shape (rows, 4 n_c) [-]."""
    offsets = step.offsets
    n_c = step.contacts.n_c
    C = np.zeros((offsets[-1], n_c, 4))
    for j, count in enumerate(step.counts.tolist()):
        C[offsets[j] : offsets[j + 1], j] = rows_of(step.cone, count)
    return C.reshape(len(C), 4 * n_c)


def face(name: str, count: int, rows: Rows) -> Face:
    """The face that some independent rows of a contact span, which has `count` rows."""
    return _face(cone(name).coefficients, count, rows)


@lru_cache(maxsize=4096)
def _face(coefficients: Coefficients, count: int, rows: Rows) -> Face:
    entries = _leading_rows(coefficients, count).ravel().tolist()
    C = fmpq_mat(count, 4, [fraction(x) for x in entries])
    table = C.tolist()
    C_w = fmpq_mat(len(rows), 4, [x for i in rows for x in table[i]])
    multipliers = fmpq_mat(0, 4)
    if rows:
        multipliers = (C_w * C_w.transpose()).solve(-C_w)
    s = C_w.transpose() * multipliers
    conditions = (C + C * s).tolist()
    for i, multiplier in zip(rows, multipliers.tolist(), strict=True):
        conditions[i] = multiplier
    numerators, denominator = fmpq_mat(conditions + s.tolist()).numer_denom()
    return Face(arb_mat(numerators), int(denominator))


def nearest_face(name: str, count: int, z: arb_mat) -> Rows:
    """The face on which the point nearest to -z lies, of a contact that has `count` rows.

    That point is the shortest s with C (z + s) >= 0, C being the rows of the contact's cone: the
    sum of the rows of its face, times their multipliers.

    Parameters
    ----------
    name : str
        A polyhedral cone.
    count : int
    z : arb_mat
        Exact, shape (4, 1) [m, or times any positive number].

    Returns
    -------
    tuple of int
        Independent rows, in increasing order; their multipliers are positive.
    """
    C = exact_matrix(rows_of(name, count))
    with working_precision(EXACT):
        constants = (C * z).entries()
    rows = [[*row, c] for row, c in zip(C.tolist(), constants, strict=True)]
    end = dual_active_set(MatrixProgram(exact_matrix(np.eye(4)), arb_mat(4, 1), arb_mat(rows)))
    assert isinstance(end, Minimiser)
    return tuple(sorted(end.working))
