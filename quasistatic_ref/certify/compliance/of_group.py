r"""The compliance of a group: so little that loads are borne, so much that noise does not show.

Each contact of a group touches two of its *sides*: what the actuated coordinates move is one, each
other body or mechanism another (:func:`~quasistatic_ref.step.groups.sides`). A force of 1 N along
n, d1 or d2 moves a side by its mobility [m/N],

.. math:: b = J K^{-1} J^T, \qquad K = H / h = K_q \text{ or } M_u / h^2 ,

J being the row of that direction. The compliance of all contacts is a power of two next to
`COMPLIANCE` times the least of these mobilities: that of the heaviest body or the stiffest spring.
It follows the units of length, mass and time, the time step and the masses, and (R43) says what
loads lose by it.
"""

import numpy as np

from quasistatic_ref.certify.norm import energy_norm
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.friction import frame_jacobian
from quasistatic_ref.step.groups import sides
from quasistatic_ref.tolerances import COMPLIANCE, HARDLY_MOVES

NOTHING_MOVES = 1e-9
"""c [m/N] of contacts between what stands: they bear nothing, whatever it is."""
SMALLEST = -900
LARGEST = 900
"""Least and largest exponent of a compliance: it and its square root are numbers of float64."""


def group_compliance(step: StepData) -> float:
    """The compliance c of the contacts of a step by itself, or of a group of one [m/N].

    A direction in which a side hardly moves, compared with other contacts and directions, is left
    out: a finger on rails beside its direction, a hinge at its axis.

    Parameters
    ----------
    step : StepData

    Raises
    ------
    StepDataError
        If H, formed without rounding, is not positive definite.
    """
    least = np.inf
    for side in sides(step):
        J = frame_jacobian(step.contacts, step.contacts.J[:, :, side])[:3]
        # LAPACK rounds differently on other processors. That counts where c is as near to one power
        # of two as to the next, and then forces change by what they lose.
        moves = energy_norm(step.H[np.ix_(side, side)]).of_impulses(np.concatenate(J))
        moves = moves[moves > np.sqrt(HARDLY_MOVES) * moves.max(initial=0.0)]
        least = min(least, moves.min(initial=np.inf))
    if least == np.inf:
        return NOTHING_MOVES
    # b = h J H^-1 J' = h least^2, which may leave the range of float64 where its logarithm does not
    exponent = round(float(np.log2(COMPLIANCE) + np.log2(step.h) + 2 * np.log2(least)))
    return float(2.0 ** np.clip(exponent, SMALLEST, LARGEST))
