"""The one protocol of adapters: what each is given, and what it gives back."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, Protocol

import numpy as np

from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.step.data import Array, Indices

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

    def __init__(self, program: Any, options: dict[str, Any]) -> None:
        """Set up with the program as it stands, a SparseProgram only if the backend takes one."""

    def reply(self, same_H: bool, warm: bool) -> Reply:
        """Solve the program as it stands now, from the answer before if `warm`."""
