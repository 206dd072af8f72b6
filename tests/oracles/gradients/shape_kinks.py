"""Constructed kinks of the geometry: rims, parallel faces, zero distances, tangents."""

from collections.abc import Callable
from typing import Final

import numpy as np

from quasistatic_ref.optional.derivatives.step import reason
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Shape,
    Sphere,
)
from quasistatic_ref.step.data import Array
from tests.oracles.gradients.placing import (
    FLOOR,
    HERE,
    IN,
    POINT,
    UP,
    Kink,
    Rng,
    Scene,
    X,
    Y,
    about_z,
    any_turn,
    anywhere,
    as_mesh,
    box,
    either,
    spot,
    turned,
)


def over_a_rim(rng: Rng) -> Kink:
    """A ball or a point where the closest point of a solid leaves its face."""
    radius, gap = float(rng.choice([0.0, 0.05])), rng.uniform(-1e-4, 1e-4)
    gap = gap if radius else abs(gap) + 1e-5
    over = (radius + gap) * UP
    kind = int(rng.integers(4))
    along, turn = rng.uniform(-0.03, 0.03), about_z(rng)
    if kind == 0:
        solid = box(rng)
        shape: Shape = either(rng, solid)
        at = np.array([solid.half_extents[0], along, solid.half_extents[2]]) + over
    elif kind == 1:
        shape = Cylinder(rng.uniform(0.06, 0.1), 0.05)
        at = turn @ (shape.radius * X + 0.05 * UP + over)
    elif kind == 2:
        shape = Cylinder(0.05, rng.uniform(0.06, 0.1))
        at = turn @ ((0.05 + radius + gap) * X + shape.half_length * UP)
    else:
        shape = Cone(rng.uniform(0.06, 0.1), rng.uniform(0.06, 0.1))
        slant = np.array([2 * shape.half_length, 0.0, shape.radius])
        slant = slant / np.linalg.norm(slant)
        end = np.array([shape.radius, 0.0, -shape.half_length])
        if rng.integers(2):
            end = shape.half_length * UP
        at = turn @ (end + (radius + gap) * slant)
    body = Sphere(radius) if radius else POINT
    force = _towards(rng, at)
    scene = Scene(body, any_turn(rng), at, [(shape, *HERE)], force=force)
    return Kink(reason.FEATURE, f"over a rim of a {type(shape).__name__}", *anywhere(rng, scene))


def _towards(rng: Rng, at: Array) -> Array:
    """A force of some newtons towards the origin and to the side, no torque, shape (6,)."""
    way = -at / np.linalg.norm(at)
    return np.array([*(8 * way + 0.5 * rng.normal(size=3)), 0, 0, 0])


def over_a_seam(rng: Rng) -> Kink:
    """A point or a ball over the seam of a capsule's side and cap."""
    rod, radius = Capsule(rng.uniform(0.02, 0.05), rng.uniform(0.04, 0.08)), 0.03
    shape = Sphere(radius) if rng.integers(2) else POINT
    gap = rod.radius + (radius if isinstance(shape, Sphere) else 0.0) + 1e-5
    at = about_z(rng) @ (gap * X + rod.half_length * UP)
    scene = Scene(shape, any_turn(rng), at, [(rod, *HERE)], force=_towards(rng, at))
    return Kink(reason.FEATURE, "over the seam of a capsule", *anywhere(rng, scene))


def flat(rng: Rng) -> Kink:
    """A body flat on the floor or on a box, of which one point is kept."""
    radius, half = rng.uniform(0.04, 0.08), rng.uniform(0.04, 0.08)
    kind = int(rng.integers(6))
    lying = about_z(rng) @ turned(X, np.pi / 2)
    shape, R, height = (
        lambda: (Box(np.array([radius, half, 0.05])), about_z(rng), 0.05),
        lambda: (as_mesh(Box(np.array([radius, half, 0.05]))), about_z(rng), 0.05),
        lambda: (Cylinder(radius, half), about_z(rng), half),
        lambda: (Cylinder(radius, half), lying, radius),
        lambda: (Capsule(radius, half), lying, radius),
        lambda: (Cone(radius, half), about_z(rng), half),
    )[kind]()
    under = _floor_or_box(rng)
    # Curved solids that meet have no tie that rounding leaves alone; so they stay apart.
    gap = IN if isinstance(shape, Cylinder | Cone) else -IN
    force = np.array([0.1, 0.2, -6.0, 0.01, 0.02, 0.01])
    scene = Scene(shape, R, spot(rng) + (height + gap) * UP, [under], force=force)
    also = frozenset({reason.FEATURE, reason.SURFACES})
    what = f"a {type(shape).__name__} flat, one point kept"
    return Kink(reason.MANY, what, *anywhere(rng, scene), also=also)


def edge_along_a_face(rng: Rng) -> Kink:
    """A box with one edge along a face; or two parallel rods."""
    if rng.integers(2):
        a, b = rng.uniform(0.02, 0.05, 2)
        rods = Capsule(a, rng.uniform(0.05, 0.1)), Capsule(b, rng.uniform(0.05, 0.1))
        at = np.array([a + b - IN, 0.0, rng.uniform(-0.02, 0.02)])
        force = np.array([-6.0, 0.2, 0.1, 0.01, 0.01, 0.01])
        scene = Scene(rods[0], about_z(rng), at, [(rods[1], *HERE)], force=force)
        return Kink(reason.MANY, "two parallel rods", *anywhere(rng, scene))
    solid, angle = box(rng), rng.uniform(0.3, 1.2)
    height = solid.half_extents[1] * np.sin(angle) + solid.half_extents[2] * np.cos(angle)
    R = about_z(rng) @ turned(X, angle)
    slab = Box(np.array([0.5, 0.5, 0.05]))
    under = (FLOOR, *HERE) if rng.integers(2) else (slab, np.eye(3), -0.05 * UP)
    scene = Scene(either(rng, solid), R, spot(rng) + (height - IN) * UP, [under])
    return Kink(reason.MANY, "an edge along a face", *anywhere(rng, scene))


def at_a_centre(rng: Rng) -> Kink:
    """A point at the centre of a ball, or on the axis of a capsule or a long cylinder."""
    kind = int(rng.integers(3))
    shape: Shape = (Sphere(0.05), Capsule(0.04, 0.08), Cylinder(0.03, 0.2))[kind]
    at = (0.0 if kind == 0 else rng.uniform(-0.05, 0.05)) * UP
    scene = Scene(POINT, any_turn(rng), at, [(shape, *HERE)])
    also = frozenset({reason.SURFACES})
    what = f"at the centre of a {type(shape).__name__}"
    return Kink(reason.MANY, what, *anywhere(rng, scene), also=also)


def at_an_edge(rng: Rng) -> Kink:
    """A point exactly on an edge, a corner, a rim or a tip; or a tip on one of these."""
    solid = box(rng)
    half, turn = solid.half_extents, about_z(rng)
    kind = int(rng.integers(4))
    if kind == 0:
        shape: Shape = either(rng, solid)
        at = half * rng.choice([-1, 1], 3)
        if rng.integers(2):
            at[int(rng.integers(3))] *= rng.uniform(-0.8, 0.8)
    elif kind == 1:
        shape = Cylinder(0.06, 0.05)
        at = turn @ np.array([0.06, 0.0, 0.05])
    elif kind == 2:
        shape = Cone(0.06, 0.05)
        at = 0.05 * UP if rng.integers(2) else turn @ np.array([0.06, 0.0, -0.05])
    else:  # a corner of the body on an edge
        shape = either(rng, solid)
        at = half * np.array([1.0, rng.uniform(-0.6, 0.6), 1.0])
        tip = Box(np.array([0.02, 0.03, 0.04]))
        R = about_z(rng) @ turned(Y, np.pi - 0.8) @ turned(X, 0.6)
        corner = R @ (tip.half_extents * np.array([1.0, 1.0, 1.0]))
        scene = Scene(tip, R, at - corner, [(shape, *HERE)], force=_towards(rng, at))
        also = frozenset({reason.SURFACES})
        return Kink(reason.NO_NORMAL, "a corner on an edge", *anywhere(rng, scene), also=also)
    scene = Scene(POINT, any_turn(rng), at, [(shape, *HERE)], force=_towards(rng, at))
    what, also = f"on an edge of a {type(shape).__name__}", frozenset({reason.SURFACES})
    return Kink(reason.NO_NORMAL, what, *anywhere(rng, scene), also=also)


def switching_axis(rng: Rng) -> Kink:
    """Two round bodies whose normal is as far from two axes of the world."""
    i, j = rng.choice(3, 2, replace=False)
    k = 3 - i - j
    way = np.zeros(3)
    way[[i, j]] = rng.choice([-1, 1], 2)
    way[k] = rng.uniform(1.2, 3) * rng.choice([-1, 1])
    if rng.integers(4) == 0:
        way[k] = rng.choice([-1, 1])
    way = way / np.linalg.norm(way)
    a, b = rng.uniform(0.03, 0.08, 2)
    cone = str(rng.choice(["pyramid", "product", "facets-6"]))
    body: Shape = Sphere(a) if rng.integers(2) else POINT
    reach = b + (a if isinstance(body, Sphere) else 0.0) - IN
    side = np.cross(way, rng.normal(size=3))
    force = np.array([*(-6 * way + 20 * side / np.linalg.norm(side)), 0, 0, 0])
    scene = Scene(body, any_turn(rng), reach * way, [(Sphere(b), *HERE)], cone=cone, force=force,
                  mu=(0.2, 0.01))  # fmt: skip
    return Kink(reason.TANGENTS, "a normal as far from two axes", *anywhere(rng, scene, turn=False))


def upright(rng: Rng) -> Kink:
    """A cylinder or cone that stands on its rim, with corners."""
    shape = (Cylinder, Cone)[int(rng.integers(2))](rng.uniform(0.04, 0.08), rng.uniform(0.05, 0.1))
    under = _floor_or_box(rng)
    scene = Scene(
        shape, about_z(rng), spot(rng) + (shape.half_length + 1e-5) * UP, [under],
        k=int(rng.choice([3, 4])), mu=(0.2, 0.01),
        force=np.array([*rng.uniform(2, 5, 2), -6.0, *rng.uniform(-0.2, 0.2, 3)]),
    )  # fmt: skip
    also = frozenset({reason.POINTS, reason.MANY, reason.CONTRADICTION})
    return Kink(reason.RIM, f"a {type(shape).__name__} upright", *anywhere(rng, scene), also=also)


def _floor_or_box(rng: Rng) -> tuple[Shape, Array, Array]:
    """What lies below z = 0: a shape, its rotation (3, 3) and its place (3,) [m]."""
    if rng.integers(2):
        return Box(np.array([0.3, 0.3, 0.1])), np.eye(3), -0.1 * UP
    return FLOOR, *HERE


SHAPES: Final[tuple[Callable[[Rng], Kink], ...]] = (
    over_a_rim,
    over_a_seam,
    flat,
    edge_along_a_face,
    at_a_centre,
    at_an_edge,
    switching_axis,
    upright,
)
