"""How far a body may fall before it touches, and whether something else holds it."""

from collections.abc import Collection

import numpy as np

from quasistatic_ref.contact.distance import in_world
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.shape_in_world import ShapeInWorld, moved
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.optional.doctor.start import Start, body, free_bases
from quasistatic_ref.shapes.placed_shape import PointCloud
from quasistatic_ref.step.data import Array, Extra
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


def held(start: Start, loose: Collection[str]) -> set[str]:
    """Those of some free bodies that rows of an extension hold, as welds and taut tendons do.

    A body is held if it cannot sink by NEAR: not even while other bodies that are `loose`, and
    links on sliding joints without an actuator, are shifted along with it. Then a chain of rows
    joins it to the world, to what is actuated, or to a body that lies on something.

    Parameters
    ----------
    start : Start
    loose : collection of str
        Free bodies that no contact bears.
    """
    extension = start.simulator.extension
    rows = None if extension is None else extension(start.q_start).rows
    if rows is None or not len(rows.A) or not start.g or not loose:
        return set()
    system = start.system
    bases = free_bases(system)
    resting = {base.name for name, base in bases.items() if name not in loose}
    shifts = [
        i
        for joint in system.joints
        if not joint.actuated and joint.name not in resting
        for i in range(joint.v.start, joint.v.start + joint.lengths)
    ]
    return {name for name in loose if _sinks(start, rows, shifts, bases[name]) <= NEAR}


def _sinks(start: Start, rows: Extra, shifts: list[int], base: Joint) -> float:
    """How far rows let a body sink, at most 2 NEAR, while all `shifts` are free [m]."""
    from scipy.optimize import linprog  # takes as long as a short run

    system = start.system
    name = base.name.removesuffix("/base")
    link = next(i for i, of in enumerate(system.links) if of.startswith(f"{name}/"))
    columns = slice(base.v.start, base.v.start + base.lengths)
    way = start.gravity / start.g
    down = np.zeros(system.n_v)
    down[columns] = np.linalg.lstsq(start.kinematics.J[link][:3, columns], way, rcond=None)[0]
    others = [i for i in shifts if not columns.start <= i < columns.stop]
    motion = np.column_stack([down, np.eye(system.n_v)[:, others]])  # in units of NEAR
    best = linprog(
        [-1.0, *np.zeros(len(others))],
        A_ub=-rows.A @ motion,
        b_ub=-np.minimum(rows.b, 0.0) / NEAR,  # a row that is violated lets nothing sink
        bounds=[(0.0, 2.0), *[(None, None)] * len(others)],
    )
    return np.inf if best.x is None else NEAR * float(best.x[0])
