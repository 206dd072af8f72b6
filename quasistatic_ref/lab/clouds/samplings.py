"""Clouds of points on a closed triangle mesh, drawn in four ways."""

import heapq
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from quasistatic_ref.step.data import Array

CANDIDATES = 4
"""Random points for each point of a farthest-point cloud."""
VIEWS = 4
"""Directions from which a scanner looks at the body."""
GRAZING = 0.3
"""A scanner sees no surface whose normal has a smaller cosine with its direction."""
HOLES = 5
HOLE = 0.008
"""Radius of a hole of a scan [m]."""
NOISE = 2e-4
"""Standard deviation of a scanned point along the normal [m]."""


class Mesh:
    """A closed triangle mesh.

    Parameters
    ----------
    vertices : ndarray, shape (V, 3)
        [m].
    triangles : ndarray of int, shape (T, 3)
        Counter-clockwise seen from outside.
    """

    def __init__(self, vertices: Array, triangles: NDArray[np.int64]) -> None:
        self.vertices = vertices
        self.triangles = triangles
        a, b, c = np.moveaxis(vertices[triangles], 1, 0)
        normals = np.cross(b - a, c - a)
        twice_area = np.linalg.norm(normals, axis=1)
        self.normals = normals / twice_area[:, None]
        self.areas = twice_area / 2

    def points_at(self, rng: np.random.Generator, count: int) -> tuple[Array, Array]:
        """Points uniformly distributed over the area, and the normals there, each (count, 3)."""
        of = rng.choice(len(self.areas), count, p=self.areas / self.areas.sum())
        towards_b, towards_c = rng.random((2, count, 1))
        beyond = towards_b + towards_c > 1.0  # in the other half of the parallelogram
        towards_b, towards_c = (np.where(beyond, 1.0 - x, x) for x in (towards_b, towards_c))
        a, b, c = np.moveaxis(self.vertices[self.triangles[of]], 1, 0)
        return a + towards_b * (b - a) + towards_c * (c - a), self.normals[of]

    def subdivided(self) -> "Mesh":
        """The same surface; the middle of each edge is a vertex as well."""
        edges = np.sort(self.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        unique, of = np.unique(edges, axis=0, return_inverse=True)
        middles = self.vertices[unique].mean(axis=1)
        ab, bc, ca = (of.reshape(-1, 3) + len(self.vertices)).T
        a, b, c = self.triangles.T
        parts = np.concatenate([(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)], axis=1)
        return Mesh(np.concatenate([self.vertices, middles]), parts.T)


def random_points(mesh: Mesh, count: int, rng: np.random.Generator) -> Array:
    """Points drawn independently, uniform over the area, shape (count, 3) [m]."""
    return mesh.points_at(rng, count)[0]


def farthest_points(mesh: Mesh, count: int, rng: np.random.Generator) -> Array:
    """Points each of which is, of many, the farthest from those before it, shape (count, 3) [m].

    A new point changes the distance of those candidates only that are nearer to it than the
    largest distance. A heap gives the farthest, and drops entries that are out of date.
    """
    candidates = random_points(mesh, CANDIDATES * count, rng)
    tree = cKDTree(candidates)
    chosen = [0]
    distance = np.linalg.norm(candidates - candidates[0], axis=1)
    heap = [(-far, i) for i, far in enumerate(distance.tolist())]
    heapq.heapify(heap)
    while len(chosen) < count:
        far, farthest = heapq.heappop(heap)
        if -far > distance[farthest]:
            continue
        chosen.append(farthest)
        near = np.array(tree.query_ball_point(candidates[farthest], -far))
        now = np.linalg.norm(candidates[near] - candidates[farthest], axis=1)
        nearer = now < distance[near]
        distance[near[nearer]] = now[nearer]
        for i, value in zip(near[nearer].tolist(), now[nearer].tolist(), strict=True):
            heapq.heappush(heap, (-value, i))
    return candidates[chosen]


def some_vertices(mesh: Mesh, count: int, rng: np.random.Generator) -> Array:
    """Vertices of the mesh, subdivided until it has enough of them, shape (count, 3) [m]."""
    while len(mesh.vertices) < count:
        mesh = mesh.subdivided()
    return mesh.vertices[rng.permutation(len(mesh.vertices))[:count]]


def scan(mesh: Mesh, count: int, rng: np.random.Generator) -> Array:
    """Points as scans from a few sides have them, noise and holes, shape (count, 3) [m].

    Points whose normal is too far from every direction of view are missing, and those within
    balls about some points of the surface. Occlusion is left out.
    """
    views = rng.normal(size=(VIEWS, 3))
    views /= np.linalg.norm(views, axis=1, keepdims=True)
    middles = random_points(mesh, HOLES, rng)
    points_seen = np.zeros((0, 3))
    while len(points_seen) < count:
        points, normals = mesh.points_at(rng, count)
        seen = (normals @ views.T > GRAZING).any(axis=1)
        distances = np.linalg.norm(points[:, None] - middles, axis=2)
        kept = seen & (distances > HOLE).all(axis=1)
        noise = NOISE * rng.normal(size=(count, 1)) * normals
        points_seen = np.concatenate([points_seen, (points + noise)[kept]])
    return points_seen[:count]


SAMPLINGS: dict[str, Callable[[Mesh, int, np.random.Generator], Array]] = {
    "random": random_points,
    "farthest": farthest_points,
    "vertices": some_vertices,
    "scan": scan,
}
"""Ways of drawing a cloud: (mesh, number of points, random numbers) -> points [m]."""
