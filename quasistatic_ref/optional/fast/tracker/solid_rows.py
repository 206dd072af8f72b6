"""Signed distances of rows of points, each row to a solid of its own, by few NumPy calls."""

from collections.abc import Sequence

import numpy as np

from quasistatic_ref.contact.cloud import signed_distance
from quasistatic_ref.shapes.placed_shape import HalfSpace, Shape
from quasistatic_ref.shapes.rounded import Rounded, distance_to_rounded_box
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.ordered import dot


def kind_order(shapes: Sequence[Shape]) -> list[int]:
    """The order in which solids of one kind follow each other, as :class:`SolidRows` needs it."""
    return sorted(range(len(shapes)), key=lambda i: _rank(shapes[i]))


def _rank(shape: Shape) -> int:
    if isinstance(shape, Rounded):
        return 0
    return 1 if isinstance(shape, HalfSpace) else 2


class SolidRows:
    """P solids in :func:`kind_order`, each to be measured from W points of its own.

    The bits are those of :func:`~quasistatic_ref.contact.cloud.signed_distance`.

    Parameters
    ----------
    shapes : sequence of Shape, length P
    W : int
    """

    def __init__(self, shapes: Sequence[Shape], W: int) -> None:
        ranks = [_rank(shape) for shape in shapes]
        cores = [s.core for s in shapes if isinstance(s, Rounded)]
        walls = [s for s in shapes if isinstance(s, HalfSpace)]
        first, second = len(cores) * W, (len(cores) + len(walls)) * W
        self.boxes, self.planes = slice(0, first), slice(first, second)
        self.half_extents = _repeated([half_extents for half_extents, _ in cores], W)
        self.ball = np.repeat([radius for _, radius in cores], W)
        self.n = _repeated([wall.normal for wall in walls], W)
        self.offset = np.repeat([wall.offset for wall in walls], W)
        self.others = [
            (slice(p * W, (p + 1) * W), shape) for p, shape in enumerate(shapes) if ranks[p] == 2
        ]
        # Kept between calls: the normals of half-spaces stay what they are.
        self.normal = np.full((3, len(shapes) * W), np.nan).T
        self.normal[self.planes] = self.n

    def __call__(self, x: Array) -> tuple[Array, Array]:
        """Signed distances and unit normals of points, a row of W after the other.

        Parameters
        ----------
        x : ndarray, shape (P W, 3)
            Each in its solid's frame [m]; NaN where a row is shorter.

        Returns
        -------
        phi : ndarray, shape (P W,)
            [m].
        normal : ndarray, shape (P W, 3)
            Until the next call.
        """
        phi, normal = np.empty(len(x)), self.normal
        if self.boxes.stop:
            phi[self.boxes], normal[self.boxes] = distance_to_rounded_box(
                x[self.boxes], self.half_extents, self.ball
            )
        if len(self.n):
            phi[self.planes] = dot(x[self.planes], self.n) - self.offset
        for row, shape in self.others:
            given = ~np.isnan(x[row, 0])
            phi[row], normal[row] = np.nan, np.nan
            phi[row][given], normal[row][given] = signed_distance(shape, x[row][given])
        return phi, normal


def _repeated(vectors: Sequence[Array], W: int) -> Array:
    """Each vector W times, shape (P W, 3), with x before y before z in memory like the points."""
    return np.repeat(np.array(vectors).reshape(-1, 3).T, W, axis=1).T
