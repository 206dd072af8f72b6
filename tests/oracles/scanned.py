"""Solids whose surface is sampled, which trimesh weighs, and what scanners make of their points."""

import numpy as np
from trimesh.boolean import union
from trimesh.creation import box, cylinder, revolve
from trimesh.sample import sample_surface

CUP = [[0, 0], [0.04, 0], [0.04, 0.09], [0.035, 0.09], [0.035, 0.006], [0, 0.006]]
"""Distances from its axis and heights [m]: walls of 5 mm, a bottom of 6 mm."""
BARS = box((0.16, 0.02, 0.02)), box((0.03, 0.09, 0.02)).apply_translation((0.095, 0, 0))
"""Of a tool, one across the end of the other."""
SOLIDS = {
    "box": box((0.06, 0.08, 0.12)),
    "can": cylinder(0.033, 0.115),
    "mug": revolve(CUP),
    "bracket": union(BARS),
}


def on_surface(solid, count, seed):
    """Points that are drawn evenly from the surface of a mesh."""
    return np.array(sample_surface(solid, count, seed=seed)[0])


def noisy(rng, points):
    return points + 1e-3 * rng.normal(size=points.shape)


def holed(rng, points):
    """Without what is within 8 mm of five of its points."""
    middles = points[rng.choice(len(points), 5)]
    return points[(np.linalg.norm(points[:, None] - middles, axis=2) > 0.008).all(axis=1)]


def with_strays(rng, points):
    """With five points on a sphere of 0.3 m around it."""
    ways = rng.normal(size=(5, 3))
    away = 0.3 * ways / np.linalg.norm(ways, axis=1, keepdims=True)
    return np.concatenate([points, points.mean(axis=0) + away])


SCANS = {"clean": lambda rng, p: p, "noisy": noisy, "holed": holed, "with strays": with_strays}
