"""Shapes of the vectors in exact numbers, where they stand in the world, and their polytopes."""

from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations, product
from typing import Any

import numpy as np
from flint import fmpq

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.lab.program.rotation import rotation
from quasistatic_ref.lab.vectors.exact.precision import (
    IDENTITY,
    ZERO,
    Matrix,
    Real,
    Vector,
    number,
    sign,
    vector,
)

SHAPES = {
    "sphere": ("radius",),
    "box": ("size",),
    "capsule": ("radius", "length"),
    "cylinder": ("radius", "length"),
    "cone": ("radius", "length"),
    "ellipsoid": ("half_axes",),
    "halfspace": ("normal", "offset"),
    "convex": ("vertices",),
    "cloud": ("points",),
}
"""Fields of each kind in addition to ``kind``: full lengths, along the local z axis."""


@dataclass(frozen=True, eq=False)
class Placed:
    """A shape in the world, x_world = R x + t; all numbers are rational.

    Parameters
    ----------
    kind : str
    R, t : matrix and vector
    sizes : list
        ``radius`` and half the ``length``, the half axes, or half of each ``size`` [m]; of a
        half-space its normal, of any length, and offset.
    points : list of vector
        Vertices of a convex body, or the points of a cloud, in the shape's own frame.
    """

    kind: str
    R: Matrix
    t: Vector
    sizes: Vector
    points: list[Vector]

    def local(self, x: Vector) -> Vector:
        """Coordinates of a point of the world in the shape's own frame."""
        return self.R.T @ (x - self.t)

    def local_direction(self, x: Vector) -> Vector:
        """The same of a direction."""
        return self.R.T @ x

    def world(self, x: Vector) -> Vector:
        """Coordinates in the world of a point of the shape's own frame."""
        return self.R @ x + self.t

    def world_direction(self, x: Vector) -> Vector:
        """The same of a direction."""
        return self.R @ x

    def world_normal(self, x: Vector) -> Vector:
        """A normal of a plane in the world: at right angles to what R makes of the plane.

        Where R is a rotation to some digits only, R x is not. Its cofactors make one that is.
        """
        rows = [np.cross(self.R[i - 2], self.R[i - 1]) for i in range(3)]
        return np.array(rows) @ x

    @property
    def normal(self) -> Vector:
        """Of a half-space, its normal in the world, of any length."""
        return self.world_direction(self.sizes[:3])


def placed_shape(shape: dict[str, Any], pose: dict[str, Any]) -> Placed:
    """A shape as written in a case.

    Raises
    ------
    InputError
        If the kind is unknown, or its fields are not those of the kind.
    """
    kind = shape.get("kind")
    if kind not in SHAPES:
        problem = f"is not a kind of shape{suggestion(str(kind), SHAPES)}"
        raise InputError(problem, field="shape.kind", value=kind)
    if set(shape) != {"kind", *SHAPES[kind]}:
        problem = f"a {kind} has the fields {', '.join(SHAPES[kind])}"
        raise InputError(problem, field="shape", value=sorted(shape))
    R = rotation(vector(pose["quaternion"]))
    t = vector(pose["xyz"])
    sizes: list[Real] = []
    points: list[Vector] = []
    match kind:
        case "sphere":
            sizes = [number(shape["radius"])]
        case "capsule" | "cylinder" | "cone":
            sizes = [number(shape["radius"]), number(shape["length"]) / 2]
        case "box":
            sizes = [number(x) / 2 for x in shape["size"]]
        case "ellipsoid":
            sizes = [number(x) for x in shape["half_axes"]]
        case "halfspace":
            sizes = [number(x) for x in (*shape["normal"], shape["offset"])]
        case _:
            points = [vector(x) for x in shape[SHAPES[kind][0]]]
    return Placed(kind, R, t, np.array(sizes), points)


@dataclass(frozen=True, eq=False)
class Core:
    """A point, a segment or a convex polytope, with a ball of some radius about every point.

    Parameters
    ----------
    margin : number
        That radius [m].
    vertices : list of vector
        In the world [m].
    normals : list of vector
        Outward normals of its faces, of any length; none of a point or a segment.
    edges : list of vector
        Directions of its edges, each once.
    sides : list of (int, int)
        The vertices at the ends of each edge.
    """

    margin: Real
    vertices: list[Vector]
    normals: list[Vector]
    edges: list[Vector]
    sides: list[tuple[int, int]]


def core(solid: Placed) -> Core | None:
    """The polytope that a shape is, but for its margin; None where it is none."""
    zero = fmpq(0)
    match solid.kind:
        case "sphere":
            local = Core(solid.sizes[0], [ZERO], [], [], [])
        case "capsule":
            margin, half = solid.sizes
            ends = [-half * IDENTITY[2], half * IDENTITY[2]]
            local = Core(margin, ends, [], [IDENTITY[2]], [(0, 1)])
        case "box":
            corners = [np.array(x) for x in product(*((-half, half) for half in solid.sizes))]
            faces = [*IDENTITY, *(-axis for axis in IDENTITY)]
            sides = [(k, k + step) for step in (4, 2, 1) for k in range(8) if not k & step]
            local = Core(zero, corners, faces, [*IDENTITY], sides)
        case "convex":
            local = _hull(tuple(tuple(point) for point in solid.points))
        case _:
            return None
    return Core(
        local.margin,
        [solid.world(x) for x in local.vertices],
        [solid.world_normal(x) for x in local.normals],
        [solid.world_direction(x) for x in local.edges],
        local.sides,
    )


@lru_cache(maxsize=64)
def _hull(points: tuple[tuple[Real, ...], ...]) -> Core:
    """Faces and edges of a convex hull, by trying the plane of every three points.

    Raises
    ------
    InputError
        If the points lie in one plane.
    """
    vertices = [np.array(point) for point in points]
    faces: dict[tuple[Real, ...], frozenset[int]] = {}
    for a, b, c in combinations(range(len(vertices)), 3):
        if any({a, b, c} <= members for members in faces.values()):
            continue
        normal = np.cross(vertices[b] - vertices[a], vertices[c] - vertices[a])
        if not any(normal):
            continue
        sides = [sign(normal @ (x - vertices[a])) for x in vertices]
        if min(sides) < 0 < max(sides):
            continue
        if max(sides) == min(sides):
            break
        outward = -normal if max(sides) > 0 else normal
        members = frozenset(k for k, side in enumerate(sides) if not side)
        faces[_direction(outward, signed=True)] = members
    if not faces:
        raise InputError("must not lie in one plane", field="vertices")
    edges: dict[tuple[Real, ...], None] = {}
    ends_of: list[tuple[int, int]] = []
    for one, other in combinations(faces.values(), 2):
        shared = sorted(one & other)
        if len(shared) > 1:
            # Of points on one line, the lexicographically least and largest are its ends.
            ends = sorted(shared, key=lambda k: points[k])
            way = vertices[ends[-1]] - vertices[ends[0]]
            edges[_direction(way, signed=False)] = None
            ends_of.append((ends[0], ends[-1]))
    return Core(fmpq(0), vertices, [*map(np.array, faces)], [*map(np.array, edges)], ends_of)


def _direction(x: Vector, signed: bool) -> tuple[Real, ...]:
    """Multiple of a direction that is the same for each of its multiples."""
    first = next(value for value in x if value)
    return tuple(value / (abs(first) if signed else first) for value in x)
