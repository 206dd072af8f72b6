"""A flat support as a cloud of points, each of which stands for an equal share of its area."""

from functools import lru_cache

import numpy as np

from quasistatic_ref.lab.reality.outline import Outline
from quasistatic_ref.step.data import Array

FINE, ROUNDS = 80, 60
"""Points of the raster along each side; rounds of the means."""


@lru_cache(maxsize=64)
def support_points(outline: Outline, count: int) -> tuple[tuple[float, float], ...]:
    """Points below an outline, from its centre [m].

    They are the means of parts of a fine raster, each point in the part of the mean that is
    nearest to it (Lloyd), started from a spiral. Their own mean is the centre.

    Parameters
    ----------
    outline : Outline
    count : int
        How many.
    """
    low = outline.vertices.min(0)
    high = outline.vertices.max(0)
    ticks = (np.arange(FINE) + 0.5) / FINE
    raster = np.array([[x, y] for x in ticks for y in ticks]) * (high - low) + low
    raster = np.array([p for p in raster if outline.closest(p)[0] < 0]) - outline.centre
    k = np.arange(count)
    radius = np.sqrt((k + 0.5) / count)
    angle = k * np.pi * (3 - np.sqrt(5))
    spiral = np.column_stack([np.cos(angle), np.sin(angle)]) * radius[:, None]
    points: Array = spiral * raster.std(0) * 1.5
    for _ in range(ROUNDS):
        gaps = ((raster[:, None] - points) ** 2).sum(2)
        own = gaps.argmin(1)
        sizes = np.maximum(np.bincount(own, minlength=count), 1)[:, None]
        sums = np.zeros_like(points)
        np.add.at(sums, own, raster)
        points = np.where(np.bincount(own, minlength=count)[:, None] > 0, sums / sizes, points)
    return tuple((float(x), float(y)) for x, y in points - points.mean(0))
