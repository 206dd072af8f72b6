"""Where bodies are at the start: free ones that nothing bears, and some that are in each other."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import ContactError
from quasistatic_ref.optional.doctor.contradictions import farthest_points, hull_of
from quasistatic_ref.optional.doctor.start import (
    Start,
    joining,
    least,
    least_mean,
    slices,
    table,
)
from quasistatic_ref.optional.doctor.telling import distance
from quasistatic_ref.optional.doctor.tolerances import NEAR, SUNK
from quasistatic_ref.optional.doctor.undecided import Undecided, failure
from quasistatic_ref.optional.doctor.unsupported import fall, held, sinks
from quasistatic_ref.parts import part
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.half_space import HalfSpace
from quasistatic_ref.shapes.placed_shape import PointCloud
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.simulator import StandingsOf
from quasistatic_ref.text.quoting import listed
from quasistatic_ref.tolerances import SAME_NORMAL

BEARING = 0.1
"""Cosine of the steepest surface that may bear a body [-]: 84 degrees."""


def gravity(start: Start) -> Iterator[Finding]:
    """A body on the world that neither gravity presses down nor friction holds at the start."""
    for name, of_body in _contacts(start):
        near = [x for x in of_body if x[1] <= SUNK * least(x[0])]
        world = [x for x in near if "world" in start.bodies(x[0])]
        if not world or len(world) < len(near) or max(up for *_, up in near) >= BEARING:
            continue
        if _clamped(start, name):
            continue
        if not _stands(start, name):
            pair, _, up = world[0]
            x, y, z = start.gravity
            planes = [x for x in (pair.alpha, pair.beta) if isinstance(x.shape, HalfSpace)]
            yield Finding(
                "gravity",
                True,
                " or ".join(
                    ["check the direction of gravity", *(f"the normal of {x.name}" for x in planes)]
                ),
                f"gravity is ({x:g}, {y:g}, {z:g}) m/s^2, and does not press {name} on what it "
                "lies on, "
                f"{pair.name}",
                {"upwards": up},
            )


def in_the_air(start: Start) -> Iterator[Finding | Undecided]:
    """A body that touches nothing at the start, and its height over what should bear it.

    Its height is the shortest move along gravity until a pair of it touches (``unsupported.fall``).
    """
    loose = {
        name: of_body
        for name, of_body in _contacts(start)
        if all(gap > max(NEAR, SUNK * least(pair)) for pair, gap, _ in of_body)
    }
    holds = held(start, loose)
    for name in [x for x in loose if x not in holds and sinks(start, x)]:
        try:
            falls = [(pair, fall(start, pair, name)) for pair, *_ in loose[name]]
        except ContactError as error:  # of a pose that no step has
            yield Undecided(f"the fall of {name}", failure(error))
            continue
        pair, gap = min(falls, key=lambda x: x[1])
        if np.isfinite(gap):
            height = distance(gap, 4)
            yield Finding(
                "starts-in-the-air",
                True,
                f"lower {name} by {height}, or check its origin",
                f"{name} starts in the air, {height} above what may bear it ({pair.name})",
                {"gap_mm": 1e3 * gap},
            )
        else:
            yield Finding(
                "unsupported-body",
                True,
                joining(start, f"{name} and what should bear it"),
                f"nothing that may touch {name} is below it: it falls past "
                f"{listed(sorted({pair.name for pair, _ in falls}))}",
                {"pairs": len(falls)},
            )


def penetration(start: Start) -> Iterator[Finding]:
    """The deepest pair of each contact table, if it is deep for its smaller shape."""
    deepest: dict[str, Finding] = {}
    if start.points is None:
        return
    for pair, of_pair in slices(start.pairs):
        depth = -float(start.points.phi[of_pair].min(initial=0.0))
        name = table(start, pair)
        deeper = name not in deepest or 1e3 * depth > deepest[name].numbers["depth_mm"]
        if depth > SUNK * least(pair) and deeper:
            overlap = distance(depth, 4)
            remedy = f"start {pair.alpha.name} and {pair.beta.name} {overlap} farther apart"
            cause = f"{pair.name} is {overlap} deep at the start"
            meshes = [s.name for s in (pair.alpha, pair.beta) if isinstance(s.shape, ConvexMesh)]
            if meshes:
                remedy += f", or split the mesh of {listed(meshes)}, if it is not convex"
                cause += f", by the hull of {listed(meshes)}"
            deepest[name] = Finding(
                "initial-penetration",
                True,
                remedy,
                f"{cause}; a step undoes that at once, with {depth / start.h**2:.3g} N for "
                "each kilogram",
                {"depth_mm": 1e3 * depth},
            )
    yield from deepest.values()


def inside(start: Start) -> Iterator[Finding]:
    """A driven shape that starts inside of something free without touching it."""
    if start.points is None:
        return
    touching = {
        frozenset((pair.alpha.link, pair.beta.link))
        for pair, of_pair in slices(start.pairs)
        if start.points.phi[of_pair].min() <= SUNK * least(pair)
    }
    solids = [side for side in start.sides if not isinstance(side.shape, PointCloud)]
    clouds = {side.link for side in start.sides} - {side.link for side in solids}
    driven = {side.link: side for side in solids if start.driven[side.link]}
    R, t = start.kinematics.R, start.kinematics.t
    for link, name, shapes in start.free_links:
        hull = hull_of(shapes) if link in clouds or len(shapes) > 1 else None
        for other, side in driven.items():
            if hull is None or frozenset((link, other)) in touching:
                continue
            middle = R[other] @ farthest_points(side).mean(axis=0) + t[other]
            depth = -float(hull.signed_distance((middle - t[link])[None] @ R[link])[0][0])
            if depth > 0:
                yield Finding(
                    "starts-inside",
                    False,
                    f"start {side.name} outside of {name}",
                    f"the middle of {side.name} is {distance(depth)} inside of the hull of "
                    f"{name}, none of "
                    "which it touches: what is between the points or shapes of a body is empty",
                    {"depth_mm": 1e3 * depth},
                    side.name,
                )


def _stands(start: Start, name: str) -> bool:
    """Whether a body would stay at the start, under the loads that are there."""
    stands: StandingsOf = part("stands")
    q = start.q_start
    load = start.load_at_start - start.simulator.generalised_force(q, None)
    rows = stands(start.simulator, q, q[: start.system.n_q_a], load, "off")
    return any(row.body == name and row.stands for row in rows)


def _clamped(start: Start, name: str) -> bool:
    """Whether opposite sides touch a body, so that no direction of gravity would press it there.

    Of some contacts that are near, sum w n = 0 with w >= 0.
    """
    assert start.points is not None
    normals = [
        start.points.n[at][start.points.phi[at] <= SUNK * least(pair)]
        for pair, at in start.pairs_of[name]
    ]
    return least_mean(np.concatenate(normals)) <= SAME_NORMAL


def _contacts(start: Start) -> Iterator[tuple[str, list[tuple[ContactPair, float, float]]]]:
    """The pairs of each free body with mass, their least gaps [m] and upward normals."""
    points = start.points
    if points is None or not start.g:
        return
    up = -start.gravity / start.g
    for name in start.free_bases:
        of_body = []
        for pair, at in start.pairs_of.get(name, ()):
            sign = 1.0 if start.body(pair.beta.link) == name else -1.0
            j = at.start + int(np.argmin(points.phi[at]))
            of_body.append((pair, float(points.phi[j]), sign * float(points.n[j] @ up)))
        if of_body:
            yield name, of_body
