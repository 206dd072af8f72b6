"""Where the contacts of a step have no derivative: kinks and jumps of their geometry, by name."""

from collections.abc import Iterator, Sequence

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.optional.derivatives.contact.closest_point_rates import Rates
from quasistatic_ref.optional.derivatives.contact.contact_rates import couple_rates, dependent
from quasistatic_ref.optional.derivatives.contact.couples import Couple
from quasistatic_ref.optional.derivatives.contact.depth_ties import depth_tie
from quasistatic_ref.optional.derivatives.step import reason
from quasistatic_ref.optional.derivatives.tolerances import TIED, UNIQUE
from quasistatic_ref.tolerances import FILLED

PARALLEL = reason.MANY, "has more than one closest pair of points: parallel surfaces"


def kinks(
    couples: Sequence[Couple], rates: Rates, J: Array, quarters: bool
) -> Iterator[tuple[int, str, str]]:
    """What has no derivative about the contacts, whether they touch or not.

    Parameters
    ----------
    couples : sequence of Couple, length n_c
    rates : Rates
    J : ndarray, shape (L, 6, n_v)
        Twist of each link at the world's origin, per unit of delta_q [m, rad].
    quarters : bool
        Whether the friction cone is the same after a quarter turn about n.

    Yields
    ------
    int
        The contact.
    kind, says : str
        A name of :mod:`~quasistatic_ref.optional.derivatives.step.reason`, and what it is, after
        the contact's name.
    """
    switching = _switching(np.array([c.n for c in couples]).reshape(-1, 3), rates.n, quarters)
    for j, couple in enumerate(couples):
        if couple.phi >= FILLED:
            continue  # it stands for nothing
        if couple.crosses:
            yield j, reason.CROSSING, "is where edges cross: its derivative is not computed"
            continue
        if rates.level_rim[j]:
            yield j, reason.RIM, "is on a rim that is level: no point of it is lowest"
        if depth_tie(couple):
            yield j, reason.SURFACES, "is as deep below another surface"
        if not rates.unique[j]:
            yield j, *_not_unique(couple)
        elif couple.at_an_end and not rates.slides[j]:
            yield j, *_at_an_end(couple, J)
        if switching[j]:
            says = "has two axes that are as far from its normal: its tangents jump"
            yield j, reason.TANGENTS, says


def _not_unique(couple: Couple) -> tuple[str, str]:
    if dependent(couple.features):
        return PARALLEL
    if abs(couple.phi) <= UNIQUE * couple.reach:
        return reason.NO_NORMAL, "touches where neither surface has a normal"
    return reason.MANY, "is at a surface's centre of curvature"


def _at_an_end(couple: Couple, J: Array) -> tuple[str, str]:
    """A point on the rim of a feature: a kink, or a jump if its neighbour has no unique point."""
    if couple_rates([couple.merged], J).unique[0]:
        return reason.FEATURE, "is where a vertex, an edge or a face of a shape ends"
    return PARALLEL


def _switching(n: Array, d_n: Array, quarters: bool) -> Mask:
    """Whether another axis is as far from n (n_c, 3), and n moves so that it matters, (n_c,).

    Where n is along an axis the frames of the two others are quarter turns of each other.
    """
    size = np.sort(np.abs(n), axis=1)
    tied = np.abs(n) - size[:, :1] <= TIED
    count = np.count_nonzero(tied, axis=1)
    if quarters:
        count[(size[:, 1] <= TIED) & (count == 2)] = 1
    turns = np.where(tied[:, :, None], np.abs(d_n), 0.0).max(axis=(1, 2), initial=0.0)
    return np.asarray((count > 1) & (turns > TIED))
