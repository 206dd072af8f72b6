"""How far a body may fall before it touches, and whether something else holds it."""

import numpy as np

from quasistatic_ref.contact.distance import in_world
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.shape_in_world import ShapeInWorld, moved
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.optional.doctor.start import Start, body, free_bases
from quasistatic_ref.shapes.placed_shape import PointCloud
from quasistatic_ref.step.data import Array
from quasistatic_ref.tolerances import NEAR

ROUNDS = 100
"""Advances until a falling body touches; corners take one, round surfaces some ten."""
CLOSE = 1e-9
"""Gap that counts as none [m]."""
LEVEL = 1e-9
"""Cosine between a fall and a normal up to which the fall goes past a surface [-]."""


def fall(start: Start, pair: ContactPair, name: str) -> float:
    """How far a body falls along gravity until a pair touches; infinity if it falls past [m].

    Of convex bodies the gap along their normal shrinks by as much as they come nearer along it, and
    they do not touch before it is closed: they are moved by that, and have a new normal, until they
    touch or the normal no longer faces the fall.

    Raises
    ------
    ContactError
        If the pair has no trustworthy normal on the way.
    """
    a, b = in_world(pair, start.kinematics.R, start.kinematics.t)
    way = start.gravity / start.g
    falling, other = (b, a) if body(start.system, pair.beta.link) == name else (a, b)
    if isinstance(falling.shape, PointCloud):
        points = moved(np.column_stack([falling.R, falling.t]), falling.shape.points)
        return _of_points(other, points, way)
    if isinstance(other.shape, PointCloud):
        points = moved(np.column_stack([other.R, other.t]), other.shape.points)
        return _of_points(falling, points, -way)
    far = 0.0
    for _ in range(ROUNDS):
        here = falling._replace(t=falling.t + far * way)
        near = solid_pair(pair.name, other, here)  # n is out of the other
        nearer = -float(near.n @ way)
        if near.phi <= CLOSE:
            break
        if nearer <= LEVEL:
            return np.inf
        far += near.phi / nearer
    return far


def _of_points(solid: ShapeInWorld, points: Array, way: Array) -> float:
    """The least way of some points until one touches a solid."""
    far = np.zeros(len(points))
    left = np.arange(len(points))
    for _ in range(ROUNDS):
        x = points[left] + far[left, None] * way
        phi, normal = solid.shape.signed_distance((x - solid.t) @ solid.R)
        nearer = -(normal @ solid.R.T) @ way
        past = (phi > CLOSE) & (nearer <= LEVEL)
        far[left[past]] = np.inf
        on_way = (phi > CLOSE) & ~past
        if not on_way.any():
            break
        left = left[on_way]
        far[left] += phi[on_way] / nearer[on_way]
    return float(far.min())


def held(start: Start) -> set[str]:
    """Free bodies that rows of an extension hold, as welds, connects and taut tendons do.

    Such a row keeps a body from falling by more than NEAR, and joins it to the world, to what is
    actuated, or to another body that is held.
    """
    extension = start.simulator.extension
    rows = None if extension is None else extension(start.q_start).rows
    if rows is None or not start.g:
        return set()
    system = start.system
    columns = {
        name: np.array([i for i, c in enumerate(system.coordinates) if c.joint == base.name])
        for name, base in free_bases(system).items()
    }
    joins: list[tuple[str, set[str], bool]] = []
    for name, own in columns.items():
        down = np.zeros(system.n_v)
        link = next(i for i, of in enumerate(system.links) if of.startswith(f"{name}/"))
        motion = np.concatenate([start.gravity / start.g, np.zeros(3)])
        down[own] = np.linalg.lstsq(start.kinematics.J[link][:, own], motion, rcond=None)[0]
        falls = rows.A @ down
        holds = (falls < 0) & (-rows.b <= -NEAR * falls)
        for row in rows.A[holds]:
            moves = set(np.flatnonzero(row).tolist()) - set(own.tolist())
            others = {other for other, at in columns.items() if moves & set(at.tolist())} - {name}
            joins.append((name, others, not others or min(moves, default=0) < system.n_a))
    borne: set[str] = set()
    while more := {name for name, others, fixed in joins if fixed or others & borne} - borne:
        borne |= more
        joins += [(other, {name}, False) for name, others, _ in joins for other in others]
        joins = [one for one in joins if one[0] not in borne]
    return borne
