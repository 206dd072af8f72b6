"""The one protocol of adapters: what each is given, and what it gives back."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal, Protocol

import numpy as np

from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.step.data import Array, Indices
from quasistatic_ref.step.groups import labels

if TYPE_CHECKING:
    from scipy.sparse import csc_matrix


@dataclass(frozen=True, eq=False)
class Program:
    """min 1/2 x'Hx + f'x subject to A x >= b: arrays that are rewritten at each step.

    Parameters
    ----------
    H : ndarray, shape (n_v, n_v)
    f : ndarray, shape (n_v,)
        -g of :class:`~quasistatic_ref.step.standard_form.StandardForm` [N m s].
    A : ndarray, shape (m, n_v)
        In the memory order that the adapter asks for.
    b : ndarray, shape (m,)
    cones : int
        How many cones s_0 >= ||(s_1, s_2, s_3)|| the first rows of s = A x - b make, four each.
    """

    H: Array
    f: Array
    A: Array
    b: Array
    cones: int = 0

    def unconstrained(self) -> Reply:
        """The minimiser of a program without rows, which not every backend takes."""
        x = np.asarray(np.linalg.solve(self.H, -self.f), dtype=np.float64)
        return Reply(x, np.zeros(0), True, "optimal", 0)

    @cached_property
    def triangle(self) -> tuple[Indices, Indices]:
        """Columns and rows of H's upper triangle, column by column, shape (n (n + 1) / 2,) each."""
        return np.tril_indices(len(self.f))

    @property
    def P_data(self) -> Array:
        """Entries of H's upper triangle, in the order of :meth:`columns`, shape (entries,)."""
        return self.H.T[self.triangle]

    @property
    def A_data(self) -> Array:
        """Entries of A, in the order of :meth:`columns`, shape (m n_v,)."""
        return self.A.ravel(order="F")

    def columns(self) -> tuple[csc_matrix, csc_matrix]:
        """H's upper triangle and A in compressed columns of a fixed pattern, zeros included."""
        from scipy.sparse import csc_matrix  # not all adapters need it

        P = csc_matrix(np.triu(np.ones(self.H.shape)))
        A = csc_matrix(np.ones(self.A.shape))
        P.data = self.P_data
        A.data = self.A_data
        return P, A


@dataclass(frozen=True, eq=False)
class SparseProgram:
    """The same program in compressed columns, without entries that are always zero.

    Parameters
    ----------
    H, P : scipy.sparse.csc_matrix, shape (n_v, n_v)
        H, and its upper triangle.
    f : ndarray, shape (n_v,)
        -g [N m s].
    A : scipy.sparse.csc_matrix, shape (m, n_v)
    b : ndarray, shape (m,)
    """

    H: csc_matrix
    P: csc_matrix
    f: Array
    A: csc_matrix
    b: Array

    @property
    def P_data(self) -> Array:
        """Entries of P, shape (entries,)."""
        return np.asarray(self.P.data)

    @property
    def A_data(self) -> Array:
        """Entries of A, shape (entries,)."""
        return np.asarray(self.A.data)

    def columns(self) -> tuple[csc_matrix, csc_matrix]:
        """P and A."""
        return self.P, self.A


class Parts:
    """What nothing couples in a sparse program, as dense programs: rewritten from it at each step.

    Parameters
    ----------
    program : SparseProgram

    Attributes
    ----------
    programs : list of Program
    """

    def __init__(self, program: SparseProgram) -> None:
        self.program = p = program
        m, n = p.A.shape
        row, column = p.A.indices, _columns(p.A)
        one, other = p.H.indices, _columns(p.H)
        entry = m + np.arange(len(one))
        part, part_of_row = labels(
            n,
            m + len(one),
            coupling=np.concatenate([row, entry, entry]),
            coordinate=np.concatenate([column, one, other]),
        )
        firsts, part = np.unique(part, return_inverse=True)
        part_of_row = np.searchsorted(firsts, part_of_row[:m])
        self.v, v_ends, v_place = _sorted_by(part, len(firsts))
        self.rows, row_ends, row_place = _sorted_by(part_of_row, len(firsts))
        width, height = np.diff(v_ends), np.diff(row_ends)
        H_ends = np.cumsum([0, *width * width])
        A_ends = np.cumsum([0, *height * width])
        at = part[column]
        self.place = A_ends[at] + row_place[row] * width[at] + v_place[column]
        at = part[other]
        H = np.zeros(H_ends[-1])
        H[H_ends[at] + v_place[one] * width[at] + v_place[other]] = p.H.data
        self.f = np.zeros(n)
        self.A = np.zeros(A_ends[-1])
        self.b = np.zeros(m)
        self.programs = [
            Program(H_i.reshape(w, w), f_i, A_i.reshape(-1, w), b_i)
            for w, H_i, f_i, A_i, b_i in zip(
                width.tolist(),
                np.split(H, H_ends[1:-1]),
                np.split(self.f, v_ends[1:-1]),
                np.split(self.A, A_ends[1:-1]),
                np.split(self.b, row_ends[1:-1]),
                strict=True,
            )
        ]
        self.rewrite()

    def rewrite(self) -> None:
        """Take over what the sparse program says now."""
        p = self.program
        self.f[:] = p.f[self.v]
        self.A[self.place] = p.A.data
        self.b[:] = p.b[self.rows]

    def joined(self, replies: Sequence[Reply]) -> Reply:
        """The reply to the sparse program from those to its parts: solved if all of them are."""
        x = np.zeros(len(self.v))
        lam = np.zeros(len(self.rows))
        x[self.v] = np.concatenate([reply.x for reply in replies])
        lam[self.rows] = np.concatenate([reply.lam for reply in replies])
        worst = min(replies, key=lambda reply: reply.solved)
        iterations = sum(reply.iterations or 0 for reply in replies)
        seconds = sum(reply.seconds or 0.0 for reply in replies)
        return Reply(x, lam, worst.solved, worst.status, iterations, seconds)


def _columns(matrix: csc_matrix) -> Indices:
    """The column of each entry, shape (entries,)."""
    return np.repeat(np.arange(matrix.shape[1]), np.diff(matrix.indptr))


def _sorted_by(part: Indices, count: int) -> tuple[Indices, Indices, Indices]:
    """Members by their part, where each of so many parts ends, and each member's place in its own.

    Parameters
    ----------
    part : ndarray of int, shape (k,)
    count : int

    Returns
    -------
    ndarray of int, shapes (k,), (count + 1,) and (k,)
        The ends begin with 0.
    """
    order = np.argsort(part, kind="stable")
    ends = np.searchsorted(part[order], np.arange(count + 1))
    place = np.empty_like(order)
    place[order] = np.arange(len(order)) - ends[part[order]]
    return order, ends, place


class Adapter(Protocol):
    """A solver that holds one program.

    Attributes
    ----------
    ORDER : str
        ``"C"`` or ``"F"``: the memory order in which it takes A and H.
    WARM : bool
        Whether it can start from its answer to the step before.
    NEAR : bool
        Whether far contacts have to be written nearer, because it loses digits where gaps of 1e6
        stand with numbers of size one. An active-set method does not lose any: rows that are far
        are never in its set.
    """

    ORDER: Literal["C", "F"] = "F"
    WARM: bool = False
    NEAR: bool = True

    def __init__(self, program: Program | SparseProgram, options: Options) -> None:
        """Set up with the program as it stands, a SparseProgram only if the backend takes one."""

    def reply(self, same_H: bool, warm: bool) -> Reply:
        """Solve the program as it stands now, from the answer before if `warm`."""
