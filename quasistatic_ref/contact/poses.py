"""Where the two sides of many pairs are, all at once."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from quasistatic_ref.shapes.placed_shape import PlacedShape
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.ordered import product


class PairPoses(NamedTuple):
    """Poses of the sides of P pairs: a solid, and points of another body.

    Parameters
    ----------
    R, t : ndarray, shapes (2 P, 3, 3) and (2 P, 3)
        From the shapes' frames to the world [-], [m]: those of the solids, then of the points.
    relative : ndarray, shape (P, 3, 4)
        [R, t] from the points' frame to the solid's.
    """

    R: Array
    t: Array
    relative: Array

    @property
    def R_rel(self) -> Array:
        """Rotations from the points' frame to the solid's, shape (P, 3, 3)."""
        return self.relative[..., :3]

    @property
    def t_rel(self) -> Array:
        """Origins of the points' frame in the solid's, shape (P, 3) [m]."""
        return self.relative[..., 3]


class Placements:
    """Where shapes are on their links: constants of a run.

    Parameters
    ----------
    solids, clouds : sequence of PlacedShape, length P
    """

    def __init__(self, solids: Sequence[PlacedShape], clouds: Sequence[PlacedShape]) -> None:
        sides = (*solids, *clouds)
        self.P = len(solids)
        self.link = np.array([side.link for side in sides], dtype=np.int64)
        on_link = [np.column_stack([side.R, side.t]) for side in sides]
        self.on_link = np.array(on_link).reshape(-1, 3, 4)

    def poses(self, R: Array, t: Array) -> PairPoses:
        """Poses from those of the links, shapes (L, 3, 3) and (L, 3)."""
        world = product(R.take(self.link, axis=0), self.on_link)
        rotation, origin = world[..., :3], world[..., 3]
        origin += t.take(self.link, axis=0)
        apart = world[self.P :].copy()  # the points' poses, from the origins of their solids
        apart[..., 3] = origin[self.P :] - origin[: self.P]
        relative = product(rotation[: self.P].transpose(0, 2, 1), apart)
        return PairPoses(rotation, origin, relative)
