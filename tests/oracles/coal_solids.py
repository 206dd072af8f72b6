"""Solids of coal's own, with the sizes of ours."""

import coal

from quasistatic_ref import Box, Sphere


def coal_solid(shape):
    """A sphere, box, cylinder or capsule as coal knows it: its volume and moments of inertia."""
    if isinstance(shape, Sphere):
        return coal.Sphere(shape.radius)
    if isinstance(shape, Box):
        return coal.Box(2 * shape.half_extents)
    return getattr(coal, type(shape).__name__)(shape.radius, 2 * shape.half_length)
