r"""Which faces and edges of two polytopes can be where they are nearest or cross.

Let s(n) be the gap of the two along a unit vector n, and p any point of b. For a face of a with
normal n in the plane n x = c,

.. math:: s(n) = \min_{v \in b} n^T v - c \le n^T p - c,

and where the normal is on the arc of an edge between faces 1 and 2, the gap is at most the larger
of n_1 p - c_1 and n_2 p - c_2, divided by the cosine of half the angle between them if positive. A
few points p, those of b that faces of a come nearest to, bound all faces and edges of a; what stays
below the gap along some face is neither nearest nor as near.
"""

from typing import Final

import numpy as np

from quasistatic_ref.contact.solids.polytope import Polytope
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.numbers.ordered import norm
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.tolerances import ON_SURFACE

MANY_FEATURES: Final = 20_000
"""Pairs of edges from which some are left out: of fewer each is looked at in less time."""
ROUNDED: Final = 4e-16 / ON_SURFACE
"""How far the direction of the common normal of two edges is off that are nearly parallel [-]."""
FAR_SIZES: Final = 10.0
"""Sizes [-] beyond which bodies count as that far.

There a normal that is off counts only where it leads from one of the nearest points to the other,
within OUTSIDE_FACE of the distance D: else their difference takes its place. Edges with that normal
n and a computed gap of D have a difference d of tails with n'd = D, and |d - D n| is at most the
bodies' sizes. With a normal that is off by r = ROUNDED the gap is off by r |d - D n| + r^2 D / 2,
which is less than r (1 + FAR_SIZES) sizes up to 4e4 sizes: such edges are not left out."""
POINTS: Final = 40
"""Most points of a body that bound the gaps of the other's faces."""


def are_fine(a: Polytope, b: Polytope) -> bool:
    """Whether a pair has so many edges that bounds on them save time."""
    one = a.vertices.shape[0] == 1
    of_mesh = isinstance(a.shape, ConvexMesh) or isinstance(b.shape, ConvexMesh)
    return one and of_mesh and len(a.edges) * len(b.edges) > MANY_FEATURES


def giving_way(a: Polytope, b: Polytope) -> float:
    """Slack added to bounds of gaps to allow for rounding [m].

    Parameters
    ----------
    a, b : Polytope
        One each, in one frame.
    """
    size = sum(float(np.ptp(one.vertices[0], axis=0).max()) for one in (a, b))
    apart = float(norm(a.vertices[0, 0] - b.vertices[0, 0]))
    return ROUNDED * (size + min(apart, FAR_SIZES * size))


class _Side:
    """The faces of one body, and the largest gap that each can have to the other.

    Parameters
    ----------
    own, other : Polytope
    """

    def __init__(self, own: Polytope, other: Polytope) -> None:
        self.normals = own.normals[0]
        self.sides = own.sides
        self.points = other.vertices[0]
        self.offsets = own.offsets[0]
        self.bound = np.full(len(self.normals), np.inf)
        first, second = self.sides.T
        cosine = np.einsum("ei,ei->e", self.normals[first], self.normals[second])
        self.cosine = np.sqrt(np.maximum(1.0 + cosine, 1e-9) / 2)
        self.edge_bound = np.full(len(self.sides), np.inf)

    def bounded_by(self, point: Array) -> None:
        """Tighten the bounds of this body's faces by a point (3,) [m] of the other body."""
        above = self.normals @ point - self.offsets
        np.minimum(self.bound, above, out=self.bound)
        first, second = self.sides.T
        of_edge = np.maximum(above[first], above[second])
        of_edge = np.where(of_edge > 0, of_edge / self.cosine, of_edge)
        np.minimum(self.edge_bound, of_edge, out=self.edge_bound)

    def lowest(self, n: Array) -> int:
        """The number of the other's corner that is least far along n, (3,) [-]."""
        return int((self.points @ n).argmin())


def near_features(a: Polytope, b: Polytope, within: float) -> list[Indices]:
    """The faces and edges that give the largest gap of two bodies, or one as large.

    Parameters
    ----------
    a, b : Polytope
        One each, in one frame.
    within : float
        Difference of gaps that are as large [m].

    Returns
    -------
    faces_a, faces_b, edges_a, edges_b : ndarray of int, shape (N,)
        Numbers of each, in ascending order.
    """
    sides = _Side(a, b), _Side(b, a)
    way = b.vertices[0].mean(axis=0) - a.vertices[0].mean(axis=0)
    for side, sign in zip(sides, (1.0, -1.0), strict=True):
        side.bounded_by(side.points[side.lowest(sign * way)])
    largest = -np.inf
    gives = giving_way(a, b)
    for _ in range(POINTS):
        side = max(sides, key=lambda one: one.bound.max())
        face = int(side.bound.argmax())
        if side.bound[face] <= largest + gives:
            break
        n = side.normals[face]
        point = side.points[side.lowest(n)]
        largest = max(largest, float(n @ point - side.offsets[face]))
        side.bounded_by(point)
    least = largest - within - gives
    bounds = [side.bound for side in sides] + [side.edge_bound for side in sides]
    return [np.flatnonzero(bound >= least) for bound in bounds]


def edges_within(a: Polytope, b: Polytope, ways: Array, bound: float) -> tuple[Indices, Indices]:
    """The edges of two bodies that can be within a `bound` [m] of each other, by planes.

    Parameters
    ----------
    a, b : Polytope
        One each, in one frame.
    ways : ndarray, shape (W, 3)
        Normals of planes from a to b [-].
    bound : float
        [m].
    """
    high = ways @ a.vertices[0].T
    low = ways @ b.vertices[0].T
    ends_a = np.maximum(high[:, a.edges[:, 0]], high[:, a.edges[:, 1]])
    ends_b = np.minimum(low[:, b.edges[:, 0]], low[:, b.edges[:, 1]])
    may_a = (low.min(axis=1)[:, None] - ends_a <= bound).all(axis=0)
    may_b = (ends_b - high.max(axis=1)[:, None] <= bound).all(axis=0)
    return np.flatnonzero(may_a), np.flatnonzero(may_b)
