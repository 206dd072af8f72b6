"""Eq. :eq:`eq-13` as sparse matrices, for steps whose contacts are in blocks."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import block_diag, bsr_matrix, csc_matrix

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.optional.large.blocks import Blocks
from quasistatic_ref.optional.large.sparse_contacts import SparseContacts
from quasistatic_ref.step.data import Array, StepData, hessian_blocks
from quasistatic_ref.step.friction import row_constants, rows_along
from quasistatic_ref.step.standard_form import StandardForm, linear_term


class Pattern:
    """Where the entries of A are, and H: constants of a run.

    Parameters
    ----------
    step : StepData
        A step whose contacts are in blocks, without rows of the user's own.

    Attributes
    ----------
    A : scipy.sparse.csc_matrix, shape (m, n_v)
        Its places alone, all entries zero; :func:`sparse_form` gives each step entries of its own.
    entry : ndarray of int
        Where they are among the entries of all rows in the columns of their blocks, (m, w).
    H : scipy.sparse.csc_matrix, shape (n_v, n_v)
    """

    def __init__(self, step: StepData) -> None:
        blocks = in_blocks(step)
        m = int(step.offsets[-1])
        n_v = step.n_v
        column = np.repeat(blocks.column, step.counts, axis=0)  # of each row, (m, w)
        row, place = np.nonzero(column < n_v)
        entry = row * column.shape[1] + place
        # Counting the entries shows where each of them ends up among the columns.
        counted = csc_matrix((entry + 1.0, (row, column[row, place])), shape=(m, n_v))
        self.entry = counted.data.astype(np.int64) - 1
        self.A = 0.0 * counted
        self.column = np.repeat(np.arange(n_v), np.diff(counted.indptr))
        self.H = sparse_hessian(step)
        self.template = step

    def matrix(self, rows: Array) -> csc_matrix:
        """A from the entries of all rows in the columns of their blocks, shape (m, w)."""
        entries = rows.ravel()[self.entry]
        return csc_matrix((entries, self.A.indices, self.A.indptr), self.A.shape)

    def fits(self, step: StepData) -> bool:
        """Whether a step has its entries where this pattern has them, and the same H."""
        template = self.template
        contacts = step.contacts
        if not isinstance(contacts, SparseContacts) or step.extra.names:
            return False
        if (step.h, step.cone) != (template.h, template.cone):
            return False
        return (
            _same(contacts.blocks.column, in_blocks(template).column)
            and _same(step.contacts.rows, template.contacts.rows)
            and _same(step.K_q, template.K_q)
            and (_same(step.kept_M_u, template.kept_M_u) or _same(step.M_u, template.M_u))
        )


def _same(one: NDArray[Any], two: NDArray[Any]) -> bool:
    """Whether two arrays are equal; the steps of a run share one array, which `is` shows."""
    return one is two or np.array_equal(one, two)


def in_blocks(step: StepData) -> Blocks:
    """The blocks of a step.

    Raises
    ------
    StepDataError
        If its contacts are not in blocks, or it has rows of the user's own.
    """
    contacts = step.contacts
    if not isinstance(contacts, SparseContacts) or step.extra.names:
        raise StepDataError("must be in blocks, without rows of the user's own", field="contacts")
    return contacts.blocks


def sparse_hessian(step: StepData) -> csc_matrix:
    """H of Eq. :eq:`eq-13`, shape (n_v, n_v), from M_u as the step keeps it."""
    M_u = step.kept_M_u
    if M_u.ndim == 2:
        return csc_matrix(step.H)
    of_a, of_u = hessian_blocks(step.h, step.K_q, M_u)
    at = np.arange(len(of_u) + 1)
    diagonal = bsr_matrix((of_u, at[:-1], at), shape=(step.n_u, step.n_u))
    H = block_diag([of_a, diagonal], format="csc")
    H.eliminate_zeros()  # of the blocks
    return H


def sparse_form(step: StepData, pattern: Pattern) -> StandardForm:
    """Its standard form, with sparse H and A in the places of the pattern."""
    (rows,) = step.present(rows_along(step.contacts, in_blocks(step).J, step.cone))  # Eqs. (4), (8)
    (b,) = -step.present(row_constants(step.contacts, step.cone))
    return StandardForm(pattern.H, linear_term(step), pattern.matrix(rows), b)
