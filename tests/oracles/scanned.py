"""Solids whose surface is sampled: their points, and their mass properties by formula.

These are volume [m^3], centre [m], and inertia about it for each kilogram [m^2].
"""

import numpy as np


def sum_of_parts(parts):
    """Of several parts; a negative volume is a part that is cut out (Steiner's theorem)."""
    volume = sum(part[0] for part in parts)
    centre = sum(part[0] * part[1] for part in parts) / volume
    inertia = np.zeros((3, 3))
    for own, middle, about in parts:
        d = middle - centre
        inertia += own * (about + d @ d * np.eye(3) - np.outer(d, d))
    return volume, centre, inertia / volume


def block(size, at=(0, 0, 0)):
    a, b, c = np.array(size) ** 2
    return float(np.prod(size)), np.array(at, dtype=float), np.diag([b + c, a + c, a + b]) / 12


def rod(radius, height, z=0.0):
    across = (3 * radius**2 + height**2) / 12
    inertia = np.diag([across, across, radius**2 / 2])
    return np.pi * radius**2 * height, np.array([0, 0, z]), inertia


def on_block(rng, count, size, at=(0, 0, 0)):
    """Uniform over the faces of a block."""
    edges = np.array(size)
    areas = np.prod(edges) / edges
    axis = rng.choice(3, count, p=areas / areas.sum())
    points = rng.uniform(-0.5, 0.5, (count, 3))
    points[np.arange(count), axis] = rng.choice([-0.5, 0.5], count)
    return points * edges + at


def on_tube(rng, count, radius, low, high):
    angle, z = rng.uniform(0, 2 * np.pi, count), rng.uniform(low, high, count)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=1)


def on_ring(rng, count, inner, outer, z):
    angle = rng.uniform(0, 2 * np.pi, count)
    radius = np.sqrt(rng.uniform(inner**2, outer**2, count))
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(count, z)], axis=1)


def box(rng, count):
    size = (0.06, 0.08, 0.12)
    return on_block(rng, count, size), block(size)


def can(rng, count):
    r, h = 0.033, 0.115
    ends = [on_ring(rng, int(count * 0.11), 0, r, z) for z in (-h / 2, h / 2)]
    return np.concatenate([on_tube(rng, int(count * 0.78), r, -h / 2, h / 2), *ends]), rod(r, h)


def mug(rng, count):
    """A cup, open at the top: walls of 5 mm, a bottom of 6 mm."""
    outer, inner, height, bottom = 0.04, 0.035, 0.09, 0.006
    places = [
        on_tube(rng, int(count * 0.46), outer, 0, height),
        on_tube(rng, int(count * 0.37), inner, bottom, height),
        on_ring(rng, int(count * 0.09), 0, outer, 0),
        on_ring(rng, int(count * 0.06), 0, inner, bottom),
        on_ring(rng, int(count * 0.02), inner, outer, height),
    ]
    hollow = rod(inner, height - bottom, (height + bottom) / 2)
    whole = rod(outer, height, height / 2)
    return np.concatenate(places), sum_of_parts([whole, (-hollow[0], *hollow[1:])])


def bracket(rng, count):
    """A tool: a bar with another one across its end."""
    long, across, at = (0.16, 0.02, 0.02), (0.03, 0.09, 0.02), (0.095, 0, 0)
    first, second = on_block(rng, count // 2, long), on_block(rng, count // 2, across, at)
    shared = abs(first[:, 0] - 0.08) < 1e-12
    hidden = (abs(second[:, 0] - 0.08) < 1e-12) & (abs(second[:, 1]) < 0.01)
    points = np.concatenate([first[~shared], second[~hidden]])
    return points, sum_of_parts([block(long), block(across, at)])


SOLIDS = {"box": box, "can": can, "mug": mug, "bracket": bracket}


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
