"""How all contacts of a step change with q, and where they have kinks."""

from collections.abc import Sequence

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.derivatives.contact.closest_point_rates import (
    Rates,
    closest_point_rates,
)
from quasistatic_ref.optional.derivatives.contact.couples import (
    Couple,
    PairInWorld,
    Rim,
    rim_velocity,
)
from quasistatic_ref.optional.derivatives.contact.features import Feature
from quasistatic_ref.optional.derivatives.model.tangent import cross_matrix
from quasistatic_ref.optional.derivatives.tolerances import LEVEL, SPLIT, UNIQUE
from quasistatic_ref.step.data import Contacts


def contact_rates(couples: Sequence[Couple], J: Array) -> Rates:
    """The derivatives of all contacts.

    Parameters
    ----------
    couples : sequence of Couple, length n_c
    J : ndarray, shape (L, 6, n_v)
        Twist of each link at the world's origin, per unit of delta_q [m, rad].
    """
    slides = np.zeros((2, len(couples), 3, J.shape[2]))
    level = np.zeros(len(couples), dtype=bool)
    slid = np.zeros(len(couples), dtype=bool)
    taken = list(couples)
    for j, couple in enumerate(couples):
        if couple.rim is not None:
            slide = _rim_slide(couple.of, couple.rim, J)
            level[j] = slide is None
            slides[couple.rim.side, j] = 0.0 if slide is None else slide
        if couple.at_an_end and couple_rates([couple.merged], J).unique[0]:
            slid[j] = dependent(couple.merged.features)
            taken[j] = couple.merged if slid[j] else couple
    rates = couple_rates(taken, J, slides)
    level_too = np.array([nearly_level(couple) for couple in couples], dtype=bool)
    return rates._replace(blurred=rates.blurred | level_too, level_rim=level, slides=slid)


def nearly_level(couple: Couple) -> bool:
    """Whether a contact is of a rim that is level but for more than rounding."""
    tilts = [
        np.hypot(*(body.R.T @ couple.n)[:2])
        for body in couple.of.bodies
        if body.shape.rim_radius is not None
    ]
    return any(SPLIT < tilt <= LEVEL for tilt in tilts)


def dependent(features: tuple[Feature, Feature]) -> bool:
    """Whether both have a straight direction in common."""
    straight = np.concatenate([f.free for f in features])
    return len(straight) > 2 or bool(np.linalg.svd(straight)[1].min(initial=1.0) <= UNIQUE)


def couple_rates(couples: Sequence[Couple], J: Array, slides: Array | float = 0.0) -> Rates:
    """The derivatives of closest points of some couples.

    Parameters
    ----------
    couples : sequence of Couple, length N
    J : ndarray, shape (L, 6, n_v)
        As above [m, rad].
    slides : ndarray, shape (2, N, 3, n_v), optional
        How corners move on their bodies [m].
    """
    links = [[c.of.pair.alpha.link for c in couples], [c.of.pair.beta.link for c in couples]]
    at = np.array([[c.points[side] for c in couples] for side in (0, 1)]).reshape(2, -1, 3)
    twist = J[np.array(links, dtype=np.int64)]
    omega = twist[:, :, 3:]
    v = twist[:, :, :3] - cross_matrix(at) @ omega + slides
    phi = np.array([c.phi for c in couples])
    size = np.array([c.reach for c in couples])
    n = np.array([c.n for c in couples]).reshape(-1, 3)
    features = [c.features[side] for side in (0, 1) for c in couples]
    return closest_point_rates(phi, n, features, v, omega, size)


def _rim_slide(of: PairInWorld, rim: Rim, J: Array) -> Array | None:
    """How a corner moves along its rim, shape (3, n_v), as the normal of the closest pair turns."""
    n = of.closest.n
    rates = couple_rates([of.closest], J)
    if not rates.unique[0] or of.closest.at_an_end:
        return None
    link = (of.pair.alpha, of.pair.beta)[rim.side].link
    turn = rates.n[0] - np.cross(J[link, 3:], n[:, None], axis=0)
    sign = 1.0 if rim.side == 0 else -1.0
    return rim_velocity(rim, of.bodies[rim.side], sign * n, sign * turn)


def tangent_rates(contacts: Contacts, d_n: Array) -> tuple[Array, Array]:
    r"""Derivatives of the tangents d1 and d2, each of shape (n_c, 3, n_v).

    The frame turns with n, and about n by :math:`-(c/s)\,d_2\cdot dn`: c and s are the cosine and
    the sine of the angle between n and the axis of the world whose projection d1 is.

    Parameters
    ----------
    contacts : Contacts
    d_n : ndarray, shape (n_c, 3, n_v)
        Derivatives of n [per m or rad].
    """
    axis = np.eye(3)[np.abs(contacts.n).argmin(axis=1)]
    c = np.vecdot(contacts.n, axis)[:, None, None]
    n, d1, d2 = (vector[:, :, None] for vector in (contacts.n, contacts.d1, contacts.d2))
    along_1, along_2 = ((vector * d_n).sum(axis=1, keepdims=True) for vector in (d1, d2))
    about = -c / np.sqrt(1 - c * c) * along_2
    return about * d2 - along_1 * n, -about * d1 - along_2 * n
