"""Shapes whose faces are flush: their seam stops what slides from one to the other.

Where a flat face slides on one shape towards another that is flush with it, the closest points of
the two lie in the plane of the faces, and so does their normal. The gap along it must not close.
Where it is none, an edge lies on an edge, and the normal, which any between the plane's and this
one might be, is midway. So no force that the body's weight bears moves it over the seam.
"""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.start import SHORT, Start, least, slices
from quasistatic_ref.shapes.half_space import HalfSpace
from quasistatic_ref.shapes.placed_shape import PlacedShape, PointCloud
from quasistatic_ref.simulate.finding import Finding

ACROSS = 0.1
"""Part of a normal along a face that counts [-]."""
COUNTS = 1e-3
"""Force that counts, over the one that bears the body [-]."""


class Side(NamedTuple):
    """A pair of shapes as seen from one of its two links.

    Parameters
    ----------
    pair : ContactPair
    at : slice
        Where its contacts are among all.
    link : int
    other : PlacedShape
        What the link touches.
    normals, places : ndarray, shape (n, 3)
        Towards the link [-], and points of the other shape [m], of the contacts that count.
    """

    pair: ContactPair
    at: slice
    link: int
    other: PlacedShape
    normals: Array
    places: Array


def flush(start: Start) -> Iterator[Finding]:
    """Before a run: what lies on one shape, from which a flush one is at most its size apart."""
    points = start.points
    if points is None or isinstance(start, Run):
        return
    bears = start.touching(points.phi)
    for on in _sides(slices(start.pairs), points, bears):
        for ahead in _sides(start.pairs_of[start.body(on.link)], points, ~bears):
            if _joined(ahead, on, start.kinematics):
                along = ahead.normals[0]
                reach = _reach(ahead.other, along, start.kinematics)
                apart = -_reach(on.other, -along, start.kinematics) - reach
                if apart <= least(ahead.pair):
                    yield _finding(start, ahead, on, "and will stop at the seam", {})
                    return


def pushed_back(run: Run) -> Iterator[Finding]:
    """After a run: the pair that pushes a body most along the face on which the body lies."""
    f_n = run["wrench"][:, :, 2]
    most = [(float(f_n[:, at].max(initial=0.0)), pair, at) for pair, at in slices(run.pairs)]
    for force, pair, at in sorted((x for x in most if x[0] > 0), key=lambda x: -x[0]):
        k = int(f_n[:, at].max(axis=1).argmax())
        presses = f_n[k] > COUNTS * force
        points = run.points_of(k)
        for ahead in _sides([(pair, at)], points, presses):
            for on in _sides(run.pairs_of[run.body(ahead.link)], points, presses):
                if on.pair is ahead.pair or force <= COUNTS * f_n[k, on.at].max():
                    continue
                if _joined(ahead, on, run.system.kinematics(run["q"][k])):
                    forces = f_n[k, at][presses[at]]
                    along = float(np.linalg.norm(forces @ _along(ahead, on)))
                    how = f"and their seam pushes it back with {along:.3g} N in step {k}"
                    yield _finding(run, ahead, on, how, {"along_N": along, "step": k})
                    return


def _finding(start: Start, ahead: Side, on: Side, how: str, numbers: dict[str, float]) -> Finding:
    name = start.body(ahead.link)
    one, other = on.other.name, ahead.other.name
    cause = f"{name} lies on {one}, with which {other} is flush, {how}: closest points at an edge "
    cause += "of this face have a normal along it"
    remedy = f"make {one} and {other} one shape, or set {other} 10 um lower"
    return Finding("flush-shapes", False, remedy, cause, numbers, name)


def _sides(
    pairs: Iterable[tuple[ContactPair, slice]], points: ClosestPoints, counts: Mask
) -> Iterator[Side]:
    """Both sides of each pair that has a contact which counts."""
    for pair, at in pairs:
        of = at.start + np.flatnonzero(counts[at])
        if not of.size:
            continue
        n = points.n[of]
        if pair.beta.link:
            yield Side(pair, at, pair.beta.link, pair.alpha, n, points.alpha[of])
        if pair.alpha.link:
            yield Side(pair, at, pair.alpha.link, pair.beta, -n, points.beta[of])


def _joined(ahead: Side, on: Side, kinematics: Kinematics) -> bool:
    """Whether the face under a body goes on to the shape that pushes along the face."""
    if ahead.link != on.link or ahead.other == on.other:
        return False
    if isinstance(ahead.other.shape, HalfSpace | PointCloud):
        return False
    up = on.normals[0]
    height = float(up @ on.places[0])
    near = SHORT * least(ahead.pair)
    along = np.linalg.norm(_along(ahead, on), axis=1)
    level = np.abs(ahead.places @ up - height).max() <= near
    return bool(
        along.min() > ACROSS and level and _reach(ahead.other, up, kinematics) <= height + near
    )


def _along(ahead: Side, on: Side) -> Array:
    """What of normals is along the face on which a body lies, shape (n, 3) [-]."""
    up = on.normals[0]
    return ahead.normals - np.outer(ahead.normals @ up, up)


def _reach(placed: PlacedShape, along: Array, kinematics: Kinematics) -> float:
    """How far a shape reaches along a unit vector of the world [m]."""
    in_link = along @ kinematics.R[placed.link]
    from_origin = placed.shape.support_value((in_link @ placed.R)[None])[0]
    return float(from_origin + in_link @ placed.t + along @ kinematics.t[placed.link])
