"""Constructed kinks of the geometry: points that are tied, and ways out that are."""

from collections.abc import Callable
from typing import Final

import numpy as np

from quasistatic_ref.optional.derivatives.step import reason
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    PointCloud,
    Shape,
    Sphere,
)
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
    about_z,
    any_turn,
    anywhere,
    box,
    either,
    spot,
    turned,
)

OFF: Final = 4e-12
"""By how much depths differ that tie [m]: a derivative cannot tell, and a step that could not is
refused."""


def tied_points(rng: Rng) -> Kink:
    """Points of a cloud at the same height, fewer kept."""
    count = int(rng.integers(2, 7))
    low = np.column_stack([rng.uniform(-0.1, 0.1, (count, 2)), np.zeros(count)])
    high = np.column_stack([rng.uniform(-0.1, 0.1, (4, 2)), rng.uniform(0.02, 0.1, 4)])
    points = np.concatenate([low, high])
    rng.shuffle(points)
    R = any_turn(rng)
    scene = Scene(
        PointCloud(points @ R), R, spot(rng) - IN * UP, [(FLOOR, *HERE)],
        k=int(rng.integers(1, count)),
    )  # fmt: skip
    what = "a cloud with equally near points"
    return Kink(reason.POINTS, what, *anywhere(rng, scene), also=frozenset({reason.CONTRADICTION}))


def tied_corners(rng: Rng) -> Kink:
    """A box flat on the floor, of whose four corners two or three are kept."""
    solid = box(rng)
    scene = Scene(
        either(rng, solid), about_z(rng), spot(rng) + (solid.half_extents[2] - IN) * UP,
        [(FLOOR, *HERE)], k=int(rng.choice([2, 3])),
    )  # fmt: skip
    also = frozenset({reason.MANY, reason.CONTRADICTION})
    return Kink(reason.POINTS, "corners of a box", *anywhere(rng, scene), also=also)


def tied_on_a_rim(rng: Rng) -> Kink:
    """A tilted cylinder or cone: the points of its rim to the left and right are as near."""
    shape = (Cylinder, Cone)[int(rng.integers(2))](rng.uniform(0.04, 0.08), rng.uniform(0.05, 0.1))
    tilt = rng.uniform(0.05, 0.3)
    R = about_z(rng) @ turned(X, tilt) @ about_z(rng)
    low = shape.half_length * np.cos(tilt) + shape.radius * np.sin(tilt)
    scene = Scene(shape, R, spot(rng) + (low - IN) * UP, [(FLOOR, *HERE)], k=2)
    return Kink(reason.POINTS, "points of a rim", *anywhere(rng, scene))


def deep_in_a_box(rng: Rng) -> Kink:
    """A point or a ball as deep below two faces of a box."""
    half = np.array([*rng.uniform(0.08, 0.12, 2), rng.uniform(0.04, 0.06)])
    solid, radius = Box(half), float(rng.choice([0.0, 0.02]))
    depth = rng.uniform(0.005, 0.03)
    at = np.array([half[0] - depth, rng.uniform(-0.03, 0.03), half[2] - depth + OFF])
    shape = Sphere(radius) if radius else POINT
    scene = Scene(shape, any_turn(rng), at, [(either(rng, solid), *HERE)])
    return Kink(reason.SURFACES, "a point as deep below two faces", *anywhere(rng, scene))


def deep_in_a_round(rng: Rng) -> Kink:
    """A point as deep below cap and side of a cylinder, or base and slant of a cone."""
    radius, half = rng.uniform(0.06, 0.1), rng.uniform(0.06, 0.1)
    turn, depth = about_z(rng), rng.uniform(0.005, 0.02)
    if rng.integers(2):
        shape: Shape = Cylinder(radius, half)
        at = turn @ np.array([radius - depth, 0.0, half - depth + OFF])
    else:
        # d above the base, the distance to the slant is d too.
        shape = Cone(radius, half)
        slant = np.hypot(radius, 2 * half)
        r = radius - depth * (slant + radius) / (2 * half)
        at = turn @ np.array([r, 0.0, -half + depth + OFF])
    scene = Scene(POINT, any_turn(rng), at, [(shape, *HERE)])
    return Kink(reason.SURFACES, "a point in a round solid", *anywhere(rng, scene))


def deep_in_an_ellipsoid(rng: Rng) -> Kink:
    """A point in the middle plane of a flat ellipsoid."""
    axes = np.array([*rng.uniform(0.08, 0.1, 2), rng.uniform(0.02, 0.04)])
    at = np.array([*rng.uniform(-0.02, 0.02, 2), 0.0])
    scene = Scene(POINT, any_turn(rng), at, [(Ellipsoid(axes), *HERE)])
    return Kink(reason.SURFACES, "a point in an ellipsoid", *anywhere(rng, scene))


def amid_a_plate(rng: Rng) -> Kink:
    """A body whose middle is in the middle of a plate or a disc: out is up, or down."""
    plate = Box(np.array([0.3, 0.3, 0.005])) if rng.integers(2) else Cylinder(0.3, 0.005)
    shape = (
        Ellipsoid(np.array([0.01, 0.02, 0.03])), Box(np.array([0.01, 0.02, 0.03])),
        Capsule(0.01, 0.02), Cylinder(0.02, 0.02), Sphere(0.02),
    )[int(rng.integers(5))]  # fmt: skip
    at = np.array([*rng.uniform(-0.05, 0.05, 2), OFF])
    scene = Scene(shape, any_turn(rng), at, [(plate, *HERE)])
    return Kink(reason.SURFACES, f"a {type(shape).__name__} amid a plate", *anywhere(rng, scene))


TIES: Final[tuple[Callable[[Rng], Kink], ...]] = (
    tied_points,
    tied_corners,
    tied_on_a_rim,
    deep_in_a_box,
    deep_in_a_round,
    deep_in_an_ellipsoid,
    amid_a_plate,
)
