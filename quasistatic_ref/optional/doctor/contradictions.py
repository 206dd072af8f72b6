"""Masses, inertias and sizes that contradict each other."""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import product

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.doctor.start import Start
from quasistatic_ref.optional.doctor.telling import distance
from quasistatic_ref.shapes.convex_mesh import ConvexMesh, convex_hull
from quasistatic_ref.shapes.placed_shape import (
    PlacedShape,
)
from quasistatic_ref.simulate.finding import Finding

DENSITIES = 10.0, 25_000.0
"""From foam to tungsten and gold [kg/m^3]."""
GYRATION = 1e-3, 10.0
"""Largest moment of inertia over m r^2, where r is the farthest point from the centre of mass [-]:
at most 1, but for what has no collision shape; of a homogeneous ball 0.4."""
WAYS = [np.array(way) / np.linalg.norm(way) for way in product((-1, 0, 1), repeat=3) if any(way)]
"""To the faces, edges and corners of a cube [-]."""
OUTSIDE = 0.25
"""How far a centre of mass may be outside of the hull of shapes or of a cloud, over its extent [-]:
a cloud may be a part of a surface."""
FOOT = 0.2
"""Largest extent of a foot over that of all feet [-]."""
RATIO = 1000.0
"""Of the largest and the smallest body or shape of a scene [-]."""


def density(start: Start) -> Iterator[Finding]:
    """Free links that are lighter than foam or heavier than gold.

    A link is light where even its shapes alone are, and heavy where even their hull is: it may be
    hollow, and what is between its shapes may be filled. Of feet neither says anything.
    """
    suspect: list[tuple[float, str, float, float]] = []
    for link, name, shapes in start.free_links:
        mass = float(start.system.masses[link])
        alone = sum(placed.shape.volume for placed in shapes)
        light = mass < DENSITIES[0] * alone
        if not light and mass <= DENSITIES[1] * alone:
            continue
        hull = hull_of(shapes)
        if hull is None or _are_feet(shapes, hull):
            continue
        volume = alone if light else max(hull.volume, alone)
        if light or mass > DENSITIES[1] * volume:
            beyond = DENSITIES[0] * volume / mass if light else mass / volume / DENSITIES[1]
            suspect.append((beyond, name, mass, volume))
    if suspect:
        _, name, mass, volume = max(suspect)
        others = f" ({len(suspect) - 1} more are as suspect)" if len(suspect) > 1 else ""
        yield Finding(
            "density",
            True,
            f"check mass and size of {name}",
            f"{name} has {mass:.3g} kg in {1e6 * volume:.3g} cm^3, {mass / volume:.3g} kg/m^3, "
            f"and bodies have {DENSITIES[0]:g} to {DENSITIES[1]:,.0f}{others}",
            {"density_kg_per_m3": mass / volume},
        )


def hull_of(shapes: Sequence[PlacedShape]) -> ConvexMesh | None:
    """Convex hull of a link's shapes, in its frame; None if they are flat."""
    first = shapes[0]
    in_frame = np.array_equal(first.R, np.eye(3)) and not first.t.any()
    if len(shapes) == 1 and in_frame and isinstance(first.shape, ConvexMesh):
        return first.shape
    points = [farthest_points(placed) for placed in shapes]
    for placed in shapes:
        corners, radius = placed.shape.corners(WAYS[0])
        if not radius:
            points.append(corners @ placed.R.T + placed.t)
    with suppress(ModelError):
        return convex_hull(np.concatenate(points))
    return None


def _are_feet(shapes: Sequence[PlacedShape], hull: ConvexMesh) -> bool:
    """Whether shapes are plainly no more than feet of a body: several small ones far apart."""
    largest = max(placed.shape.extent for placed in shapes)
    return len(shapes) > 2 and largest <= FOOT * hull.extent


def inertia(start: Start) -> Iterator[Finding]:
    """Findings on free links whose inertia no body of their mass and size can have."""
    for link, name, shapes in start.free_links:
        mass = float(start.system.masses[link])
        moment = start.system.inertias[link]
        points = np.concatenate([farthest_points(placed) for placed in shapes])
        radius = float(np.linalg.norm(points - start.system.centres[link], axis=1).max())
        largest = float(np.linalg.eigvalsh(moment).max())
        share = largest / (mass * radius**2) if radius > 0 else 1.0
        if not GYRATION[0] <= share <= GYRATION[1]:
            yield Finding(
                "inertia",
                True,
                f"check the inertia of {name}",
                f"the largest moment of inertia of {name}, {largest:.3g} kg m^2, is {share:.2g} "
                "times "
                f"m r^2, with {mass:.3g} kg and at most r = {distance(radius)} from the "
                "centre of mass; a ball has 0.4",
                {"share": share},
            )


def centre(start: Start) -> Iterator[Finding]:
    """Findings on free links whose centre of mass is far outside of the hull of their shapes.

    The body that stands on feet is above them, by their distance at most.
    """
    for link, name, shapes in start.free_links:
        at = start.system.centres[link]
        seen = ((x.shape, (at - x.t)[None] @ x.R) for x in shapes)  # in the frame of each shape
        if any(shape.signed_distance(point)[0][0] <= 0 for shape, point in seen):
            continue
        hull = hull_of(shapes)
        if hull is None:
            continue
        away = float(hull.signed_distance(at[None])[0][0])
        extent = hull.extent
        if away > (1.0 if _are_feet(shapes, hull) else OUTSIDE) * extent:
            yield Finding(
                "centre-of-mass",
                True,
                f"check the centre of mass of {name}, or the origin of its shapes",
                f"the centre of mass of {name} is {distance(away)} outside of its shapes, "
                "which are "
                f"{distance(extent)} long; both are in the frame of the link",
                {"outside_mm": 1e3 * away},
            )


def sizes_apart(start: Start) -> Iterator[Finding]:
    """A body that is a thousand times as long as another; what never moves may be of any size."""
    largest: dict[str, float] = {}
    for placed in start.sides:
        name = start.body(placed.link)
        extent = placed.shape.extent
        if 0 < extent < np.inf and start.moves[placed.link].any():
            largest[name] = max(largest.get(name, 0.0), extent)
    if not largest:
        return
    small = min(largest, key=largest.__getitem__)
    large = max(largest, key=largest.__getitem__)
    if largest[large] > RATIO * largest[small]:
        yield Finding(
            "sizes-apart",
            True,
            f"check the units of {large} and {small}",
            f"lengths are in metres, and {large} is {largest[large]:.3g} m long, {small} "
            f"{largest[small]:.3g} m",
            {"ratio": largest[large] / largest[small]},
        )


def farthest_points(placed: PlacedShape) -> Array:
    """The points of a shape that are farthest in the WAYS, in the frame of its link, (n, 3) [m]."""
    farthest = np.array([placed.shape.support_point(way) for way in WAYS])
    return farthest @ placed.R.T + placed.t
