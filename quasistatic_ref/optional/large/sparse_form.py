"""Eq. :eq:`eq-13` as sparse matrices, for steps whose contacts are in blocks."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import block_diag, bsr_matrix, csc_matrix

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.optional.large.blocks import Blocks
from quasistatic_ref.optional.large.sparse_contacts import SparseContacts
from quasistatic_ref.step.data import Array, StepData, hessian_blocks
from quasistatic_ref.step.friction import row_constants, rows_along
from quasistatic_ref.step.ordered import product


class Pattern:
    """Where the entries of A and of H's upper triangle are: a constant of a run.

    Parameters
    ----------
    step : StepData
        A step whose contacts are in blocks, without rows of the user's own.

    Attributes
    ----------
    A : scipy.sparse.csc_matrix, shape (m, n_v)
        Its places alone, all entries zero; :func:`sparse_form` gives each step entries of its own.
    P : scipy.sparse.csc_matrix, shape (n_v, n_v)
        The upper triangle of H itself.
    """

    def __init__(self, step: StepData) -> None:
        blocks = in_blocks(step)
        m = int(step.offsets[-1])
        n_v = step.n_v
        column = np.repeat(blocks.column, step.counts, axis=0)  # of each row, (m, w)
        row = np.broadcast_to(np.arange(m)[:, None], column.shape)
        real = np.flatnonzero((column < n_v).ravel())
        # Counting the entries shows where each of them ends up among the columns.
        counted = csc_matrix(
            (np.arange(len(real)) + 1.0, (row.ravel()[real], column.ravel()[real])), shape=(m, n_v)
        )
        self.entry = real[counted.data.astype(np.int64) - 1]
        self.A = csc_matrix((np.zeros(len(real)), counted.indices, counted.indptr), shape=(m, n_v))
        self.column = np.repeat(np.arange(n_v), np.diff(counted.indptr))
        self.P = upper_triangle(step)
        self.P_column = np.repeat(np.arange(n_v), np.diff(self.P.indptr))
        self.template = step
        self.blocks = blocks

    def fits(self, step: StepData) -> bool:
        """Whether a step has its entries where this pattern has them, and the same H."""
        template = self.template
        contacts = step.contacts
        if not isinstance(contacts, SparseContacts) or step.extra.names:
            return False
        if (step.h, step.cone) != (template.h, template.cone):
            return False
        return (
            _same(contacts.blocks.column, self.blocks.column)
            and _same(step.contacts.rows, template.contacts.rows)
            and _same(step.K_q, template.K_q)
            and (_same(kept_M_u(step), kept_M_u(template)) or _same(step.M_u, template.M_u))
        )


def _same(one: NDArray[Any], two: NDArray[Any]) -> bool:
    """Whether two arrays are equal; the steps of a run share one array, which `is` shows."""
    return one is two or np.array_equal(one, two)


@dataclass(frozen=True, eq=False)
class SparseForm:
    """The quadratic program of one step, in float64.

    Parameters
    ----------
    P : scipy.sparse.csc_matrix, shape (n_v, n_v)
        Upper triangle of H.
    g : ndarray, shape (n_v,)
    A : scipy.sparse.csc_matrix, shape (m, n_v)
    b : ndarray, shape (m,)
    """

    P: csc_matrix
    g: Array
    A: csc_matrix
    b: Array


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


def kept_M_u(step: StepData) -> Array:
    """M_u as a step keeps it [kg, kg m]: whole, or in diagonal blocks, shape (n_u / 6, 6, 6)."""
    kept: Array = vars(step)["M_u"]
    return kept


def upper_triangle(step: StepData) -> csc_matrix:
    """Of H of Eq. :eq:`eq-13`, shape (n_v, n_v), from M_u as the step keeps it."""
    M_u = kept_M_u(step)
    if M_u.ndim == 2:
        return csc_matrix(np.triu(step.H))
    of_a, of_u = hessian_blocks(step.h, step.K_q, M_u)
    at = np.arange(len(of_u) + 1)
    diagonal = bsr_matrix((np.triu(of_u), at[:-1], at), shape=(step.n_u, step.n_u))
    P = block_diag([np.triu(of_a), diagonal], format="csc")
    P.eliminate_zeros()  # of the blocks
    return P


def sparse_form(step: StepData, pattern: Pattern) -> SparseForm:
    """H, g of Eq. :eq:`eq-13` and A, b of Eq. :eq:`eq-8`; of H and A the pattern's places only."""
    blocks = in_blocks(step)
    tau_k = product(step.K_q, step.delta_q_bar_a)  # Eq. (1)
    g = step.h * np.concatenate([tau_k + step.tau_a, step.tau_u])  # Eq. (13)
    rows = rows_along(step.contacts, blocks.J, step.cone)[step.mask]  # Eqs. (4), (8), (m, w)
    entries = rows.ravel()[pattern.entry]
    A = csc_matrix((entries, pattern.A.indices, pattern.A.indptr), pattern.A.shape)
    return SparseForm(pattern.P, g, A, -row_constants(step.contacts, step.cone)[step.mask])
