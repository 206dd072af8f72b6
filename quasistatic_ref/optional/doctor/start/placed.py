"""Where bodies are at the start: on what does not bear them, or in each other."""

from collections.abc import Iterator
from functools import cache

import numpy as np

from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.ordered import rotated
from quasistatic_ref.optional.doctor.frame.hulls import (
    corners_of,
    farthest_points,
    hull_of,
    surely_outside,
)
from quasistatic_ref.optional.doctor.frame.run import Run
from quasistatic_ref.optional.doctor.frame.start import Start, least, least_mean, table
from quasistatic_ref.optional.doctor.frame.tolerances import SUNK
from quasistatic_ref.optional.doctor.texts import distance, finding
from quasistatic_ref.parts import part
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.half_space import HalfSpace
from quasistatic_ref.shapes.placed_shape import PlacedShape, PointCloud
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.simulator import StandingsOf
from quasistatic_ref.tolerances import SAME_NORMAL

BEARING = 0.1
"""Cosine of the steepest surface that may bear a body [-]: 84 degrees."""


def gravity(start: Start) -> Iterator[Finding]:
    """A body on the world that neither gravity presses down nor friction holds at the start.

    What opposite sides touch no direction of gravity would press there: it is none.
    """
    points = start.points
    near = points.phi <= SUNK * start.sizes
    world = np.array(["world" in start.bodies(pair) for pair in start.pairs], dtype=bool)
    for name in start.free_bases if start.g else ():
        on = start.of_body(name) & near
        if not on.any() or not world[start.pair_of[on]].all():
            continue
        up = -start.signs(name)[on] * (points.n[on] @ start.down)
        clamped = up.max() < BEARING and least_mean(points.n[on]) <= SAME_NORMAL
        if up.max() >= BEARING or clamped or _stands(start, name):
            continue
        pair = start.pairs[start.pair_of[on][0]]
        x, y, z = start.gravity.tolist()
        planes = [x for x in (pair.alpha, pair.beta) if isinstance(x.shape, HalfSpace)]
        normals = "".join(f" or the normal of {plane.name}" for plane in planes)
        cause = f"gravity is ({x:g}, {y:g}, {z:g}) m/s^2, and does not press {name} on what it "
        cause += f"lies on, {pair.name}"
        remedy = f"check the direction of gravity{normals}"
        yield finding("gravity", cause, remedy, upwards=up[0])


def _stands(start: Start, name: str) -> bool:
    """Whether a body would stay at the start, under the loads that are there."""
    stands: StandingsOf = part("stands")
    q = start.q_start
    load = start.load_at_start - start.simulator.generalised_force(q, None)
    rows = stands(start.simulator, q, q[: start.system.n_q_a], load, "off")
    return any(row.body == name and row.stands for row in rows)


def penetration(start: Start) -> Iterator[Finding]:
    """The deepest pair of each contact table, if it is deep for its smaller shape."""
    deepest: dict[str, tuple[float, int]] = {}
    for i, (pair, of_pair) in enumerate(start.slices):
        depth = -float(start.points.phi[of_pair].min())
        name = table(start, pair)
        if depth > max(SUNK * least(pair), deepest.get(name, (0.0, 0))[0]):
            deepest[name] = depth, i
    for depth, i in deepest.values():
        pair = start.pairs[i]
        sides = pair.alpha, pair.beta
        meshes = " and ".join(x.name for x in sides if isinstance(x.shape, ConvexMesh))
        hull = f", by the hull of {meshes}" if meshes else ""
        cause = f"{pair.name} is {distance(depth, 4)} deep at the start{hull}; a step undoes that "
        cause += f"at once, with {depth / start.h**2:.3g} N for each kilogram"
        remedy = f"start {pair.alpha.name} and {pair.beta.name} {distance(depth, 4)} farther apart"
        if meshes:
            remedy += f", or split the mesh of {meshes}, if it is not convex"
        yield finding("initial-penetration", cause, remedy, depth_mm=1e3 * depth)


EMPTY = "what is between the points or shapes of a body is empty"


def inside(start: Start) -> Iterator[Finding]:
    """A driven shape that starts inside of something free without touching it."""
    phi = np.array([start.points.phi[of_pair].min() for _, of_pair in start.slices])
    for side, name, depths in _depths(start, start.q_start[None], phi[None]):
        if depths[0] > 0:
            cause = (
                f"the middle of {side.name} is {distance(depths[0])} inside the hull of {name}, "
            )
            cause += f"and {side.name} touches no part of {name}: {EMPTY}"
            remedy = f"start {side.name} outside of {name}"
            yield finding("starts-inside", cause, remedy, side.name, depth_mm=1e3 * depths[0])


def comes_inside(run: Run) -> Iterator[Finding]:
    """A driven shape that a step leaves inside of something free which it has not touched."""
    last = run.simulator.closest_points(run.system.kinematics(run["q"][-1])).phi
    phi = np.vstack([run.nearest, [last[of_pair].min() for _, of_pair in run.slices]])
    for side, name, depths in _depths(run, run["q"], phi):
        k = int((depths > 0).argmax())
        if k > 0:
            cause = (
                f"the middle of {side.name} comes {distance(depths[k])} into the hull of {name} "
            )
            cause += f"in step {k - 1}, and {side.name} touches no part of {name}: {EMPTY}"
            remedy = f"keep {side.name} outside of {name}, or give {name} points or a solid there"
            numbers = {"depth_mm": 1e3 * depths[k], "step": k - 1}
            yield finding("passes-through", cause, remedy, side.name, False, **numbers)


def _depths(start: Start, q: Array, nearest: Array) -> Iterator[tuple[PlacedShape, str, Array]]:
    """How deep middles of driven shapes are in hulls of free links that they have not touched.

    Parameters
    ----------
    start : Start
    q : ndarray, shape (K, n_q)
        Some states.
    nearest : ndarray, shape (K, pairs)
        Least distance of each pair there [m].

    Yields
    ------
    side, name : PlacedShape, str
        The shape, and the link.
    depths : ndarray, shape (K,)
        [m]; not above 0 from where they touch.
    """
    solids = [side for side in start.sides if not isinstance(side.shape, PointCloud)]
    clouds = {side.link for side in start.sides} - {side.link for side in solids}
    driven = {side.link: side for side in solids if start.driven[side.link]}
    links = start.free_links if driven else ()
    hollow = [one for one in links if one[0] in clouds or len(one[2]) > 1]
    if not hollow:
        return
    touched = nearest <= [SUNK * least(pair) for pair in start.pairs]
    poses = cache(lambda k: start.system.kinematics(q[k]))
    for link, name, shapes in hollow:
        corners = corners_of(shapes)
        hull: ConvexMesh | None = None
        for other, side in driven.items():
            joined = [{link, other} == {x.alpha.link, x.beta.link} for x in start.pairs]
            apart = np.flatnonzero(~np.logical_or.accumulate(touched[:, joined].any(axis=1)))
            middle = farthest_points(side).mean(axis=0)
            each = [_seen(poses(k), link, other, middle) for k in apart.tolist()]
            seen = np.reshape(each, (-1, 3))
            inside = ~surely_outside(seen, corners)
            hull = hull or (hull_of(shapes) if inside.any() else None)
            depths = np.zeros(len(q))
            if hull is not None:
                depths[apart[inside]] = -hull.signed_distance(seen[inside])[0]
            yield side, name, depths


def _seen(at: Kinematics, link: int, other: int, point: Array) -> Array:
    """A point of another link's frame in a link's, both (3,) [m]."""
    world = rotated(at.R[other], point) + at.t[other]
    return rotated(at.R[link].T, world - at.t[link])
