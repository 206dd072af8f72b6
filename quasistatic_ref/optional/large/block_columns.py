"""Which columns of J the contacts of many bodies keep: those that move one of their two bodies."""

from dataclasses import dataclass

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.pairs import ContactLayout
from quasistatic_ref.model.column_map import ColumnMap
from quasistatic_ref.optional.between import BLOCK_COLUMNS
from quasistatic_ref.optional.large.blocks import Blocks
from quasistatic_ref.optional.large.sparse_contacts import SparseContacts
from quasistatic_ref.step.data import Array, Indices


@dataclass(frozen=True, eq=False)
class BlockColumns:
    """The columns of J that each contact keeps, and the columns of joints that are added to them.

    Parameters
    ----------
    column : ndarray of int, shape (n_c, w)
        As of :class:`~quasistatic_ref.optional.large.blocks.Blocks`; read-only.
    joint_column, place : ndarray of int, shape (n_c, n_x)
        Columns of pinocchio's Jacobian, and to which of the w columns each is added. Where a
        contact has fewer than n_x, the others move none of its bodies.
    alpha, beta : ndarray, shape (n_c, n_x)
        1.0 where the column moves alpha's or beta's body, else 0.0.
    n_v : int
        Number of coordinates.
    """

    column: Indices
    joint_column: Indices
    place: Indices
    alpha: Array
    beta: Array
    n_v: int

    def columns(self) -> tuple[Indices, Indices, Array, Array, int]:
        """The fields from the second to the fifth, of shape (n_c, n_x), and w."""
        return self.joint_column, self.place, self.alpha, self.beta, int(self.column.shape[1])

    def contacts(
        self,
        layout: ContactLayout,
        name: tuple[str, ...],
        points: ClosestPoints,
        d1: Array,
        d2: Array,
        J: Array,
    ) -> SparseContacts:
        """The contacts at those points, from d1, d2 (n_c, 3) [-], and J (n_c, 4, w) [m, rad]."""
        blocks = Blocks(self.column, J, self.n_v)
        friction = layout.mu_v, layout.mu_omega, layout.rows
        return SparseContacts(name, points.phi, points.n, d1, d2, blocks, *friction)


def block_columns(layout: ContactLayout, column_map: ColumnMap) -> BlockColumns:
    """Those of a simulator's contacts."""
    # Joints' columns in the order of their coordinates; a mimic's is that of another.
    by_coordinate = np.argsort(column_map.owner, kind="stable")
    owner = column_map.owner[by_coordinate]
    moves = column_map.moves[:, 0, by_coordinate] > 0
    a = moves[layout.link_alpha]
    b = moves[layout.link_beta]
    contact, joint_column = np.nonzero(a | b)
    rank = _ranks(contact)
    coordinate = owner[joint_column]
    new = np.diff(contact * column_map.n_v + coordinate, prepend=-1) > 0  # no mimic's
    position = _ranks(contact[new])
    column = np.full((len(a), _width(position)), column_map.n_v)
    column[contact[new], position] = coordinate[new]
    column.setflags(write=False)  # one array for all steps
    n_x = _width(rank)
    joints, place = np.zeros((2, len(a), n_x), dtype=np.int64)
    joints[contact, rank] = by_coordinate[joint_column]
    place[contact, rank] = position[np.cumsum(new) - 1]
    alpha, beta = np.zeros((2, len(a), n_x))
    alpha[contact, rank] = a[contact, joint_column]
    beta[contact, rank] = b[contact, joint_column]
    return BlockColumns(column, joints, place, alpha, beta, column_map.n_v)


def _ranks(row: Indices) -> Indices:
    """The rank of each entry among those of its row; `row` (n,) is ascending."""
    return np.arange(len(row)) - np.searchsorted(row, row)


def _width(rank: Indices) -> int:
    """The most entries of a row, whose ranks (n,) are there."""
    return int(rank.max(initial=-1)) + 1


BLOCK_COLUMNS.fill(block_columns)
