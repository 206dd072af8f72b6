"""Faces that rest on fewer points than hold them."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints, closest_points
from quasistatic_ref.contact.jacobian import tangents
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import ContactError
from quasistatic_ref.optional.doctor.start import (
    Start,
    bodies,
    body,
    free_bases,
    least,
    more_points,
    slices,
)
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.step.data import Array
from quasistatic_ref.tolerances import REPEATED, SUNK

UPWARDS = 0.5
"""Cosine of the steepest normal that counts as bearing weight [-]."""
MOST = 1000
"""Candidates of a pair that are looked at."""
ROUNDING = 1e-6
"""Angle [rad] by which a centre of mass is over an edge."""


def few_points(start: Start) -> Iterator[Finding]:
    """Bodies whose centre is over the points of their faces, and not over the k that are kept."""
    points = start.points
    if not start.g or points is None:
        return
    for name in free_bases(start.system):
        own = [(p, at) for p, at in slices(start.pairs) if name in bodies(start.system, p)]
        if all(pair.n_c == pair.candidates for pair, _ in own):
            continue
        each = [(pair, points.chosen(np.r_[at])) for pair, at in own]
        kept = [_bearing(start, pair, name, nearest) for pair, nearest in each]
        centre = _centre(start, name)
        of_kept = np.concatenate(kept)
        if _around(of_kept - centre, start):
            continue
        every = []
        for pair, _ in own:
            wider = replace(pair, k=max(pair.k, MOST))
            try:
                found = closest_points([wider], start.kinematics)
            except ContactError:
                return  # of a point that no step keeps
            every.append(_bearing(start, pair, name, found))
        of_all = np.concatenate(every)
        if _around(of_all - centre, start):
            more = [len(some) - len(few) for few, some in zip(kept, every, strict=True)]
            lacks = int(np.argmax(more))
            yield Finding(
                "too few points",
                True,
                more_points(start, own[lacks][0], len(every[lacks])),
                f"{name} lies flat on {len(of_all)} points, of which {len(of_kept)} are kept, and "
                "its centre of mass is not over these: it tips",
                {"points": len(of_all), "kept": len(of_kept)},
            )


def _bearing(start: Start, pair: ContactPair, name: str, points: ClosestPoints) -> Array:
    """Those of a pair's nearest points that are level and bear a body, shape (N, 3).

    None of a pair that is apart, as a body in a gripper is from the floor.
    """
    up = -start.gravity / start.g
    above = 1 if body(start.system, pair.beta.link) == name else -1
    level = points.phi <= min(points.phi.min() + REPEATED, SUNK * least(pair))
    if not pair.has_cloud and level.sum() > 1:
        level &= points.point != pair.corners  # the closest pair lies between corners
    return np.asarray(points.beta[level & (above * (points.n @ up) > UPWARDS)])


def _centre(start: Start, name: str) -> Array:
    """Centre of mass of a body [m]."""
    system = start.system
    at = start.kinematics
    mass = np.where([link.startswith(f"{name}/") for link in system.links], system.masses, 0.0)
    places = at.t + np.einsum("lij,lj->li", at.R, system.centres)
    return np.asarray(mass @ places / mass.sum())


def _around(points: Array, start: Start) -> bool:
    """Whether points, seen along gravity, lie around the origin."""
    d1, d2 = (axis[0] for axis in tangents(start.gravity[None] / start.g))
    angles = np.sort(np.arctan2(points @ d2, points @ d1))
    if len(angles) < 3:
        return False
    gaps = np.diff(angles, append=angles[0] + 2 * np.pi)
    return bool(gaps.max() < np.pi - ROUNDING)
