"""Where the two sides of many pairs are, all at once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from quasistatic_ref.model.shapes import PlacedShape
from quasistatic_ref.step.data import Array


class PairPoses(NamedTuple):
    """Poses of the sides of P pairs: a solid, and points of another body.

    Parameters
    ----------
    R, t : ndarray, shapes (2 P, 3, 3) and (2 P, 3)
        From the shapes' frames to the world [-], [m]: those of the solids, then of the points.
    R_rel, t_rel : ndarray, shapes (P, 3, 3) and (P, 3)
        From the points' frame to the solid's.
    """

    R: Array
    t: Array
    R_rel: Array
    t_rel: Array


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
        self.R = np.array([side.R for side in sides]).reshape(-1, 3, 3)
        self.t = np.array([side.t for side in sides]).reshape(-1, 3, 1)

    def poses(self, R: Array, t: Array) -> PairPoses:
        """Poses from those of the links, shapes (L, 3, 3) and (L, 3).

        Each product is one of 3 x 3 matrices, whatever the number of pairs, so that a pair's pose
        does not depend on the others.
        """
        R_link = R.take(self.link, axis=0)
        R_all = R_link @ self.R
        t_all = (R_link @ self.t)[..., 0] + t.take(self.link, axis=0)
        inverse = R_all[: self.P].transpose(0, 2, 1)
        apart = t_all[self.P :] - t_all[: self.P]
        return PairPoses(
            R_all, t_all, inverse @ R_all[self.P :], (inverse @ apart[..., None])[..., 0]
        )


def rotated(R: Array, points: Array) -> Array:
    """Points (..., 3) turned by R, shape (3, 3), or one for each, shape (..., 3, 3)."""
    # Not `@`: BLAS may sum in another order for another number of points, and a point's
    # distance must not depend on its company.
    return np.asarray(
        points[..., :1] * R[..., 0] + points[..., 1:2] * R[..., 1] + points[..., 2:] * R[..., 2]
    )
