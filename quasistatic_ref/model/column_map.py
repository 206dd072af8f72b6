"""Which coordinates move which links: the part of a Jacobian that does not depend on q."""

from abc import ABC, abstractmethod
from collections.abc import Sequence

import numpy as np

from quasistatic_ref.model.coordinates import Order
from quasistatic_ref.model.world import Part
from quasistatic_ref.numbers.arrays import Array, Indices


class JacobianColumns(ABC):
    """Which columns of a Jacobian move a link, and with which coordinate.

    Parameters
    ----------
    moves : ndarray, shape (L, 1, n_x)
        1 where a column moves a link, else 0 [-].
    owner : ndarray of int, shape (n_x,)
        The coordinate of each column, in the paper's order [-].
    n_v : int
        Number of coordinates.
    """

    def __init__(self, moves: Array, owner: Indices, n_v: int) -> None:
        self.moves = moves
        self.owner = owner
        self.n_v = n_v

    @property
    def shares(self) -> tuple[Indices, Indices, Array]:
        """Numbers of columns, ascending, and of coordinates that they move with, and how much [-].

        (k,) each. A column mostly moves with one coordinate, as much as that.
        """
        n_x = len(self.owner)
        return np.arange(n_x), self.owner, np.ones(n_x)

    @abstractmethod
    def of_coordinates(self, columns: Array) -> Array:
        """Columns per unit of delta_q, shape (..., n_v), from `columns` (..., n_x) [m, rad]."""


class JointColumns(JacobianColumns):
    """Which columns of pinocchio's ``data.J`` move a link, and with which coordinate.

    A link is moved by the joints between it and the world. A mimic joint has columns, but no
    coordinate of its own: it moves with the coordinate of another joint.

    Parameters
    ----------
    parts : sequence of Part
    order : Order
    """

    def __init__(self, parts: Sequence[Part], order: Order) -> None:
        n_x = sum(part.model.nvExtended for part in parts)
        moves = np.zeros((1 + sum(len(part.frames) for part in parts), 1, n_x))
        owner = np.zeros(n_x, dtype=np.int64)
        link = 1  # where the next part begins: its links, its columns, its coordinates
        x = 0
        v = 0
        for model, frames in parts:
            sizes = zip(model.idx_vExtendeds, model.nvExtendeds, strict=True)
            columns = [slice(x + start, x + start + size) for start, size in sizes]
            for frame in frames:
                for joint in model.supports[model.frames[frame].parentJoint]:
                    moves[link, 0, columns[joint]] = 1.0
                link += 1
            for of_joint, of_model in zip(columns, model.idx_vs, strict=True):
                owner[of_joint] = v + of_model + np.arange(of_joint.stop - of_joint.start)
            x += model.nvExtended
            v += model.nv
        super().__init__(moves, np.argsort(order.v)[owner], v)
        self.order = order
        # A mimic joint comes after the one that it mimics.
        self.owned = np.unique(self.owner, return_index=True)[1]
        copies = np.delete(np.arange(n_x), self.owned)
        self.copies = list(zip(copies.tolist(), self.owner[copies].tolist(), strict=True))

    def of_coordinates(self, columns: Array) -> Array:
        """Columns per unit of delta_q, shape (..., n_v), from `columns` of pinocchio [m, rad]."""
        of_joints = columns.take(self.owned, axis=-1)
        for x, owner in self.copies:
            # A view: `of_joints[..., owner] += ...` would write the sums a second time.
            of_owner = of_joints[..., owner]
            of_owner += columns[..., x]
        return of_joints
