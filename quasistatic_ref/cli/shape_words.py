"""Shapes in words: kind and size."""

import numpy as np

from quasistatic_ref.model import shapes
from quasistatic_ref.model.convex_mesh import ConvexMesh


def shape_words(shape: shapes.Shape) -> str:
    """Kind and size of a shape [m], e.g. ``box 0.1 x 0.2 x 0.3 m``."""
    match shape:
        case shapes.Sphere():
            return f"sphere of radius {shape.radius:g} m"
        case shapes.Box():
            return f"box {_sizes(2 * shape.half_extents)}"
        case shapes.Ellipsoid():
            return f"ellipsoid {_sizes(2 * shape.half_axes)}"
        case shapes.Cylinder() | shapes.Capsule() | shapes.Cone():
            kind = type(shape).__name__.lower()
            return f"{kind} of radius {shape.radius:g} m, length {2 * shape.half_length:g} m"
        case shapes.HalfSpace():
            x, y, z = shape.normal + 0.0
            return f"half-space below ({x:g}, {y:g}, {z:g}) . x = {shape.offset:g} m"
        case ConvexMesh():
            extent = _sizes(np.ptp(shape.vertices, axis=0))
            what = "convex mesh" if shape.is_convex else "convex hull of a mesh"
            return f"{what}, {len(shape.vertices)} corners within {extent}"
        case shapes.PointCloud():
            extent = _sizes(np.ptp(shape.points, axis=0))
            return f"cloud of {len(shape.points)} points within {extent}"


def _sizes(lengths: np.ndarray) -> str:
    return " x ".join(f"{length:.4g}" for length in lengths) + " m"
