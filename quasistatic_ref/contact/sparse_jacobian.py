"""Contact Jacobians of many bodies: of each contact only the columns that move it."""

from __future__ import annotations

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.jacobian import tangents
from quasistatic_ref.contact.pairs import ContactLayout
from quasistatic_ref.model.motion import Motion, cross_matrix
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.step.blocks import Blocks
from quasistatic_ref.step.data import Contacts


class BlockLayout:
    """Which columns move the bodies of each contact: a constant of a run.

    Parameters
    ----------
    layout : ContactLayout
    motion : Motion
        Without mimic joints, whose columns move with another coordinate.
    """

    def __init__(self, layout: ContactLayout, motion: Motion) -> None:
        moves = motion.order.paper_v(motion.moves[:, 0]) > 0
        a, b = moves[layout.link_alpha], moves[layout.link_beta]
        either, n_v = a | b, moves.shape[1]
        contact, column = np.nonzero(either)  # contact by contact, ascending
        count = either.sum(axis=1)
        rank = np.arange(len(contact)) - np.repeat(np.cumsum(count) - count, count)
        shape = (len(a), int(count.max(initial=0)))
        self.column = np.full(shape, n_v)
        self.column[contact, rank] = column
        self.alpha, self.beta = np.zeros((2, *shape))
        self.alpha[contact, rank], self.beta[contact, rank] = a[contact, column], b[contact, column]
        self.model_column = np.append(motion.order.v, 0)[self.column]
        self.n_v = n_v

    def jacobian(self, kinematics: Kinematics, points: ClosestPoints) -> Blocks:
        """J of Eq. (3), those columns."""
        twist = kinematics.columns.T[self.model_column].transpose(0, 2, 1)  # (n_c, 6, w)
        nu, omega = twist[:, :3], twist[:, 3:]
        a, b = self.alpha[:, None], self.beta[:, None]
        at_alpha = nu - cross_matrix(points.alpha) @ omega  # nu_origin + omega x r
        at_beta = nu - cross_matrix(points.beta) @ omega
        spin = points.n[:, None] @ (omega * (b - a))
        J = np.concatenate([b * at_beta - a * at_alpha, spin], axis=1)  # Eqs. (2)-(3)
        return Blocks(self.column, J, self.n_v)


def contacts_in_blocks(
    layout: ContactLayout,
    blocks: BlockLayout,
    points: ClosestPoints,
    kinematics: Kinematics,
    like: Contacts | None = None,
) -> Contacts:
    """As :func:`~quasistatic_ref.contact.jacobian.contacts`, J in blocks."""
    d1, d2 = tangents(points.n)

    def name() -> tuple[str, ...]:
        numbered = zip(layout.names, points.point.tolist(), strict=True)
        return tuple([f"{pair}/{i}" for pair, i in numbered])

    if like is None:
        without = np.zeros((len(points.phi), 4, 0))
        mu = layout.mu_v, layout.mu_omega, layout.rows
        like = Contacts(name(), points.phi, points.n, d1, d2, without, *mu)
    J = blocks.jacobian(kinematics, points)
    return like.moved(name, blocks=J, phi=points.phi, n=points.n, d1=d1, d2=d2)
