"""Faces that rest on fewer points than hold them."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from quasistatic_ref.contact.all_pairs import closest_points
from quasistatic_ref.contact.closest_points import ClosestPoints
from quasistatic_ref.contact.jacobian import tangents
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.doctor.frame.start import Start, least, more_points
from quasistatic_ref.optional.doctor.frame.tolerances import SUNK
from quasistatic_ref.optional.doctor.frame.undecided import LARGE, Undecided
from quasistatic_ref.optional.doctor.texts import finding
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.tolerances import REPEATED

UPWARDS = 0.5
"""Cosine of the steepest normal that counts as bearing weight [-]."""
MOST_CANDIDATES = 1000
"""Candidates of a pair that are looked at."""
ROUNDING = 1e-6
"""Angle [rad] by which a centre of mass is over an edge."""


def few_points(start: Start) -> Iterator[Finding | Undecided]:
    """Bodies whose centre lies over their faces' points, but not over the k kept points."""
    if not start.small:
        yield Undecided("points of faces", LARGE)
        return
    for name in start.free_bases if start.g else ():
        of_body = start.pairs_of.get(name, [])
        if all(pair.n_c == pair.candidates for pair, _ in of_body):
            continue
        each = [(pair, start.points.chosen(np.r_[at])) for pair, at in of_body]
        kept = [_bearing(start, pair, name, nearest) for pair, nearest in each]
        if _around(start, name, kept):
            continue
        wider = [replace(pair, k=max(pair.k, MOST_CANDIDATES)) for pair, _ in of_body]
        every = [_bearing(start, x, name, closest_points([x], start.kinematics)) for x in wider]
        if _around(start, name, every):
            counts, more = (np.array([len(x) for x in points]) for points in (kept, every))
            lacks = int(np.argmax(more - counts))
            remedy = more_points(start, of_body[lacks][0], int(more[lacks]))
            numbers = {"points": more.sum(), "kept": counts.sum()}
            cause = f"{name} lies flat on {more.sum()} points, of which {counts.sum()} are kept, "
            cause += "and its centre of mass is not over these: it tips"
            yield finding("too-few-points", cause, remedy, **numbers)


def _bearing(start: Start, pair: ContactPair, name: str, points: ClosestPoints) -> Array:
    """Points of a pair that, equally near, bear a body from below, shape (N, 3) [m].

    None of a pair that is apart, as a body in a gripper is from the floor.
    """
    below = -1 if start.body(pair.beta.link) == name else 1
    level = points.phi <= min(points.phi.min() + REPEATED, SUNK * least(pair))
    if not pair.has_cloud and level.sum() > 1:
        level &= points.point != pair.corners  # the closest pair lies between corners
    return np.asarray(points.beta[level & (below * (points.n @ start.down) > UPWARDS)])


def _around(start: Start, name: str, bearing: list[Array]) -> bool:
    """Whether points, seen along gravity, lie around a body's centre of mass."""
    system, at = start.system, start.kinematics
    mass = system.masses * [start.body(link) == name for link in range(len(system.links))]
    centre = mass @ (at.t + np.einsum("lij,lj->li", at.R, system.centres)) / mass.sum()
    d1, d2 = (axis[0] for axis in tangents(start.down[None]))
    points = np.concatenate(bearing) - centre
    angles = np.sort(np.arctan2(points @ d2, points @ d1))
    if len(angles) < 3:
        return False
    gaps = np.diff(angles, append=angles[0] + 2 * np.pi)
    return bool(gaps.max() < np.pi - ROUNDING)
