"""Masses, inertias and sizes that contradict each other."""

from collections.abc import Iterator, Sequence

import numpy as np

from quasistatic_ref.optional.doctor.frame.hulls import (
    farthest_points,
    holds,
    hull_of,
    volume_bounds,
)
from quasistatic_ref.optional.doctor.frame.start import Start
from quasistatic_ref.optional.doctor.texts import distance, finding, others
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.placed_shape import PlacedShape
from quasistatic_ref.simulate.finding import Finding

DENSITIES = 10.0, 25_000.0
"""From foam to tungsten and gold [kg/m^3]."""
GYRATION = 1e-3, 10.0
"""Largest moment of inertia over m r^2, where r is the farthest point from the centre of mass [-]:
at most 1, but for what has no collision shape; of a homogeneous ball 0.4."""
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
    low, high = DENSITIES
    suspect: list[tuple[float, str, float, float]] = []
    for link, name, shapes in start.free_links:
        mass = float(start.system.masses[link])
        least, most = np.sum([volume_bounds(placed.shape) for placed in shapes], axis=0)
        if low * most <= mass <= high * least:
            continue
        alone = sum(placed.shape.volume for placed in shapes)
        if low * alone <= mass <= high * alone:
            continue
        hull = hull_of(shapes)
        if hull is None or _are_feet(shapes, hull):
            continue
        volume = alone if mass < low * alone else max(hull.volume, alone)
        beyond = max(low * volume / mass, mass / volume / high)
        suspect.append((beyond, name, mass, volume))
    beyond, name, mass, volume = max(suspect, default=(0.0, "", 0.0, 1.0))
    if beyond > 1:
        more = others(sum(share > 1 for share, *_ in suspect) - 1)
        density = mass / volume
        cause = f"{name} has {mass:.3g} kg in {1e6 * volume:.3g} cm^3, {density:.3g} kg/m^3, and "
        cause += f"bodies have {low:g} to {high:,.0f}{more}"
        remedy = f"check mass and size of {name}"
        yield finding("density", cause, remedy, density_kg_per_m3=density)


def _are_feet(shapes: Sequence[PlacedShape], hull: ConvexMesh) -> bool:
    """Whether shapes are plainly no more than feet of a body: several small ones far apart."""
    largest = max(placed.shape.extent for placed in shapes)
    return len(shapes) > 2 and largest <= FOOT * hull.extent


def inertia(start: Start) -> Iterator[Finding]:
    """Free links whose inertia no body of their mass and size can have."""
    for link, name, shapes in start.free_links:
        mass = float(start.system.masses[link])
        points = np.concatenate([farthest_points(placed) for placed in shapes])
        radius = float(np.linalg.norm(points - start.system.centres[link], axis=1).max())
        largest = float(np.linalg.eigvalsh(start.system.inertias[link]).max())
        share = largest / (mass * radius**2) if radius > 0 else 1.0
        if not GYRATION[0] <= share <= GYRATION[1]:
            cause = (
                f"the largest moment of inertia of {name}, {largest:.3g} kg m^2, is {share:.2g} "
            )
            cause += f"times m r^2, with {mass:.3g} kg and at most r = {distance(radius)} from the "
            cause += "centre of mass; a ball has 0.4"
            yield finding("inertia", cause, f"check the inertia of {name}", share=share)


def centre(start: Start) -> Iterator[Finding]:
    """Free links whose centre of mass is far outside of the hull of their shapes.

    The body that stands on feet is above them, by their distance at most.
    """
    for link, name, shapes in start.free_links:
        at = start.system.centres[link]
        if any(holds(placed, at) for placed in shapes):
            continue
        hull = hull_of(shapes)
        if hull is None:
            continue
        away = float(hull.signed_distance(at[None])[0][0])
        if away > (1.0 if _are_feet(shapes, hull) else OUTSIDE) * hull.extent:
            cause = (
                f"the centre of mass of {name} is {distance(away)} outside of its shapes, which "
            )
            cause += f"are {distance(hull.extent)} long; both are in the frame of the link"
            remedy = f"check the centre of mass of {name}, or the origin of its shapes"
            yield finding("centre-of-mass", cause, remedy, outside_mm=1e3 * away)


def sizes_apart(start: Start) -> Iterator[Finding]:
    """A body that is a thousand times as long as another; what never moves may be of any size."""
    sizes: dict[str, float] = {}
    for placed in start.sides:
        name, extent = start.body(placed.link), placed.shape.extent
        if 0 < extent < np.inf and start.moves[placed.link].any():
            sizes[name] = max(sizes.get(name, 0.0), extent)
    if not sizes:
        return
    small, large = (ends(sizes, key=sizes.__getitem__) for ends in (min, max))
    ratio = sizes[large] / sizes[small]
    if ratio > RATIO:
        cause = f"lengths are in metres, and {large} is {sizes[large]:.3g} m long, {small} "
        cause += f"{sizes[small]:.3g} m"
        yield finding("sizes-apart", cause, f"check the units of {large} and {small}", ratio=ratio)
