"""Where bodies are at the start: on what does not bear them, or in each other."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.optional.doctor.frame.hulls import farthest_points, hull_of
from quasistatic_ref.optional.doctor.frame.start import Start, least, least_mean, table
from quasistatic_ref.optional.doctor.frame.tolerances import SUNK
from quasistatic_ref.optional.doctor.texts import distance, finding
from quasistatic_ref.parts import part
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.half_space import HalfSpace
from quasistatic_ref.shapes.placed_shape import PointCloud
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


def inside(start: Start) -> Iterator[Finding]:
    """A driven shape that starts inside of something free without touching it."""
    touching = {
        frozenset((pair.alpha.link, pair.beta.link))
        for pair, of_pair in start.slices
        if start.points.phi[of_pair].min() <= SUNK * least(pair)
    }
    solids = [side for side in start.sides if not isinstance(side.shape, PointCloud)]
    clouds = {side.link for side in start.sides} - {side.link for side in solids}
    driven = {side.link: side for side in solids if start.driven[side.link]}
    R, t = start.kinematics.R, start.kinematics.t
    for link, name, shapes in start.free_links if driven else ():
        hull = hull_of(shapes) if link in clouds or len(shapes) > 1 else None
        for other, side in driven.items():
            if hull is None or {link, other} in touching:
                continue
            middle = R[other] @ farthest_points(side).mean(axis=0) + t[other]
            depth = -float(hull.signed_distance((middle - t[link])[None] @ R[link])[0][0])
            if depth > 0:
                cause = f"the middle of {side.name} is {distance(depth)} inside the hull of {name}"
                cause += f", and {side.name} touches no part of {name}: what is between the points "
                cause += "or shapes of a body is empty"
                remedy = f"start {side.name} outside of {name}"
                yield finding("starts-inside", cause, remedy, side.name, depth_mm=1e3 * depth)
