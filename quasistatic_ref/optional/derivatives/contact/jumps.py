"""Which points that a pair leaves out a motion would bring in: where its contacts jump.

A point that is left out may be as near as the farthest of those that are kept. And of two solids
the candidates are the corners and the closest pair, which is left out where they span it. Where it
lies on parallel faces that overlap in more than corners, or where its feature ends, a motion makes
another point of it.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.derivatives.contact.contact_rates import couple_rates
from quasistatic_ref.optional.derivatives.contact.couples import Couple, PairInWorld
from quasistatic_ref.optional.derivatives.step import reason
from quasistatic_ref.optional.derivatives.tolerances import TIED
from quasistatic_ref.shapes.placed_shape import HalfSpace, Sphere
from quasistatic_ref.tolerances import REPEATED

LEVEL = 1e-11
"""Difference of heights, relative to the solid, at which corners are of one face."""


def jumps(
    kept: Sequence[Couple], points: ClosestPoints, J: Array
) -> Iterator[tuple[str, tuple[str, ...], str]]:
    """The jumps of the contacts of one pair.

    Parameters
    ----------
    kept : sequence of Couple
    points : ClosestPoints
        The same.
    J : ndarray, shape (L, 6, n_v)
        Twist of each link at the world's origin, per unit of delta_q [m, rad].

    Yields
    ------
    kind : str
        A name of :mod:`~quasistatic_ref.optional.derivatives.step.reason`.
    where : tuple of str
        Points, or the pair.
    sentence : str
    """
    of = kept[0].of
    pair = of.pair
    if pair.n_c >= pair.candidates or (pair.n_c == 1 and not pair.has_cloud):
        return  # all of them are kept, or the closest pair of two solids
    as_near = np.abs(of.search.rank - points.phi.max()) <= TIED * of.size
    tied = of.search.number[as_near]
    are_kept = np.isin(tied, points.point)
    if not are_kept.all():
        where = tuple(f"{pair.name}/{i}" for i in (*tied[are_kept], *tied[~are_kept]))
        says = f"{', '.join(where)} are as near as each other, and not all of them are kept"
        yield reason.POINTS, where, says
    if pair.has_cloud or pair.corners in points.point:
        return
    nearest = of.closest
    covered = _covered(of)
    if not nearest.at_an_end and (covered or couple_rates([nearest], J).unique[0]):
        return
    if couple_rates([nearest.merged], J).unique[0]:
        says = f"{pair.name} has a closest pair where a vertex, an edge or a face ends"
        yield reason.FEATURE, (pair.name,), says
    elif not covered:
        says = f"{pair.name} has parallel surfaces that overlap in more than corners"
        yield reason.MANY, (pair.name,), says


def _covered(of: PairInWorld) -> bool:
    """Whether the corners at the distance of the closest pair are all of a face, or edge."""
    a, b = of.bodies
    n = of.closest.n
    every = of.search.candidates
    level = every.phi <= of.closest.phi + REPEATED
    of_alpha = every.point < a.shape.corner_count
    of_beta = (every.point < of.pair.corners) & ~of_alpha
    for body, way, corners in ((a, n, of_alpha), (b, -n, of_beta)):
        whole = not isinstance(body.shape, HalfSpace | Sphere)
        if whole and np.count_nonzero(level & corners) >= _face_corners(body, way):
            return True
    return False


def _face_corners(body: ShapeInWorld, n: Array) -> int:
    """How many corners a solid has farthest along n (3,), of a disc and a round surface one."""
    way = body.R.T @ n
    corners, _ = body.shape.corners(way)
    height = corners @ way
    level = height >= height.max(initial=-np.inf) - LEVEL * np.abs(corners).max(initial=0.0)
    count = int(np.count_nonzero(level))
    on_disc = body.shape.rim_radius is not None and count > 2
    return 1 if on_disc else max(1, count)
