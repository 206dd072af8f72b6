"""A solid of each kind."""

import numpy as np

from quasistatic_ref import Box, Capsule, Cylinder, HalfSpace, Sphere, convex_hull

WEDGE = np.array([[0, 0, 0], [0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.2], [0.2, 0.2, 0.1]])
SHAPES = {
    "sphere": Sphere(0.1),
    "box": Box((0.05, 0.125, 0.25)),
    "capsule": Capsule(0.05, 0.1),
    "half-space": HalfSpace((0.0, 0.0, 1.0), -0.0625),
    "tilted half-space": HalfSpace((1.0, 2.0, 2.0), 0.1),
    "cylinder": Cylinder(0.1, 0.05),
    "hull": convex_hull(WEDGE),
}
"""Compiled code knows all but the last two."""
