"""Faces and edges of convex polytopes, for the closed form of a pair of them.

A capsule is a segment with a margin, its radius. So box, convex mesh and capsule are one family.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.numbers.ordered import dot, rotated
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.placed_shape import Box, Capsule, Shape
from quasistatic_ref.shapes.rounded import distance_to_rounded_box

UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class Polytope:
    """A convex polytope or a segment, with a ball of some radius about every point.

    Parameters
    ----------
    shape : Capsule, Box or ConvexMesh
    half_extents : ndarray, shape (3,)
        Of the core, a segment or a box [m]; of a mesh empty.
    margin : ndarray, shape ()
        [m].
    vertices : ndarray, shape (V, 3)
        Of the core [m].
    normals : ndarray, shape (F, 3)
        Outward unit normals of its faces. A segment has three, at right angles to it, and is
        three edges, so that each has a face on either side like any other.
    offsets : ndarray, shape (F,)
        Of those faces' planes [m].
    edges : ndarray of int, shape (E, 2)
        Vertices at the ends of each edge.
    sides : ndarray of int, shape (E, 2)
        The two faces that meet there.

    Of P :func:`stacked` ones, shapes of all but edges and sides begin with P.
    """

    shape: Shape
    half_extents: Array
    margin: Array
    vertices: Array
    normals: Array
    offsets: Array
    edges: Indices
    sides: Indices

    @cached_property
    def tails(self) -> Array:
        """Where each edge begins, shape (E, 3) [m]."""
        return self.vertices[..., self.edges[:, 0], :]

    @cached_property
    def ways(self) -> Array:
        """The vector from the beginning of each edge to its end, shape (E, 3) [m]."""
        return self.vertices[..., self.edges[:, 1], :] - self.tails

    @cached_property
    def stack_of_one(self) -> "Polytope":
        """The polytope as a stack of one."""
        return stacked([self])

    def in_frame(self, R: Array, t: Array) -> "Polytope":
        """Stacked polytopes in other frames, x' = R x + t (`shape` stays in its own).

        Parameters
        ----------
        R, t : ndarray, shapes (P, 3, 3) and (P, 3)
            [-] and [m].
        """
        normals = rotated(R[:, None], self.normals)
        vertices = rotated(R[:, None], self.vertices) + t[:, None]
        offsets = self.offsets + dot(normals, t[:, None])
        return replace(self, vertices=vertices, normals=normals, offsets=offsets)

    def part(self, edges: Indices) -> "Polytope":
        """The polytope with some of its edges, the faces beside them, and all of its corners."""
        faces, sides = np.unique(self.sides[edges], return_inverse=True)
        return replace(
            self,
            normals=self.normals[..., faces, :],
            offsets=self.offsets[..., faces],
            edges=self.edges[edges],
            sides=sides.reshape(-1, 2),
        )

    def core_distance(self, points: Array) -> tuple[Array, Array]:
        """Signed distances and normals of points (P, N, 3) [m], in each one's own frame."""
        flat = points.reshape(-1, 3)
        if isinstance(self.shape, ConvexMesh):
            phi, normal = self.shape.signed_distance(flat)
        else:
            half_extents = np.repeat(self.half_extents, points.shape[1], axis=0)
            phi, normal = distance_to_rounded_box(flat, half_extents)
        return phi.reshape(points.shape[:2]), normal.reshape(points.shape)


def stacked(polytopes: Sequence[Polytope]) -> Polytope:
    """Several `polytopes` as one: boxes, or one mesh."""
    return replace(
        polytopes[0],
        half_extents=np.array([one.half_extents for one in polytopes]),
        margin=np.array([one.margin for one in polytopes]),
        vertices=np.array([one.vertices for one in polytopes]),
        normals=np.array([one.normals for one in polytopes]),
        offsets=np.array([one.offsets for one in polytopes]),
    )


def polytope(shape: Shape) -> Polytope | None:
    """A shape as a polytope in its own frame, kept with the shape; None if it is not one."""
    kept = shape.__dict__
    if "_polytope" not in kept:
        kept["_polytope"] = _polytope(shape)
    found: Polytope | None = kept["_polytope"]
    return found


@lru_cache(maxsize=256)
def _polytope(shape: Shape) -> Polytope | None:
    """The same, one for shapes that are equal."""
    match shape:
        case Capsule():
            ends, radius = shape.corners(UP)
            x = -0.5
            y = math.sqrt(0.75)  # of a third of a turn
            around = np.array([[1.0, 0.0, 0.0], [x, y, 0.0], [x, -y, 0.0]])
            sides = np.array([[0, 1], [1, 2], [2, 0]])
            edges = np.array([[0, 1]] * 3)
            half_extents, _ = shape.core
            margin = np.array(radius)
            return Polytope(shape, half_extents, margin, ends, around, np.zeros(3), edges, sides)
        case Box():
            return _box(shape)
        case ConvexMesh():
            return _mesh(shape)
        case _:
            return None


def _box(box: Box) -> Polytope:
    bits = (np.arange(8)[:, None] >> np.array([0, 1, 2])) & 1
    normals = np.concatenate([np.eye(3), -np.eye(3)])
    edges = []
    sides = []
    for axis in range(3):
        first = (axis + 1) % 3
        second = (axis + 2) % 3
        for corner in np.flatnonzero(bits[:, axis] == 0):
            edges.append((corner, corner | 1 << axis))
            sides.append([a if bits[corner, a] else a + 3 for a in (first, second)])
    vertices, radius = box.corners(UP)
    half = box.half_extents
    margin = np.array(radius)
    offsets = np.tile(half, 2)
    return Polytope(box, half, margin, vertices, normals, offsets, np.array(edges), np.array(sides))


def _mesh(mesh: ConvexMesh) -> Polytope:
    """A mesh as a polytope: coplanar triangles form one face, without edges between them."""
    every = np.column_stack([mesh.normals, mesh.offsets])
    planes, face = np.unique(every, axis=0, return_inverse=True)
    face = face.reshape(-1)
    pairs = np.concatenate([np.roll(mesh.triangles, -k, axis=1)[:, :2] for k in range(3)])
    owner = np.tile(face, 3)
    order = np.lexsort(np.sort(pairs, axis=1).T)
    edges = np.sort(pairs, axis=1)[order].reshape(-1, 2, 2)[:, 0]
    sides = owner[order].reshape(-1, 2)
    real = sides[:, 0] != sides[:, 1]
    none = np.zeros(0)
    normals = planes[:, :3]
    edges = edges[real]
    sides = sides[real]
    return Polytope(mesh, none, np.array(0.0), mesh.vertices, normals, planes[:, 3], edges, sides)
