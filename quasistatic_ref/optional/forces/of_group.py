r"""The compliance of a group: so little that loads are borne, so much that noise does not show.

Each contact of a group touches two of its *sides*: what the actuated coordinates move is one, each
other body or mechanism another (:func:`sides`). Forces of 1 N along the directions that a contact
bears (n; with friction d1 and d2, too) move a side by its mobility [m/N], a symmetric matrix of up
to 3 x 3:

.. math:: b = J K^{-1} J^T, \qquad K = H / h = K_q \text{ or } M_u / h^2 ,

J being the rows of these directions. The compliance of all contacts is a power of two next to
`COMPLIANCE` times the least of the mobilities along n, d1 and d2: that of the heaviest body or the
stiffest spring. It follows the units of length, mass and time, the time step and the masses, and
(R43) says what loads lose by it.

What a rail or a hinge bears is no load of the side. So an eigenvalue of b that is zero counts as
the largest of its contact, and a contact at the axis of a hinge as the one that moves most: none
makes c smaller. :func:`counted` passes from the one to the other without a jump.
"""

from typing import Final

import numpy as np

from quasistatic_ref.certify.norm import energy_norm
from quasistatic_ref.exact.components import components
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.optional.friction import scaled_by
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import frame_jacobian

COMPLIANCE: Final = 2e-9
"""Compliance of a group's contacts over the least mobility of what they touch [-].

A body that rests on its contacts loses so much of its weight, the lowest of 20 like it 100 times as
much (R43): less than 1e-6. A last bit of phi, 1e-17 m, changes the forces of a body that bears its
weight by 1e-5 of it at h = 10 ms, and by 1e-3 at 1 ms."""

HARDLY_MOVES: Final = 1e-3
"""Mobility of a side along a principal direction, relative to its largest [-], below which loads
along it count less and less as loads of the side: at the square of this not at all. A free body has
1 / m at least, and more than 1000 times as much only where it is 30 times as far from its centre as
its mass is."""

NOTHING_MOVES = 1e-9
"""c [m/N] of contacts between what stands: they bear nothing, whatever it is."""
SMALLEST = -900
LARGEST = 900
"""Least and largest exponent of a compliance: it and its square root are numbers of float64."""


def group_compliance(step: StepData) -> float:
    """The compliance c that all contacts of a step, or of one of its groups, get [m/N].

    Before it is rounded to a power of two it is continuous in J and H.

    Parameters
    ----------
    step : StepData

    Raises
    ------
    StepDataError
        If H, formed without rounding, is not positive definite.
    """
    contacts = step.contacts
    borne = cone(step.cone).matrix[:, :3].any(axis=0) & (scaled_by(contacts)[:, :3] > 0)
    least = np.inf
    for side in sides(step):
        J = np.stack(frame_jacobian(contacts, contacts.J[:, :, side])[:3], axis=1)
        J = (borne[:, :, None] * J)[(borne[:, :, None] & (J != 0)).any(axis=(1, 2))]
        if not len(J):
            continue
        # LAPACK rounds differently on other processors. That counts where c is as near to one power
        # of two as to the next, and then forces change by what they lose.
        norm = energy_norm(step.H[np.ix_(side, side)])
        # H^-1 p of each row p of J, in axes in which ||.||_H is the length
        rows = (J * norm.unit).reshape(-1, len(side))
        moves = np.linalg.solve(norm.L, rows.T).T.reshape(J.shape)
        unit = np.abs(moves).max()
        moves = moves / unit
        b, axes = np.linalg.eigh(moves @ moves.transpose(0, 2, 1))  # in units of unit^2 / h
        along = (axes**2 @ counted(b, b[:, -1:])[:, :, None])[:, :, 0]  # n, d1 and d2
        least = min(least, unit * np.sqrt(counted(along, along.max()).min()))
    if least == np.inf:
        return NOTHING_MOVES
    # b = h J H^-1 J' = h least^2, which may leave the range of float64 where its logarithm does not
    exponent = round(float(np.log2(COMPLIANCE) + np.log2(step.h) + 2 * np.log2(least)))
    return float(2.0 ** np.clip(exponent, SMALLEST, LARGEST))


def counted(b: Array, largest: Array) -> Array:
    """Mobilities b, shape (k, 3) [-], so changed that one near zero counts as a large one.

    Below, small^2 / b, which grows to the largest again; shape (k, 3). `largest` has shape (k, 1),
    or () for one of all [-].
    """
    small = HARDLY_MOVES * largest
    return np.where(b >= small, b, small**2 / np.maximum(b, HARDLY_MOVES * small))


def sides(step: StepData) -> list[Indices]:
    """Coordinates of each side of a contact: all actuated ones, and each other body or mechanism.

    Two coordinates of a mechanism are coupled by M_u, or they move the same contacts, as the six of
    a free body do. Two bodies that touch each other alone count as one.

    Returns
    -------
    list of ndarray of int, shape (n,)
    """
    moved = step.contacts.J.any(axis=1)  # (n_c, n_v)
    _, kind = np.unique(moved, axis=1, return_inverse=True)
    alike = (np.arange(step.n_v)[:, None] == kind) & moved.any(axis=0)
    label, _ = components(np.concatenate([step.coupled(), alike]))
    label[: step.n_a] = 0
    label[label < step.n_a] = 0
    return [np.flatnonzero(label == side) for side in np.unique(label)]
