"""Contact Jacobians of many bodies: of each contact only the columns that move it."""

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.jacobian import tangents
from quasistatic_ref.contact.pairs import ContactLayout
from quasistatic_ref.model.column_map import ColumnMap
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.optional.large.blocks import Blocks
from quasistatic_ref.optional.large.sparse_contacts import SparseContacts
from quasistatic_ref.step.data import Indices, Mask
from quasistatic_ref.step.ordered import crossed, product


class BlockGeometry:
    """As :class:`~quasistatic_ref.contact.jacobian.ContactGeometry`, J in blocks.

    Parameters
    ----------
    layout : ContactLayout
    column_map : ColumnMap
    """

    in_blocks = True

    def __init__(self, layout: ContactLayout, column_map: ColumnMap) -> None:
        self.layout = layout
        # Joints' columns in the order of their coordinates; a mimic's is that of another.
        owner = column_map.owner
        by_coordinate = np.argsort(owner, kind="stable")
        owner = owner[by_coordinate]
        moves = column_map.moves[:, 0, by_coordinate] > 0
        a = moves[layout.link_alpha]
        b = moves[layout.link_beta]
        contact, rank, joint_column = _ragged(a | b)
        shape = (len(a), 1 + int(rank.max(initial=-1)))
        self.joint_column, (self.alpha, self.beta) = np.zeros(shape, int), np.zeros((2, *shape))
        self.joint_column[contact, rank] = by_coordinate[joint_column]
        self.alpha[contact, rank] = a[contact, joint_column]
        self.beta[contact, rank] = b[contact, joint_column]
        self.n_v = column_map.n_v
        coordinate = np.zeros((len(a), self.n_v), dtype=bool)
        coordinate[contact, owner[joint_column]] = True
        at, place, column = _ragged(coordinate)
        self.column = np.full((len(a), 1 + int(place.max(initial=-1))), self.n_v)
        self.column[at, place] = column
        self.column.setflags(write=False)  # one array for all steps
        self.sums = None
        if column_map.mimics:  # the columns of one coordinate add up
            self.sums = np.zeros((*shape, self.column.shape[1]))
            position = coordinate.cumsum(axis=1) - 1
            self.sums[contact, rank, position[contact, owner[joint_column]]] = 1.0

    def contacts(self, points: ClosestPoints, kinematics: Kinematics) -> SparseContacts:
        """The contacts of one step, from the closest points of all pairs."""
        phi = points.phi
        n = points.n
        layout = self.layout
        d1, d2 = tangents(n)
        blocks = self.jacobian(kinematics, points)
        names = layout.contact_names(points.point)
        return SparseContacts(
            names, phi, n, d1, d2, blocks, layout.mu_v, layout.mu_omega, layout.rows
        )

    def jacobian(self, kinematics: Kinematics, points: ClosestPoints) -> Blocks:
        """J of Eq. :eq:`eq-3`, those columns."""
        twist = kinematics.columns.T[self.joint_column].transpose(0, 2, 1)  # (n_c, 6, w)
        nu = twist[:, :3]
        omega = twist[:, 3:]
        a = self.alpha[:, None]
        b = self.beta[:, None]
        at_alpha = nu + crossed(omega, points.alpha[:, :, None])  # nu_origin + omega x r
        at_beta = nu + crossed(omega, points.beta[:, :, None])
        spin = product(points.n[:, None], omega * (b - a))
        J = np.concatenate([b * at_beta - a * at_alpha, spin], axis=1)  # Eqs. (2)-(3)
        return Blocks(self.column, J if self.sums is None else product(J, self.sums), self.n_v)


def _ragged(marked: Mask) -> tuple[Indices, Indices, Indices]:
    """Row, rank in the row and column of each mark."""
    row, column = np.nonzero(marked)
    return row, marked.cumsum(axis=1)[row, column] - 1, column
