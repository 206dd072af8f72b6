"""Signed distances of points to an ellipsoid (Newton's method) and to a cone (closed form).

Vectorised, as in :mod:`~quasistatic_ref.contact.cloud`: points in the shape's own frame in, phi [m]
and unit outward normals out.
"""

import numpy as np

from quasistatic_ref.step.data import Array

STEPS = 100
"""Most Newton steps to an ellipsoid's root: about ten are usual, as each starts within 1 of it in
the sum."""


def distance_to_ellipsoid(points: Array, half_axes: Array) -> tuple[Array, Array]:
    """Signed distance (N,) [m] and outward normal (N, 3) of points against an ellipsoid.

    The closest point x of p has p = x + t grad, x_i = e_i^2 p_i / (t + e_i^2), and t is the largest
    root of sum (e_i p_i / (t + e_i^2))^2 = 1. With e the least half-axis and w = t / e^2 + 1,
    every sum of the denominators is free of cancellation. Where one term alone is 1 the root is not
    yet reached; the sum is at most 3 there and convex, so that Newton's steps rise to the root.
    (D. Eberly, "Distance from a point to an ellipse, an ellipsoid, or a hyperellipsoid".)
    """
    least = half_axes.min()
    r = (half_axes / least) ** 2
    sign = np.where(points < 0, -1.0, 1.0)
    z = np.abs(points) / half_axes
    # On the plane of the medial axis the closest point is not unique: one side, always the same,
    # is taken by moving the point off that plane by less than any number matters.
    z[:, half_axes.argmin()] = np.maximum(z[:, half_axes.argmin()], 1e-150)
    low = np.max(np.where(r * z > r - 1, r * z - (r - 1), 0.0), axis=1)
    w = low
    for _ in range(STEPS):
        terms = (r * z / (w[:, None] + (r - 1))) ** 2
        slope = 2 * np.sum(terms / (w[:, None] + (r - 1)), axis=1)
        rise = (np.sum(terms, axis=1) - 1) / slope
        # A point that is there stays there: its bits do not depend on the others of its batch.
        moving = rise > np.spacing(w)
        if not moving.any():
            break
        w = np.where(moving, w + rise, w)
    on = z * r / (w[:, None] + (r - 1))  # x / e, of length one
    on /= np.sqrt(np.sum(on * on, axis=1))[:, None]
    normal = on / half_axes
    normal /= np.sqrt(np.sum(normal * normal, axis=1))[:, None]
    # Along the normal, which is exact to rounding also where the distance is next to nothing.
    phi = np.sum((np.abs(points) - on * half_axes) * normal, axis=1)
    return phi, sign * normal


def distance_to_cone(points: Array, radius: float, half_length: float) -> tuple[Array, Array]:
    """Signed distance (N,) [m] and outward normal (N, 3) of points against a cone, tip up.

    In the half-plane (r, z) it is a triangle with the edges rim - tip and axis - rim.
    """
    r = np.sqrt(points[:, 0] ** 2 + points[:, 1] ** 2)
    degenerate = r == 0
    outward = points[:, :2] / np.where(degenerate, 1.0, r)[:, None]
    outward[degenerate] = (1.0, 0.0)
    p = np.stack([r, points[:, 2]], axis=1)
    rim, tip = np.array([radius, -half_length]), np.array([0.0, half_length])
    slant = np.hypot(radius, 2 * half_length)
    side = np.array([2 * half_length, radius]) / slant  # outward normal of rim - tip
    above_side = (p[:, 0] - rim[0]) * side[0] + (p[:, 1] - rim[1]) * side[1]
    above_base = -half_length - p[:, 1]
    along = (tip - rim) / slant
    s = (p[:, 0] - rim[0]) * along[0] + (p[:, 1] - rim[1]) * along[1]
    on_side = rim + np.clip(s, 0.0, slant)[:, None] * along
    on_base = np.stack([np.minimum(p[:, 0], radius), np.full(len(p), -half_length)], axis=1)
    d_side, d_base = _length(p - on_side), _length(p - on_base)
    side_nearest = d_side <= d_base
    nearest = np.where(side_nearest[:, None], on_side, on_base)
    away = p - nearest
    distance = _length(away)
    flat = np.where((above_side >= above_base)[:, None], side, np.array([0.0, -1.0]))
    level = np.maximum(above_side, above_base)
    # Inside, and wherever a face is the closest feature, its normal; else that of an edge or tip.
    # By where the closest point is, not by its distance: next to the surface that is all rounding.
    within = np.where(side_nearest, (s > 0) & (s < slant), p[:, 0] < radius)
    face = (level <= 0) | within | (distance == 0)
    flat = np.where(face[:, None], flat, away / np.where(face, 1.0, distance)[:, None])
    phi = np.where(face, level, distance)
    return phi, np.concatenate([flat[:, :1] * outward, flat[:, 1:]], axis=1)


def _length(vectors: Array) -> Array:
    return np.hypot(vectors[:, 0], vectors[:, 1])
