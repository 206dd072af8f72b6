"""Faces that rest on fewer points than hold them, and points of a cloud that are no part of it."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from quasistatic_ref.contact.all_pairs import closest_points
from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.jacobian import tangents
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import ContactError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.doctor.start import (
    Start,
    least,
    more_points,
)
from quasistatic_ref.optional.doctor.tolerances import SUNK
from quasistatic_ref.optional.doctor.undecided import Undecided, failure
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.tolerances import REPEATED

UPWARDS = 0.5
"""Cosine of the steepest normal that counts as bearing weight [-]."""
MOST = 1000
"""Candidates of a pair that are looked at."""
ROUNDING = 1e-6
"""Angle [rad] by which a centre of mass is over an edge."""


def few_points(start: Start) -> Iterator[Finding | Undecided]:
    """Bodies whose centre lies over their faces' points, but not over the k kept points."""
    points = start.points
    if not start.g or points is None:
        return
    for name in start.free_bases:
        of_body = start.pairs_of.get(name, [])
        if all(pair.n_c == pair.candidates for pair, _ in of_body):
            continue
        each = [(pair, points.chosen(np.r_[at])) for pair, at in of_body]
        kept = [_bearing(start, pair, name, nearest) for pair, nearest in each]
        middle = start.centre(name)
        of_kept = np.concatenate(kept)
        if _around(of_kept - middle, start):
            continue
        every = []
        try:
            for pair, _ in of_body:
                wider = replace(pair, k=max(pair.k, MOST))
                all_points = closest_points([wider], start.kinematics)
                every.append(_bearing(start, pair, name, all_points))
        except ContactError as error:  # of a point that no step keeps
            yield Undecided(f"points of faces of {name}", failure(error))
            continue
        of_all = np.concatenate(every)
        if _around(of_all - middle, start):
            more = [len(some) - len(few) for few, some in zip(kept, every, strict=True)]
            lacks = int(np.argmax(more))
            yield Finding(
                "too-few-points",
                True,
                more_points(start, of_body[lacks][0], len(every[lacks])),
                f"{name} lies flat on {len(of_all)} points, of which {len(of_kept)} are kept, and "
                "its centre of mass is not over these: it tips",
                {"points": len(of_all), "kept": len(of_kept)},
            )


def _bearing(start: Start, pair: ContactPair, name: str, points: ClosestPoints) -> Array:
    """Points of a pair that, equally near, bear a body from below, shape (N, 3) [m].

    None of a pair that is apart, as a body in a gripper is from the floor.
    """
    up = -start.gravity / start.g
    above = 1 if start.body(pair.beta.link) == name else -1
    level = points.phi <= min(points.phi.min() + REPEATED, SUNK * least(pair))
    if not pair.has_cloud and level.sum() > 1:
        level &= points.point != pair.corners  # the closest pair lies between corners
    return np.asarray(points.beta[level & (above * (points.n @ up) > UPWARDS)])


def _around(points: Array, start: Start) -> bool:
    """Whether points, seen along gravity, lie around the origin."""
    d1, d2 = (axis[0] for axis in tangents(start.gravity[None] / start.g))
    angles = np.sort(np.arctan2(points @ d2, points @ d1))
    if len(angles) < 3:
        return False
    gaps = np.diff(angles, append=angles[0] + 2 * np.pi)
    return bool(gaps.max() < np.pi - ROUNDING)
