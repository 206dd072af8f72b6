"""Small steps whose solutions are forged: one or more for each kind of certificate."""

import numpy as np

from quasistatic_ref import Extra
from tests.made import X, Y, contacts_of, frames_about, free_step, point_step

FACING = frames_about(np.array([Y, -Y]), X)
"""Frames of two walls that face each other along y; rows d1, d2, n."""


def scenes():
    """Steps by the kind of their solution and a name."""
    slides = (4.0, 1.0, -2.943)
    sticks = (1.0, 0.5, -2.943)
    flies = (1.0, 0.0, 1.0)

    def on_floor(force, mu_v=0.5):
        return point_step(0.3, force, mu_v, 0.0, 0.01)

    walls = between_walls()
    held = walls.replace(extra=Extra(("held back",), -np.eye(3)[:1], [-2e-4]))
    apart = contacts_of((-1e-3, -1e-3), FACING, np.tile(np.eye(4, 3), (2, 1, 1)), 0.0)
    return {
        ("exact", "held back by a row of its own"): held.replace(cone="pyramid"),
        ("exact", "sticks, six rows of rank four"): on_floor(sticks),
        ("exact", "touches, but bears nothing"): on_floor((0.0, 0.0, 0.0), mu_v=0.0),
        ("exact in the ellipsoid", "sticks"): on_floor(sticks).replace(cone="ellipsoid"),
        ("exact in the ellipsoid", "flies"): on_floor(flies).replace(cone="ellipsoid"),
        ("enclosure", "slides"): on_floor(slides).replace(cone="ellipsoid"),
        ("residual", "slides"): on_floor(slides),
        ("residual in the ellipsoid", "slides"): on_floor(slides).replace(cone="ellipsoid"),
        ("none", "slides"): on_floor(slides),
        ("infeasible", "two walls apart"): on_floor(slides).replace(contacts=apart),
    }


def between_walls():
    """A ball that slides along a floor between two walls, each 1 m away."""
    frames = np.concatenate([np.eye(3)[None], FACING])
    J = np.tile(np.eye(4, 3), (3, 1, 1))
    contacts = contacts_of((0.0, 1.0, 1.0), frames, J, 0.5)
    return free_step(0.3 * np.eye(3), (4.0, 1.0, -2.943), contacts, 0.01).replace(cone="ellipsoid")
